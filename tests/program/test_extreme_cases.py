"""A representative part of the cases of doc/extremes.md, judged as there, and the table of that page."""

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
    from extremes import judge, oracle, page
    from extremes.cases import CASES
    import scipy.sparse as sparse
except ImportError:
    raise unittest.SkipTest("NumPy and SciPy are missing") from None


class Cases(unittest.TestCase):
    def test_are_right_or_refused(self):
        for case in CASES:
            if case.quick:
                with self.subTest(case.name), tempfile.TemporaryDirectory() as folder:
                    row = judge.judge(case, pathlib.Path(folder))
                    self.assertTrue(row.is_as_expected, page.line(row))


class Page(unittest.TestCase):
    def test_has_cases_of_the_list_and_none_that_is_wrong(self):
        cases = {(case.group, case.value): case for case in CASES}
        self.assertEqual(len(cases), len(CASES))
        rows = page.cases_of_page()
        names = [tuple(row[:2]) for row in rows]
        self.assertEqual(names, list(cases))
        self.assertGreaterEqual(len(CASES), 100)
        for row in rows:
            self.assertEqual(row[2], "right" if cases[tuple(row[:2])].expected == "right" else "refused", row)


class Oracle(unittest.TestCase):
    """Known eigenvalues: a chain of oscillators whose friction makes a pair flutter, and dampers that overdamp."""

    @staticmethod
    def matrices(squares, rates):
        n = len(squares)
        none = sparse.csr_matrix((0, n))
        diagonal = sparse.diags(squares).tocsr()
        return {"M": sparse.identity(n, format="csr"), "K": diagonal, "C": sparse.diags(rates).tocsr(), "G": 0 * diagonal, "C_b": 0 * diagonal,
                "P_n": none, "P_t": none, "P_b": none, "T_c": sparse.identity(n, format="csr")}

    def test_finds_known_eigenvalues(self):
        squares, rates = np.array([1e2, 1e4, 1e4 * (1 + 1e-9), 4e4, 1e9]), np.array([0.0, 1.0, 1.0, 1e3, 1e6])
        found = oracle.Oracle(self.matrices(squares, rates), 0, 100.0).solve(980.0)
        roots = -rates / 2 + np.sqrt((rates**2 / 4 - squares).astype(complex))
        expected = [10j, roots[1], roots[2], roots[3], -rates[3] - roots[3]]
        self.assertEqual(len(found.values), len(expected))
        self.assertLessEqual(oracle.match(found.values, expected), 1e-13)

    def test_sees_what_differs(self):
        with self.assertRaises(judge.Wrong):
            judge.compare("modes", [1j, 2j], [1j], 3.0, 3.0)
        with self.assertRaises(judge.Wrong):
            judge.compare("modes", [1j, -2 + 0j], [1j, 2j], 3.0, 3.0)
        self.assertGreater(judge.compare("modes", [1j, 2j], [1j, 2.001j], 3.0, 3.0), 1e-4)


if __name__ == "__main__":
    unittest.main()
