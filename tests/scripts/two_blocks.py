"""A run as squeal exports it, made without squeal: a plate on springs rubbed by a block whose top is clamped.

Both are boxes of equal trilinear bricks, so that one element matrix serves everywhere. The contact normal is z,
the plate slides along x, hence b = n x t = y.
"""

import csv
import itertools
import math
import pathlib

import numpy as np
import scipy.io
import scipy.sparse as sparse


def brick_matrices(edge, young_modulus, poisson_ratio, density):
    """Stiffness and mass of a cube of eight nodes, node order (x fastest, then y, then z)."""
    corners = np.array([(x, y, z) for z, y, x in itertools.product((-1, 1), repeat=3)], dtype=float)
    shear = young_modulus / (2 * (1 + poisson_ratio))
    lame = young_modulus * poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio))
    elasticity = np.diag([2 * shear] * 3 + [shear] * 3)
    elasticity[:3, :3] += lame
    stiffness, mass = np.zeros((24, 24)), np.zeros((24, 24))
    weight = (edge / 2) ** 3
    for point in itertools.product((-1 / math.sqrt(3), 1 / math.sqrt(3)), repeat=3):
        factors = 1 + corners * point
        shape = factors.prod(axis=1) / 8
        gradient = np.stack([corners[:, i] * factors[:, (i + 1) % 3] * factors[:, (i + 2) % 3] for i in range(3)]) / 8 * (2 / edge)
        strain = np.zeros((6, 24))
        for i in range(3):
            strain[i, i::3] = gradient[i]
            j, k = (i + 1) % 3, (i + 2) % 3
            strain[3 + i, j::3], strain[3 + i, k::3] = gradient[k], gradient[j]
        stiffness += weight * strain.T @ elasticity @ strain
        interpolation = np.kron(shape, np.eye(3))
        mass += weight * density * interpolation.T @ interpolation
    return stiffness, mass


def box(cells, edge, material):
    """Stiffness, mass (n x n) and node coordinates of a box of cells[0] x cells[1] x cells[2] cubes."""
    nodes = [c + 1 for c in cells]
    index = np.arange(np.prod(nodes)).reshape(nodes[::-1])
    element = brick_matrices(edge, *material)
    rows, columns, entries = [], [], ([], [])
    for z, y, x in itertools.product(*(range(c) for c in cells[::-1])):
        dofs = (3 * index[z:z + 2, y:y + 2, x:x + 2].reshape(-1, 1) + np.arange(3)).ravel()
        rows.append(np.repeat(dofs, 24))
        columns.append(np.tile(dofs, 24))
        for matrix, list_of_entries in zip(element, entries):
            list_of_entries.append(matrix.ravel())
    n = 3 * index.size
    rows, columns = np.concatenate(rows), np.concatenate(columns)
    stiffness, mass = (sparse.csr_matrix((np.concatenate(values), (rows, columns)), shape=(n, n)) for values in entries)
    coordinates = edge * np.stack([np.tile(np.arange(nodes[0]), nodes[1] * nodes[2]),
                                   np.tile(np.repeat(np.arange(nodes[1]), nodes[0]), nodes[2]),
                                   np.repeat(np.arange(nodes[2]), nodes[0] * nodes[1])], axis=1)
    return stiffness, mass, coordinates


