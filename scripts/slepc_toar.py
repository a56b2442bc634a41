#!/usr/bin/python3
"""Complex modes by SLEPc: two-level orthogonal Arnoldi (TOAR), shift-invert at zero with an LU factorisation by MUMPS.

    scripts/slepc_toar.py DIRECTORY [--modes 66] [--runs 3]

DIRECTORY is the output of a run with Output/Write matrices = true. Prints, for each run, the time from the
coupled matrices in memory to the eigenvalues and eigenvectors. Like every Krylov method with one starting vector a run
may miss members of multiple eigenvalues; the number found is printed. Needs Debian's python3-slepc4py (real scalars).
"""

import argparse
import importlib.util
import math
import os
import statistics
import sys
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np

import exported_matrices


def available():
    """Whether SLEPc is installed."""
    return importlib.util.find_spec("petsc4py") is not None and importlib.util.find_spec("slepc4py") is not None


class Toar:
    """One solution: the eigenvalues nearest a real shift, their vectors, and the times it took.

    A basis of one and a half times the eigenvalues wanted was faster than SLEPc's default of twice as many.
    """

    def __init__(self, problem, n_eigenvalues, shift=0.0, tolerance=1e-12, basis=None, seed=1):
        from petsc4py import PETSc
        from slepc4py import SLEPc

        if np.issubdtype(PETSc.ScalarType, np.complexfloating):
            sys.exit("The PETSc in use is one for complex scalars; choose the one for real scalars.")
        wall, cpu = time.perf_counter(), time.process_time()

        operators = []
        for matrix in (problem.stiffness, problem.damping, problem.mass):
            matrix.sort_indices()
            csr = (matrix.indptr.astype(PETSc.IntType), matrix.indices.astype(PETSc.IntType), matrix.data)
            operators.append(PETSc.Mat().createAIJ(matrix.shape, csr=csr, comm=PETSc.COMM_SELF))

        solver = SLEPc.PEP().create(PETSc.COMM_SELF)
        solver.setOperators(operators)
        solver.setProblemType(SLEPc.PEP.ProblemType.GENERAL)
        solver.setType(SLEPc.PEP.Type.TOAR)
        solver.setWhichEigenpairs(SLEPc.PEP.Which.TARGET_MAGNITUDE)
        solver.setTarget(shift)
        solver.setScale(SLEPc.PEP.Scale.SCALAR)
        solver.setDimensions(n_eigenvalues, min(basis or 3 * n_eigenvalues // 2 + 1, 2 * problem.size))
        solver.setTolerances(tol=tolerance, max_it=1000)
        transformation = solver.getST()
        transformation.setType(SLEPc.ST.Type.SINVERT)
        transformation.setTransform(True)
        inner = transformation.getKSP()
        inner.setType("preonly")
        inner.getPC().setType("lu")
        inner.getPC().setFactorSolverType("mumps")
        solver.setFromOptions()

        start = operators[0].createVecRight()
        start.setArray(np.random.default_rng(seed).standard_normal(problem.size))
        solver.setInitialSpace(start)
        solver.setUp()
        self.setup_wall, self.setup_cpu = time.perf_counter() - wall, time.process_time() - cpu
        solver.solve()

        n_converged = solver.getConverged()
        real, imaginary = operators[0].createVecs()
        eigenvalues, vectors = [], []
        for i in range(n_converged):
            eigenvalue = solver.getEigenpair(i, real, imaginary)
            eigenvalues.append(eigenvalue)
            vectors.append(real.getArray() + 1j * imaginary.getArray())
        self.eigenvalues = np.array(eigenvalues, dtype=complex)
        self.vectors = np.array(vectors, dtype=complex).reshape(n_converged, problem.size).T
        self.wall, self.cpu = time.perf_counter() - wall, time.process_time() - cpu

        solver.destroy()
        for operator in operators:
            operator.destroy()


def solve_band(problem, band, n_modes, shift=0.0):
    """All eigenvalues of the band (and their vectors): asks for more until the largest one lies beyond it."""
    from petsc4py import PETSc

    def solve(seed):
        n_eigenvalues = 2 * n_modes + 4
        while True:
            try:
                solution = Toar(problem, min(n_eigenvalues, 2 * problem.size), shift, seed=seed)
            except PETSc.Error:
                return None  # Clusters make LAPACK fail in SLEPc's reordering now and then.
            if solution.eigenvalues.size == 0:
                return None
            if abs(solution.eigenvalues - shift).max() > 2 * math.pi * band + abs(shift) or n_eigenvalues >= 2 * problem.size:
                listed = exported_matrices.in_band(solution.eigenvalues, band)
                return solution.eigenvalues[listed], solution.vectors[:, listed]
            n_eigenvalues = n_eigenvalues * 3 // 2

    return exported_matrices.collect(solve)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", metavar="DIRECTORY", help="output of a run with Output/Write matrices = true")
    parser.add_argument("--mu", type=float, help="friction coefficient (default: that of the run)")
    parser.add_argument("--band", type=float, help="upper end of the band in Hz (default: that of the run)")
    parser.add_argument("--modes", type=int, default=66, help="modes to ask for (default: %(default)s)")
    parser.add_argument("--runs", type=int, default=3, help="repetitions (default: %(default)s)")
    parser.add_argument("--tolerance", type=float, default=1e-12, help="SLEPc's tolerance (default: %(default)s)")
    parser.add_argument("--basis", type=int, help="vectors of the Krylov basis (default: 1.5 for each eigenvalue)")
    parser.epilog = "Other options are handed to PETSc, for example -mat_mumps_icntl_7 5 or -log_view."
    arguments, options = parser.parse_known_args()
    if not available():
        sys.exit("SLEPc is missing: apt-get install python3-petsc4py python3-slepc4py (or scripts/setup.sh peers)")
    import slepc4py
    slepc4py.init([sys.argv[0], *options])
    from petsc4py import PETSc

    friction_coefficient = exported_matrices.run_parameter(arguments.directory, "Operation/Friction coefficient", arguments.mu)
    band = exported_matrices.run_parameter(arguments.directory, "Band/Maximum frequency", arguments.band)
    start = time.perf_counter()
    matrices = exported_matrices.read_matrices(arguments.directory)
    print(f"reading the matrices: {time.perf_counter() - start:.2f} s (not counted)")
    start = time.perf_counter()
    problem = exported_matrices.couple(matrices, friction_coefficient)
    print(f"coupling them: {time.perf_counter() - start:.2f} s (not counted); {problem.size} dofs, "
          f"{problem.stiffness.nnz} entries in the stiffness")

    walls = []
    for run in range(arguments.runs):
        try:
            solution = Toar(problem, 2 * arguments.modes + 4, tolerance=arguments.tolerance, basis=arguments.basis, seed=run + 1)
        except PETSc.Error as error:
            sys.exit(f"SLEPc failed; another --basis may help:\n{error}")
        listed = exported_matrices.in_band(solution.eigenvalues, band)
        errors = problem.backward_errors(solution.eigenvalues[listed], solution.vectors[:, listed])
        reach = abs(solution.eigenvalues).max() / (2 * math.pi)
        print(f"run {run + 1}: {solution.wall:.2f} s wall, {solution.cpu:.2f} s CPU (setup {solution.setup_wall:.2f} s wall, "
              f"{solution.setup_cpu:.2f} s CPU); {listed.sum()} modes up to {band:g} Hz, "
              f"{'the last one found lies beyond' if reach > band else 'the band is not covered'}, largest backward error {errors.max(initial=0):.1e}")
        walls.append(solution.wall)
    print(f"median: {statistics.median(walls):.2f} s wall")


if __name__ == "__main__":
    main()
