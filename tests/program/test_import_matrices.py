# SPDX-License-Identifier: GPL-3.0-or-later

"""Studies of imported matrices, compared with SciPy's eigenvalues of the original matrices."""

import math
import subprocess
import sys
import unittest

from program import SOURCE, read_table
from test_systems import BAND, HAS_NUMPY, SystemTest

import squeal

if HAS_NUMPY:
    import numpy as np
    import scipy.io
    import scipy.linalg
    import scipy.sparse

CONFIGURATION = """
description: D = D1 + D_R / omega + omega D_G, K = K1 + omega^2 K_geo
parameters:
  omega: {value: 2*_pi, lower: _pi, upper: 4*_pi, unit: rad/s}
terms:
  - {name: mass, power: 2, file: mass.mtx, symmetry: symmetric}
  - {name: damping, power: 1, file: damping.mat, variable: D1, symmetry: symmetric, scale: 1/1000}
  - {name: friction, power: 1, coefficient: 1/omega, file: damping.mat, variable: DR}
  - {name: gyroscopic forces, power: 1, coefficient: omega, file: damping.mat, variable: DG, symmetry: skew, kind: rotation}
  - {name: stiffness, power: 0, file: stiffness.npz, symmetry: symmetric}
  - {name: circulation, power: 0, file: circulation.npy, kind: circulatory}
  - {name: geometric stiffness, power: 0, coefficient: omega^2, file: geometric.npy, symmetry: symmetric}
groups: {disc: [[1, 25]], pads: [[26, 40]]}
"""


@unittest.skipUnless(HAS_NUMPY, "needs NumPy")
class ImportedBrake(SystemTest):
    N = 40

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        n, random = cls.N, np.random.default_rng(2)
        near = np.abs(np.subtract.outer(np.arange(n), np.arange(n))) <= 4
        parts = [near * random.standard_normal((n, n)) for _ in range(4)]
        cls.M = np.eye(n) + 0.1 * (np.eye(n, k=1) + np.eye(n, k=-1))
        cls.K1 = np.diag(30.0 + 10.0 * np.arange(n)) - 4.0 * (np.eye(n, k=1) + np.eye(n, k=-1))
        cls.D1, cls.DR, cls.DG = 0.1 * cls.K1, 0.02 * parts[0], 0.005 * (parts[1] - parts[1].T)
        cls.KR, cls.K_geo = 2.0 * parts[2], 0.002 * (parts[3] + parts[3].T)
        scipy.io.mmwrite(cls.folder / "mass.mtx", scipy.sparse.coo_matrix(cls.M), precision=17)
        scipy.io.savemat(cls.folder / "damping.mat", {"D1": scipy.sparse.csc_matrix(cls.D1), "DR": cls.DR, "DG": cls.DG})
        scipy.sparse.save_npz(cls.folder / "stiffness.npz", scipy.sparse.csr_matrix(cls.K1))
        np.save(cls.folder / "circulation.npy", cls.KR)
        np.save(cls.folder / "geometric.npy", cls.K_geo)
        (cls.folder / "brake.yaml").write_text(CONFIGURATION, encoding="utf-8")
        process = subprocess.run([sys.executable, "-B", SOURCE / "scripts" / "import_matrices.py", "brake.yaml", "--output", "system"],
                                 cwd=cls.folder, text=True, capture_output=True)
        assert process.returncode == 0, process.stderr

    def expected(self, omega):
        """λ in the band with Im λ > 0, computed by SciPy from the matrices in memory."""
        D, K, none = self.D1 / 1000 + self.DR / omega + omega * self.DG, self.K1 + self.KR + omega**2 * self.K_geo, np.zeros((self.N, self.N))
        values = scipy.linalg.eigvals(np.block([[none, np.eye(self.N)], [-K, -D]]), scipy.linalg.block_diag(np.eye(self.N), self.M))
        return values[(values.imag > 1e-6) & (values.imag <= 2 * math.pi * BAND)]

    def assert_same(self, found, expected, tolerance):
        self.assertEqual(len(found), len(expected))
        self.assertGreater(len(expected), 5)
        for value in expected:
            self.assertLess(min(abs(value - other) for other in found), tolerance * abs(value))

    def test_stability(self):
        n_unstable = set()
        for omega in (math.pi, 2 * math.pi, 4 * math.pi):
            results = self.study("stability", f"System values=omega = {omega!r}")
            expected = self.expected(omega)
            self.assert_same(self.lambdas(results), expected, 1e-9)
            modes = squeal.Results(results).modes
            self.assertEqual(modes["unstable"].sum(), sum(expected.real > 1e-9))
            np.testing.assert_allclose(modes["kinetic energy of disc"] + modes["kinetic energy of pads"], 100.0)
            n_unstable.add(sum(expected.real > 1e-9))
        self.assertGreater(max(n_unstable), 0)

    def test_sweep(self):
        omegas = (math.pi, 2.5 * math.pi, 4 * math.pi)
        results = self.study("sweep", f"Sweep/Parameter=omega, {math.pi!r}, {4 * math.pi!r}, 7",
                             "Sweep/Complex plane at=" + ", ".join(map(repr, omegas)))
        plane = read_table(results / "complex_plane.csv")
        for omega in omegas:
            found = [complex(float(row["growth rate [1/s]"]), 2 * math.pi * float(row["frequency [Hz]"])) for row in plane
                     if abs(float(row["omega [rad/s]"]) - omega) < 1e-9]
            expected = self.expected(omega)
            self.assert_same(found, expected[expected.real >= -0.2 * math.pi * BAND], 1e-6)


if __name__ == "__main__":
    unittest.main()
