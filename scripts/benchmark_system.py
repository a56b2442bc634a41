#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Compares the CPU time of a sweep over a parameter of a system with full-order solutions by SLEPc at each value, on
one core.

    scripts/benchmark_system.py PRM [--set "Section/Name=value"]... [--runs 3] [--core 0]

PRM is a parameter file with Study = sweep, System and one parameter in the section Sweep; the settings are passed to
squeal. SLEPc uses TOAR at the shift zero with the smallest number of eigenvalues, in steps of two, that covers the band
at both ends and in the middle of the sweep.

Times of squeal cover the whole run from the files to branches and thresholds; times of SLEPc cover the solutions from
M, C and K in memory. The two programs run alternately. Modes in the band with Re lambda of at least -0.1 times the
circular frequency at its end are compared. Requires Debian's python3-slepc4py (scripts/setup.sh peers).
"""

import os
import pathlib
import tempfile

import benchmarking

os.environ.update(benchmarking.environment())  # before NumPy loads OpenBLAS, which reads these variables

import numpy as np

import slepc_modes
from squeal import exported_matrices, quadratic
from squeal.command_line import exit_on_error
from squeal.errors import Error
from squeal.results import Results
from squeal.system import System


def swept(results):
    """Name of the parameter of a sweep and its values."""
    words = [word.strip() for word in results.parameter("Sweep/Parameter").split(",")]
    if len(words) != 4:
        raise Error("Sweep/Parameter does not have four entries", results.folder,
                    "set Sweep/Parameter = NAME, FIRST, LAST, NUMBER")
    return words[0], np.linspace(float(words[1]), float(words[2]), int(words[3]))


def modes_by_value(results, values):
    """The eigenvalues of the sweep at each of the planned values."""
    table = results.table("branches")
    at, planned = np.array(table.numbers(table.parameter)), ~np.array(table.flags("refinement [-]"), dtype=bool)
    eigenvalues = np.array(table.eigenvalues(), dtype=complex)
    close = 1e-9 * abs(values).max()
    return [eigenvalues[planned & (abs(at - value) <= close)] for value in values]


def listed(eigenvalues, band):
    """Eigenvalues in the band with Re lambda of at least -0.1 times the circular frequency at its end."""
    return eigenvalues[exported_matrices.in_band(eigenvalues, band) & (eigenvalues.real >= -0.2 * np.pi * band)]


def smallest_number(problems, band, first):
    """The smallest number of eigenvalues with which SLEPc covers the band."""
    number = first
    while not all(slepc_modes.Solution(problem, number, "toar").covers(band) for problem in problems):
        number += 2
    return number


@exit_on_error()
def main():
    parser = benchmarking.parser_of(__doc__)
    parser.add_argument("parameter_file", metavar="PRM", type=pathlib.Path)
    parser.add_argument("--set", action="append", default=[], dest="settings", metavar="Section/Name=value")
    arguments = parser.parse_args()
    if not slepc_modes.available():
        raise slepc_modes.missing()
    os.sched_setaffinity(0, {arguments.core})
    print(benchmarking.describe_machine(arguments.core), flush=True)

    rounds, problems = benchmarking.Rounds(arguments.parameter_file.name), []
    with tempfile.TemporaryDirectory() as directory:
        for run in range(1, arguments.runs + 1):
            record = benchmarking.run_squeal([arguments.core], arguments.parameter_file, directory, arguments.settings)
            seconds = benchmarking.cpu_seconds(record)
            if not problems:
                results = Results(directory)
                (name, values), band = swept(results), results.number("Band/Maximum frequency")
                system = System.read(arguments.parameter_file.parent / results.parameter("System"))
                problems = [exported_matrices.QuadraticProblem(*system.matrices({name: float(value)})) for value in values]
                expected = [listed(found, band) for found in modes_by_value(results, values)]
                some = [problems[0], problems[len(problems) // 2], problems[-1]]
                number = smallest_number(some, band, 2 * max(map(len, expected)) + 4)
                print(f"{system.size} dofs, {len(values)} values of {name}; SLEPc computes {number} eigenvalues", flush=True)
            found = [slepc_modes.Solution(problem, number, "toar", seed=run) for problem in problems]
            of_slepc = sum(solution.cpu for solution in found)
            rounds.add("squeal, the whole run, CPU [s]", seconds)
            rounds.add(f"{len(values)} solutions by SLEPc, CPU [s]", of_slepc)
            rounds.add("  mean of one solution", of_slepc / len(values))
            rounds.add(f"{len(values)} solutions by SLEPc / the run [-]", of_slepc / seconds)
            pairs = [(listed(solution.eigenvalues, band), one) for solution, one in zip(found, expected)]
            n_uncovered = sum(not solution.covers(band) for solution in found)
            n_unequal = sum(len(one) != len(other) for one, other in pairs)
            distance = max(quadratic.match(*pair)[2].max(initial=0.0) for pair in pairs)
            print(f"run {run}: {min(map(len, expected))} to {max(map(len, expected))} modes, different numbers at {n_unequal} "
                  f"values, band not covered at {n_uncovered}, largest relative difference {distance:.1e}", flush=True)
    rounds.print()


if __name__ == "__main__":
    main()
