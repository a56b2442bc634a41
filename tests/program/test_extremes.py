# SPDX-License-Identifier: GPL-3.0-or-later

"""Extreme parameters: the spectrum is correct and complete, or the run stops and states the reason.

References are eigenvalues of the exported matrices, refined with a 64-bit mantissa by scripts/extremes/oracle.py.
"""

import os
import re
import sys
import unittest

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from program import SOURCE, ProgramTest, eigenvalues, read_table, real_frequencies, settings

sys.path.insert(0, str(SOURCE / "scripts"))
try:
    import numpy as np

    from extremes import oracle
    from squeal import exported_matrices
except ImportError:
    raise unittest.SkipTest("NumPy or SciPy is missing") from None

BAND = 2 * np.pi * 5000
RADIUS = 1.01**0.5 * BAND
FRICTION = "Operation/Friction coefficient"
MATRICES = "Output/Write matrices=true"
RESIDUAL_ITERATION = "Complex modes/Solver=residual iteration"

# One pin on each side of a narrow disc with one layer: 780 dofs
SMALL = [
    *(f"Geometry/{side} pin {what}" for side in ("Top", "Bottom") for what in ("radii=0.257", "angles=0")),
    "Geometry/Disc inner radius=0.2",
    "Geometry/Element size=0.0577",
]


def is_real(root):
    return root.imag <= 1e-7 * abs(root)


def real_values(folder):
    path = folder / "real_eigenvalues.csv"
    return sorted(float(row["growth rate [1/s]"]) for row in read_table(path)) if path.exists() else []


class Extremes(ProgramTest):
    def succeed(self, output, *overrides):
        process = self.call("scene.prm", "--output", output, *settings(overrides))
        self.assertEqual(process.returncode, 0, process.stderr)
        return self.folder / output, process.stdout

    def refused(self, mentions, *overrides):
        self.assert_message(self.call("scene.prm", "--output", "refused", *settings(overrides)), mentions)
        self.assertFalse((self.folder / "refused").exists())

    def assert_spectrum(self, folder, friction_coefficient=0.4, slowest=0.0, tolerance=1e-6):
        """Checks that the tables contain exactly the eigenvalues with slowest < |lambda| <= RADIUS."""
        solution = oracle.Oracle(exported_matrices.read_matrices(folder), friction_coefficient, BAND / (2 * np.pi)).solve(RADIUS)
        self.assertLess(solution.error, 0.01 * tolerance)
        inside = [root for root in solution.values if slowest < abs(root) <= RADIUS and root.imag <= BAND]
        self.assert_same_eigenvalues([root for root in eigenvalues(folder) if abs(root) > slowest], [root for root in inside if not is_real(root)],
                                     tolerance)
        self.assert_same_eigenvalues(real_values(folder), [root.real for root in inside if is_real(root)], tolerance)

    # ------------------------------------------------------------ real eigenvalues

    def test_large_friction(self):
        """Static divergence is listed, counted and reported; both solvers omit eigenvalues beyond the search radius."""
        n_real = set()
        for friction_coefficient in (3, 10):
            folder, screen = self.succeed("friction", *SMALL, f"{FRICTION}={friction_coefficient}", MATRICES)
            self.assert_spectrum(folder, friction_coefficient)
            growing = [value for value in real_values(folder) if value > 0]
            n_real.add(len(growing))
            self.assertEqual("static divergence" in screen, bool(growing))
            if growing:
                found = re.search(r"static divergence: (\d+) real eigenvalues? above zero at mu = \d+, largest growth rate (\S+) 1/s", screen)
                self.assertEqual(int(found[1]), len(growing))
                self.assertAlmostEqual(float(found[2]) / max(growing), 1, delta=1e-3)
                self.assertIn('"growing real eigenvalues": ' + str(len(growing)), (folder / "run.json").read_text(encoding="utf-8"))
            self.assert_found_by_iteration(folder, *SMALL, f"{FRICTION}={friction_coefficient}")
        self.assertNotEqual(n_real, {0})

    def assert_found_by_iteration(self, folder, *overrides):
        other, _ = self.succeed("iterated", *overrides, RESIDUAL_ITERATION)
        self.assert_same_eigenvalues(eigenvalues(other), eigenvalues(folder), tolerance=1e-6)
        self.assert_same_eigenvalues(real_values(other), real_values(folder), tolerance=1e-6)

    # ------------------------------------------------------------ soft mounts

    def test_soft_mounts(self):
        mounts = "Mounts/Elastic mounts=disc_bore: 1e3, 1e3, 1e3"
        folder, _ = self.succeed("soft", *SMALL, mounts, MATRICES)
        self.assert_spectrum(folder, slowest=1e-4 * BAND)
        self.assert_found_by_iteration(folder, *SMALL, mounts)

    # ------------------------------------------------------------ wide bands

    def test_small_pins_in_a_wide_band(self):
        """All modes are found with blocks that are large compared with the number of dofs of the pins."""
        folder, screen = self.succeed("wide", "Band/Maximum frequency=10000")
        found, counted = map(int, re.search(r"Real modes .* (\d+) found, (\d+) counted", screen).groups())
        self.assertEqual(found, counted)
        self.assertEqual(found, len(real_frequencies(folder)))

    def test_band_beyond_the_mesh(self):
        resolved = ["the mesh does not resolve", "Band/Maximum frequency", "lower this parameter below"]
        for override, body in (("Band/Maximum frequency=100000", "disc"), ("Pin material/Density=3.07e9", "pin_top_1")):
            with self.subTest(override):
                self.refused([*resolved, body], override)
        self.dry_run_refused(resolved, "Pin material/Young modulus=1900")

    def test_too_many_modes(self):
        n = len(real_frequencies(self.run_scene("plain")))
        cap = "Real modes/Maximum number of modes"
        self.refused([f"{n} modes lie below 5000 Hz, more than the maximum of {n - 1}", "Band/Maximum frequency", cap], f"{cap}={n - 1}")
        self.succeed("allowed", f"{cap}={n}")

    # ------------------------------------------------------------ damping, locking

    def test_overdamped_waves(self):
        self.refused(["Pin material/Rayleigh beta", "-1/beta = -10000 1/s", "give less than 2.639e-05 s", "Modal damping ratio"],
                     "Pin material/Rayleigh beta=1e-4")
        folder, _ = self.succeed("damped", *SMALL, "Disc material/Rayleigh beta=2.6e-5", "Pin material/Rayleigh beta=2.6e-5", MATRICES)
        self.assert_spectrum(folder)

    def test_locking(self):
        constants = "Materials/Orthotropic=pin_top_1: {0}, 0.49, {1}, 6.5e8, 6.5e8, 6.5e8, 3070".format
        change = "Discretization/Element = incompatible modes"
        for override, place in (("Pin material/Poisson ratio=0.49", "the Poisson ratio in Pin material is 0.49"),
                                (constants("1.9e9, 1.9e9, 1.9e9", "0.49, 0.49"),
                                 "the mean Poisson ratio in Materials/Orthotropic, pin_top_1 is 0.49")):
            process = self.dry_run(*SMALL, override)
            self.assertIn(f"note: trilinear elements lock: {place}", process.stdout)
            self.assertIn(change, process.stdout)
            self.assertNotIn("lock", self.dry_run(*SMALL, override, "Discretization/Element=incompatible modes").stdout)
        # Soft only along axis 3: a single large Poisson's ratio does not cause locking
        self.assertNotIn("lock", self.dry_run(*SMALL, constants("1.9e9, 1.9e9, 0.5e9", "0.1, 0.1")).stdout)


if __name__ == "__main__":
    unittest.main()
