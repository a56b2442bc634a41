# SPDX-License-Identifier: GPL-3.0-or-later

"""Computes all eigenvalues in a band from the exported matrices, independently of the program.

Three steps:

1. Approximations of all eigenvalues by LAPACK's dense solvers from the equilibrated matrices of size n:

       mu = 0, no damping   T x = theta S x, S = K + s^2 M, T = M, theta = 1 / (s^2 - lambda^2)       symmetric, eigh
       no damping           the eigenvalues theta of S^-1 T                                             eig
       damping              with lambda = s + s / nu:  nu^2 Q(s) + nu s Q'(s) + s^2 M                   eig of size 2 n

   Systems with more than LARGEST_DENSE dofs are solved by ARPACK on the shifted and inverted companion form.
2. Two-sided block inverse iteration about the centre c of each cluster; the eigenvalues then follow from W^H Q(c + delta) V, whose entries
   are computed with a 64-bit mantissa. The error of the eigenvalues is proportional to the product of the errors of V and W.
3. Step 2 is repeated, up to three times in total, while it changes the eigenvalues by more than 1e-10. The last change is the error of the
   oracle.
"""

import dataclasses

import numpy as np
import scipy.linalg
import scipy.sparse as sparse
import scipy.sparse.csgraph
import scipy.sparse.linalg

import check_eigenvalues
from squeal import exported_matrices, quadratic

LARGEST_DENSE = 1600
# Relative distance up to which eigenvalues are refined together
CLUSTER = 1e-6
N_ITERATIONS = 4
# Relative distance up to which eigenvalues from ARPACK are copies if their vectors are linearly dependent
COPIES = 1e-5
# |lambda| / end of the band below which eigenvalues are not refined
ZERO = 0.9e-4
# Relative change below which refinement stops
CONVERGED = 1e-10


@dataclasses.dataclass
class Solution:
    """Eigenvalues with Im lambda >= 0 and |lambda| up to 1.001 times a radius."""

    values: np.ndarray
    error: float  # largest relative change in the last refinement
    method: str
    first_error: float  # relative error of the approximations before refinement


