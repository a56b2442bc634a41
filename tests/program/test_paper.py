# SPDX-License-Identifier: GPL-3.0-or-later

"""scripts/paper.py, the comparison with the paper, for the default model on a coarse mesh."""

import os
import subprocess
import sys

from program import EXECUTABLE, SOURCE, ProgramTest, read_table, settings

COARSE = ["Geometry/Nodes per pin face=7", "Geometry/Element size=0.04", "Geometry/Pin layers=2", "Geometry/Disc layers=2"]


class Paper(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.results = cls.folder / "paper"
        process = subprocess.run([sys.executable, "-B", SOURCE / "scripts" / "paper.py", "--results", cls.results, *settings(COARSE)], text=True,
                                 capture_output=True, check=False, env={**os.environ, "SQUEAL": EXECUTABLE})
        if process.returncode != 0:
            raise AssertionError(process.stdout + process.stderr)

    def test_every_printed_number_has_one_to_compare(self):
        """Every number of the paper up to the end of the band has a counterpart; growing modes are compared with growing modes."""
        for row in read_table(self.results / "table1.csv"):
            if row["label"][:4] in ("A0-6", "A1-3"):
                continue  # above the band on the coarse mesh
            for column in ("component", "coupled", "without C_b", "with C_b"):
                self.assertEqual(row[f"{column} paper [Hz]"] == "", row[f"{column} [Hz]"] == "", f"{row['label']}, {column}")
            for column in ("without C_b", "with C_b"):
                paper, here = row[f"divergence {column} paper [%]"], row[f"divergence {column} [%]"]
                if row["label"][:4] in ("A0-4", "A0-5") or paper and float(paper) > 0:
                    self.assertGreater(float(paper) * float(here), 0, f"{row['label']}, {column}")

    def test_statements(self):
        statements = {row["statement"]: row for row in read_table(self.results / "statements.csv")}
        self.assertEqual(statements["unstable disc modes without C_b"]["here"], "2")
        self.assertEqual(statements["bending modes F1 per pin below 5 kHz"]["verdict"], "holds")

    def test_readings(self):
        """The published coefficient lacks the factor mu = 0.4 and damps T1 about 2.5 times as much; equal load and
        steady sliding differ."""
        most = min((row for row in read_table(self.results / "dissipation.csv") if row["label"] == "T1"),
                   key=lambda row: float(row["steady sliding consistent [%]"]))
        self.assertAlmostEqual(float(most["no C_b [%]"]), 0, delta=1e-6)
        for state in ("equal load", "steady sliding"):
            self.assertAlmostEqual(float(most[f"{state} published [%]"]) / float(most[f"{state} consistent [%]"]), 2.5, delta=0.4)
        self.assertNotAlmostEqual(float(most["equal load consistent [%]"]), float(most["steady sliding consistent [%]"]), places=2)
