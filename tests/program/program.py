# SPDX-License-Identifier: GPL-3.0-or-later

"""Runs the executable on a small model and reads its results.

Environment variables: SQUEAL, the executable; MPIRUN, the launcher for several processes; STARTER, the optional library
of starter.cc.
"""

import atexit
import csv
import math
import os
import pathlib
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest

EXECUTABLE = os.path.abspath(os.environ["SQUEAL"])
MPIRUN = os.environ.get("MPIRUN", "mpirun")
SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(SOURCE / "scripts"), str(SOURCE / "python")]

# Two pins on each side, seven contact nodes per pin, large elements: 38 modes, including unstable modes of disc and pins;
# a run takes less than a second
SCENE = """
subsection Geometry
  set Top pin radii = 0.2275, 0.2275
  set Top pin angles = -10, 10
  set Bottom pin radii = 0.2275, 0.2275
  set Bottom pin angles = -10, 10
  set Nodes per pin face = 7
  set Pin layers = 2
  set Disc layers = 1
  set Element size = 0.04
end
subsection Output
  set Mode shapes = none
  set Animation frames = 3
end
"""

# A disc with fewer elements, for tests that do not need resolved modes
COARSE = SCENE.replace("Element size = 0.04", "Element size = 0.08")

COMPLEX_COLUMNS = ["label", "share [-]", "frequency [Hz]", "growth rate [1/s]", "divergence rate [%]", "effective damping ratio -2R/omega [%]",
                   "residual [-]", "eps_res [-]", "unstable [-]", "wave with rotation [-]", "wave against rotation [-]",
                   *(f"strain energy in {part} [%]" for part in ("disc", "pins", "mounts")), "verdict"]

# Largest relative difference of an eigenvalue computed by two methods [-]
SAME = 1e-9


def settings(overrides):
    """Command-line arguments for overrides "Section/Name=value"."""
    return [word for override in overrides for word in ("--set", override)]


class Starter:
    """Process of the program that has loaded its libraries and forks for every call (starter.cc)."""

    def __init__(self):
        self.socket, its_socket = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with its_socket:
            number = its_socket.fileno()
            self.process = subprocess.Popen([EXECUTABLE], pass_fds=[number],
                                            env={**os.environ, "LD_PRELOAD": os.environ["STARTER"], "SQUEAL_STARTER_SOCKET": str(number)})
        atexit.register(self.stop)

    def stop(self):
        self.socket.close()
        self.process.wait()

    def run(self, arguments, folder, timeout):
        words = [folder, EXECUTABLE, *arguments]
        with tempfile.TemporaryFile() as output, tempfile.TemporaryFile() as errors:
            socket.send_fds(self.socket, [b"".join(os.fsencode(word) + b"\0" for word in words)], [output.fileno(), errors.fileno()])
            self.socket.settimeout(timeout)
            try:
                status, = struct.unpack("i", self.socket.recv(struct.calcsize("i")))
            except TimeoutError:
                self.process.kill()  # also ends the forked process
                ProgramTest.starter = None
                raise
            texts = []
            for file in (output, errors):
                file.seek(0)
                texts.append(file.read().decode(errors="surrogateescape"))
        return subprocess.CompletedProcess(words[1:], os.waitstatus_to_exitcode(status), *texts)


