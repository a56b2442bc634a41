# SPDX-License-Identifier: GPL-3.0-or-later

"""Reads the matrices exported by a run and forms the quadratic eigenproblem.

DIRECTORY/matrices contains, in Matrix Market format,

    M, K            n x n    mass and stiffness of disc and pins before coupling, without clamped dofs
    C               n x n    damping of materials and dashpots
    G               n x n    gyroscopic matrix of the disc, skew-symmetric; no file if it is zero
    C_b             n x n    contact damping, radial and along the sliding direction
    P_n, P_t, P_b   n_c x n  relative displacement disc minus pin: normal, along the sliding direction times the friction factor f of the
                             pair of surfaces (rows f t), radial
    K_n             n_c x n_c  contact stiffness, diagonal; zero at rigid contact nodes, no file if all are rigid
    T_c             n x n_k  basis of the kernel of the rigid rows of P_n

The coupled problem is (lambda^2 M~_c + lambda C_c + K~_c) phi = 0 with

    K~ = K - mu P_t^T S K + (P_n + mu P_t)^T K_n P_n,  M~ = M - mu P_t^T S M,  C~ = C + G - mu P_t^T S (C + G) + C_b,
    K~_c = T_c^T K~ T_c, M~_c and C_c accordingly.

S extracts the reactions of the rigid contact nodes from nodal forces: S [P_n; P_t; P_b]^T = [I, 0, 0]. S consists of rows of the
pseudo-inverse; for pairs of coincident nodes, it is 1/2 P_n. For nonmatching faces the program uses another left inverse.

Results computed from these matrices are an independent check of the program.
"""

import dataclasses
import math
import pathlib

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg

from squeal import quadratic
from squeal.errors import Error
from squeal.system import read_matrix


@dataclasses.dataclass
class QuadraticProblem:
    """The coupled matrices of lambda^2 mass + lambda damping + stiffness in SciPy's CSR format."""

    mass: sparse.csr_matrix
    damping: sparse.csr_matrix
    stiffness: sparse.csr_matrix

    @property
    def size(self):
        return self.stiffness.shape[0]

    def backward_errors(self, eigenvalues, vectors):
        """|Q(lambda) x| / ((|lambda|^2 |M| + |lambda| |C| + |K|) |x|) of each eigenpair, with Frobenius norms."""
        return quadratic.errors(self.mass, self.damping, self.stiffness, eigenvalues, vectors)[1]


def read_matrices(directory):
    """Reads the exported matrices: name -> CSR matrix. G and K_n are zero if they have no file; raises Error if another file is missing."""
    matrices = {}
    for name in ("M", "C", "K", "G", "C_b", "P_n", "P_t", "P_b", "K_n", "T_c"):
        path = pathlib.Path(directory) / "matrices" / f"{name}.mtx"
        if not path.is_file() and name in ("G", "K_n"):
            n = matrices["C" if name == "G" else "P_n"].shape[0]
            matrices[name] = sparse.csr_matrix((n, n))
            continue
        if not path.is_file():
            raise Error(f"{path} is missing", directory, 'run squeal with --set Study=stability --set "Output/Write matrices=true"')
        matrices[name] = read_matrix(path.parent, path.name, directory)
    return matrices


def rigid_rows(matrices):
    """Indices of the contact nodes without springs."""
    return np.flatnonzero(matrices["K_n"].diagonal() == 0)


def reactions(matrices):
    """S (n_c x n); rows of contact nodes with springs are zero."""
    rigid, P_n = rigid_rows(matrices), matrices["P_n"]
    if len(rigid) == P_n.shape[0] and (abs(P_n @ P_n.T - 2 * sparse.identity(len(rigid))) > 1e-12).nnz == 0:
        return 0.5 * P_n  # coincident nodes
    select = sparse.csr_matrix((np.ones(len(rigid)), (rigid, np.arange(len(rigid)))), (P_n.shape[0], len(rigid)))
    B = sparse.vstack([matrices[name][rigid] for name in ("P_n", "P_t", "P_b")]).tocsr()
    normal = sparse.identity(len(rigid), format="csc")
    first = sparse.vstack([normal, sparse.csc_matrix((2 * len(rigid), len(rigid)))]).toarray()
    inverse = sparse.linalg.splu(sparse.csc_matrix(B @ B.T)).solve(first) if len(rigid) else first
    inverse[abs(inverse) < 1e-17 * abs(inverse).max(initial=0.0)] = 0.0
    return sparse.csr_matrix(select @ sparse.csr_matrix(inverse.T) @ B)


def couple(matrices, friction_coefficient):
    """The quadratic problem of the coupled system with friction."""
    T_c, P_n, P_t = (matrices[name] for name in ("T_c", "P_n", "P_t"))
    friction = -friction_coefficient * (P_t.T @ reactions(matrices))
    springs = (P_n + friction_coefficient * P_t).T @ matrices["K_n"] @ P_n

    def project(matrix):
        projected = sparse.csr_matrix(T_c.T @ matrix @ T_c)
        projected.sum_duplicates()
        return projected

    bodies = matrices["C"] + matrices["G"]
    return QuadraticProblem(
        mass=project(matrices["M"] + friction @ matrices["M"]),
        damping=project(bodies + friction @ bodies + matrices["C_b"]),
        stiffness=project(matrices["K"] + friction @ matrices["K"] + springs),
    )


def structure_errors(matrices):
    """Quantities that must be zero: description -> value; symmetry errors are relative to the largest entry."""

    def largest(matrix):
        return abs(matrix).max() if matrix.nnz else 0.0

    rigid, T_c = rigid_rows(matrices), matrices["T_c"]
    P_n, P_t, P_b, S = (matrix[rigid] for matrix in (matrices["P_n"], matrices["P_t"], matrices["P_b"], reactions(matrices)))
    n_contact, n_dofs = P_n.shape
    errors = {"S P_n^T - I": largest(S @ P_n.T - sparse.identity(n_contact)), "S P_t^T": largest(S @ P_t.T),
              "S P_b^T": largest(S @ P_b.T), "P_n T_c": largest(P_n @ T_c),
              "columns of T_c - (n - n_c)": float(abs(T_c.shape[1] - (n_dofs - n_contact)))}
    for name, sign, factor in (("M", "-", 1), ("C", "-", 1), ("K", "-", 1), ("C_b", "-", 1), ("G", "+", -1)):
        A = matrices[name]
        errors[f"{name} {sign} {name}^T"] = largest(A - factor * A.T) / (largest(A) or 1.0)
    return errors


def in_band(eigenvalues, band):
    """Mask of the eigenvalues with frequencies up to `band` [Hz], without real eigenvalues and rigid-body modes."""
    frequencies = eigenvalues.imag / (2 * math.pi)
    return (frequencies > 1e-5 * band) & (frequencies <= band)
