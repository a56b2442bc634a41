#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Compares the CPU times of linearisations of a reduced quadratic eigenproblem with dissipation.

    scripts/benchmark_linearisations.py DIRECTORY [--runs 3] [--core 0]

DIRECTORY is the output of a run with Output/Write matrices = true and dissipation, such as prm/dissipation.prm.
Projection onto the lowest 234 real modes without friction gives a small dense problem lambda^2 M + lambda C + K, with a
nonsymmetric K. Right and left eigenvectors are computed

    companion    by the QR algorithm (dgeev) on [[0, I], [-inv(M) K, -inv(M) C]], which ignores the structure
    symmetric    by the QZ algorithm (dggev) on lambda [[C, M], [M, 0]] + [[K, 0], [0, -M]], which would preserve symmetry of K, C and M
    values       by the QR algorithm for the eigenvalues of the companion form only, and two steps of inverse iteration with
                 lambda^2 M + lambda C + K for each eigenvalue of the band
    toar         by SLEPc's two-level orthogonal Arnoldi method, a Krylov method that preserves the structure of the companion form;
                 once for right and once for left vectors (requires scripts/setup.sh peers)

Prints medians of the CPU seconds on one core, and the largest relative difference from the eigenvalues of the companion method in the band.
"""

import os
import time

import benchmarking

os.environ.update(benchmarking.environment())  # before NumPy loads OpenBLAS, which reads these variables

import numpy as np
import scipy.linalg
import scipy.sparse as sparse
import scipy.sparse.linalg

import slepc_modes
from squeal import exported_matrices
from squeal.command_line import exit_on_error
from squeal.errors import Error
from squeal.results import Results

N_VECTORS, N_MODES = 234, 66


def small_problem(directory):
    """M, C and K projected onto the lowest real modes of the frictionless system, and the end of the band [Hz]."""
    matrices, results = exported_matrices.read_matrices(directory), Results(directory)
    bare = exported_matrices.couple(matrices, 0.0)
    full = exported_matrices.couple(matrices, results.number("Operation/Friction coefficient"))
    K, M = sparse.csc_matrix(bare.stiffness), sparse.csc_matrix(bare.mass)
    _, basis = scipy.sparse.linalg.eigsh(K, N_VECTORS, M, sigma=0.0)
    projected = [basis.T @ (matrix @ basis) for matrix in (full.mass, full.damping, full.stiffness)]
    return projected, results.number("Band/Maximum frequency")


def companion_form(M, C, K):
    r = len(M)
    return np.block([[np.zeros((r, r)), np.eye(r)], [-scipy.linalg.solve(M, K), -scipy.linalg.solve(M, C)]])


def by_companion(M, C, K, _):
    return scipy.linalg.eig(companion_form(M, C, K), left=True, right=True)[0]


def by_symmetric(M, C, K, _):
    zero = np.zeros_like(M)
    return scipy.linalg.eig(np.block([[-K, zero], [zero, M]]), np.block([[C, M], [M, zero]]), left=True, right=True)[0]


def by_values(M, C, K, band):
    values = scipy.linalg.eigvals(companion_form(M, C, K))
    values = values[exported_matrices.in_band(values, band)]
    start = np.random.default_rng(1).standard_normal(len(M)).astype(complex)
    for value in values:
        factor = scipy.linalg.lu_factor(value**2 * M + value * C + K)
        for kind in (0, 2):  # 0: right vectors, 2: left vectors
            vector = start
            for _ in range(2):
                vector = scipy.linalg.lu_solve(factor, vector, trans=kind)
                vector /= np.linalg.norm(vector)
    return values


def by_toar(M, C, K, _):
    for transpose in (False, True):
        problem = exported_matrices.QuadraticProblem(*(sparse.csr_matrix(A.T if transpose else A) for A in (M, C, K)))
        solution = slepc_modes.Solution(problem, slepc_modes.n_wanted("toar", N_MODES), "toar")
    return solution.eigenvalues


@exit_on_error()
def main():
    parser = benchmarking.parser_of(__doc__)
    parser.add_argument("directory")
    arguments = parser.parse_args()
    os.sched_setaffinity(0, {arguments.core})
    print(benchmarking.describe_machine(arguments.core), flush=True)

    (M, C, K), band = small_problem(arguments.directory)
    if abs(C).max() == 0.0:
        raise Error("the problem has no damping and is linear in lambda^2", arguments.directory, "name a run of prm/dissipation.prm")
    methods = {"companion": by_companion, "symmetric": by_symmetric, "values": by_values}
    if slepc_modes.available():
        methods["toar"] = by_toar
    times, found = {name: [] for name in methods}, {}
    for _ in range(arguments.runs):
        for name, method in methods.items():
            before = time.process_time()
            values = method(M, C, K, band)
            found[name] = values[exported_matrices.in_band(values, band)]
            times[name].append(time.process_time() - before)
    reference = found["companion"]
    print(f"{len(M)} vectors, {len(reference)} modes of the band")
    for name, values in found.items():
        distance = max((abs(values - value).min() / abs(value) for value in reference), default=0.0) if len(values) else np.inf
        print(f"  {name:<10} CPU [s] {benchmarking.spread(times[name], 3)}, {len(values)} found, distance {distance:.1e}")


if __name__ == "__main__":
    main()
