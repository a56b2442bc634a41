#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Memory of the processes of a run, step by step: the largest resident size of each, and the largest sum at one time.

    scripts/measure_memory.py N PRM [ARGUMENT]...

Runs `squeal PRM ARGUMENT...` on N processes of this machine (mpirun, possibly more than cores) and prints a table in megabytes. The sizes
are sampled twenty times a second; the first line has the sizes at the start, mainly those of libraries.
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

INTERVAL = 0.05  # [s]
STEP = re.compile(r"^  (\S.*?)\s{2,}[\d.]+ s\b")


def resident(pid):
    """Resident size of a process [byte]; zero once it has ended."""
    try:
        with open(f"/proc/{pid}/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except (OSError, IndexError):
        return 0


def ranks(program, measurement):
    """Rank -> PID of the processes that this measurement has started."""
    result = {}
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            if os.path.realpath(folder / "exe") != str(program):
                continue
            environment = dict(entry.split(b"=", 1) for entry in (folder / "environ").read_bytes().split(b"\0") if b"=" in entry)
            if int(environment[b"PARENT_OF_MEASUREMENT"]) == measurement:
                result[int(environment.get(b"OMPI_COMM_WORLD_RANK", b"0"))] = int(folder.name)
        except (OSError, KeyError, ValueError):
            continue
    return result


class Sampler(threading.Thread):
    """Samples the largest sizes since the end of the last step."""

    def __init__(self, program, n):
        super().__init__(daemon=True)
        self.program, self.n, self.lock, self.done = program, n, threading.Lock(), False
        self.first, self.largest, self.at_once = None, [0] * n, 0

    def run(self):
        pids = {}
        while not self.done:
            if len(pids) < self.n:
                pids = ranks(self.program, os.getpid())
            sizes = [resident(pids[rank]) if rank in pids else 0 for rank in range(self.n)]
            with self.lock:
                if self.first is None and all(sizes):
                    self.first = sizes
                self.largest = [max(pair) for pair in zip(self.largest, sizes)]
                self.at_once = max(self.at_once, sum(sizes))
            time.sleep(INTERVAL)

    def end_step(self):
        with self.lock:
            result = self.largest, self.at_once
            self.largest, self.at_once = [0] * self.n, 0
        return result


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
            rows.append((step[1], line.split("  ")[-1].strip(), *sampler.end_step()))
        elif "error" in line.lower():
            print(line, end="")
    sampler.done = True
    if process.wait() != 0:
        sys.exit(f"the program ended with {process.returncode}")
    mega = lambda size: f"{size / 1e6:9.0f}"
    print(f"{'[MB]':24}" + "".join(f"{'rank ' + str(rank):>9}" for rank in range(n)) + f"{'all':>9}")
    if sampler.first:
        print(f"{'at the start':24}" + "".join(map(mega, sampler.first)) + mega(sum(sampler.first)))
    for name, _, largest, at_once in rows:
        print(f"{name:24}" + "".join(map(mega, largest)) + mega(at_once))
    print(f"{'largest':24}" + "".join(mega(max(row[2][rank] for row in rows)) for rank in range(n)) + mega(max(row[3] for row in rows)))


if __name__ == "__main__":
    main()
