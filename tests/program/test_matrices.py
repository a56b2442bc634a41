"""The exported matrices: form, structure, and the eigenvalues that others find from them."""

import csv
import importlib.util
import re
import subprocess
import sys
import unittest

from program import SOURCE, ProgramTest

MATRICES = ["M", "C", "K", "C_b", "P_n", "P_t", "P_b", "T_c"]


class Matrices(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.results = {(n_processes, dissipation): cls.run_scene(f"{dissipation}_{n_processes}", "Output/Write matrices=true",
                                                                 f"Operation/Radial dissipation={dissipation}",
                                                                 n_processes=n_processes)
                       for n_processes, dissipation in ((1, "none"), (2, "consistent"))}

    def test_files(self):
        folder = self.results[1, "none"] / "matrices"
        self.assertEqual(sorted(path.name for path in folder.iterdir()),
                         sorted([f"{name}.mtx" for name in MATRICES] + ["nodes.csv", "contact_nodes.csv"]))
        for name in MATRICES:
            with open(folder / f"{name}.mtx", encoding="utf-8") as file:
                symmetry = "symmetric" if name in ("M", "C", "K", "C_b") else "general"
                self.assertEqual(file.readline(), f"%%MatrixMarket matrix coordinate real {symmetry}\n")
                n_entries = int(file.readline().split()[2])
                entries = file.read().splitlines()
            self.assertEqual(len(entries), n_entries)
            # 17 digits give back every double; shorter numbers end in zeros.
            digits = [len(re.sub(r"e.*|[-.]", "", entry.split()[2]).lstrip("0")) for entry in entries]
            if name in ("M", "K"):
                self.assertEqual(max(digits), 17, name)

    def test_nodes(self):
        folder = self.results[1, "none"] / "matrices"
        with open(folder / "nodes.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
        self.assertEqual(rows[0], ["x [m]", "y [m]", "z [m]", "component", "row x", "row y", "row z"])
        with open(folder / "M.mtx", encoding="utf-8") as file:
            n_dofs = int(file.read().splitlines()[1].split()[0])
        numbered = sorted(int(row) for line in rows[1:] for row in line[4:] if int(row) > 0)
        self.assertEqual(numbered, list(range(1, n_dofs + 1)))
        with open(folder / "contact_nodes.csv", encoding="utf-8") as file:
            self.assertEqual(len(file.read().splitlines()), 1 + 4 * 7)

    @unittest.skipUnless(importlib.util.find_spec("scipy"), "needs SciPy")
    def test_gyroscopic_forces(self):
        results = self.run_scene("rotating", "Output/Write matrices=true", "Operation/Gyroscopic forces=true",
                                 "Operation/Radial dissipation=consistent")
        self.assertTrue((results / "matrices" / "G.mtx").is_file())
        check = subprocess.run([sys.executable, "-B", SOURCE / "scripts" / "check_eigenvalues.py", results, "--solver", "scipy"],
                               text=True, capture_output=True, check=False)
        self.assertEqual(check.returncode, 0, check.stdout + check.stderr)

    @unittest.skipUnless(importlib.util.find_spec("scipy"), "needs SciPy")
    def test_every_damping(self):
        """Open contact nodes, damping of the contact along both directions and of the materials, with friction's part in it."""
        results = self.run_scene("damped", "Output/Write matrices=true", "Steady sliding/Contact state=steady sliding",
                                 "Steady sliding/Gaps=pin_top_1: 1e-4", "Operation/Radial dissipation=consistent",
                                 "Operation/Friction slope=-0.02", "Pin material/Rayleigh beta=1e-7", "Disc material/Rayleigh alpha=2")
        with open(results / "matrices" / "contact_nodes.csv", encoding="utf-8") as file:
            self.assertEqual(len(file.read().splitlines()), 1 + 3 * 7)
        check = subprocess.run([sys.executable, "-B", SOURCE / "scripts" / "check_eigenvalues.py", results, "--solver", "scipy"],
                               text=True, capture_output=True, timeout=300)
        self.assertEqual(check.returncode, 0, check.stdout + check.stderr)

    @unittest.skipUnless(importlib.util.find_spec("scipy"), "needs SciPy")
    def test_eigenvalues(self):
        for (n_processes, dissipation), results in self.results.items():
            with self.subTest(n_processes=n_processes, dissipation=dissipation):
                check = subprocess.run([sys.executable, "-B", SOURCE / "scripts" / "check_eigenvalues.py", results, "--solver", "scipy"],
                                       text=True, capture_output=True, timeout=300)
                self.assertEqual(check.returncode, 0, check.stdout + check.stderr)
                self.assertNotIn("should vanish", check.stdout)
                for name in ("P_n P_n^T - 2 I", "P_n T_c", "M - M^T", "K - K^T"):
                    self.assertIn(name, check.stdout)
