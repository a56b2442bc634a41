# SPDX-License-Identifier: GPL-3.0-or-later

"""Eigenvalues of quadratic pencils Q(λ) = λ² M + λ C + K.

Matrices are scaled as proposed by Fan, Lin and Van Dooren, λ = γ μ with γ² = |K| / |M|, before linearisation. Small problems are solved by
the QZ algorithm, others by shift-invert ARPACK with a sparse LU factorisation of Q(σ) for each shift σ.
"""

import dataclasses
import math

import numpy as np
import scipy.linalg
import scipy.optimize
import scipy.sparse as sparse
import scipy.sparse.linalg

from squeal.errors import Error

# Largest size of problems whose eigenvalues are all computed by the dense QZ algorithm
DENSE_SIZE = 200
# Initial number of eigenvalues per shift, and the number above which the region is divided
FIRST_NUMBER, LARGEST_NUMBER = 24, 160
# Relative distance up to which eigenvalues may be copies of one eigenvalue
EQUAL = 1e-8
# A unit vector counts as linearly independent if its component outside the span of the others exceeds this value
INDEPENDENT = 1e-3
# The pencil counts as singular if relative changes in its entries by this value make Q(s) singular at an arbitrary s
SINGULAR = 1e-13


@dataclasses.dataclass
class Eigenpairs:
    """Eigenvalues λ (m) [1/s] and right unit vectors (n x m), with two error measures.

    residuals: |Q(λ) x| / (|λ² M x| + |λ C x| + |K x|); backward_errors: |Q(λ) x| / ((|λ|² |M| + |λ| |C| + |K|) |x|) with Frobenius norms.
    """

    eigenvalues: np.ndarray
    vectors: np.ndarray
    residuals: np.ndarray
    backward_errors: np.ndarray

    def __len__(self):
        return len(self.eigenvalues)


def errors(M, C, K, eigenvalues, vectors):
    """Residuals and backward errors as in Eigenpairs."""
    parts = [M @ (vectors * eigenvalues**2), C @ (vectors * eigenvalues), K @ vectors]
    defects, sizes = np.linalg.norm(sum(parts), axis=0), abs(eigenvalues)
    norms = [scipy.sparse.linalg.norm(matrix) for matrix in (M, C, K)]
    scales = (sizes**2 * norms[0] + sizes * norms[1] + norms[2]) * np.linalg.norm(vectors, axis=0)
    tiny = np.finfo(float).tiny
    return defects / np.maximum(sum(np.linalg.norm(part, axis=0) for part in parts), tiny), defects / np.maximum(scales, tiny)


def match(values, others):
    """One-to-one assignment of two lists of eigenvalues with the smallest total distance: indices in both lists, and
    relative differences."""
    values, others = np.asarray(values, dtype=complex), np.asarray(others, dtype=complex)
    distances = abs(values[:, None] - others[None, :])
    pairs = scipy.optimize.linear_sum_assignment(distances)
    sizes = np.maximum(abs(values[pairs[0]]), abs(others[pairs[1]]))
    return *pairs, distances[pairs] / np.maximum(sizes, np.finfo(float).tiny)


def scaling(M, C, K):
    """Scaling factors γ and δ of Fan, Lin and Van Dooren: γ² δ M, γ δ C and δ K have norms of at most two."""
    norms = [scipy.sparse.linalg.norm(matrix) for matrix in (M, C, K)]
    if norms[2] == 0:
        gamma = norms[1] / norms[0] or 1.0
        return gamma, 1.0 / (gamma**2 * norms[0])
    gamma = math.sqrt(norms[2] / norms[0])
    return gamma, 2.0 / (norms[2] + norms[1] * gamma)


def linearise(M, C, K):
    """A and B of the first companion form A z = λ B z, z = (x, λ x)."""
    unit = sparse.identity(M.shape[0], format="csr")
    return sparse.bmat([[None, unit], [-K, -C]], format="csr"), sparse.block_diag([unit, M], format="csr")


