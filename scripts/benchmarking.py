# SPDX-License-Identifier: GPL-3.0-or-later

"""Functions shared by the benchmarks: description of the machine, medians, and runs of squeal and SLEPc with the same
BLAS kernels."""

import json
import os
import pathlib
import statistics
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from squeal.command_line import Parser
from squeal.errors import Error
from squeal.program import SOURCE, find_program, words_of

PEER = SOURCE / "scripts" / "slepc_modes.py"
# Steps from the assembled matrices to the modes
FULL_ORDER = ("Mode count", "Factorisation", "Real modes", "Complex modes")


def cpu():
    """Name and flags of the processor from /proc/cpuinfo."""
    lines = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").split("\n\n")[0].splitlines()
    fields = {name.strip(): value.strip() for name, _, value in (line.partition(":") for line in lines)}
    return fields.get("model name", "unknown processor"), fields.get("flags", "").split()


def kernels():
    """The OpenBLAS kernels for both programs: the user's choice, kernels for AVX-512 or AVX2, or None."""
    _, flags = cpu()
    widest = "SkylakeX" if "avx512vl" in flags else "Haswell" if "avx2" in flags else None
    return os.environ.get("OPENBLAS_CORETYPE", widest)


def environment(n_threads=1):
    """Environment variables: numbers of threads, BLAS kernels, and settings of Open MPI for root in a container."""
    settings = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": str(n_threads), "DEAL_II_NUM_THREADS": str(n_threads),
                "OMPI_MCA_btl_vader_single_copy_mechanism": "none",
                "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    return {**os.environ, **settings, **({"OPENBLAS_CORETYPE": kernels()} if kernels() else {})}


def describe_machine(core):
    """A line that describes the machine and its load."""
    return (f"{cpu()[0]}, core {core} of {os.cpu_count()}, OpenBLAS kernels {kernels() or 'chosen by OpenBLAS'}, "
            f"load average {os.getloadavg()[0]:.1f}")


def parser_of(description):
    """The command-line parser of a benchmark with options for repetitions and core."""
    parser = Parser(description)
    parser.add_argument("--runs", type=int, default=3, help="repetitions (default: %(default)s)")
    parser.add_argument("--core", type=int, default=0, help="the core to run on (default: %(default)s)")
    return parser


def run_on_cores(cores, command):
    """The output of a command on the given cores, with one thread per core. Raises Error with the output on failure."""
    words = ["taskset", "-c", ",".join(map(str, cores)), *map(str, command)]
    process = subprocess.run(words, env=environment(len(cores)), text=True, capture_output=True, check=False)
    if process.returncode != 0:
        raise Error(f"{process.stdout}{process.stderr}the command failed", " ".join(map(str, command)), "read the output above")
    return process.stdout


def run_squeal(cores, parameter_file, output, settings=()):
    """Runs squeal with settings "Section/Name=value"; returns the run record."""
    run_on_cores(cores, [find_program(), parameter_file, "--output", output, *words_of(settings)])
    return json.loads((pathlib.Path(output) / "run.json").read_text(encoding="utf-8"))


def cpu_seconds(record, steps=None):
    """CPU seconds of the named steps of a run record, or of all steps."""
    return sum(step["CPU time [s]"] for step in record["steps"] if steps is None or step["name"] in steps)


def spread(values, digits=1):
    """Text with the median, the smallest and the largest value."""
    return f"{statistics.median(values):.{digits}f} ({min(values):.{digits}f} to {max(values):.{digits}f})"


class Rounds:
    """Measured values of all rounds of a benchmark, by name of the quantity."""

    def __init__(self, title):
        self.title, self.values = title, {}

    def add(self, name, value):
        self.values.setdefault(name, []).append(value)

    def print(self):
        print(f"\n{self.title}")
        for name, values in self.values.items():
            print(f"  {name:<62} {spread(values, 2)}", flush=True)
