#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Computes complex modes with SLEPc: Krylov methods with shift-invert and an LU factorisation by MUMPS, in several
formulations.

    scripts/slepc_modes.py DIRECTORY [--formulation linear|toar|q-arnoldi|linearised] [--modes 66] [--runs 3]

DIRECTORY is the output of a run with Output/Write matrices = true. The formulations are

    linear      K x = -lambda^2 M x by Krylov-Schur, for systems without damping
    toar        lambda^2 M + lambda C + K by two-level orthogonal Arnoldi, which finds lambda and its conjugate
    q-arnoldi   the same by the quadratic Arnoldi method
    linearised  the same by Krylov-Schur on the companion form

The default is the fastest formulation: linear, or toar with damping. Prints for each run the time from the coupled matrices in memory to
the eigenvalues and eigenvectors, and the number of modes. A Krylov method with one starting vector may miss multiple eigenvalues.
Requires Debian's python3-slepc4py (real scalars).
"""

import importlib.util
import json
import math
import os
import pathlib
import statistics
import sys
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from squeal import exported_matrices, quadratic
from squeal.command_line import Parser, exit_on_error
from squeal.errors import Error
from squeal.results import Results

FORMULATIONS = ("linear", "toar", "q-arnoldi", "linearised")


def available():
    """True if SLEPc is installed."""
    return importlib.util.find_spec("petsc4py") is not None and importlib.util.find_spec("slepc4py") is not None


def missing():
    return Error("slepc4py or petsc4py is missing", "SLEPc", "apt-get install python3-petsc4py python3-slepc4py (or scripts/setup.sh peers)")


def is_undamped(problem):
    """True if there is no damping and the problem is therefore linear in lambda^2."""
    return problem.damping.nnz == 0 or abs(problem.damping).max() == 0


def applicable(problem):
    """The formulations that apply to the problem; `linear` only without damping."""
    return FORMULATIONS if is_undamped(problem) else FORMULATIONS[1:]


def default_basis(formulation, n_eigenvalues):
    """Size of the Krylov basis for which a formulation was fastest (doc/benchmarks.md)."""
    return {"linear": 19 * n_eigenvalues // 10, "toar": 2 * n_eigenvalues}.get(formulation, 3 * n_eigenvalues // 2) + 1


class Solution:
    """One solution: the eigenvalues lambda nearest to a real shift, their vectors, and the times of the solution.

    n_eigenvalues is the number of lambda^2 for `linear`; otherwise the number of lambda, two for each mode.
    """

    def __init__(self, problem, n_eigenvalues, formulation=None, shift=0.0, tolerance=1e-12, basis=None, seed=1):
        from petsc4py import PETSc

        if np.issubdtype(PETSc.ScalarType, np.complexfloating):
            raise Error("PETSc has complex scalars", "petsc4py", "choose a PETSc build with real scalars")
        self.formulation = formulation or applicable(problem)[0]
        self.shift = shift
        start = time.perf_counter(), time.process_time()
        matrices = [problem.stiffness, problem.mass] if self.formulation == "linear" else [problem.stiffness, problem.damping, problem.mass]
        operators = [petsc_matrix(matrix) for matrix in matrices]
        solver = self.solver(operators)
        size = problem.size if self.formulation == "linear" else 2 * problem.size
        solver.setDimensions(n_eigenvalues, min(basis or default_basis(self.formulation, n_eigenvalues), size))
        solver.setTolerances(tol=tolerance, max_it=1000)
        solver.setFromOptions()
        first = operators[0].createVecRight()
        first.setArray(np.random.default_rng(seed).standard_normal(problem.size))
        solver.setInitialSpace(first)
        solver.solve()

        n_converged = solver.getConverged()
        real, imaginary = operators[0].createVecs()
        eigenvalues, vectors = [], []
        for i in range(n_converged):
            eigenvalues.append(solver.getEigenpair(i, real, imaginary))
            vectors.append(real.getArray() + 1j * imaginary.getArray())
        self.found = np.array(eigenvalues, dtype=complex)
        self.eigenvalues = 1j * np.sqrt(self.found) if self.formulation == "linear" else self.found
        self.vectors = np.array(vectors, dtype=complex).reshape(n_converged, problem.size).T
        self.wall, self.cpu = time.perf_counter() - start[0], time.process_time() - start[1]
        solver.destroy()
        for operator in operators:
            operator.destroy()

    def solver(self, operators):
        """The solver with shift-invert by MUMPS; the linear problem is K x = nu M x with nu = -lambda^2, shifted by
        -shift^2."""
        from petsc4py import PETSc
        from slepc4py import SLEPc

        is_linear = self.formulation == "linear"
        solver = (SLEPc.EPS if is_linear else SLEPc.PEP)().create(PETSc.COMM_SELF)
        if is_linear:
            solver.setOperators(*operators)
            solver.setProblemType(SLEPc.EPS.ProblemType.GNHEP)
            solver.setType(SLEPc.EPS.Type.KRYLOVSCHUR)
        else:
            solver.setOperators(operators)
            solver.setProblemType(SLEPc.PEP.ProblemType.GENERAL)
            solver.setType({"toar": SLEPc.PEP.Type.TOAR, "q-arnoldi": SLEPc.PEP.Type.QARNOLDI, "linearised": SLEPc.PEP.Type.LINEAR}[self.formulation])
            solver.setScale(SLEPc.PEP.Scale.SCALAR)
        solver.setWhichEigenpairs(type(solver).Which.TARGET_MAGNITUDE)
        solver.setTarget(-self.shift**2 if is_linear else self.shift)
        transformation = solver.getST()
        transformation.setType(SLEPc.ST.Type.SINVERT)
        transformation.setTransform(not is_linear)
        inner = transformation.getKSP()
        inner.setType("preonly")
        inner.getPC().setType("lu")
        inner.getPC().setFactorSolverType("mumps")
        return solver

    def covers(self, band):
        """True if eigenvalues beyond the band were found; the band is then complete except for multiple eigenvalues."""
        end = 2 * math.pi * band
        if self.formulation == "linear":
            return abs(self.found + self.shift**2).max(initial=0.0) > end**2 + self.shift**2
        return abs(self.found - self.shift).max(initial=0.0) > end + abs(self.shift)


def petsc_matrix(matrix):
    from petsc4py import PETSc

    matrix.sort_indices()
    csr = (matrix.indptr.astype(PETSc.IntType), matrix.indices.astype(PETSc.IntType), matrix.data)
    return PETSc.Mat().createAIJ(matrix.shape, csr=csr, comm=PETSc.COMM_SELF)


def n_wanted(formulation, n_modes):
    """Number of eigenvalues to request, some of them beyond the band."""
    return n_modes + 4 if formulation == "linear" else 2 * n_modes + 4


def solve_band(problem, band, n_modes, shift=0.0):
    """All eigenvalues in the band and their vectors; the number is increased until the largest eigenvalue lies beyond
    the band."""
    from petsc4py import PETSc

    formulation = applicable(problem)[0]
    size = problem.size if formulation == "linear" else 2 * problem.size

    def solve(seed):
        n_eigenvalues = n_wanted(formulation, n_modes)
        while True:
            try:
                solution = Solution(problem, min(n_eigenvalues, size), formulation, shift, seed=seed)
            except PETSc.Error:
                return None  # LAPACK occasionally fails when SLEPc reorders clusters
            if solution.eigenvalues.size == 0:
                return None
            if solution.covers(band) or n_eigenvalues >= size:
                listed = exported_matrices.in_band(solution.eigenvalues, band)
                return solution.eigenvalues[listed], solution.vectors[:, listed]
            n_eigenvalues = n_eigenvalues * 3 // 2

    return quadratic.collect(solve)


@exit_on_error()
def main():
    parser = Parser(__doc__)
    parser.add_argument("directory", metavar="DIRECTORY", help="output of a run with Output/Write matrices = true")
    parser.add_argument("--formulation", choices=FORMULATIONS, help="(default: the fastest one)")
    parser.add_argument("--mu", type=float, help="friction coefficient (default: from the run)")
    parser.add_argument("--modes", type=int, default=66, help="number of modes (default: %(default)s)")
    parser.add_argument("--runs", type=int, default=3, help="repetitions (default: %(default)s)")
    parser.add_argument("--tolerance", type=float, default=1e-12, help="SLEPc's tolerance (default: %(default)s)")
    parser.add_argument("--basis", type=int, help="size of the Krylov basis (default: the fastest one)")
    parser.add_argument("--json", metavar="FILE", help="also writes the measurements to FILE")
    parser.epilog = "Other options are passed to PETSc, for example -st_mat_mumps_icntl_7 5 or -log_view."
    arguments, options = parser.parse_known_args()
    if not available():
        raise missing()
    import slepc4py
    slepc4py.init([sys.argv[0], *options])
    from petsc4py import PETSc

    results = Results(arguments.directory)
    band = results.number("Band/Maximum frequency")
    friction_coefficient = results.number("Operation/Friction coefficient") if arguments.mu is None else arguments.mu
    problem = exported_matrices.couple(exported_matrices.read_matrices(arguments.directory), friction_coefficient)
    print(f"{problem.size} dofs, {problem.stiffness.nnz} entries in the stiffness")
    if arguments.formulation == "linear" and not is_undamped(problem):
        raise Error("the problem has damping and is not linear in lambda^2", "--formulation", "choose another formulation")
    formulation = arguments.formulation or applicable(problem)[0]

    records = []
    for run in range(arguments.runs):
        try:
            solution = Solution(problem, n_wanted(formulation, arguments.modes), formulation, tolerance=arguments.tolerance,
                                basis=arguments.basis, seed=run + 1)
        except PETSc.Error as error:
            raise Error(f"SLEPc failed: {error}", arguments.directory, "try another --basis, --formulation or --modes") from error
        listed = exported_matrices.in_band(solution.eigenvalues, band)
        found, vectors = solution.eigenvalues[listed], solution.vectors[:, listed]
        records.append({"formulation": formulation, "CPU time [s]": solution.cpu, "wall time [s]": solution.wall, "modes": len(found),
                        "covers the band": bool(solution.covers(band)),
                        "largest backward error": float(problem.backward_errors(found, vectors).max(initial=0))})
        expected = results.table("complex_modes").eigenvalues()
        if arguments.mu is None and len(found) == len(expected):
            records[-1]["largest difference"] = float(quadratic.match(expected, found)[2].max(initial=0))
        print(f"run {run + 1}: " + ", ".join(f"{name}: {value:.3g}" if isinstance(value, float) else f"{name}: {value}"
                                             for name, value in records[-1].items()), flush=True)
    print(f"median: {statistics.median(record['CPU time [s]'] for record in records):.2f} s of CPU")
    if arguments.json:
        pathlib.Path(arguments.json).write_text(json.dumps(records, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
