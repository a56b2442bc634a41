# SPDX-License-Identifier: GPL-3.0-or-later

"""Functions shared by the benchmarks: the machine, runs of squeal and SLEPc on one core with the same BLAS kernels, medians."""

import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from squeal.command_line import Parser
from squeal.errors import Error
from squeal.parameter_file import read_parameters
from squeal.program import SOURCE, find_program, words_of
from squeal.results import Table

PEER = SOURCE / "scripts" / "slepc_modes.py"
PARTS = (0.1, 0.3, 0.5, 0.7, 0.9)  # positions in the range of a sweep at which SLEPc solves


def cpu():
    """Name and flags of the processor from /proc/cpuinfo."""
    fields = {}
    for line in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        name, _, value = line.partition(":")
        fields.setdefault(name.strip(), value.strip())
    return fields.get("model name", "unknown processor"), fields.get("flags", "").split()


def kernels():
    """The OpenBLAS kernels for both programs: the user's choice, or the widest that the processor supports."""
    _, flags = cpu()
    widest = "SkylakeX" if "avx512vl" in flags else "Haswell" if "avx2" in flags else None
    return os.environ.get("OPENBLAS_CORETYPE", widest)


def environment(n_threads=1):
    """Environment with numbers of threads, BLAS kernels, and settings of Open MPI for root in a container."""
    settings = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": str(n_threads), "DEAL_II_NUM_THREADS": str(n_threads),
                "OMPI_MCA_btl_vader_single_copy_mechanism": "none",
                "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    if kernels():
        settings["OPENBLAS_CORETYPE"] = kernels()
    return {**os.environ, **settings}


def describe_machine(core):
    """One line on the machine and its load."""
    name, _ = cpu()
    load = os.getloadavg()[0]
    return f"{name}, core {core} of {os.cpu_count()}, OpenBLAS kernels {kernels() or 'chosen by OpenBLAS'}, load average {load:.1f}"


def parser_of(description, of_sweep=False):
    """The command line of a benchmark: repetitions and core; for a sweep also parameter file and settings."""
    parser = Parser(description)
    if of_sweep:
        parser.add_argument("parameter_file", metavar="PRM", type=pathlib.Path)
        parser.add_argument("--set", action="append", default=[], dest="settings", metavar="Section/Name=value")
    parser.add_argument("--runs", type=int, default=3, help="repetitions (default: %(default)s)")
    parser.add_argument("--core", type=int, default=0, help="the core to run on (default: %(default)s)")
    return parser


def run_on_core(core, command):
    """The output of a command on one core, or on several with as many threads. Raises Error with its messages if it fails."""
    cores = core if isinstance(core, list) else [core]
    words = ["taskset", "-c", ",".join(map(str, cores)), *map(str, command)]
    process = subprocess.run(words, env=environment(len(cores)), text=True, capture_output=True, check=False)
    if process.returncode != 0:
        raise Error(f"{process.stdout}{process.stderr}the command failed", " ".join(map(str, command)), "see the messages")
    return process.stdout


def run_squeal(core, parameter_file, output, settings=()):
    """Runs squeal with settings "Section/Name=value" and returns its run record."""
    run_on_core(core, [find_program(), parameter_file, "--output", output, *words_of(settings)])
    return json.loads((pathlib.Path(output) / "run.json").read_text(encoding="utf-8"))


def run_peer(core, directory, n_modes, formulation=None, friction_coefficient=None):
    """Solves once by SLEPc and returns the record of scripts/slepc_modes.py --json."""
    with tempfile.NamedTemporaryFile(suffix=".json") as file:
        options = ["--formulation", formulation] if formulation else []
        options += ["--mu", repr(friction_coefficient)] if friction_coefficient is not None else []
        run_on_core(core, [PEER, directory, "--modes", n_modes, "--runs", 1, "--json", file.name, *options])
        return json.loads(pathlib.Path(file.name).read_text(encoding="utf-8"))[0]


def cpu_seconds(record, steps=None):
    """CPU seconds of the named steps of a run record, or of all."""
    return sum(step["CPU time [s]"] for step in record["steps"] if steps is None or step["name"] in steps)


def parameter(directory, name):
    """A parameter of the run as text."""
    return read_parameters(pathlib.Path(directory) / "parameters.prm")[name]


def spread(values, digits=1):
    """Median with the smallest and largest value."""
    return f"{statistics.median(values):.{digits}f} ({min(values):.{digits}f} to {max(values):.{digits}f})"


class Rounds:
    """Measured values of all rounds of a benchmark, by the name of the quantity."""

    def __init__(self, title):
        self.title, self.values = title, {}

    def add(self, name, value):
        self.values.setdefault(name, []).append(value)

    def print(self):
        print(f"\n{self.title}")
        for name, values in self.values.items():
            print(f"  {name:<62} {spread(values, 2)}", flush=True)


def matrices_of(directory, parameter_file, settings, core):
    """The folder with the matrices of a model for SLEPc, written once, and the number of modes."""
    if not directory.exists():
        run_squeal(core, parameter_file, directory, [*settings, "Study=stability", "Output/Write matrices=true", "Output/Mode shapes=none"])
    return directory, len(Table(directory / "real_modes.csv"))


def mean_peer(rounds, core, matrices, chosen):
    """Mean CPU seconds of SLEPc over friction coefficients."""
    directory, n_modes = matrices
    solutions = [run_peer(core, directory, n_modes, friction_coefficient=mu) for mu in chosen]
    for solution in solutions:
        if solution["modes"] != n_modes:
            print(f"  note: SLEPc {solution['formulation']} found {solution['modes']} of {n_modes} modes")
    mean = statistics.mean(solution["CPU time [s]"] for solution in solutions)
    rounds.add(f"SLEPc {solutions[0]['formulation']}, one friction coefficient, CPU [s]", mean)
    return mean


def compare_sweep(rounds, core, parameter_file, settings, output, models):
    """One round: a sweep, then SLEPc for each of the models at five of its friction coefficients, whose mean represents all."""
    record = run_squeal(core, parameter_file, output, settings)
    seconds = cpu_seconds(record)
    rounds.add("squeal, the whole run, CPU [s]", seconds)
    for name in dict.fromkeys(step["name"] for step in record["steps"]):
        rounds.add(f"  {name}", cpu_seconds(record, {name}))
    number, first, last = (float(parameter(output, f"Sweep/{name}"))
                           for name in ("Number of friction coefficients", "First friction coefficient", "Last friction coefficient"))
    peers = sum(mean_peer(rounds, core, model, [first + part * (last - first) for part in PARTS]) for model in models)
    rounds.add(f"{number:.0f} solutions by SLEPc / the run [-]", number * peers / seconds)