class ProgramTest(unittest.TestCase):
    """Tests with a temporary folder that contains `scene` as scene.prm, shared by the tests of a class."""

    scene = SCENE
    starter = None

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        (cls.folder / "scene.prm").write_text(cls.scene, encoding="utf-8")

    @classmethod
    def call(cls, *arguments, n_processes=1):
        """Finished process of a call, without hwloc's messages on virtual machines."""
        if n_processes > 1 or "STARTER" not in os.environ:
            launcher = [MPIRUN, "-np", str(n_processes)] if n_processes > 1 else []
            process = subprocess.run([*launcher, EXECUTABLE, *arguments], cwd=cls.folder, text=True, errors="surrogateescape", capture_output=True,
                                     timeout=300)
        else:
            ProgramTest.starter = ProgramTest.starter or Starter()
            process = ProgramTest.starter.run(arguments, cls.folder, 300)
        process.stderr = "".join(line for line in process.stderr.splitlines(keepends=True) if not line.startswith("[hwloc"))
        return process

    @classmethod
    def call_scene(cls, output, *overrides):
        """Finished process for scene.prm with overrides "Section/Name=value"."""
        return cls.call("scene.prm", "--output", output, *settings(overrides))

    @classmethod
    def run_scene(cls, output, *overrides, file="scene.prm", n_processes=1):
        """Runs a parameter file with overrides "Section/Name=value" and returns the result folder."""
        process = cls.call(file, "--output", output, *settings(overrides), n_processes=n_processes)
        if process.returncode != 0:
            raise AssertionError(f"the run {output} failed:\n{process.stdout}\n{process.stderr}")
        return cls.folder / output

    @classmethod
    def shared(cls, *overrides, file="scene.prm"):
        """Result folder computed once for each combination of file and overrides; tests must not change it."""
        runs = cls.__dict__.get("shared_runs")
        if runs is None:
            runs = cls.shared_runs = {}
        if (file, overrides) not in runs:
            runs[file, overrides] = cls.run_scene(f"shared_{len(runs)}", *overrides, file=file)
        return runs[file, overrides]

    def write(self, name, content):
        """Writes a file that is removed after the test; returns its name."""
        path = self.folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        self.addCleanup(path.unlink, missing_ok=True)
        return name

    def dry_run(self, *overrides, file="scene.prm"):
        return self.call(file, "--dry-run", *settings(overrides))

    def dry_run_refused(self, mentions, *overrides, file="scene.prm"):
        process = self.dry_run(*overrides, file=file)
        self.assertEqual(process.returncode, 1)
        self.assert_message(process, mentions)

    def assert_refused(self, mentions, *overrides):
        """Checks that the run with these overrides writes nothing and fails with one message that says what happened,
        where, and what to change."""
        before = contents(self.folder)
        process = self.call_scene("refused", *overrides)
        self.assertEqual(contents(self.folder), before)
        self.assertEqual(process.returncode, 1)
        self.assert_message(process, mentions)

    def assert_message(self, process, mentions):
        """Checks that the program or a script failed with one message in three parts that contains these words."""
        self.assertNotEqual(process.returncode, 0, process.stdout)
        lines = process.stderr.strip().splitlines()
        for start in ("error: ", "  where:  ", "  change: "):
            self.assertEqual(sum(line.startswith(start) and len(line) > len(start) for line in lines), 1, process.stderr)
        for text in mentions:
            self.assertIn(text, process.stderr)

    def interrupt(self, output, overrides, ends, kind="design"):
        """Starts or resumes a study once for each (number, signal) in `ends`, and sends the signal when `number` designs
        or sets of samples have been stored. The interrupted study must not write results."""
        for number, how in ends:
            with open(self.folder / "interrupted.log", "w+", encoding="utf-8") as log:
                process = subprocess.Popen([EXECUTABLE, "scene.prm", "--output", output, *settings(overrides)], cwd=self.folder, stdout=log, stderr=log)
                deadline = time.monotonic() + 300
                while len(self.stored(output, kind)) < number and process.poll() is None and time.monotonic() < deadline:
                    time.sleep(0.02)
                process.send_signal(how)
                process.wait()
                log.seek(0)
                self.assertGreaterEqual(len(self.stored(output, kind)), number, log.read())
            self.assertNotEqual(process.returncode, 0)
            self.assertFalse((self.folder / output / "run.json").exists())

    def stored(self, output, kind="design"):
        """Files of the designs or sets of samples that an interrupted study has stored."""
        return sorted((self.folder / f"{output}.checkpoint").glob(f"{kind}-*.result"))

    def assert_same_eigenvalues(self, actual, expected, tolerance=SAME):
        """Compares two lists of eigenvalues, regardless of the order within clusters."""
        self.assertEqual(len(actual), len(expected))
        self.assertLessEqual(distance(actual, expected), tolerance)


def read_table(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def design_tables(folder):
    """All tables of a design study, without computing times."""
    return {name: [{key: value for key, value in row.items() if key != "time [s]"} for row in read_table(folder / f"{name}.csv")]
            for name in ("designs", "design_thresholds", "design_modes")}


def header(path):
    with open(path, encoding="utf-8") as file:
        return file.readline().rstrip("\n")


def eigenvalues(folder):
    """lambda [rad/s] of the complex modes."""
    return [complex(float(row["growth rate [1/s]"]), 2 * math.pi * float(row["frequency [Hz]"]))
            for row in read_table(folder / "complex_modes.csv")]


def real_frequencies(folder, table="real_modes.csv"):
    return [float(row["frequency [Hz]"]) for row in read_table(folder / table)]


def distance(actual, expected):
    """Largest relative difference of eigenvalues, each compared with the nearest unused value."""
    left, largest = list(expected), 0.0
    for value in actual:
        nearest = min(left, key=lambda other: abs(other - value))
        left.remove(nearest)
        largest = max(largest, abs(value - nearest) / max(abs(value), abs(nearest)) if value != nearest else 0.0)
    return largest


def numbers(path):
    for row in read_table(path):
        for text in row.values():
            try:
                yield float(text)
            except ValueError:
                pass


def contents(folder):
    """Content of every file in a folder and its subfolders."""
    return {str(path.relative_to(folder)): path.read_bytes() if path.is_file() else None for path in sorted(folder.rglob("*"))}
