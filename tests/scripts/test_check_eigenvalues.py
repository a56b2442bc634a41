"""Tests of scripts/check_eigenvalues.py on a small run whose eigenvalues come from a dense solver."""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import two_blocks

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "check_eigenvalues.py"


def check(directory, *arguments):
    return subprocess.run([sys.executable, SCRIPT, directory, "--solver", "scipy", *arguments],
                          capture_output=True, text=True, check=False)


class CheckEigenvalues(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.original = pathlib.Path(cls.temporary.name) / "original"
        two_blocks.write_run(cls.original)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def setUp(self):
        self.run_directory = pathlib.Path(self.temporary.name) / "run"
        shutil.copytree(self.original, self.run_directory)
        self.addCleanup(shutil.rmtree, self.run_directory)

    def edit(self, name, change):
        path = self.run_directory / name
        path.write_text(change(path.read_text(encoding="utf-8")), encoding="utf-8")

    def test_accepts_the_dense_solution(self):
        result = check(self.run_directory)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertRegex(result.stdout, r"SciPy: \d\d modes")

    def test_finds_unstable_modes(self):
        growth_rates = [float(value) for value in re.findall(r"^mode \d+ +\S+ +(\S+)", check(self.run_directory).stdout, re.MULTILINE)]
        self.assertGreater(max(growth_rates), 1.0)

    def test_refuses_a_wrong_eigenvalue(self):
        def shift(text):
            lines = text.splitlines()
            cells = lines[3].split(",")
            cells[2] = repr(float(cells[2]) * (1 + 1e-6))
            lines[3] = ",".join(cells)
            return "\n".join(lines) + "\n"

        self.edit("complex_modes.csv", shift)
        result = check(self.run_directory)
        self.assertEqual(result.returncode, 1)
        self.assertIn("too much", result.stdout)
        self.assertEqual(check(self.run_directory, "--tolerance", "1e-5").returncode, 0)

    def test_allows_for_the_errors_that_the_table_estimates(self):
        def add_estimates(text, error):
            lines = text.splitlines()
            cells = lines[3].split(",")
            cells[2] = repr(float(cells[2]) * (1 + 1e-6))
            lines[3] = ",".join(cells)
            return "\n".join([lines[0] + ",estimated error of lambda [-]"] + [f"{line},{error}" for line in lines[1:]]) + "\n"

        original = (self.run_directory / "complex_modes.csv").read_text(encoding="utf-8")
        for error, status in {"5e-7": 0, "1e-7": 1, "1e-12": 1}.items():
            with self.subTest(error):
                self.edit("complex_modes.csv", lambda _, error=error: add_estimates(original, error))
                result = check(self.run_directory)
                self.assertEqual(result.returncode, status, result.stdout)
                if error == "5e-7":
                    self.assertIn("tolerance 1.5e-06, 3 times the largest error", result.stdout)

    def test_chooses_a_shift_where_a_body_is_free(self):
        free = pathlib.Path(self.temporary.name) / "free"
        two_blocks.write_run(free, is_free=True)
        self.addCleanup(shutil.rmtree, free)
        result = check(free)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn("can move freely", result.stdout)
        self.assertNotIn("can move freely", check(self.run_directory).stdout)

    def test_refuses_a_table_that_misses_a_mode(self):
        self.edit("complex_modes.csv", lambda text: "".join(text.splitlines(keepends=True)[:-1]))
        result = check(self.run_directory)
        self.assertEqual(result.returncode, 1)
        self.assertIn("counts differ", result.stdout)
        self.assertIn("missing", result.stdout)

    def test_refuses_the_other_friction_coefficient(self):
        self.assertEqual(check(self.run_directory, "--mu", "0.3").returncode, 1)

    def test_refuses_contact_matrices_that_do_not_belong_together(self):
        shutil.copy(self.run_directory / "matrices" / "P_t.mtx", self.run_directory / "matrices" / "P_n.mtx")
        result = check(self.run_directory)
        self.assertEqual(result.returncode, 1)
        self.assertIn("should vanish", result.stdout)

    def test_names_a_missing_file(self):
        (self.run_directory / "matrices" / "K.mtx").unlink()
        result = check(self.run_directory)
        self.assertEqual(result.returncode, 1)
        self.assertIn("K.mtx is missing", result.stderr)


if __name__ == "__main__":
    unittest.main()