def solve_dense(M, C, K, where):
    """All finite eigenvalues and vectors by QZ. Raises Error if the pencil is singular."""
    n, (gamma, delta) = M.shape[0], scaling(M, C, K)
    A, B = (matrix.toarray() for matrix in linearise(gamma**2 * delta * M, gamma * delta * C, delta * K))
    pairs, vectors = scipy.linalg.eig(A, B, homogeneous_eigvals=True)
    rounding = 10 * n * np.finfo(float).eps
    is_infinite = abs(pairs[1]) <= rounding * np.linalg.norm(B)
    if np.any(is_infinite & (abs(pairs[0]) <= rounding * np.linalg.norm(A))):
        raise singular(where)
    finite = ~is_infinite
    eigenvalues = pairs[0][finite] / pairs[1][finite]
    # The larger of x and λ x has the smaller relative error
    parts = np.where(abs(eigenvalues) <= 1, vectors[:n, finite], vectors[n:, finite])
    return gamma * eigenvalues, parts


def singular(where):
    return Error("the pencil is singular to working precision: det Q(λ) = 0 for every λ", where,
                 "remove dofs without stiffness, damping and mass, and redundant constraints")


class ShiftInvert:
    """Shift-invert ARPACK on the companion form."""

    def __init__(self, M, C, K, where):
        self.M, self.C, self.K, self.where = M, C, K, where
        self.gamma, _ = scaling(M, C, K)

    def check(self):
        """Raises Error if Q(σ) is singular to working precision at an arbitrary σ.

        By Oettli and Prager, relative changes in the entries by max |Q x| / (|Q| |x|) make Q(σ) singular; x is computed
        by inverse iteration.
        """
        sigma, lu = self.factor(self.gamma * (0.6 + 0.7j))
        Q = self.K + sigma * self.C + sigma**2 * self.M
        x = np.random.default_rng(0).standard_normal(Q.shape[0]).astype(complex)
        for _ in range(2):
            x = lu.solve(x)
            x /= np.linalg.norm(x)
        if not np.max(abs(Q @ x) / np.maximum(abs(Q) @ abs(x), np.finfo(float).tiny)) > SINGULAR:
            raise singular(self.where)

    def factor(self, sigma):
        """σ and the LU factorisation of Q(σ); if Q(σ) is singular, σ is changed slightly."""
        for step in range(4):
            moved = sigma + step * 1e-4 * (1 + 1j if np.iscomplex(sigma) else 1) * (abs(sigma) + 1e-2 * self.gamma)
            matrix = (self.K + moved * self.C + moved**2 * self.M).tocsc()
            try:
                return moved, scipy.sparse.linalg.splu(matrix, permc_spec="COLAMD" if matrix.shape[0] < 50 else "MMD_AT_PLUS_A",
                                                       diag_pivot_thresh=0.1, options={"SymmetricMode": True})
            except RuntimeError:  # Q(σ) is exactly singular
                continue
        raise singular(self.where)

    def nearest(self, sigma, number, seed, factor=None):
        """Finite eigenvalues among the `number` nearest to the shift, or all eigenvalues if `number` is at least n; their
        vectors; and the radius about the shift within which all simple eigenvalues are expected to be found."""
        n, scale = self.M.shape[0], self.gamma
        if number >= n:
            return *solve_dense(self.M, self.C, self.K, self.where), math.inf
        sigma, lu = factor or self.factor(sigma)
        damping = self.C + sigma * self.M

        def apply(state):
            u, w = state[:n], state[n:]
            x = -lu.solve(scale * (self.M @ w) + damping @ u)
            return scale * np.concatenate([x, (u + sigma * x) / scale])

        is_complex = np.iscomplex(sigma)
        operator = scipy.sparse.linalg.LinearOperator((2 * n, 2 * n), matvec=apply, dtype=complex if is_complex else float)
        start = np.random.default_rng(seed).standard_normal((2, 2 * n))
        try:
            inverse, vectors = scipy.sparse.linalg.eigs(operator, k=number, v0=start[0] + 1j * start[1] if is_complex else start[0],
                                                        ncv=min(2 * number + 20, 2 * n - 1), tol=0, maxiter=1000)
        except scipy.sparse.linalg.ArpackNoConvergence as problem:
            raise Error(f"ARPACK does not converge at the shift {sigma:.6g}: {problem}", self.where,
                        "select fewer eigenvalues or another shift or region") from problem
        finite = abs(inverse) > 1e-14 * abs(inverse).max(initial=0.0)
        eigenvalues = sigma + scale / inverse[finite]
        radius = abs(eigenvalues - sigma).max() if finite.all() else math.inf
        return eigenvalues, vectors[:n, finite], radius


