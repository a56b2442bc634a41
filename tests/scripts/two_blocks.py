# SPDX-License-Identifier: GPL-3.0-or-later

"""Result files generated without squeal, for a plate on springs in frictional contact with a block clamped at its top.

Both bodies are lattices of point masses with springs along edges and diagonals. The contact normal is z and the plate
slides along x, so that b = n x t = y.
"""

import csv
import itertools
import math
import pathlib

import numpy as np
import scipy.io
import scipy.sparse as sparse
import scipy.spatial

EDGE, PLATE, BLOCK, FRICTION_COEFFICIENT = 0.01, (5, 4, 1), (2, 2, 2), 0.4


def lattice(cells, young_modulus, density):
    """Stiffness, mass and positions of a lattice of point masses."""
    places = EDGE * np.array(list(itertools.product(*(range(n + 1) for n in cells))), dtype=float)
    pairs = scipy.spatial.cKDTree(places).query_pairs(1.8 * EDGE, output_type="ndarray")
    lengthening = sparse.lil_matrix((len(pairs), places.size))
    for row, (i, j) in enumerate(pairs):
        direction = (places[j] - places[i]) / np.linalg.norm(places[j] - places[i])
        lengthening[row, 3 * i:3 * i + 3], lengthening[row, 3 * j:3 * j + 3] = -direction, direction
    return young_modulus * EDGE * (lengthening.T @ lengthening), density * EDGE**3 * sparse.identity(places.size), places


def write_run(directory, band=20000.0):
    """Writes matrices/*.mtx and parameters.prm, and complex_modes.csv from a dense solution."""
    K_d, M_d, x_d = lattice(PLATE, 210e9, 7850.0)
    K_p, M_p, x_p = lattice(BLOCK, 1.9e9, 3070.0)
    x_p = x_p + EDGE * np.array([(PLATE[0] - BLOCK[0]) // 2, (PLATE[1] - BLOCK[1]) // 2 + 1, PLATE[2]])

    # Uneven springs under the plate make all eigenvalues simple
    foot = np.flatnonzero(x_d[:, 2] < EDGE / 2)
    springs = np.zeros(x_d.size)
    for direction, value in enumerate((2.0e6, 2.2e6, 5.0e6)):
        springs[3 * foot + direction] = value * (1 + 0.1 * x_d[foot, 0] / (EDGE * PLATE[0]))
    K_d = K_d + sparse.diags(springs)
    free = np.flatnonzero(np.repeat(x_p[:, 2] < x_p[:, 2].max() - EDGE / 2, 3))
    new_number = np.full(x_p.size, -1)
    new_number[free] = x_d.size + np.arange(free.size)
    K = sparse.block_diag([K_d, K_p.tocsr()[free][:, free]], format="csr")
    M = sparse.block_diag([M_d, M_p.tocsr()[free][:, free]], format="csr")
    n = K.shape[0]

    pairs = [(int(np.argmin(np.linalg.norm(x_d - x_p[node], axis=1))), node)
             for node in np.flatnonzero(abs(x_p[:, 2] - EDGE * PLATE[2]) < EDGE / 2)]

    def relative(direction):
        matrix = sparse.lil_matrix((len(pairs), n))
        for row, (disc_node, pin_node) in enumerate(pairs):
            matrix[row, 3 * disc_node + direction] = 1.0
            matrix[row, new_number[3 * pin_node + direction]] = -1.0
        return matrix.tocsr()

    P_t, P_b, P_n = (relative(direction) for direction in range(3))
    C_b = P_b.T @ sparse.diags(np.linspace(1.0, 2.0, len(pairs))) @ P_b

    slaves = [new_number[3 * pin_node + 2] for _, pin_node in pairs]
    masters = np.setdiff1d(np.arange(n), slaves)
    column = np.full(n, -1)
    column[masters] = np.arange(masters.size)
    column[slaves] = [column[3 * disc_node + 2] for disc_node, _ in pairs]
    T_c = sparse.csr_matrix((np.ones(n), (np.arange(n), column)), shape=(n, masters.size))

    directory = pathlib.Path(directory)
    (directory / "matrices").mkdir(parents=True, exist_ok=True)
    for name, matrix in {"M": M, "C": 0 * M, "K": K, "C_b": C_b, "P_n": P_n, "P_t": P_t, "P_b": P_b, "T_c": T_c}.items():
        symmetry = "symmetric" if name in ("M", "K") else "general"
        scipy.io.mmwrite(directory / "matrices" / f"{name}.mtx", sparse.coo_matrix(matrix), precision=17, symmetry=symmetry)
    (directory / "run.json").write_text("{}", encoding="utf-8")
    (directory / "parameters.prm").write_text(
        f"subsection Operation\n  set Friction coefficient = {FRICTION_COEFFICIENT} # none\n  set Rotation = positive\nend\n"
        f"subsection Band\n  set Maximum frequency = {band}\nend\n", encoding="utf-8")
    with open(directory / "complex_modes.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["label", "share [-]", "frequency [Hz]", "growth rate [1/s]", "divergence rate [%]"])
        for number, value in enumerate(dense_eigenvalues(M, C_b, K, P_n, P_t, T_c, band), start=1):
            writer.writerow([f"mode {number}", 1, repr(float(value.imag) / (2 * math.pi)), repr(float(value.real)),
                             repr(float(100 * value.real / value.imag))])


def dense_eigenvalues(M, C_b, K, P_n, P_t, T_c, band):
    """Eigenvalues in the band, from dense matrices.

    Small eigenvalues are accurate, because they are reciprocals of the large eigenvalues of a standard problem.
    """
    M, C_b, K, P_n, P_t, T_c = (matrix.toarray() for matrix in (M, C_b, K, P_n, P_t, T_c))
    friction = np.eye(K.shape[0]) - FRICTION_COEFFICIENT / 2 * P_t.T @ P_n
    M_c, C_c, K_c = T_c.T @ friction @ M @ T_c, T_c.T @ C_b @ T_c, T_c.T @ friction @ K @ T_c
    n, scale = K_c.shape[0], math.pi * band
    state = np.block([[-scale * np.linalg.solve(K_c, C_c), -scale**2 * np.linalg.solve(K_c, M_c)], [np.eye(n), np.zeros((n, n))]])
    reciprocals = np.linalg.eigvals(state)
    eigenvalues = scale / reciprocals[reciprocals != 0]
    frequencies = eigenvalues.imag / (2 * math.pi)
    listed = eigenvalues[(frequencies > 1e-5 * band) & (frequencies <= band)]
    return listed[np.argsort(listed.imag)]
