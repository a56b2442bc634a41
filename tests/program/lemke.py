# SPDX-License-Identifier: GPL-3.0-or-later

"""Independent solution of steady sliding from exported matrices by Lemke's complementary pivoting."""

import csv

import numpy as np
import scipy.io
import scipy.sparse as sparse
import scipy.sparse.linalg

# Reference of the travel d [m], negative to keep d >= 0 if the disc recedes
START = -1e-4


class SlidingContact:
    """Contact condensed to the contact nodes, from the exported matrices of a run with all nodes closed."""

    def __init__(self, folder, friction_coefficient):
        K, P_n, P_t = (sparse.csc_matrix(scipy.io.mmread(folder / "matrices" / f"{name}.mtx")) for name in ("K", "P_n", "P_t"))
        factors = scipy.sparse.linalg.splu(K)
        self.flexibility = P_n @ factors.solve((P_n + friction_coefficient * P_t).T.toarray())
        with open(folder / "matrices" / "contact_nodes.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.pins = [row["pin"] for row in rows]
        self.sides = np.array([float(row["n_z"]) for row in rows])
        self.normals = np.array([[float(row[f"n_{axis}"]) for axis in "xyz"] for row in rows])
        self.friction_coefficient = friction_coefficient
        self.areas = np.array([float(row["area [m^2]"]) for row in rows])
        self.positions = np.array([[float(row[f"{axis} [m]"]) for axis in "xyz"] for row in rows])
        self.sliding = np.array([[float(row[f"t_{axis}"]) for axis in "xyz"] for row in rows])
        self.axis_distances = np.hypot(self.positions[:, 0], self.positions[:, 1])

    def gaps(self, pins):
        """Initial gaps [m] of all nodes from the gap, sliding taper and radial taper of each pin in `pins`."""
        gaps = np.zeros(len(self.pins))
        for pin, (gap, along, outwards) in pins.items():
            nodes = [c for c, name in enumerate(self.pins) if name == pin]
            centre = np.average(self.positions[nodes], axis=0, weights=self.areas[nodes])
            gaps[nodes] = (gap + along * np.sum((self.positions[nodes] - centre) * self.sliding[nodes], axis=1)
                           + outwards * (self.axis_distances[nodes] - np.hypot(centre[0], centre[1])))
        return gaps

    def solve(self, gaps, plates, loads):
        """Compression [N] of every node and travel [m] of every backplate; `plates` is the index of the backplate of
        each node.

        The compressions p >= 0 are complementary to the remaining gaps G p - B (d + START) + gaps >= 0; the travels d
        >= 0, measured from START, are complementary to the excess loads B^T p - loads >= 0.
        """
        n, unit = len(gaps), np.mean(np.diag(self.flexibility))
        B = np.equal.outer(np.array(plates), np.arange(len(loads))).astype(float)
        matrix = np.block([[self.flexibility / unit, -B], [B.T, np.zeros((len(loads), len(loads)))]])
        solution = lemke(matrix, np.concatenate([(gaps - START) / unit, -np.array(loads)]))
        return solution[:n], unit * solution[n:] + START

    def pressed_along_normals(self, load):
        """Normal load [N] and travel [m] of each body if all its nodes are closed and it is pressed along its mean
        normal."""
        names = list(dict.fromkeys(self.pins))
        n, k = len(self.pins), len(names)
        closing, balance = np.zeros((n, k)), np.zeros((k, n))
        for j, name in enumerate(names):
            nodes = [c for c, pin in enumerate(self.pins) if pin == name]
            mean = self.areas[nodes] @ self.normals[nodes]
            travel = -mean / np.linalg.norm(mean)
            closing[nodes, j] = -self.normals[nodes] @ travel
            balance[j, nodes] = (self.normals[nodes] + self.friction_coefficient * self.sliding[nodes]) @ travel
        # Solve G r + B z = 0 (no gap at any node) and L r = load (for each body)
        unit = np.mean(np.diag(self.flexibility))
        matrix = np.block([[self.flexibility / unit, closing], [balance, np.zeros((k, k))]])
        solution = np.linalg.solve(matrix, np.concatenate([np.zeros(n), np.full(k, load)]))
        sums = [-sum(r for r, pin in zip(solution, self.pins) if pin == name) for name in names]
        return sums, unit * solution[n:]


def lemke(matrix, vector):
    """Solution of the linear complementarity problem z >= 0, w = matrix z + vector >= 0, z^T w = 0."""
    n = len(vector)
    if vector.min() >= 0:
        return np.zeros(n)
    # Columns: slack variables 0 ... n - 1, z n ... 2 n - 1, artificial variable 2 n
    tableau = np.hstack([np.eye(n), -matrix, -np.ones((n, 1)), vector[:, None]])
    basis, row, entering = list(range(n)), int(np.argmin(vector)), 2 * n
    for _ in range(100 * n):
        tableau[row] /= tableau[row, entering]
        others = np.arange(n) != row
        tableau[others] -= np.outer(tableau[others, entering], tableau[row])
        leaving, basis[row] = basis[row], entering
        if leaving == 2 * n:
            z = np.zeros(2 * n)
            z[basis] = tableau[:, -1]
            return z[n:]
        entering = leaving + n if leaving < n else leaving - n
        column = tableau[:, entering]
        positive = np.flatnonzero(column > 1e-11 * abs(column).max())
        if len(positive) == 0:
            break
        ratios = tableau[positive, -1] / column[positive]
        # In a tie, the artificial variable leaves the basis, which ends the iteration
        row = int(min(positive[ratios <= ratios.min() * (1 + 1e-12)], key=lambda i: basis[i] != 2 * n))
    raise RuntimeError(f"Lemke's method found no solution: it ended on a ray or after {100 * n} pivots")