def inside(eigenvalues, region, margin=0.0):
    """Mask of the eigenvalues in the rectangle `region`, whose rows are the limits of real and imaginary parts [1/s]."""
    parts = np.array([eigenvalues.real, eigenvalues.imag])
    return ((parts >= region[:, :1] - margin) & (parts <= region[:, 1:] + margin)).all(axis=0)


def solve_region(solver, region, seed):
    """Eigenvalues and vectors in a rectangle, which is halved if a single shift requires too many eigenvalues."""
    widths, centre = np.ptp(region, axis=1), complex(*region.mean(axis=1))
    factor, number = solver.factor(centre if centre.imag else centre.real), FIRST_NUMBER
    while True:
        eigenvalues, vectors, radius = solver.nearest(factor[0], number, seed, factor)
        reach = 0.5 * math.hypot(*widths) + abs(factor[0] - centre)
        if radius > reach:
            found = inside(eigenvalues, region, EQUAL * solver.gamma)
            return eigenvalues[found], vectors[:, found]
        # Extrapolate the number of eigenvalues within reach of the corners
        number = max(2 * number, math.ceil(1.2 * number * (reach / radius)))
        if number > LARGEST_NUMBER:
            halves, axis = np.array([region, region]), np.argmax(widths)
            halves[0, axis, 1] = halves[1, axis, 0] = region[axis].mean()
            eigenvalues, vectors = map(np.hstack, zip(*(solve_region(solver, half, seed) for half in halves)))
            kept = merge(eigenvalues, vectors)
            return eigenvalues[kept], vectors[:, kept]


def merge(eigenvalues, vectors, tolerance=EQUAL):
    """Indices that select each mode once among eigenpairs from several runs.

    Pairs with the same eigenvalue are copies of one mode, or members of a multiple eigenvalue; a pair is kept if its
    vector is linearly independent of the vectors already kept.
    """
    kept, left = [], list(np.argsort(eigenvalues.imag, kind="stable"))
    unit = vectors / np.linalg.norm(vectors, axis=0)
    while left:
        cluster = [left[0]]
        for candidate in left[1:]:
            if eigenvalues[candidate].imag - eigenvalues[cluster[-1]].imag > tolerance * abs(eigenvalues[candidate]):
                break
            cluster.append(candidate)
        left = left[len(cluster):]
        # Separate eigenvalues of one frequency with different growth rates, for example -R and R
        while cluster:
            equal = [i for i in cluster if abs(eigenvalues[i] - eigenvalues[cluster[0]]) <= 10 * tolerance * abs(eigenvalues[i])]
            cluster = [i for i in cluster if i not in equal]
            _, triangle, order = scipy.linalg.qr(unit[:, equal], mode="economic", pivoting=True)
            rank = int(np.sum(abs(np.diagonal(triangle)) > INDEPENDENT))
            kept.extend(equal[i] for i in order[:rank])
    return np.array(kept, dtype=int)


