"""Faults at random moments: killed runs, full disks, folders that vanish, several runs at once, sweeps that go on.

The environment variable SQUEAL_TRIALS says how many moments each test tries.
"""

import concurrent.futures
import os
import random
import shutil
import signal
import subprocess
import time
import unittest

from program import ProgramTest, contents, read_table
from test_lost_results import EXECUTABLE, LONG, TimedRuns, limit_files

TRIALS = int(os.environ.get("SQUEAL_TRIALS", "6"))
PATIENCE = 120  # [s] for one run on a busy machine


def is_one_message(text):
    lines = text.strip().splitlines()
    return len(lines) == 3 and all(line.startswith(part) for line, part in zip(lines, ("error: ", "  where:  ", "  change: ")))


class Faults(TimedRuns):
    def at_random_moments(self, trial, seed):
        """Calls trial(number, delay), two at a time; it returns what is wrong."""
        numbers = random.Random(seed)
        delays = [numbers.uniform(0, 1.1 * self.duration) for _ in range(TRIALS)]
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            outcomes = list(pool.map(trial, range(TRIALS), delays))
        self.assertEqual([outcome for outcome in outcomes if outcome], [])

    def ending(self, process):
        """Exit status and message of a process."""
        _, message = process.communicate(timeout=PATIENCE)
        return process.returncode, message

    def is_complete(self, folder):
        try:
            self.assert_complete(folder)
        except (AssertionError, OSError):
            return False
        return True


class KilledRuns(Faults):
    def trial(self, number, delay):
        """The former or the new results are there and complete; the next run succeeds, and clears away what is left."""
        output = f"trial_{number}"
        self.copy(output)
        process = self.start(output, *LONG)
        time.sleep(delay)
        process.kill()
        self.ending(process)
        if (self.folder / output / "run.json").exists() and not self.is_complete(self.folder / output):
            return f"SIGKILL after {delay:.2f} s: the results are gone"
        next_run = self.call("scene.prm", "--output", output)
        left = [path.name for path in (self.folder / output).glob(".*")]
        if next_run.returncode != 0 or left or not self.is_complete(self.folder / output):
            return f"SIGKILL after {delay:.2f} s: then status {next_run.returncode}, {next_run.stderr!r}, left {left}"
        shutil.rmtree(self.folder / output)
        return None

    def test_at_random_moments(self):
        self.at_random_moments(self.trial, 1)


class FullDisks(Faults):
    def outcome(self, shown, process, folder, before):
        """What is wrong with a run that meets a full disk."""
        status, message = self.ending(process)
        left = [path.name for path in folder.glob(".*")]
        if left:
            return f"{shown}: left {left}"
        if status == 0:
            return None if self.is_complete(folder) and not message else f"{shown}: incomplete, {message!r}"
        causes = ("No space left on device", "File too large", "not everything could be printed")
        if status != 1 or not is_one_message(message) or not any(cause in message for cause in causes):
            return f"{shown}: status {status}, {message!r}"
        return None if contents(folder) == before else f"{shown}: results differ"

    def test_of_any_size(self):
        place = self.folder / "disk"
        place.mkdir()
        if os.geteuid() != 0 or subprocess.run(["mount", "-t", "tmpfs", "tmpfs", place], capture_output=True).returncode:
            self.skipTest("only root may mount a small disk")
        self.addCleanup(subprocess.run, ["umount", place], check=True)
        numbers, found = random.Random(2), []
        # None at all, then up to what everything needs
        for left in [0, 4096, *(int(numbers.uniform(0, 1.2) * self.needed) for _ in range(TRIALS))]:
            results = shutil.copytree(self.results, place / "results")
            used = shutil.disk_usage(place).used
            subprocess.run(["mount", "-o", f"remount,size={used + left}", place], check=True)
            found.append(self.outcome(f"{left} bytes left", self.start(str(results), *LONG), results, contents(results)))
            subprocess.run(["mount", "-o", "remount,size=1g", place], check=True)
            shutil.rmtree(results)
        self.assertEqual([text for text in found if text], [])

    def test_files_of_any_size(self):
        numbers, found = random.Random(3), []
        largest = max(path.stat().st_size for path in self.results.rglob("*"))
        for number in range(TRIALS):
            size = int(numbers.choice([10, 100, 1000, 10_000, largest]) * numbers.random())
            copy = self.copy(f"limited_{number}")
            found.append(self.outcome(f"limit {size}", self.start(copy.name, *LONG, preexec_fn=limit_files(size)), copy, contents(copy)))
        self.assertEqual([text for text in found if text], [])


