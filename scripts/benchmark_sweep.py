#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Times an error-controlled sweep on one core beside full-order solutions by SLEPc, with the same BLAS kernels.

    scripts/benchmark_sweep.py PRM [--set "Section/Name=value"]... [--runs 3] [--core 0]

PRM is a parameter file with Study = sweep; the settings are handed to squeal. SLEPc solves the problem in the formulation that is
fastest for it: without damping the linear one in lambda^2 (scripts/slepc_modes.py).

Processor seconds: of squeal, the whole run from the mesh to the tables; of SLEPc, the solution from the assembled matrices at
friction coefficients spread over the sweep, of which the mean stands for all. Both run in turn: in every run a sweep, then five solutions.
Where the sweep makes the chart without dissipation besides, that is counted to squeal alone. Medians, with the smallest and the largest.
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
        scene = benchmarking.matrices_of(folder / "matrices", arguments.parameter_file, arguments.settings, arguments.core)
        for _ in range(arguments.runs):
            benchmarking.compare_sweep(rounds, arguments.core, arguments.parameter_file, arguments.settings, folder / "sweep", [scene])
    rounds.print()


if __name__ == "__main__":
    main()