def collect(solve, n_agreeing=2, n_runs=8):
    """Eigenvalues and vectors from runs with different starting vectors.

    A Krylov method with a single starting vector may miss members of multiple eigenvalues. Runs are therefore repeated
    and merged until `n_agreeing` successive runs find no new eigenvalues; the first run counts as one of them.
    solve(seed) returns eigenvalues and vectors, or None if it fails.
    """
    pairs, agreeing = None, 0
    for seed in range(1, n_runs + 1):
        found = solve(seed)
        if found is None:
            continue
        n_before = 0 if pairs is None else len(pairs[0])
        if pairs is not None:
            found = np.concatenate([pairs[0], found[0]]), np.hstack([pairs[1], found[1]])
        keep = merge(*found)
        pairs = found[0][keep], found[1][:, keep]
        agreeing = agreeing + 1 if len(keep) == n_before else 1
        if agreeing == n_agreeing:
            return pairs
    if pairs is None:
        raise Error("the eigensolver fails with every starting vector", "eigensolver", "check the matrices")
    raise Error("no two successive runs of the eigensolver find the same eigenvalues", "eigensolver", "select fewer eigenvalues")


def solve(M, C, K, number=None, largest=None, region=None, shift=None, where="system"):
    """Selected eigenpairs of a quadratic pencil of real sparse matrices, or all eigenpairs of a small system, by
    increasing Im λ.

    region: ((lower, upper) real part, (lower, upper) imaginary part) [1/s]; largest: maximum |λ|; number: number of
    eigenvalues nearest to `shift` (default 0). Raises Error if M = 0, if the pencil is singular, or if a large system is
    solved without a selection.
    """
    n = M.shape[0]
    if M.nnz == 0 or not abs(M.data).max(initial=0.0):
        raise Error("the mass is zero: Q(λ) is not quadratic", where, "add a nonzero term of power 2")
    if empty := np.flatnonzero(sum(abs(matrix).sum(axis=1).A1 for matrix in (M, C, K)) == 0).tolist():
        raise Error(f"row {empty[0] + 1} of M, C and K is zero: det Q(λ) = 0 for every λ", where, "remove this dof")
    if sum(choice is not None for choice in (number, largest, region)) > 1:
        raise Error("`number`, `largest` and `region` are mutually exclusive", where, "give only one of them")
    if n <= DENSE_SIZE or (number or 0) > n:
        eigenvalues, vectors = solve_dense(M, C, K, where)
    elif region is None and largest is None and number is None:
        raise Error(f"the system has {n} dofs; all eigenvalues are computed only up to {DENSE_SIZE} dofs", where,
                    "give `number`, `largest` or `region`")
    else:
        solver = ShiftInvert(M, C, K, where)
        solver.check()
        if number is not None:
            eigenvalues, vectors = collect(lambda seed: solver.nearest(shift or 0.0, number + 8, seed)[:2])
        else:
            rectangle = np.array([(-largest, largest), (0.0, largest)] if region is None else region, dtype=float)
            eigenvalues, vectors = collect(lambda seed: solve_region(solver, rectangle, seed))
            if region is None:
                above = eigenvalues.imag > EQUAL * abs(eigenvalues)
                eigenvalues = np.concatenate([eigenvalues[above].conj(), eigenvalues])
                vectors = np.hstack([vectors[:, above].conj(), vectors])
    if region is not None:
        chosen = inside(eigenvalues, np.array(region, dtype=float))
    elif largest is not None:
        chosen = abs(eigenvalues) <= largest
    else:
        chosen = np.argsort(abs(eigenvalues - (shift or 0.0)), kind="stable")[:number]
    eigenvalues, vectors = eigenvalues[chosen], vectors[:, chosen]
    order = np.lexsort((eigenvalues.real, eigenvalues.imag))
    eigenvalues, vectors = eigenvalues[order], vectors[:, order] / np.linalg.norm(vectors[:, order], axis=0)
    return Eigenpairs(eigenvalues, vectors, *errors(M, C, K, eigenvalues, vectors))
