# SPDX-License-Identifier: GPL-3.0-or-later

"""scripts/slepc_modes.py: formulations compared with a dense solver, and their applicability."""

import math
import pathlib
import sys
import tempfile
import unittest

import two_blocks

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))

import slepc_modes  # also adds the folder of the module squeal to the path
from squeal import exported_matrices

BAND = 20000.0


class Formulations(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            two_blocks.write_run(folder, band=BAND)
            matrices = exported_matrices.read_matrices(folder)
        damped, nothing = matrices["C_b"], 0 * matrices["C_b"]
        others = [matrices[name] for name in ("K", "P_n", "P_t", "T_c")]
        cls.damped, cls.undamped = (exported_matrices.couple({**matrices, "C_b": C_b}, 0.4) for C_b in (damped, nothing))
        cls.dense = [(problem, two_blocks.dense_eigenvalues(matrices["M"], C_b, *others, BAND))
                     for problem, C_b in ((cls.undamped, nothing), (cls.damped, damped))]

    def assert_all_found(self, problem, expected, formulation, **options):
        solution = slepc_modes.Solution(problem, slepc_modes.n_wanted(formulation, len(expected)), formulation, **options)
        found = solution.eigenvalues[exported_matrices.in_band(solution.eigenvalues, BAND)]
        self.assertTrue(solution.covers(BAND))
        self.assertEqual(len(found), len(expected))
        self.assertLess((abs(found[:, None] - expected[None, :]).min(axis=1) / abs(found)).max(), 1e-8)

    def test_linear_fits_without_damping_only(self):
        self.assertEqual(slepc_modes.applicable(self.undamped)[0], "linear")
        self.assertEqual(slepc_modes.applicable(self.damped)[0], "toar")
        self.assertNotIn("linear", slepc_modes.applicable(self.damped))

    @unittest.skipUnless(slepc_modes.available(), "SLEPc is not installed")
    def test_every_formulation_finds_the_dense_solution(self):
        for problem, expected in self.dense:
            self.assertGreater(len(expected), 5)
            for formulation in slepc_modes.applicable(problem):
                with self.subTest(formulation, damped=problem is self.damped):
                    self.assert_all_found(problem, expected, formulation)
        self.assert_all_found(*self.dense[0], "linear", shift=0.05 * 2 * math.pi * BAND)


if __name__ == "__main__":
    unittest.main()
