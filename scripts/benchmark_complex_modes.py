#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Times the complex modes of one run on one core: squeal and SLEPc in turn, with the same BLAS kernels.

    scripts/benchmark_complex_modes.py DIRECTORY [--formulations linear,toar] [--runs 3] [--core 0]

DIRECTORY is the output of a run with Output/Write matrices = true, in which the modes were found by Krylov methods. SLEPc is asked
for the number of modes of that run in every formulation of scripts/slepc_modes.py that fits the problem, and the fastest that finds all
modes is the one to compare with.

All times are processor seconds from the assembled matrices in memory to the modes: of squeal, the steps Factorisation and Complex
modes of its run record, and the same with the steps Mode count and Real modes, which a run makes in any case and from which it takes
the number of modes to look for; of SLEPc, set-up and solution with that number given. Reading the matrices is not counted. Ratios are those of one
round, of which the median is printed.
"""

import pathlib
import statistics
import tempfile

import benchmarking
import slepc_modes
from squeal import exported_matrices
from squeal.command_line import exit_on_error
from squeal.errors import Error


def squeal_times(core, directory):
    """Processor seconds of the complex modes, without and with the real modes."""
    with tempfile.TemporaryDirectory() as folder:
        record = benchmarking.run_squeal(core, directory / "parameters.prm", f"{folder}/run",
                                         ["Output/Mode shapes=none", "Output/Write matrices=false"])
    alone = benchmarking.cpu_seconds(record, {"Factorisation", "Complex modes"})
    return alone, alone + benchmarking.cpu_seconds(record, {"Mode count", "Real modes"})


def describe(record, n_modes):
    """Time of a solution, and whether it is the right one."""
    found = (f"all {n_modes} modes, largest difference {record['largest difference']:.1e}" if record["modes"] == n_modes
             else f"{record['modes']} of {n_modes} modes")
    return f"{record['CPU time [s]']:.1f} s, {found}"


def compare(rounds, n_modes):
    """Prints medians; each round holds squeal's times and the records of SLEPc by formulation."""
    alone, with_real = [[times[i] for times, _ in rounds] for i in range(2)]
    print(f"\nmedian CPU [s]: squeal {benchmarking.spread(alone)}, with its real modes {benchmarking.spread(with_real)}")
    complete = {}
    for formulation in rounds[0][1]:
        records = [peers[formulation] for _, peers in rounds]
        seconds = [record["CPU time [s]"] for record in records]
        n_complete = sum(record["modes"] == n_modes for record in records)
        print(f"  SLEPc {formulation:<11} {benchmarking.spread(seconds)}; all modes in {n_complete} of {len(records)} runs")
        if n_complete == len(records):
            complete[formulation] = statistics.median(seconds)
    if not complete:
        raise Error("no formulation found all modes in every run", "SLEPc", "give other --formulations, or more --runs")
    fastest = min(complete, key=complete.get)
    ratios = [[times[i] / peers[fastest]["CPU time [s]"] for times, peers in rounds] for i in range(2)]
    print(f"fastest peer: {fastest}; squeal takes {benchmarking.spread(ratios[0], 2)} of its time, "
          f"with the real modes {benchmarking.spread(ratios[1], 2)}")


@exit_on_error()
def main():
    parser = benchmarking.parser_of(__doc__)
    parser.add_argument("directory", metavar="DIRECTORY", type=pathlib.Path, help="output of a run with Output/Write matrices = true")
    parser.add_argument("--formulations", help="of SLEPc, separated by commas (default: all that fit)")
    arguments = parser.parse_args()
    if not slepc_modes.available():
        raise slepc_modes.missing()

    matrices = exported_matrices.read_matrices(arguments.directory)
    problem = exported_matrices.couple(matrices, exported_matrices.run_parameter(arguments.directory, "Operation/Friction coefficient"))
    formulations = arguments.formulations.split(",") if arguments.formulations else slepc_modes.applicable(problem)
    n_modes = benchmarking.n_rows(arguments.directory / "complex_modes.csv")

    print(benchmarking.describe_machine(arguments.core))
    print(f"{problem.size} dofs, {n_modes} modes, {'no damping' if slepc_modes.is_undamped(problem) else 'damped'}")
    rounds = []
    for run in range(1, arguments.runs + 1):
        times = squeal_times(arguments.core, arguments.directory)
        print(f"run {run}: squeal {times[0]:.1f} s, with its real modes {times[1]:.1f} s", flush=True)
        peers = {}
        for formulation in formulations:
            peers[formulation] = benchmarking.run_peer(arguments.core, arguments.directory, n_modes, formulation)
            print(f"  SLEPc {formulation:<11} {describe(peers[formulation], n_modes)}", flush=True)
        rounds.append((times, peers))
    compare(rounds, n_modes)


if __name__ == "__main__":
    main()
