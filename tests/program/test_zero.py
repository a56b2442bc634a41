# SPDX-License-Identifier: GPL-3.0-or-later

"""The limit below which eigenvalues count as zero does not depend on the band; verdicts account for the number of correct digits."""

import json
import math
import os
import re
import sys
import unittest

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from program import SOURCE, ProgramTest, read_table, real_frequencies

try:
    import numpy as np
except ImportError:
    raise unittest.SkipTest("NumPy is missing") from None

sys.path.insert(0, str(SOURCE / "scripts"))
from squeal import exported_matrices

STIFFNESS = 1e4  # stiffness of a very soft mount [N/m³]
BANDS = (1000, 5000)


def soft(stiffness=STIFFNESS):
    return f"Mounts/Elastic mounts=disc_bore: {stiffness!r}, {stiffness!r}, {stiffness!r}"


def frequencies(folder, table):
    return real_frequencies(folder, f"{table}.csv")


def record(folder):
    return json.loads((folder / "run.json").read_text(encoding="utf-8"))


def warnings(folder):
    return " ".join(record(folder)["warnings"])


def of_a_rigid_disc(folder, stiffness):
    """Frequencies [Hz] of a rigid disc with a mount on its polygonal bore: ω² = k A / m along x and y, ω² = k ∫r² dA / J
    about z."""
    nodes = [row for row in read_table(folder / "matrices" / "nodes.csv") if row["component"] == "disc"]
    points = np.array([[float(row[f"{axis} [m]"]) for axis in "xyz"] for row in nodes])
    radii, height = np.hypot(points[:, 0], points[:, 1]), np.ptp(points[:, 2])
    mass = exported_matrices.read_matrices(folder)["M"].tocsr()
    x, z = (np.zeros(mass.shape[0]) for _ in range(2))
    for row, point in zip(nodes, points):
        places = [int(row[f"row {axis}"]) - 1 for axis in "xyz"]
        x[places[0]] = 1
        z[places[0]], z[places[1]] = -point[1], point[0]
    corners = points[(radii < radii.min() * (1 + 1e-6)) & (points[:, 2] == points[:, 2].max()), :2]
    corners = corners[np.argsort(np.arctan2(corners[:, 1], corners[:, 0]))]
    following = np.roll(corners, -1, axis=0)
    lengths = np.linalg.norm(following - corners, axis=1)
    area = height * lengths.sum()
    second_moment = height * (lengths * (corners**2 + following**2 + corners * following).sum(axis=1)).sum() / 3
    squares = stiffness * area / (x @ mass @ x), stiffness * second_moment / (z @ mass @ z)
    return sorted(math.sqrt(square) / (2 * math.pi) for square in (squares[0], squares[0], squares[1]))


class SoftMount(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.runs = {band: cls.run_scene(f"band-{band}", soft(), f"Band/Maximum frequency={band}", "Output/Write matrices=true")
                    for band in BANDS}

    def test_has_the_frequencies_of_a_rigid_disc_in_every_band(self):
        for folder in self.runs.values():
            expected = of_a_rigid_disc(folder, STIFFNESS)
            for table in ("real_modes", "complex_modes"):
                np.testing.assert_allclose(frequencies(folder, table)[:3], expected, rtol=1e-5)

    def test_lists_the_same_modes_in_every_band(self):
        for table in ("real_modes", "complex_modes"):
            widest = np.array(frequencies(self.runs[BANDS[-1]], table))
            for band in BANDS[:-1]:
                found = frequencies(self.runs[band], table)
                np.testing.assert_allclose(found, widest[widest <= band], rtol=1e-4)
        for folder in self.runs.values():
            self.assertEqual(record(folder)["counts"]["rigid-body modes"], 0)

    def test_leaves_growth_open_that_digits_do_not_show(self):
        for folder in self.runs.values():
            with self.subTest(folder.name):
                rows = read_table(folder / "complex_modes.csv")
                # The warnings give one limit for all modes and one for low frequencies
                limits = [float(text) for text in re.findall(r"(?:below|limit is) ([-+.e0-9]+) %", warnings(folder))]
                self.assertEqual(len(limits), 2, warnings(folder))
                for row in rows:
                    rate, is_slow = float(row["divergence rate [%]"]), float(row["frequency [Hz]"]) < 1
                    if abs(rate) < limits[is_slow]:
                        self.assertNotEqual(row["verdict"], "unstable")
                    self.assertEqual(row["unstable [-]"], str(int(row["verdict"] == "unstable")))
                counts = record(folder)["counts"]
                for verdict in ("unstable", "undecided"):
                    self.assertEqual(counts[f"{verdict} modes"], sum(row["verdict"] == verdict for row in rows))
                # Growth of the modes along x and y is undecided, because their frequencies are equal
                self.assertGreater(counts["undecided modes"], 0)


class HiddenMount(ProgramTest):
    def test_is_named(self):
        folder = self.run_scene("hidden", soft(1e-3), "Band/Maximum frequency=1000")
        self.assertEqual(record(folder)["counts"]["rigid-body modes"], 3)
        self.assertRegex(warnings(folder), r"3 of the 3 modes .* Hz.*Mounts/Elastic mounts")

    def test_is_not_meant_where_the_disc_is_free(self):
        folder = self.run_scene("free", "Mounts/Elastic mounts=")
        self.assertEqual(record(folder)["counts"]["rigid-body modes"], 3)
        self.assertNotIn("Mounts/Elastic mounts", warnings(folder))
        self.assertEqual(frequencies(folder, "real_modes")[:3], [0, 0, 0])
        self.assertGreater(frequencies(folder, "complex_modes")[0], 1)

class WeakDamping(ProgramTest):
    def test_names_the_number_of_modes_that_it_does_not_decide(self):
        process = self.call_scene("weak", "Disc material/Rayleigh beta=1e-14", "Pin material/Rayleigh beta=1e-14")
        self.assertEqual(process.returncode, 0, process.stderr)
        rows = read_table(self.folder / "weak" / "complex_modes.csv")
        neutral = [row for row in rows if abs(float(row["divergence rate [%]"])) <= 1e-6 and row["verdict"] == "stable"]
        self.assertGreater(len(neutral), 0)
        self.assertRegex(process.stdout, rf"\b{len(neutral)} of {len(rows)} modes\b")

if __name__ == "__main__":
    unittest.main()
