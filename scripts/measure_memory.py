#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Measures the memory of a run in each step: the largest resident size of each process, and the largest sum over all
processes.

    scripts/measure_memory.py N PRM [ARGUMENT]...

Runs `squeal PRM ARGUMENT...` with mpirun on N processes, which may exceed the number of cores, and prints a table in
megabytes. Sizes are sampled twenty times a second. The first line shows the sizes at the start, mainly of libraries.
"""

import os
import pathlib
import re
import subprocess
import sys
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from squeal.command_line import Parser, exit_on_error
from squeal.program import find_program

INTERVAL = 0.05  # sampling interval [s]
STEP = re.compile(r"^  (\S.*?)\s{2,}[\d.]+ s\b")


def resident(pid):
    """Resident size of a process [byte]; zero before it starts and after it ends."""
    try:
        pages = int(pathlib.Path(f"/proc/{pid}/statm").read_text(encoding="ascii").split()[1])
        return pages * os.sysconf("SC_PAGE_SIZE")
    except (OSError, IndexError):
        return 0


def ranks(program, measurement):
    """Rank -> PID of the processes started by this measurement."""
    result = {}
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            environment = dict(entry.split(b"=", 1) for entry in (folder / "environ").read_bytes().split(b"\0") if b"=" in entry)
            if os.path.realpath(folder / "exe") == str(program) and int(environment[b"PARENT_OF_MEASUREMENT"]) == measurement:
                result[int(environment.get(b"OMPI_COMM_WORLD_RANK", b"0"))] = int(folder.name)
        except (OSError, KeyError, ValueError):
            continue
    return result


class Sampler(threading.Thread):
    """Samples the sizes of the processes; `samples` contains a row for each sample since the end of the last step."""

    def __init__(self, program, n):
        super().__init__(daemon=True)
        self.program, self.n, self.samples, self.first = program, n, [], None

    def run(self):
        pids = {}
        while True:
            if len(pids) < self.n:
                pids = ranks(self.program, os.getpid())
            sizes = [resident(pids.get(rank)) for rank in range(self.n)]
            if self.first is None and all(sizes):
                self.first = sizes
            self.samples.append(sizes)
            time.sleep(INTERVAL)

    def end_step(self):
        """The largest size of each process in the step, and the largest sum over the processes."""
        samples, self.samples = self.samples or [[0] * self.n], []
        return [max(sizes) for sizes in zip(*samples)], max(map(sum, samples))


@exit_on_error()
def main():
    parser = Parser(__doc__)
    parser.add_argument("n", metavar="N", type=int, help="number of processes")
    parser.add_argument("prm", metavar="PRM")
    arguments, others = parser.parse_known_args()
    n, program = arguments.n, find_program().resolve()
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "PARENT_OF_MEASUREMENT": str(os.getpid()), "OMPI_MCA_mpi_yield_when_idle": "1",
                   "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_hwloc_base_binding_policy": "none"}
    sampler = Sampler(program, n)
    sampler.start()
    launcher = ["mpirun", "-np", str(n)] if n > 1 else []
    process = subprocess.Popen([*launcher, program, arguments.prm, *others], env=environment, stdout=subprocess.PIPE, text=True)
    rows = []
    for line in process.stdout:
        if step := STEP.match(line):
            rows.append((step[1], *sampler.end_step()))
        elif "error" in line.lower():
            print(line, end="")
    if process.wait() != 0:
        sys.exit(f"squeal ended with exit status {process.returncode}")
    if sampler.first:
        rows.insert(0, ("at the start", sampler.first, sum(sampler.first)))
    largest = [max(sizes) for sizes in zip(*(sizes for _, sizes, _ in rows))]
    rows.append(("largest", largest, max(at_once for *_, at_once in rows)))
    print(f"{'[MB]':24}" + "".join(f"{'rank ' + str(rank):>9}" for rank in range(n)) + f"{'all':>9}")
    for name, sizes, at_once in rows:
        print(f"{name:24}" + "".join(f"{size / 1e6:9.0f}" for size in (*sizes, at_once)))


if __name__ == "__main__":
    main()
