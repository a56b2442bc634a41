# SPDX-License-Identifier: GPL-3.0-or-later

"""The quick cases of doc/extremes.md, and the reference solution with which they are compared."""

import os
import pathlib
import sys
import tempfile
import unittest

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from program import SOURCE

sys.path.insert(0, str(SOURCE / "scripts"))
try:
    import numpy as np
    from extremes import judge, oracle
    from extremes.cases import CASES
    import scipy.sparse as sparse
    from squeal import quadratic
except ImportError:
    raise unittest.SkipTest("NumPy or SciPy is missing") from None


class Cases(unittest.TestCase):
    def test_are_right_or_refused(self):
        for case in CASES:
            if case.quick:
                with self.subTest(case.name), tempfile.TemporaryDirectory() as folder:
                    row = judge.judge(case, pathlib.Path(folder))
                    self.assertTrue(row.is_as_expected, row)


class Oracle(unittest.TestCase):
    def test_finds_known_eigenvalues(self):
        """Uncoupled oscillators: two with close eigenvalues, one overdamped within and one beyond the search radius."""
        squares, rates = np.array([1e2, 1e4, 1e4 * (1 + 1e-9), 4e4, 1e9]), np.array([0.0, 1.0, 1.0, 1e3, 1e6])
        none, unit = sparse.csr_matrix((0, len(squares))), sparse.identity(len(squares), format="csr")
        matrices = {"M": unit, "K": sparse.diags(squares).tocsr(), "C": sparse.diags(rates).tocsr(), "G": 0 * unit, "C_b": 0 * unit, "P_n": none, "P_t": none,
                    "P_b": none, "K_n": sparse.csr_matrix((0, 0)), "T_c": unit}
        found = oracle.Oracle(matrices, 0, 100.0).solve(980.0)
        roots = -rates / 2 + np.sqrt((rates**2 / 4 - squares).astype(complex))
        expected = [10j, roots[1], roots[2], roots[3], -rates[3] - roots[3]]
        self.assertEqual(len(found.values), len(expected))
        self.assertLessEqual(quadratic.match(found.values, expected)[2].max(), 1e-13)


if __name__ == "__main__":
    unittest.main()
