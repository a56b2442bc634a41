#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Compares the CPU time of an error-controlled sweep with that of full-order solutions by SLEPc, on one core with the same BLAS kernels.

    scripts/benchmark_sweep.py PRM [--set "Section/Name=value"]... [--runs 3] [--core 0]

PRM is a parameter file with Study = sweep; the settings are passed to squeal. SLEPc uses its fastest formulation for the problem, without
damping the linear one in lambda^2 (scripts/slepc_modes.py).

Times of squeal are those of the whole run from the mesh to the tables, including the chart without dissipation if there is one; times of
SLEPc are those of the solution from the assembled matrices, as a mean of five friction coefficients. Each repetition is one sweep followed
by five solutions. Prints medians with the smallest and largest values.
"""

import pathlib
import tempfile

import benchmarking
from squeal.command_line import exit_on_error


@exit_on_error()
def main():
    arguments = benchmarking.parser_of(__doc__, of_sweep=True).parse_args()
    print(benchmarking.describe_machine(arguments.core), flush=True)
    rounds = benchmarking.Rounds(arguments.parameter_file.name)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        model = benchmarking.matrices_of(folder / "matrices", arguments.parameter_file, arguments.settings, arguments.core)
        for _ in range(arguments.runs):
            benchmarking.compare_sweep(rounds, arguments.core, arguments.parameter_file, arguments.settings, folder / "sweep", [model])
    rounds.print()


if __name__ == "__main__":
    main()
