# SPDX-License-Identifier: GPL-3.0-or-later

"""scripts/check_eigenvalues.py on a small run with eigenvalues from a dense solver."""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import two_blocks

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))
import squeal
from squeal import exported_matrices

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "check_eigenvalues.py"


def check(directory, *arguments):
    return subprocess.run([sys.executable, SCRIPT, directory, "--solver", "scipy", *arguments],
                          capture_output=True, text=True, check=False)


class CheckEigenvalues(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        two_blocks.write_run(cls.folder / "original")

    def setUp(self):
        self.run_directory = self.folder / "run"
        shutil.copytree(self.folder / "original", self.run_directory)
        self.addCleanup(shutil.rmtree, self.run_directory)

    def assert_status(self, status, words, *arguments):
        result = check(self.run_directory, *arguments)
        self.assertEqual(result.returncode, status, result.stdout + result.stderr)
        self.assertRegex(result.stdout + result.stderr, words)

    def change_a_mode(self, error=None):
        """Multiplies one frequency by 1 + 1e-6; `error`: estimated error to be written for all modes."""
        header, *lines = (self.folder / "original" / "complex_modes.csv").read_text(encoding="utf-8").splitlines()
        cells = lines[2].split(",")
        lines[2] = ",".join([*cells[:2], repr(float(cells[2]) * (1 + 1e-6)), *cells[3:]])
        if error:
            header, lines = header + ",estimated error of lambda [-]", [f"{line},{error}" for line in lines]
        (self.run_directory / "complex_modes.csv").write_text("\n".join([header, *lines]) + "\n", encoding="utf-8")

    def test_accepts_the_dense_solution(self):
        self.assert_status(0, r"SciPy: \d\d modes")
        growth_rates = [float(value) for value in re.findall(r"^mode \d+ +\S+ +(\S+)", check(self.run_directory).stdout, re.MULTILINE)]
        self.assertGreater(max(growth_rates), 0.5)

    def test_system(self):
        """The stiffness (0.5 + part) K agrees with the table only if the command line sets part = 0.5."""
        problem = exported_matrices.couple(exported_matrices.read_matrices(self.run_directory), two_blocks.FRICTION_COEFFICIENT)
        shutil.rmtree(self.run_directory / "matrices")
        system = squeal.System({"part": squeal.Parameter(0.3, 0, 1)}, [
            squeal.Term("M", 2, matrix=problem.mass), squeal.Term("C", 1, matrix=problem.damping),
            squeal.Term("K", 0, "0.5 + part", problem.stiffness)])
        system.write(self.run_directory / "system")
        arguments = ("--system", str(self.run_directory / "system"), "--parameter")
        self.assert_status(0, r"SciPy: \d\d modes", *arguments, "part=0.5")
        self.assert_status(1, "too large", *arguments, "part=0.4")
        self.assert_status(1, "no parameter `parts`", *arguments, "parts=0.4")

    def test_refuses_a_wrong_eigenvalue(self):
        self.change_a_mode()
        self.assert_status(1, "too large")
        self.assert_status(0, "largest relative difference 1.0e-06", "--tolerance", "1e-5")

    def test_allows_for_the_errors_that_the_table_estimates(self):
        self.change_a_mode("5e-7")
        self.assert_status(0, "tolerance 1.5e-06, 3 times the largest error")
        self.change_a_mode("1e-7")
        self.assert_status(1, "too large")

    def test_refuses_a_table_that_misses_a_mode(self):
        table = self.run_directory / "complex_modes.csv"
        table.write_text("".join(table.read_text(encoding="utf-8").splitlines(keepends=True)[:-1]), encoding="utf-8")
        self.assert_status(1, r"\nmissing(.|\n)*the counts differ")

    def test_refuses_what_does_not_belong_together(self):
        self.assert_status(1, "too large", "--mu", "0.3")
        shutil.copy(self.run_directory / "matrices" / "P_t.mtx", self.run_directory / "matrices" / "P_n.mtx")
        self.assert_status(1, "should vanish")
        (self.run_directory / "matrices" / "K.mtx").unlink()
        self.assert_status(1, "K.mtx is missing")


if __name__ == "__main__":
    unittest.main()