def write_run(directory, friction_coefficient=0.4, plate=(5, 4, 1), block=(2, 2, 2), edge=0.01, band=20000.0, is_free=False):
    """Writes matrices/*.mtx and parameters.prm, and complex_modes.csv from a dense solution when that is small.

    The plate of a free run has no springs: it can move in its plane, and turn in it.
    """
    K_d, M_d, x_d = box(plate, edge, (210e9, 0.3, 7850.0))
    K_p, M_p, x_p = box(block, edge, (1.9e9, 0.25, 3070.0))
    offset = edge * np.array([(plate[0] - block[0]) // 2, (plate[1] - block[1]) // 2 + 1, plate[2]])
    x_p = x_p + offset

    # The plate stands on springs; uneven ones, so that no eigenvalue is double.
    foot = np.flatnonzero(x_d[:, 2] < edge / 2)
    springs = np.zeros(K_d.shape[0])
    for direction, value in enumerate((2.0e6, 2.2e6, 5.0e6)):
        springs[3 * foot + direction] = value * (1 + 0.1 * x_d[foot, 0] / (edge * plate[0]))
    if not is_free:
        K_d = K_d + sparse.diags(springs)
    top = np.flatnonzero(x_p[:, 2] > x_p[:, 2].max() - edge / 2)
    free = np.setdiff1d(np.arange(K_p.shape[0]), (3 * top[:, None] + np.arange(3)).ravel())
    new_number = np.full(K_p.shape[0], -1)
    new_number[free] = K_d.shape[0] + np.arange(free.size)

    K = sparse.block_diag([K_d, K_p[free][:, free]], format="csr")
    M = sparse.block_diag([M_d, M_p[free][:, free]], format="csr")
    n = K.shape[0]

    pairs = []
    for pin_node in np.flatnonzero(abs(x_p[:, 2] - edge * plate[2]) < edge / 2):
        disc_node = int(np.argmin(np.linalg.norm(x_d - x_p[pin_node], axis=1)))
        pairs.append((disc_node, pin_node))
    n_c = len(pairs)

    def relative(direction):
        matrix = sparse.lil_matrix((n_c, n))
        for row, (disc_node, pin_node) in enumerate(pairs):
            matrix[row, 3 * disc_node + direction] = 1.0
            matrix[row, new_number[3 * pin_node + direction]] = -1.0
        return matrix.tocsr()

    P_t, P_b, P_n = (relative(direction) for direction in range(3))
    C_b = P_b.T @ sparse.diags(np.linspace(1.0, 2.0, n_c)) @ P_b

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
    (directory / "parameters.prm").write_text(
        f"subsection Operation\n  set Friction coefficient = {friction_coefficient} # none\n  set Rotation = positive\nend\n"
        f"subsection Band\n  set Maximum frequency = {band}\nend\n", encoding="utf-8")
    if n < 1000:
        write_modes(directory, dense_eigenvalues(M, C_b, K, P_n, P_t, T_c, friction_coefficient, band))


def dense_eigenvalues(M, C_b, K, P_n, P_t, T_c, friction_coefficient, band):
    """Eigenvalues of the band from the definition, all matrices dense.

    The reciprocals come from a standard eigenvalue problem, which makes the small eigenvalues the accurate ones.
    """
    M, C_b, K, P_n, P_t, T_c = (matrix.toarray() for matrix in (M, C_b, K, P_n, P_t, T_c))
    friction = np.eye(K.shape[0]) - friction_coefficient / 2 * P_t.T @ P_n
    M_c, C_c, K_c = T_c.T @ friction @ M @ T_c, T_c.T @ C_b @ T_c, T_c.T @ friction @ K @ T_c
    # About a shift, with which a free plate has no singular matrix
    n, scale, shift = K_c.shape[0], math.pi * band, -0.02 * math.pi * band
    D_c = C_c + shift * M_c
    Q = K_c + shift * D_c
    state = np.vstack([np.hstack([-scale * np.linalg.solve(Q, D_c), -scale**2 * np.linalg.solve(Q, M_c)]), np.zeros((n, 2 * n))])
    state[n:] = np.hstack([np.eye(n), np.zeros((n, n))]) + shift / scale * state[:n]
    reciprocals = np.linalg.eigvals(state)
    eigenvalues = shift + scale / reciprocals[reciprocals != 0]
    frequencies = eigenvalues.imag / (2 * math.pi)
    listed = eigenvalues[(frequencies > 1e-5 * band) & (frequencies <= band)]
    return listed[np.argsort(listed.imag)]


def write_modes(directory, eigenvalues):
    with open(pathlib.Path(directory) / "complex_modes.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["label", "share [-]", "frequency [Hz]", "growth rate [1/s]", "divergence rate [%]"])
        for number, value in enumerate(eigenvalues, start=1):
            writer.writerow([f"mode {number}", 1, repr(float(value.imag) / (2 * math.pi)), repr(float(value.real)),
                             repr(float(100 * value.real / value.imag))])
