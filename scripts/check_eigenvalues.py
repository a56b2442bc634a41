#!/usr/bin/python3
"""Checks the complex modes of a run with other people's eigensolvers.

    scripts/check_eigenvalues.py DIRECTORY [--modes FILE] [--solver scipy|slepc|both]

DIRECTORY is the output of a run with Output/Write matrices = true. The coupled quadratic problem is formed here
from the exported matrices and solved by SciPy (ARPACK on the companion form) and, where installed, by SLEPc (MUMPS;
Krylov-Schur on the linear problem in lambda^2, or with damping two-level orthogonal Arnoldi). Each eigenvalue of the
table is held against the nearest one found, one to one. The exit status is 1 when a difference exceeds the tolerance, a count
differs or the matrices are not what they should be.

Where a body can move freely the stiffness is singular, and the eigenvalues are sought about a real shift that is
chosen here. Where the table estimates the errors of its eigenvalues, as that of the residual iteration does, they may
differ by three times the largest estimate.
"""

import argparse
import csv
import math
import os
import pathlib
import sys

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
import scipy.optimize
import scipy.sparse.linalg

import exported_matrices
import parameter_file
import slepc_modes

STRUCTURE_TOLERANCE = 1e-10
# Largest relative difference of eigenvalues that the table says nothing about the accuracy of
TOLERANCE = 1e-8
# The largest of the errors that a run estimates may be that much too small
ESTIMATE_SAFETY = 3.0
# Of a stiffness that is singular but for rounding
SINGULAR_CONDITION = 1e12


def read_modes(path):
    """Labels, eigenvalues and, where there are any, estimated errors of a table of modes.

    The columns are `frequency [Hz]`, `growth rate [1/s]` and `estimated error of lambda [-]`.
    """
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(line for line in file if line.strip() and not line.startswith("#")))
    columns = {name.split("[")[0].strip(): index for index, name in enumerate(rows[0])}
    for name in ("frequency", "growth rate"):
        if name not in columns:
            sys.exit(f"{path} has no column `{name}`; its columns are {', '.join(columns)}.")
    label = columns.get("label")
    labels = [row[label].strip() if label is not None else "" for row in rows[1:]]
    eigenvalues = [complex(float(row[columns["growth rate"]]), 2 * math.pi * float(row[columns["frequency"]]))
                   for row in rows[1:]]
    error = columns.get("estimated error of lambda")
    errors = [float(row[error]) for row in rows[1:]] if error is not None else []
    return labels, np.array(eigenvalues, dtype=complex), errors


def choose_shift(problem, band):
    """Zero [1/s], or a twentieth of the band where the stiffness is singular."""
    n = problem.size
    try:
        factor = scipy.sparse.linalg.splu(problem.stiffness.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.1,
                                          options={"SymmetricMode": True})
    except RuntimeError:  # exactly singular
        return 0.05 * 2 * math.pi * band
    inverse = scipy.sparse.linalg.LinearOperator((n, n), matvec=factor.solve, rmatvec=lambda x: factor.solve(x, trans="T"), dtype=float)
    condition = scipy.sparse.linalg.norm(problem.stiffness, 1) * scipy.sparse.linalg.onenormest(inverse)
    return 0.0 if condition < SINGULAR_CONDITION else 0.05 * 2 * math.pi * band


def choose_tolerance(errors):
    """Largest relative difference that is accepted, and where it comes from."""
    estimate = ESTIMATE_SAFETY * max(errors, default=0.0)
    if estimate > TOLERANCE:
        return estimate, f"{ESTIMATE_SAFETY:g} times the largest error that the table estimates"
    return TOLERANCE, "that of converged eigenvalues"


def solve_by_scipy(problem, band, n_modes, shift=0.0):
    """All eigenvalues of the band by ARPACK on the companion form, which costs one factorisation of size n.

    With w = lambda u / s, s of the size of the eigenvalues sought, s / (lambda - shift) are the eigenvalues of

        (u, w) -> (x, u + shift / s x),  x = -s Q(shift)^-1 ((C + shift M) u + s M w).
    """
    n = problem.size
    scale = math.pi * band
    damping = problem.damping + shift * problem.mass
    factor = scipy.sparse.linalg.splu((problem.stiffness + shift * damping).tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.1,
                                      options={"SymmetricMode": True})

    def apply(state):
        u, w = state[:n], state[n:]
        x = -scale * factor.solve(damping @ u + scale * (problem.mass @ w))
        return np.concatenate([x, u + shift / scale * x])

    operator = scipy.sparse.linalg.LinearOperator((2 * n, 2 * n), matvec=apply, dtype=float)

    def solve(seed):
        start = np.random.default_rng(seed).standard_normal(2 * n)
        n_eigenvalues = 2 * n_modes + 8
        while True:
            n_eigenvalues = min(n_eigenvalues, 2 * n - 2)
            ncv = min(2 * n_eigenvalues + 20, 2 * n)
            inverse, vectors = scipy.sparse.linalg.eigs(operator, k=n_eigenvalues, v0=start, ncv=ncv, tol=0, maxiter=1000)
            eigenvalues = shift + scale / inverse
            if abs(eigenvalues - shift).max() > 2 * math.pi * band + abs(shift) or n_eigenvalues == 2 * n - 2:
                listed = exported_matrices.in_band(eigenvalues, band)
                return eigenvalues[listed], vectors[:n, listed]
            n_eigenvalues = n_eigenvalues * 3 // 2

    return exported_matrices.collect(solve)


