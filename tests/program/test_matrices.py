# SPDX-License-Identifier: GPL-3.0-or-later

"""Exported matrices: format, structure, and eigenvalues by SciPy."""

import csv
import importlib.util
import re
import subprocess
import sys
import unittest

from program import COARSE, SOURCE, ProgramTest

MATRICES = ["M", "C", "K", "C_b", "P_n", "P_t", "P_b", "K_n", "T_c"]
DISSIPATION = "Operation/Radial dissipation=consistent"

# Model with open contact nodes, radial and tangential contact damping, material damping, and friction
DAMPED = ["Steady sliding/Contact state=steady sliding", "Steady sliding/Gaps=pin_top_1: 1e-4", DISSIPATION,
          "Operation/Friction slope=-0.02", "Pin material/Rayleigh beta=1e-7", "Disc material/Rayleigh alpha=2"]


class Matrices(ProgramTest):
    scene = COARSE

    def matrices(self, *overrides, n_processes=1):
        return self.run_scene("results", "Output/Write matrices=true", *overrides, n_processes=n_processes) / "matrices"

    def test_files(self):
        folder = self.matrices()
        self.assertEqual(sorted(path.name for path in folder.iterdir()),
                         sorted([f"{name}.mtx" for name in MATRICES] + ["nodes.csv", "contact_nodes.csv"]))
        for name in MATRICES:
            with open(folder / f"{name}.mtx", encoding="utf-8") as file:
                symmetry = "symmetric" if name in ("M", "C", "K", "C_b") else "general"
                self.assertEqual(file.readline(), f"%%MatrixMarket matrix coordinate real {symmetry}\n")
                n_dofs, _, n_entries = map(int, file.readline().split())
                entries = file.read().splitlines()
            self.assertEqual(len(entries), n_entries)
            if name in ("M", "K"):
                # 17 digits reproduce every double; trailing zeros are omitted
                self.assertEqual(max(len(re.sub(r"e.*|[-.]", "", entry.split()[2]).lstrip("0")) for entry in entries), 17, name)
                n = n_dofs
        with open(folder / "nodes.csv", newline="", encoding="utf-8") as file:
            header, *rows = csv.reader(file)
        self.assertEqual(header, ["x [m]", "y [m]", "z [m]", "component", "row x", "row y", "row z"])
        self.assertEqual(sorted(int(row) for line in rows for row in line[4:] if int(row) > 0), list(range(1, n + 1)))
        self.assertEqual(len((folder / "contact_nodes.csv").read_text(encoding="utf-8").splitlines()), 1 + 4 * 7)

    @unittest.skipUnless(importlib.util.find_spec("scipy"), "needs SciPy")
    def test_eigenvalues(self):
        for name, overrides, n_processes in (("plain", [], 1), ("dissipation", [DISSIPATION], 2), ("damped", DAMPED, 1),
                                             ("rotating", ["Operation/Gyroscopic forces=true", DISSIPATION], 1),
                                             ("free", ["Mounts/Elastic mounts="], 1)):
            with self.subTest(name):
                folder = self.matrices(*overrides, n_processes=n_processes)
                self.assertEqual((folder / "G.mtx").is_file(), name == "rotating")
                n_nodes = len((folder / "contact_nodes.csv").read_text(encoding="utf-8").splitlines()) - 1
                self.assertEqual(n_nodes, 21 if name == "damped" else 28)
                script = SOURCE / "scripts" / "check_eigenvalues.py"
                check = subprocess.run([sys.executable, "-B", script, folder.parent, "--solver", "scipy"], text=True, capture_output=True,
                                       timeout=300)
                self.assertEqual(check.returncode, 0, check.stdout + check.stderr)
                self.assertEqual("stiffness is singular" in check.stdout, name == "free")
