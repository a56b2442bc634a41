"""Results are never lost: two runs into one folder, files of the user, killed runs, full disks, folders that cannot be written."""

import json
import os
import resource
import shutil
import signal
import subprocess
import time
import unittest

from program import EXECUTABLE, ProgramTest, contents

TABLES = ["component_modes.csv", "real_modes.csv", "complex_modes.csv"]

# Every mode shape: half of the time of the run goes into writing.
LONG = ["Output/Mode shapes=all", "Output/Animation frames=3"]


def limit_files(size):
    """Lets a process write no file beyond this size [byte]."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


class LostResults(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.results = cls.run_scene("results")

    def setUp(self):
        """Everything beside the scene and the first results goes."""
        self.addCleanup(self.clean)

    def clean(self):
        for path in self.folder.iterdir():
            if path.name not in ("results", "scene.prm"):
                shutil.rmtree(path) if path.is_dir() and not path.is_symlink() else path.unlink()

    def copy(self, name="copy"):
        shutil.copytree(self.results, self.folder / name)
        return self.folder / name

    def start(self, output, *overrides, **options):
        settings = [word for override in overrides for word in ("--set", override)]
        process = subprocess.Popen([EXECUTABLE, "scene.prm", "--output", output, *settings], cwd=self.folder, text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)
        self.addCleanup(self.stop, process)
        return process

    @staticmethod
    def stop(process):
        if process.poll() is None:
            process.kill()
            process.communicate()

    def wait_for(self, condition, process):
        deadline = time.monotonic() + 60
        while not condition():
            self.assertIsNone(process.poll(), "the run ended too early")
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.005)

    def assert_complete(self, folder):
        """Every file that the record lists is there with its size."""
        record = json.loads((folder / "run.json").read_text(encoding="utf-8"))
        sizes = record["files [byte]"]
        self.assertLessEqual({*TABLES, "parameters.prm", "mesh.msh"}, set(sizes))
        self.assertEqual({name: (folder / name).stat().st_size for name in sizes}, sizes)

    def assert_refused(self, process, *mentions):
        """One error with its three parts, before any work."""
        self.assertEqual(process.returncode, 1, process.stderr)
        lines = process.stderr.strip().splitlines()
        for start in ("error: ", "  where:  ", "  change: "):
            self.assertEqual(sum(line.startswith(start) and len(line) > len(start) for line in lines), 1, process.stderr)
        for word in mentions:
            self.assertIn(word, process.stderr)
        self.assertNotIn("Component modes", process.stdout)

    def refused(self, output, *mentions):
        before = contents(self.folder)
        process = self.call("scene.prm", "--output", output)
        self.assertEqual(contents(self.folder), before)
        self.assertNotIn("Mesh", process.stdout)
        self.assert_refused(process, *mentions)


class TwoRuns(LostResults):
    def test_the_second_is_refused(self):
        (self.folder / "link").symlink_to("shared")
        first = self.start("shared", *LONG)
        self.wait_for((self.folder / "shared" / ".unfinished").is_dir, first)
        first.send_signal(signal.SIGSTOP)
        for name in ("shared", "shared/", "link"):
            second = self.call("scene.prm", "--output", name)
            self.assert_refused(second, "another run", f"--output {name.rstrip('/')}")
        first.send_signal(signal.SIGCONT)
        first.communicate()
        self.assertEqual(first.returncode, 0)
        self.assert_complete(self.folder / "shared")
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["link", "results", "scene.prm", "shared"])

    def test_a_killed_run_keeps_nobody_out(self):
        copy = self.copy()
        before = contents(copy)
        process = self.start("copy", *LONG)
        self.wait_for((copy / ".unfinished" / "modes").is_dir, process)
        process.kill()
        process.communicate()
        left = {name: content for name, content in contents(copy).items() if not name.startswith(".unfinished")}
        self.assertEqual(left, before)
        self.run_scene("copy")
        self.assert_complete(copy)
        self.assertEqual([path.name for path in copy.glob(".*")], [])

    def test_an_interrupted_run_leaves_the_former_results(self):
        for ending in (signal.SIGINT, signal.SIGTERM):
            copy = self.copy(ending.name)
            process = self.start(copy.name, *LONG)
            self.wait_for((copy / ".unfinished" / "modes").is_dir, process)
            process.send_signal(ending)
            process.communicate()
            self.assertEqual(process.returncode, -ending)
            self.assert_complete(copy)


class FilesOfTheUser(LostResults):
    def test_they_stay(self):
        shapes = self.run_scene("copy", "Output/Mode shapes=unstable")
        (shapes / "mynotes.txt").write_text("notes", encoding="utf-8")
        (shapes / "modes" / "mode.png").write_bytes(b"picture")
        (shapes / "own" / "deep").mkdir(parents=True)
        (shapes / "own" / "deep" / "data.csv").write_text("1,2", encoding="utf-8")
        (shapes / "latest").symlink_to("own/deep")
        self.run_scene("copy")
        self.assert_complete(shapes)
        self.assertEqual((shapes / "mynotes.txt").read_text(encoding="utf-8"), "notes")
        self.assertEqual((shapes / "modes" / "mode.png").read_bytes(), b"picture")
        self.assertEqual((shapes / "latest" / "data.csv").read_text(encoding="utf-8"), "1,2")
        # What the former run wrote is gone where this one does not write it.
        self.assertEqual([path.name for path in (shapes / "modes").iterdir()], ["mode.png"])
        self.assertFalse((shapes / "animations").exists())

class Places(LostResults):
    def test_refusals(self):
        (self.folder / "circle").symlink_to("circle")
        (self.folder / "file").touch()
        (self.folder / "taken").mkdir()
        (self.folder / "taken" / "thesis.tex").touch()
        self.refused(".", "`.`", "not the results")
        self.refused("taken", "`taken`", "not the results")
        self.refused("/", "`/`", "not the results")
        self.refused("", "empty")
        self.refused("file/", "`file` is a file")
        self.refused("file/results", "Not a directory", "file/results")
        self.refused("circle", "symbolic links")
        self.refused("x" * 300, "File name too long")
        self.refused("/proc/results", "/proc/results")

    @unittest.skipIf(os.geteuid() == 0, "root may write everywhere")
    def test_permissions(self):
        copy = self.copy()
        for mode in (0o500, 0o000):
            copy.chmod(mode)
            self.addCleanup(copy.chmod, 0o700)
            self.refused("copy", "Permission denied")

class FullDisks(LostResults):
    EVERYTHING = ["Output/Mode shapes=unstable", "Output/Write matrices=true"]

    def assert_not_written(self, process, name, cause, output):
        _, message = process.communicate()
        self.assertEqual(process.returncode, 1, message)
        self.assertEqual(message.count("error: "), 1, message)
        self.assertEqual(len(message.strip().splitlines()), 3, message)
        self.assertIn(name, message)
        self.assertIn(cause, message)
        self.assertEqual(list((self.folder / output).glob(".*")), [])

    def test_limited_sizes(self):
        """The first file beyond the limit is named, whoever writes it."""
        sizes = json.loads((self.run_scene("whole", *self.EVERYTHING) / "run.json").read_text(encoding="utf-8"))["files [byte]"]
        copy = self.copy()
        before = contents(copy)
        largest = {ending: max((name for name in sizes if name.endswith(ending)), key=sizes.get) for ending in (".mtx", ".msh", ".vtu")}
        self.assertGreater(sizes[largest[".mtx"]], sizes[largest[".msh"]])
        for ending, settings in {".mtx": self.EVERYTHING, ".msh": self.EVERYTHING[2:], ".vtu": self.EVERYTHING[:1]}.items():
            process = self.start("copy", *settings, preexec_fn=limit_files(sizes[largest[ending]] - 100))
            self.assert_not_written(process, largest[ending], "free space" if ending == ".msh" else "File too large", "copy")
            self.assertEqual(contents(copy), before)

    def test_nothing_can_be_written(self):
        process = self.start("new", preexec_fn=limit_files(1000))
        self.assert_not_written(process, "--output new", "File too large", "new")
        self.assertEqual(list(self.folder.glob("new*")), [])

    def test_screen(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            process = subprocess.run([EXECUTABLE, "--help"], stdout=full, stderr=subprocess.PIPE, text=True, timeout=60)
        self.assertEqual(process.returncode, 1)
        self.assertIn("standard output", process.stderr)


class CommandLine(LostResults):
    def test_words(self):
        self.assertEqual(self.call("-h").stdout, self.call("--help").stdout)
        for words, mentions in {("scene.prm", "--ouput", "x"): ["unknown option", "`--ouput`"],
                                ("-x", "scene.prm"): ["unknown option", "`-x`"],
                                ("scene.prm", "-nx", "--dry-run"): ["unknown option", "`-nx`"],
                                ("scene.prm", "--dry-run=1"): ["takes no value", "`--dry-run=1`"],
                                ("scene.prm", "--output", "--dry-run"): ["lacks its value", "`--output`"],
                                ("scene.prm", "--output", "a", "--output", "b"): ["more than one result folder", "`b`"],
                                ("results",): ["is a directory", "results"],
                                ("--", "--missing.prm"): ["cannot be read", "--missing.prm"]}.items():
            with self.subTest(words):
                self.assert_refused(self.call(*words), *mentions)

    def test_words_that_are_not_text(self):
        """File names may be any bytes; the record of the run stands all the same."""
        name = os.fsdecode(b"r\xff\xfe")
        process = self.start(name, errors="replace")
        process.communicate()
        self.assertEqual(process.returncode, 0)
        record = json.loads((self.folder / name / "run.json").read_text(encoding="utf-8"))
        self.assertIn("--output", record["command"])

    def test_options_are_not_those_of_libraries(self):
        process = self.call("scene.prm", "--dry-run", "--set", "Geometry/Disc layers=1")
        self.assertEqual(process.stderr, "")


if __name__ == "__main__":
    unittest.main()
