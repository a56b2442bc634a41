# SPDX-License-Identifier: GPL-3.0-or-later

"""Results and user files survive concurrent runs in one folder, killed runs, full disks and read-only folders."""

import json
import os
import resource
import shutil
import signal
import subprocess
import time
import unittest

from program import EXECUTABLE, ProgramTest, contents, settings

TABLES = ["component_modes.csv", "real_modes.csv", "complex_modes.csv"]

# All mode shapes are written, which takes half of the run time
LONG = ["Output/Mode shapes=all", "Output/Animation frames=3"]


def limit_files(size):
    """Function for preexec_fn that limits the size of the files that a process writes [byte]."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


class LostResults(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.results = cls.run_scene("results")

    def setUp(self):
        self.addCleanup(self.clean)

    def clean(self):
        """Removes everything except the parameter file and the first results."""
        for path in self.folder.iterdir():
            if path.name not in ("results", "scene.prm"):
                shutil.rmtree(path) if path.is_dir() and not path.is_symlink() else path.unlink()

    def copy(self, name="copy"):
        shutil.copytree(self.results, self.folder / name)
        return self.folder / name

    def start(self, output, *overrides, **options):
        process = subprocess.Popen([EXECUTABLE, "scene.prm", "--output", output, *settings(overrides)], cwd=self.folder, text=True,
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
            self.assertIsNone(process.poll(), "the run ended before the expected state was reached")
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.005)

    def assert_complete(self, folder):
        """Checks that every file in the record exists with the recorded size."""
        record = json.loads((folder / "run.json").read_text(encoding="utf-8"))
        sizes = record["files [byte]"]
        self.assertLessEqual({*TABLES, "parameters.prm", "mesh.msh"}, set(sizes))
        self.assertEqual({name: (folder / name).stat().st_size for name in sizes}, sizes)

    def refused(self, mentions, *words):
        """Checks that the run is rejected before meshing and changes no files."""
        before = contents(self.folder)
        process = self.call(*words)
        self.assertEqual(contents(self.folder), before)
        self.assertNotIn("Mesh", process.stdout)
        self.assertEqual(process.returncode, 1)
        self.assert_message(process, mentions)


class TwoRuns(LostResults):
    def test_the_second_is_refused(self):
        (self.folder / "link").symlink_to("shared")
        first = self.start("shared", *LONG)
        self.wait_for((self.folder / "shared" / ".unfinished").is_dir, first)
        first.send_signal(signal.SIGSTOP)
        for name in ("shared/", "link"):
            second = self.call("scene.prm", "--output", name)
            self.assert_message(second, ["another run", f"--output {name.rstrip('/')}"])
        first.send_signal(signal.SIGCONT)
        first.communicate()
        self.assertEqual(first.returncode, 0)
        self.assert_complete(self.folder / "shared")
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["link", "results", "scene.prm", "shared"])

    def test_an_ended_run_leaves_the_former_results_and_keeps_nobody_out(self):
        copy = self.copy()
        before = contents(copy)
        for ending in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
            process = self.start("copy", *LONG)
            self.wait_for((copy / ".unfinished" / "modes").is_dir, process)
            process.send_signal(ending)
            process.communicate()
            self.assertEqual(process.returncode, -ending)
            self.assertEqual({name: content for name, content in contents(copy).items() if not name.startswith(".unfinished")}, before)
        self.run_scene("copy")
        self.assert_complete(copy)
        self.assertEqual([path.name for path in copy.glob(".*")], [])


class Places(LostResults):
    def test_refusals(self):
        (self.folder / "circle").symlink_to("circle")
        (self.folder / "file").touch()
        for output, mentions in {".": ["`.`", "not the results"], "": ["empty"], "file/": ["`file` is a file"],
                                 "file/results": ["Not a directory", "file/results"], "circle": ["symbolic links"],
                                 "/proc/results": ["/proc/results"]}.items():
            with self.subTest(output):
                self.refused(mentions, "scene.prm", "--output", output)

    @unittest.skipIf(os.geteuid() == 0, "root may write everywhere")
    def test_permissions(self):
        copy = self.copy()
        for mode in (0o500, 0o000):
            copy.chmod(mode)
            self.addCleanup(copy.chmod, 0o700)
            self.refused(["Permission denied"], "scene.prm", "--output", "copy")


class FullDisks(LostResults):
    EVERYTHING = ["Output/Mode shapes=unstable", "Output/Write matrices=true"]

    def assert_not_written(self, process, name, cause):
        streams = process.communicate()
        self.assertEqual(process.returncode, 1, streams)
        self.assert_message(subprocess.CompletedProcess(process.args, 1, *streams), [name, cause])

    def test_limited_sizes(self):
        """The message names the first file beyond the limit, regardless of the library that writes it."""
        sizes = json.loads((self.run_scene("whole", *self.EVERYTHING) / "run.json").read_text(encoding="utf-8"))["files [byte]"]
        copy = self.copy()
        before = contents(copy)
        largest = {ending: max((name for name in sizes if name.endswith(ending)), key=sizes.get) for ending in (".mtx", ".msh", ".vtu")}
        self.assertGreater(sizes[largest[".mtx"]], sizes[largest[".msh"]])
        for ending, overrides in {".mtx": self.EVERYTHING, ".msh": self.EVERYTHING[2:], ".vtu": self.EVERYTHING[:1]}.items():
            process = self.start("copy", *overrides, preexec_fn=limit_files(sizes[largest[ending]] - 100))
            self.assert_not_written(process, largest[ending], "disk space" if ending == ".msh" else "File too large")
            self.assertEqual(contents(copy), before)
        process = self.start("new", preexec_fn=limit_files(1000))
        self.assert_not_written(process, "--output new", "File too large")
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
                                ("scene.prm", "--output", "--dry-run"): ["requires a value", "`--output`"],
                                ("results",): ["is a directory", "results"],
                                ("--", "--missing.prm"): ["cannot be read", "--missing.prm"]}.items():
            with self.subTest(words):
                self.refused(mentions, *words)


if __name__ == "__main__":
    unittest.main()