class Oracle:
    """Solves the eigenproblem of the matrices of a run at one friction coefficient."""

    def __init__(self, matrices, friction_coefficient, band):
        extended = {name: matrix.astype(np.longdouble) for name, matrix in matrices.items()}
        self.extended = exported_matrices.couple(extended, np.longdouble(friction_coefficient))
        self.problem = exported_matrices.QuadraticProblem(
            *(sparse.csr_matrix(matrix.astype(float)) for matrix in (self.extended.mass, self.extended.damping, self.extended.stiffness)))
        self.is_damped = abs(self.problem.damping).max() > 0 if self.problem.damping.nnz else False
        self.is_symmetric = friction_coefficient == 0 and not self.is_damped
        self.band = band
        self.shift = 0.1 * 2 * np.pi * band

    def solve(self, radius):
        """All eigenvalues with Im lambda >= 0 and |lambda| up to 1.001 times a radius [1/s]."""
        values, method = self.approximate()
        values = values[(values.imag >= 0) & (abs(values) <= 1.001 * radius)]
        changes = [np.inf]
        while changes[-1] > CONVERGED and len(changes) < 4:
            refined = self.refine(values)
            changes.append(quadratic.match(values, refined)[2].max(initial=0.0))
            values = refined
        return Solution(values, changes[-1], method, changes[1])

    # ------------------------------------------------------------ approximations

    def approximate(self):
        n = self.problem.size
        if n > LARGEST_DENSE:
            shift = check_eigenvalues.choose_shift(self.problem, self.band)
            found, vectors = check_eigenvalues.solve_by_scipy(self.problem, 1.05 * self.band, 40, shift)
            # Merge copies, which occur far below the band, where vectors are least accurate
            return found[quadratic.merge(found, vectors, COPIES)], "ARPACK"
        mass, damping, stiffness = (matrix.toarray() for matrix in (self.problem.mass, self.problem.damping, self.problem.stiffness))
        s = self.shift
        scale = 1 / np.sqrt(abs(np.diagonal(stiffness + s * damping + s**2 * mass)))
        mass, damping, stiffness = (scale[:, None] * matrix * scale for matrix in (mass, damping, stiffness))
        if self.is_symmetric:
            theta = scipy.linalg.eigh((mass + mass.T) / 2, (stiffness + stiffness.T) / 2 + s**2 * (mass + mass.T) / 2, eigvals_only=True)
            return upper_root(s**2 - 1 / theta[theta > 0]), "eigh"
        if not self.is_damped:
            theta = scipy.linalg.eigvals(scipy.linalg.solve(stiffness + s**2 * mass, mass))
            return upper_root(s**2 - 1 / theta[theta != 0]), "eig"
        at_shift = scipy.linalg.lu_factor(stiffness + s * damping + s**2 * mass)
        companion = np.zeros((2 * n, 2 * n))
        companion[:n, :n] = -scipy.linalg.lu_solve(at_shift, s * (damping + 2 * s * mass))
        companion[:n, n:] = -scipy.linalg.lu_solve(at_shift, s**2 * mass)
        companion[n:, :n] = np.eye(n)
        nu = scipy.linalg.eigvals(companion)
        values = s + s / nu[abs(nu) > 1e-12]
        return values[values.imag >= 0], "eig 2n"

    # ---------------------------------------------------------------- refinement

    def refine(self, values):
        """Refines each cluster of values; values near zero are not changed."""
        values = values[np.lexsort((values.real, values.imag))]
        is_near = abs(values[:, None] - values) <= CLUSTER * abs(values)
        n_clusters, cluster_of = scipy.sparse.csgraph.connected_components(is_near, directed=False)
        refined = [value for number in range(n_clusters) for value in self.refine_cluster(values[cluster_of == number])]
        return np.array(refined, dtype=complex)

    def refine_cluster(self, cluster):
        centre = np.mean(cluster)
        if abs(centre) < ZERO * 2 * np.pi * self.band:
            return cluster
        if abs(centre.imag) <= 1e-9 * abs(centre):
            centre = complex(centre.real, 0)
        m, n = len(cluster), self.problem.size
        at_centre = (self.problem.stiffness + centre * self.problem.damping + centre**2 * self.problem.mass).tocsc()
        size = abs(centre)
        scale = 1 / np.sqrt(abs(self.problem.stiffness.diagonal()) + size * abs(self.problem.damping.diagonal())
                            + size**2 * abs(self.problem.mass.diagonal()))
        scaling = sparse.diags(scale)
        scaled = (scaling @ at_centre @ scaling).tocsc()
        try:
            factor = scipy.sparse.linalg.splu(scaled)
        except RuntimeError:  # exactly singular: shift away from the eigenvalue
            factor = scipy.sparse.linalg.splu((scaled + 1e-13 * sparse.identity(n)).tocsc())
        derivative = (self.problem.damping + 2 * centre * self.problem.mass).tocsr()
        adjoint = derivative.conj().T.tocsr()
        random = np.random.default_rng(1)
        right, left = (random.standard_normal((n, m)) + 1j * random.standard_normal((n, m)) for _ in range(2))
        for _ in range(N_ITERATIONS):
            right = scale[:, None] * factor.solve(scale[:, None] * (derivative @ right))
            left = scale[:, None] * factor.solve(scale[:, None] * (adjoint @ left), trans="H")
            right, left = (orthonormal(vectors, scale) for vectors in (right, left))
        return [centre + delta for delta in self.corrections(centre, right, left)]

    def corrections(self, centre, right, left):
        """The values delta nearest to zero with W^H Q(centre + delta) V y = 0, one for each column of V."""
        m = right.shape[1]
        c = np.clongdouble(centre)
        right, left = right.astype(np.clongdouble), left.astype(np.clongdouble)
        mass, damping, stiffness = (left.conj().T @ (matrix @ right)
                                    for matrix in (self.extended.mass, self.extended.damping, self.extended.stiffness))
        constant = (stiffness + c * damping + c * c * mass).astype(complex)
        linear = (damping + 2 * c * mass).astype(complex)
        # Iterate Delta = -L^-1 (A + M Delta^2), which converges because Delta is small compared with the centre
        first, second = -scipy.linalg.solve(linear, constant), -scipy.linalg.solve(linear, mass.astype(complex))
        delta = np.zeros((m, m), dtype=complex)
        for _ in range(3):
            delta = first + second @ delta @ delta
        return np.linalg.eigvals(delta)


def orthonormal(vectors, scale):
    """Columns that span the same space, orthonormal after division by the scale."""
    q, _ = np.linalg.qr(vectors / scale[:, None])
    return q * scale[:, None]


def upper_root(squares):
    """Roots with Im >= 0; both roots of a positive square, because both are real eigenvalues."""
    roots = np.sqrt(squares.astype(complex))
    roots = np.where(roots.imag < 0, -roots, roots)
    is_real = abs(roots.imag) <= 1e-9 * abs(roots)
    return np.concatenate([roots, -roots[is_real]])


