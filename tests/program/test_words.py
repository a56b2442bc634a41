# SPDX-License-Identifier: GPL-3.0-or-later

"""Messages of the program about invalid values, unused parameters and results."""

import os
import pathlib
import re
import subprocess
import sys

from program import EXECUTABLE, ProgramTest, read_table, settings

# The default disc and pins on a mesh of a few thousand dofs
COARSE = ["Geometry/Nodes per pin face=7", "Geometry/Element size=0.04", "Geometry/Pin layers=2", "Geometry/Disc layers=2",
          "Output/Mode shapes=none"]


class Words(ProgramTest):

    def screen(self, *overrides, output="results"):
        process = self.call("scene.prm", "--output", output, *settings(overrides))
        self.assertEqual((process.returncode, process.stderr), (0, ""))
        return process.stdout

    def test_reference_of_parameters(self):
        """doc/parameters.md agrees with the program."""
        script = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "parameter_reference.py"
        process = subprocess.run([sys.executable, "-B", script, "--check"], capture_output=True, text=True, check=False,
                                 env={**os.environ, "SQUEAL": str(EXECUTABLE)})
        self.assertEqual((process.returncode, process.stderr), (0, ""))

    # ------------------------------------------------------------------ values

    def test_refused_values(self):
        """Messages contain name, range, unit and location of the value; tests/parameters covers all kinds of
        parameters."""
        for value, words in {"Operation/Friction coefficient=-0.1": "Operation/Friction coefficient must lie in 0 ... 10, not -0.1\n",
                             "Operation/Load per side=heavy": "must be a number >= 0 N, not `heavy`\n"}.items():
            with self.subTest(value):
                self.dry_run_refused([words, f'where:  --set "{value}"'], value)
        name = self.write("value.prm", "subsection Operation\n  set Friction coefficient = 11\nend\n")
        self.dry_run_refused(["where:  file value.prm, line 2\n"], file=name)

    # ------------------------------------------------------- unused parameters

    def test_parameters_that_change_nothing(self):
        """Unused parameters are listed once, before the computation, and have no effect."""
        in_vain = {"Operation/Load per side": "500", "Operation/Rotation speed": "7", "Steady sliding/Gaps": "pin_top_1: 1e-5",
                   "Sweep/Tolerance": "1e-5", "Reduction/POD tolerance": "1e-3", "Complex modes/Iteration tolerance": "1e-5"}
        screen = self.screen(*(f"{name}={value}" for name, value in in_vain.items()), output="in_vain")
        notes = [line for line in screen.splitlines() if "unused parameters" in line]
        self.assertEqual(len(notes), 1, screen)
        self.assertLess(screen.index("unused parameters"), screen.index("  Mesh "))
        for name in in_vain:
            self.assertIn(f"{name} (", notes[0])
        self.run_scene("plain")
        for table in ("complex_modes.csv", "real_modes.csv", "component_modes.csv"):
            self.assertEqual((self.folder / "in_vain" / table).read_bytes(), (self.folder / "plain" / table).read_bytes())

    # ----------------------------------------------------------------- results

    def test_the_answer_comes_on_one_screen(self):
        results = self.folder / "results"
        screen = self.screen()
        lines = screen.splitlines()
        self.assertLessEqual(len(lines), 40)
        rows = sorted((row for row in read_table(results / "complex_modes.csv") if float(row["growth rate [1/s]"]) > 1e-3),
                         key=lambda row: -float(row["divergence rate [%]"]))
        start = next(i for i, line in enumerate(lines) if "unstable mode " in line)
        self.assertRegex(lines[start - 2], rf"squeal: {len(rows)} unstable modes at mu = 0.4, led by {re.escape(rows[0]['label'])} at \d+ Hz")
        for row, line in zip(rows, lines[start + 1:]):
            self.assertTrue(line.strip().startswith(row["label"]), line)
            self.assertIn(f"{float(row['frequency [Hz]']):.1f}", line)
        tables = next(line for line in lines if line.startswith("  tables: "))
        self.assertEqual(sorted(tables.replace("  tables: ", "").split(", ")), sorted(path.name for path in results.glob("*.csv")))

    def test_growing_modes_of_the_disc_are_waves(self):
        """The two modes of a doublet are waves in opposite directions; the growing A0-4 travels with the rotation."""
        self.write("default.prm", "")
        for rotation in ("positive", "negative"):
            results = self.shared(*COARSE, f"Operation/Rotation={rotation}", file="default.prm")
            rows = {row["label"]: row for row in read_table(results / "complex_modes.csv")}
            for shape in ("A0-4", "A0-5"):
                growing, decaying = rows[f"{shape} +"], rows[f"{shape} -"]
                self.assertEqual((growing["unstable [-]"], decaying["unstable [-]"]), ("1", "0"))
                for one, other in (("with", "against"), ("against", "with")):
                    self.assertAlmostEqual(float(growing[f"wave {one} rotation [-]"]), float(decaying[f"wave {other} rotation [-]"]), places=5)
            self.assertGreater(float(rows["A0-4 +"]["wave with rotation [-]"]), 0.8, rotation)

    def test_growing_modes_have_one_name(self):
        """The growing mode of a doublet has the label `+` in a stability run and in a sweep."""
        self.write("default.prm", "")
        sweep = ["Study=sweep", "Sweep/First friction coefficient=0.3", "Sweep/Last friction coefficient=0.4",
                   "Sweep/Number of friction coefficients=3"]
        studies = {"stability": read_table(self.shared(*COARSE, "Operation/Rotation=positive", file="default.prm") / "complex_modes.csv"),
                   "sweep": [row for row in read_table(self.run_scene("sweep", *COARSE, *sweep, file="default.prm") / "branches.csv")
                             if float(row["mu [-]"]) == 0.4]}
        growing = {}
        for study, rows in studies.items():
            rates = {row["label"]: float(row["growth rate [1/s]"]) for row in rows if row["label"][-2:] in (" -", " +")}
            growing[study] = {label for label, rate in rates.items() if rate > 1e-3}
            for label in growing[study]:
                self.assertTrue(label.endswith("+") or rates[label] < rates[label[:-1] + "+"], f"{label} in {study}")
        self.assertTrue(growing["stability"])
        self.assertEqual(growing["stability"], growing["sweep"])
