# SPDX-License-Identifier: GPL-3.0-or-later

"""Reads the matrices that a run of squeal has exported and forms the quadratic eigenproblem from them.

The files of DIRECTORY/matrices, in Matrix Market form, are

    M, K            n x n    mass and stiffness of disc and pins, not yet coupled, clamped dofs gone
    C               n x n    damping of the materials
    G               n x n    gyroscopic forces of the disc, skew-symmetric; missing without them
    C_b             n x n    damping of the contact, along the radius and along the sliding
    P_n, P_t, P_b   n_c x n  relative displacement disc minus pin, normal, along the sliding times the friction factor f of the pair of
                             surfaces (rows f t), along the radius
    K_n             n_c x n_c  springs of the contact, diagonal; zero where it is rigid, missing if all of it is
    T_c             n x n_k  basis of the kernel of the rigid rows of P_n

and the problem is (lambda^2 M~_c + lambda C_c + K~_c) phi = 0 with

    K~ = K - mu P_t^T S K + (P_n + mu P_t)^T K_n P_n,  M~ = M - mu P_t^T S M,  C~ = C + G - mu P_t^T S (C + G) + C_b,
    K~_c = T_c^T K~ T_c, M~_c and C_c likewise.

S reads the reactions of the rigid contact nodes from forces, S [P_n; P_t; P_b]^T = [I, 0, 0]: the pseudo-inverse, which is 1/2 P_n between
pairs of coincident nodes; the program uses another left inverse where faces do not match.

Nothing here is taken from the program but these matrices, so that what follows is independent of it.
"""

import dataclasses
import math
import pathlib

import numpy as np
import scipy.io
import scipy.sparse as sparse
import scipy.sparse.linalg

from squeal import quadratic
from squeal.errors import Error
from squeal.parameter_file import read_parameters


@dataclasses.dataclass
class QuadraticProblem:
    """The coupled matrices of lambda^2 mass + lambda damping + stiffness, as scipy's csr matrices."""

    mass: sparse.csr_matrix
    damping: sparse.csr_matrix
    stiffness: sparse.csr_matrix

    @property
    def size(self):
        return self.stiffness.shape[0]

    def backward_errors(self, eigenvalues, vectors):
        """|Q(lambda) x| / ((|lambda|^2 |M| + |lambda| |C| + |K|) |x|) of each pair, Frobenius norms of the matrices."""
        return quadratic.errors(self.mass, self.damping, self.stiffness, eigenvalues, vectors)[1]


def read_matrices(directory):
    """A dictionary name -> csr matrix of the exported matrices."""
    matrices = {}
    for name in ("M", "C", "K", "G", "C_b", "P_n", "P_t", "P_b", "K_n", "T_c"):
        path = pathlib.Path(directory) / "matrices" / f"{name}.mtx"
        if not path.is_file() and name in ("G", "K_n"):
            n = matrices["C" if name == "G" else "P_n"].shape[0]
            matrices[name] = sparse.csr_matrix((n, n))
            continue
        if not path.is_file():
            raise Error(f"{path} is missing", directory, 'run squeal with --set "Output/Write matrices=true"')
        matrices[name] = sparse.csr_matrix(scipy.io.mmread(path))
    return matrices


def rigid_rows(matrices):
    """Numbers of the contact nodes without springs."""
    return np.flatnonzero(matrices["K_n"].diagonal() == 0)


def reactions(matrices):
    """S, n_c x n, with zero rows at contact nodes with springs."""
    rigid, P_n = rigid_rows(matrices), matrices["P_n"]
    if len(rigid) == P_n.shape[0] and (abs(P_n @ P_n.T - 2 * sparse.identity(len(rigid))) > 1e-12).nnz == 0:
        return 0.5 * P_n  # pairs of nodes, in the precision of the matrices
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
    """What must vanish in exported matrices, each relative to the size of what it is made of: description -> value."""

    def largest(matrix):
        return abs(matrix).max() if matrix.nnz else 0.0

    rigid, T_c = rigid_rows(matrices), matrices["T_c"]
    P_n, P_t, P_b, S = (matrix[rigid] for matrix in (matrices["P_n"], matrices["P_t"], matrices["P_b"], reactions(matrices)))
    n_contact, n_dofs = P_n.shape
    errors = {
        "S P_n^T - I": largest(S @ P_n.T - sparse.identity(n_contact)),
        "S P_t^T": largest(S @ P_t.T),
        "S P_b^T": largest(S @ P_b.T),
        "P_n T_c": largest(P_n @ T_c),
        "columns of T_c - (n - n_c)": float(abs(T_c.shape[1] - (n_dofs - n_contact))),
    }
    for name in ("M", "C", "K", "C_b"):
        matrix = matrices[name]
        errors[f"{name} - {name}^T"] = largest(matrix - matrix.T) / (largest(matrix) or 1.0)
    errors["G + G^T"] = largest(matrices["G"] + matrices["G"].T) / (largest(matrices["G"]) or 1.0)
    return errors


def run_parameter(directory, name, given=None):
    """A number of the run: the one given on the command line, else the one in DIRECTORY/parameters.prm."""
    if given is not None:
        return given
    path = pathlib.Path(directory) / "parameters.prm"
    values = read_parameters(path) if path.is_file() else {}
    if name not in values:
        raise Error(f"{name} is missing", path, "give it on the command line")
    return float(values[name])


def in_band(eigenvalues, band):
    """Which eigenvalues have a frequency in (0, band], band in Hz; real ones and rigid-body modes do not count."""
    frequencies = eigenvalues.imag / (2 * math.pi)
    return (frequencies > 1e-5 * band) & (frequencies <= band)
