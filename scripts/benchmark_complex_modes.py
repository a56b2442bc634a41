#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Times the complex modes of one run on one core: squeal and SLEPc alternately, with the same BLAS kernels.

    scripts/benchmark_complex_modes.py DIRECTORY [--formulations linear,toar] [--runs 3] [--core 0]

DIRECTORY is the output of a run with Output/Write matrices = true and Krylov methods. SLEPc computes the same number of modes in every
applicable formulation of scripts/slepc_modes.py; the fastest one that finds all modes is the reference.

All times are CPU seconds from the assembled matrices in memory to the modes. For squeal they are the steps Factorisation and Complex modes
of the run record, without and with the steps Mode count and Real modes, which provide the number of modes; for SLEPc, set-up and solution
with that number given. Reading the matrices is not counted. The median of the ratios of each round is printed.
"""

import pathlib
import statistics
import tempfile

import benchmarking
import slepc_modes
from squeal import exported_matrices
from squeal.command_line import exit_on_error
from squeal.errors import Error
from squeal.results import Table


def squeal_times(core, directory):
    """CPU seconds of the complex modes, without and with the real modes."""
    with tempfile.TemporaryDirectory() as folder:
        record = benchmarking.run_squeal(core, directory / "parameters.prm", f"{folder}/run",
                                         ["Output/Mode shapes=none", "Output/Write matrices=false"])
    alone = benchmarking.cpu_seconds(record, {"Factorisation", "Complex modes"})
    return alone, alone + benchmarking.cpu_seconds(record, {"Mode count", "Real modes"})


@exit_on_error()
def main():
    parser = benchmarking.parser_of(__doc__)
    parser.add_argument("directory", metavar="DIRECTORY", type=pathlib.Path, help="output of a run with Output/Write matrices = true")
    parser.add_argument("--formulations", help="formulations of SLEPc, separated by commas (default: all applicable ones)")
    arguments = parser.parse_args()
    if not slepc_modes.available():
        raise slepc_modes.missing()

    matrices = exported_matrices.read_matrices(arguments.directory)
    problem = exported_matrices.couple(matrices, exported_matrices.run_parameter(arguments.directory, "Operation/Friction coefficient"))
    formulations = arguments.formulations.split(",") if arguments.formulations else slepc_modes.applicable(problem)
    n_modes = len(Table(arguments.directory / "complex_modes.csv"))

    print(benchmarking.describe_machine(arguments.core), flush=True)
    rounds = benchmarking.Rounds(f"{problem.size} dofs, {n_modes} modes, {'no damping' if slepc_modes.is_undamped(problem) else 'damped'}")
    complete = set(formulations)
    for _ in range(arguments.runs):
        alone, with_real = squeal_times(arguments.core, arguments.directory)
        rounds.add("squeal, CPU [s]", alone)
        rounds.add("squeal with its real modes, CPU [s]", with_real)
        for formulation in formulations:
            peer = benchmarking.run_peer(arguments.core, arguments.directory, n_modes, formulation)
            rounds.add(f"SLEPc {formulation}, CPU [s]", peer["CPU time [s]"])
            rounds.add(f"  squeal / SLEPc {formulation} [-]", alone / peer["CPU time [s]"])
            rounds.add(f"  with its real modes / SLEPc {formulation} [-]", with_real / peer["CPU time [s]"])
            if peer["modes"] != n_modes:
                print(f"  note: SLEPc {formulation} found {peer['modes']} of {n_modes} modes", flush=True)
                complete.discard(formulation)
            else:
                print(f"  SLEPc {formulation}: all modes, largest difference {peer['largest difference']:.1e}", flush=True)
    rounds.print()
    if not complete:
        raise Error("no formulation found all modes in every run", "SLEPc", "give other --formulations, or more --runs")
    print(f"fastest that found all modes in every run: {min(complete, key=lambda one: statistics.median(rounds.values[f'SLEPc {one}, CPU [s]']))}")


if __name__ == "__main__":
    main()