def compare(name, labels, eigenvalues, found, tolerance):
    """Prints the differences to the eigenvalues found and says whether they and the counts are as they should be."""
    distances = abs(eigenvalues[:, None] - found[None, :])
    rows, columns = scipy.optimize.linear_sum_assignment(distances)
    matched = {row: found[column] for row, column in zip(rows, columns)}

    print(f"\n{'mode':<10} {'frequency [Hz]':>16} {'growth rate [1/s]':>18} {name + ' [Hz]':>16} {name + ' [1/s]':>18} {'difference':>11}")
    largest = 0.0
    for row in np.argsort(eigenvalues.imag, kind="stable"):
        value, line = eigenvalues[row], f"{labels[row]:<10} {eigenvalues[row].imag / (2 * math.pi):16.6f} {eigenvalues[row].real:18.6f}"
        if row in matched:
            difference = abs(value - matched[row]) / abs(matched[row])
            largest = max(largest, difference)
            print(f"{line} {matched[row].imag / (2 * math.pi):16.6f} {matched[row].real:18.6f} {difference:11.1e}"
                  + ("" if difference <= tolerance else "  <-"))
        else:
            print(f"{line} {'not found':>16}")
    for column in sorted(set(range(len(found))) - set(columns), key=lambda column: found[column].imag):
        print(f"{'missing':<10} {'':>16} {'':>18} {found[column].imag / (2 * math.pi):16.6f} {found[column].real:18.6f}")

    right = len(found) == len(eigenvalues) and largest <= tolerance
    print(f"{name}: {len(found)} modes, the table has {len(eigenvalues)}; largest relative difference {largest:.1e}, "
          f"{'as it should be' if right else f'too much (tolerance {tolerance:g})' if largest > tolerance else 'the counts differ'}")
    return right


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", metavar="DIRECTORY", type=pathlib.Path, help="output of a run with Output/Write matrices = true")
    parser.add_argument("--modes", metavar="FILE", default="complex_modes.csv", help="the table, in DIRECTORY (default: %(default)s)")
    parser.add_argument("--solver", choices=("scipy", "slepc", "both"), default="both", help="(default: %(default)s)")
    parser.add_argument("--mu", type=float, help="friction coefficient (default: that of the run)")
    parser.add_argument("--band", type=float, help="upper end of the band in Hz (default: that of the run)")
    parser.add_argument("--shift", type=float, help="real shift in 1/s (default: 0, or chosen where a body can move freely)")
    parser.add_argument("--tolerance", type=float,
                        help=f"largest relative difference (default: {TOLERANCE:g}, or what the table's own estimates allow)")
    arguments = parser.parse_args()

    friction_coefficient = exported_matrices.run_parameter(arguments.directory, "Operation/Friction coefficient", arguments.mu)
    band = exported_matrices.run_parameter(arguments.directory, "Band/Maximum frequency", arguments.band)
    labels, eigenvalues, errors = read_modes(arguments.directory / arguments.modes)
    listed = exported_matrices.in_band(eigenvalues, band)
    labels, eigenvalues = [label for label, keep in zip(labels, listed) if keep], eigenvalues[listed]
    file = pathlib.Path(arguments.directory) / "parameters.prm"
    parameters = parameter_file.read_parameters(file) if file.is_file() else {}
    if parameters.get("Damping/Modal damping ratio"):
        sys.exit("The run has modal damping, which no exported matrix holds; repeat it without Damping/Modal damping ratio.")
    matrices = exported_matrices.read_matrices(arguments.directory)

    print(f"{matrices['M'].shape[0]} dofs, {matrices['P_n'].shape[0]} contact nodes, friction coefficient {friction_coefficient:g}, "
          f"modes up to {band:g} Hz")
    right = True
    for description, error in exported_matrices.structure_errors(matrices).items():
        fails = error > STRUCTURE_TOLERANCE
        right = right and not fails
        print(f"  {description:<28} {error:8.1e}" + ("  <- should vanish" if fails else ""))

    problem = exported_matrices.couple(matrices, friction_coefficient)
    shift = arguments.shift
    if shift is None:
        shift = choose_shift(problem, band)
        if shift != 0:
            print(f"  a body can move freely: eigenvalues are sought about the shift {shift:.0f} 1/s")
    tolerance, source = (arguments.tolerance, "as given") if arguments.tolerance is not None else choose_tolerance(errors)
    print(f"  tolerance {tolerance:.1e}, {source}")
    solvers = {"SciPy": solve_by_scipy} if arguments.solver in ("scipy", "both") else {}
    if arguments.solver in ("slepc", "both"):
        if slepc_modes.available():
            solvers["SLEPc"] = slepc_modes.solve_band
        elif arguments.solver == "slepc":
            sys.exit("SLEPc is missing: apt-get install python3-petsc4py python3-slepc4py (or scripts/setup.sh peers)")
        else:
            print("SLEPc is not installed; SciPy alone is asked.")

    for name, solve in solvers.items():
        found, vectors = solve(problem, band, max(len(eigenvalues), 1), shift)
        right = compare(name, labels, eigenvalues, found, tolerance) and right
        print(f"{name}: largest backward error {problem.backward_errors(found, vectors).max(initial=0):.1e}")
    sys.exit(0 if right else 1)


if __name__ == "__main__":
    main()