class LostFolders(Faults):
    def trial(self, number, delay):
        """The folder of the unfinished results, that of the former ones, or the one about both vanishes."""
        parent = self.folder / f"parent_{number}"
        shutil.copytree(self.results, parent / "results")
        before = contents(parent / "results")
        lost = parent / ("results/.unfinished", "results", "")[number % 3]
        process = self.start(f"{parent.name}/results", *LONG)
        time.sleep(delay)
        for _ in range(100):  # while the program writes to it
            shutil.rmtree(lost, ignore_errors=True)
            if not lost.exists():
                break
        status, message = self.ending(process)
        shown = f"{lost.name} lost after {delay:.2f} s: status {status}, {message.strip()!r}"
        if status not in (0, 1) or (status == 1) != is_one_message(message) or "defect" in message:
            return shown
        if status == 1 and number % 3 == 0 and contents(parent / "results") != before:
            return f"{shown}, results differ"
        # Lost after the end of the run, or else there
        is_there = (parent / "results").exists()
        if status == 0 and is_there and not self.is_complete(parent / "results"):
            return f"{shown}, incomplete"
        return None

    def test_at_random_moments(self):
        self.at_random_moments(self.trial, 4)

    def test_of_the_program(self):
        """The folder in which the program was started is gone before it begins."""
        gone = self.folder / "gone"
        gone.mkdir()
        command = f'cd "{gone}" && rmdir "{gone}" && exec "{EXECUTABLE}" "{self.folder}/scene.prm" --output '
        for output in ("results", f"{self.folder}/elsewhere"):
            gone.mkdir(exist_ok=True)
            process = subprocess.run(["sh", "-c", command + output], text=True, capture_output=True, timeout=PATIENCE)
            self.assertEqual(process.returncode, 1, process.stderr)
            self.assertTrue(is_one_message(process.stderr), process.stderr)
            self.assertNotIn("defect", process.stderr)


class RunsAtOnce(Faults):
    def trial(self, number, delay):
        """Three runs into one folder: one after the other, or all but one are refused."""
        output = f"shared_{number}"
        processes = []
        for pause in (0, delay, 0.2 * delay):
            time.sleep(pause)
            processes.append(self.start(output))
        endings = [self.ending(process) for process in processes]
        left = [path.name for path in (self.folder / output).glob(".*")]
        shown = f"runs {delay:.2f} s apart: {endings}, left {left}"
        refused = [message for status, message in endings if status != 0]
        if left or len(refused) == 3 or any(status not in (0, 1) for status, _ in endings) or not self.is_complete(self.folder / output):
            return shown
        return None if all(is_one_message(message) and "another run" in message for message in refused) else shown

    def test_at_random_moments(self):
        self.at_random_moments(self.trial, 5)


class InterruptedSweeps(ProgramTest):
    SETTINGS = ["Study=sweep", "Sweep/First friction coefficient=0", "Sweep/Last friction coefficient=0.45",
                "Sweep/Number of friction coefficients=10", "Operation/Radial dissipation=consistent"]
    TABLES = ["branches.csv", "thresholds.csv", "counts.csv"]

    def start(self, output, **options):
        settings = [word for setting in self.SETTINGS for word in ("--set", setting)]
        return subprocess.Popen([EXECUTABLE, "scene.prm", "--output", output, *settings], cwd=self.folder, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        start = time.monotonic()
        cls.reference = cls.run_scene("reference", *cls.SETTINGS)
        cls.duration = time.monotonic() - start

    def assert_as_the_reference(self, output):
        for name in self.TABLES:
            self.assertEqual(read_table(self.folder / output / name), read_table(self.reference / name), name)

    def assert_nothing_beside(self, output):
        self.assertEqual([path.name for path in self.folder.glob(f"{output}.*")], [])

    def test_signals_at_random_moments(self):
        numbers, n_ended = random.Random(6), 0
        while n_ended < TRIALS:
            for attempt in range(100):
                process = self.start("resumed")
                time.sleep(numbers.uniform(0, 0.8 * self.duration) if n_ended < TRIALS else 0)
                ending = numbers.choice([signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
                if n_ended < TRIALS:
                    process.send_signal(ending)
                _, message = process.communicate(timeout=PATIENCE)
                if process.returncode == 0:
                    break
                n_ended += 1
                self.assertEqual(process.returncode, -ending, message)
                self.assertNotIn("error", message)
                # One that comes when the results are in their place finds them complete
                if (self.folder / "resumed" / "run.json").exists():
                    break
            self.assert_as_the_reference("resumed")
            if process.returncode != 0:
                # What had been kept for the next run may be there still: it takes it up, and clears it away
                process = self.start("resumed")
                _, message = process.communicate(timeout=PATIENCE)
                self.assertEqual(process.returncode, 0, message)
                self.assert_as_the_reference("resumed")
            self.assert_nothing_beside("resumed")
            shutil.rmtree(self.folder / "resumed")

    def test_disks_that_are_full(self):
        """What has been found before is kept, and serves when there is space again."""
        numbers = random.Random(7)
        for size in [0, 100, *(int(numbers.uniform(1e3, 1e6)) for _ in range(TRIALS // 2))]:
            process = self.start("full", preexec_fn=limit_files(size))
            _, message = process.communicate(timeout=PATIENCE)
            with self.subTest(size):
                self.assertEqual(process.returncode, 1, message)
                self.assertTrue(is_one_message(message), message)
                self.assertIn("File too large", message)
                self.assertFalse((self.folder / "full").exists())
        process = self.start("full")
        process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, 0)
        self.assert_as_the_reference("full")
        self.assert_nothing_beside("full")


if __name__ == "__main__":
    unittest.main()
