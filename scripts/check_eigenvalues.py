#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Checks the complex modes of a run with independent eigensolvers.

    scripts/check_eigenvalues.py DIRECTORY [--solver scipy|slepc|both] [--system FOLDER]

DIRECTORY is the output of a run with Output/Write matrices = true, or of any run of the system in FOLDER
(doc/python.md). The coupled quadratic problem is assembled from the exported matrices and solved by SciPy (ARPACK on
the companion form) and, if installed, by SLEPc (MUMPS; Krylov-Schur on the linear problem in lambda^2, or two-level
orthogonal Arnoldi with damping). The eigenvalues in the table are compared one to one with the nearest eigenvalues
found. The exit status is 1 if a difference exceeds the tolerance, if the numbers of eigenvalues differ, or if the
matrices do not have the required structure.

If the stiffness is singular, for example because a body can move freely, a nonzero real shift is chosen. If the table
contains estimated errors of the eigenvalues, as for the residual iteration, differences up to three times the largest estimate are accepted.
"""

import math
import os
import pathlib
import sys

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
import scipy.sparse.linalg

import slepc_modes

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from squeal import exported_matrices, quadratic
from squeal.command_line import Parser, exit_on_error
from squeal.errors import Error
from squeal.results import Results
from squeal.system import System

STRUCTURE_TOLERANCE = 1e-10
# Largest relative difference of eigenvalues without estimated errors
TOLERANCE = 1e-8
# Largest factor by which a run may underestimate its largest error
ESTIMATE_SAFETY = 3.0
# Condition number above which a stiffness matrix counts as singular
SINGULAR_CONDITION = 1e12


def choose_shift(problem, band):
    """A real shift [1/s]: zero, or a twentieth of the end of the band if the stiffness is singular."""
    n, away = problem.size, 0.05 * 2 * math.pi * band
    try:
        factor = scipy.sparse.linalg.splu(problem.stiffness.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.1,
                                          options={"SymmetricMode": True})
    except RuntimeError:  # exactly singular stiffness
        return away
    inverse = scipy.sparse.linalg.LinearOperator((n, n), matvec=factor.solve, rmatvec=lambda x: factor.solve(x, trans="T"), dtype=float)
    condition = scipy.sparse.linalg.norm(problem.stiffness, 1) * scipy.sparse.linalg.onenormest(inverse)
    return 0.0 if condition < SINGULAR_CONDITION else away


def solve_by_scipy(problem, band, n_modes, shift=0.0):
    """Eigenvalues in the band by ARPACK on the companion form; requires one factorisation of size n."""
    solver = quadratic.ShiftInvert(problem.mass, problem.damping, problem.stiffness, "exported matrices")
    factor = solver.factor(shift)

    def solve(seed):
        n_eigenvalues, radius = 2 * n_modes + 8, 0.0
        while radius <= 2 * math.pi * band + abs(shift):
            eigenvalues, vectors, radius = solver.nearest(shift, n_eigenvalues, seed, factor)
            n_eigenvalues = n_eigenvalues * 3 // 2
        listed = exported_matrices.in_band(eigenvalues, band)
        return eigenvalues[listed], vectors[:, listed]

    return quadratic.collect(solve)


def problem_of_system(arguments):
    """The quadratic problem of a system of matrices, and True, because System.read() checks its structure."""
    system = System.read(arguments.system)
    try:
        p = {name: float(value) for name, value in (word.split("=") for word in arguments.parameter)}
    except ValueError:
        raise Error("a parameter is not given as NAME=NUMBER", f"--parameter {', '.join(arguments.parameter)}", "write, e.g., --parameter mu=0.4") from None
    print(f"{system.size} dofs, {len(system.terms)} terms, " + "".join(f"{name} = {value:g}, " for name, value in system.values(p).items()), end="")
    return exported_matrices.QuadraticProblem(*system.matrices(p)), True


def problem_of_run(arguments):
    """The coupled quadratic problem of the exported matrices, and whether their structure is correct."""
    friction_coefficient = arguments.mu
    if friction_coefficient is None:
        friction_coefficient = Results(arguments.directory).number("Operation/Friction coefficient")
    matrices, right = exported_matrices.read_matrices(arguments.directory), True
    for description, error in exported_matrices.structure_errors(matrices).items():
        fails = error > STRUCTURE_TOLERANCE
        right = right and not fails
        print(f"  {description:<28} {error:8.1e}" + ("  <- should vanish" if fails else ""))
    print(f"{matrices['M'].shape[0]} dofs, {matrices['P_n'].shape[0]} contact nodes, friction coefficient {friction_coefficient:g}, ", end="")
    return exported_matrices.couple(matrices, friction_coefficient), right


def compare(name, labels, eigenvalues, found, tolerance):
    """Prints the differences from the independent eigenvalues `found`; returns True if values and numbers agree."""
    rows, columns, differences = quadratic.match(eigenvalues, found)
    matched = {row: pair for row, *pair in zip(rows, found[columns], differences)}

    print(f"\n{'mode':<10} {'frequency [Hz]':>16} {'growth rate [1/s]':>18} {name + ' [Hz]':>16} {name + ' [1/s]':>18} {'difference':>11}")
    for row in np.argsort(eigenvalues.imag, kind="stable"):
        line = f"{labels[row]:<10} {eigenvalues[row].imag / (2 * math.pi):16.6f} {eigenvalues[row].real:18.6f}"
        if row in matched:
            other, difference = matched[row]
            print(f"{line} {other.imag / (2 * math.pi):16.6f} {other.real:18.6f} {difference:11.1e}"
                  + ("" if difference <= tolerance else "  <-"))
        else:
            print(f"{line} {'not found':>16}")
    for column in sorted(set(range(len(found))) - set(columns), key=lambda column: found[column].imag):
        print(f"{'missing':<10} {'':>16} {'':>18} {found[column].imag / (2 * math.pi):16.6f} {found[column].real:18.6f}")

    largest = differences.max(initial=0)
    right = len(found) == len(eigenvalues) and largest <= tolerance
    print(f"{name}: {len(found)} modes, the table has {len(eigenvalues)}; largest relative difference {largest:.1e}, "
          f"{'passed' if right else f'too large (tolerance {tolerance:g})' if largest > tolerance else 'the counts differ'}")
    return right


@exit_on_error()
def main():
    parser = Parser(__doc__)
    parser.add_argument("directory", metavar="DIRECTORY", type=pathlib.Path, help="output of a run with Output/Write matrices = true")
    parser.add_argument("--solver", choices=("scipy", "slepc", "both"), default="both", help="(default: %(default)s)")
    parser.add_argument("--system", metavar="FOLDER", help="system of matrices of the run, instead of exported matrices")
    parser.add_argument("--parameter", action="append", default=[], metavar="NAME=VALUE", help="overrides a parameter of the system")
    parser.add_argument("--mu", type=float, help="friction coefficient (default: from the run)")
    parser.add_argument("--shift", type=float, help="real shift in 1/s (default: 0, or chosen if the stiffness is singular)")
    parser.add_argument("--tolerance", type=float,
                        help=f"largest relative difference (default: {TOLERANCE:g}, or from the errors estimated in the table)")
    arguments = parser.parse_args()

    results = Results(arguments.directory)
    if results.parameters.get("Damping/Modal damping ratio"):
        raise Error("the run has modal damping, which is not exported", results.folder,
                    "repeat the run without Damping/Modal damping ratio")
    table, band = results.table("complex_modes"), results.number("Band/Maximum frequency")
    labels, eigenvalues = np.array(table.texts("label")), np.array(table.eigenvalues(), dtype=complex)
    listed = exported_matrices.in_band(eigenvalues, band)
    labels, eigenvalues = labels[listed], eigenvalues[listed]
    problem, right = (problem_of_system if arguments.system else problem_of_run)(arguments)
    print(f"modes up to {band:g} Hz")
    shift = arguments.shift if arguments.shift is not None else choose_shift(problem, band)
    if arguments.shift is None and shift != 0:
        print(f"  the stiffness is singular to working precision: the shift is {shift:.0f} 1/s")
    error = "estimated error of lambda [-]"
    estimate = ESTIMATE_SAFETY * max(table.numbers(error), default=0.0) if error in table.columns else 0.0
    tolerance, source = TOLERANCE, "for converged eigenvalues"
    if arguments.tolerance is not None:
        tolerance, source = arguments.tolerance, "as given"
    elif estimate > TOLERANCE:
        tolerance, source = estimate, f"{ESTIMATE_SAFETY:g} times the largest error estimated in the table"
    print(f"  tolerance {tolerance:.1e}, {source}")
    solvers = {"SciPy": solve_by_scipy} if arguments.solver in ("scipy", "both") else {}
    if arguments.solver in ("slepc", "both"):
        if slepc_modes.available():
            solvers["SLEPc"] = slepc_modes.solve_band
        elif arguments.solver == "slepc":
            raise slepc_modes.missing()
        else:
            print("SLEPc is not installed: only SciPy is used.")

    for name, solve in solvers.items():
        found, vectors = solve(problem, band, max(len(eigenvalues), 1), shift)
        right = compare(name, labels, eigenvalues, found, tolerance) and right
        print(f"{name}: largest backward error {problem.backward_errors(found, vectors).max(initial=0):.1e}")
    sys.exit(0 if right else 1)


if __name__ == "__main__":
    main()
