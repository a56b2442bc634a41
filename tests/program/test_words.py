"""What the program says: of wrong values and files, of parameters that a run does not use, and of its results."""

import os
import pathlib
import re
import subprocess
import sys

from program import EXECUTABLE, ProgramTest, read_table

# The default disc and pins on a mesh of some thousand dofs
COARSE = ["Geometry/Nodes per pin face=7", "Geometry/Element size=0.04", "Geometry/Pin layers=2", "Geometry/Disc layers=2",
          "Output/Mode shapes=none"]


class Words(ProgramTest):
    def write(self, name, content):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        self.addCleanup(path.unlink)
        return name

    def message(self, *arguments):
        """The one error of a call that fails."""
        process = self.call(*arguments)
        self.assertEqual(process.returncode, 1, process.stdout + process.stderr)
        self.assertEqual(process.stderr.count("error: "), 1)
        return process.stderr

    def screen(self, *overrides, output="results"):
        settings = [word for override in overrides for word in ("--set", override)]
        process = self.call("scene.prm", "--output", output, *settings)
        self.assertEqual((process.returncode, process.stderr), (0, ""))
        return process.stdout

    def test_reference_of_parameters(self):
        """doc/parameters.md is what the program says."""
        script = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "parameter_reference.py"
        process = subprocess.run([sys.executable, "-B", script, "--check"], capture_output=True, text=True, check=False,
                                 env={**os.environ, "SQUEAL": str(EXECUTABLE)})
        self.assertEqual((process.returncode, process.stderr), (0, ""))

    # ------------------------------------------------------------------ values

    def test_refused_values(self):
        """Name, range, unit, and where the value stands."""
        for value, words in {"Operation/Friction coefficient=-0.1": "Operation/Friction coefficient must lie in 0 ... 10, not -0.1\n",
                             "Operation/Load per side=heavy": "must be a number >= 0 N, not `heavy`\n",
                             "Geometry/Pin layers=1.5": "must be an integer >= 1, not 1.5\n",
                             "Output/Write matrices=perhaps": "must be true or false, not `perhaps`\n",
                             "Operation/Rotation=left": "must be one of positive, negative, not `left`\n",
                             "Geometry/Top pin angles=0, x": "Geometry/Top pin angles, value 2, must be a number in degree, not `x`\n"}.items():
            with self.subTest(value):
                message = self.message("scene.prm", "--set", value)
                self.assertIn(words, message)
                self.assertIn(f'where:  --set "{value}"', message)
                self.assertNotIn("pattern", message)
        name = self.write("value.prm", "subsection Operation\n  set Friction coefficient = 11\nend\n")
        self.assertIn("where:  file value.prm, line 2\n", self.message(name))

    def test_values_are_shown_as_they_are(self):
        self.assertIn("the density is 0 kg/m^3", self.message("scene.prm", "--set", "Disc material/Density=0"))
        process = self.call("scene.prm", "--print-parameters", "--set", "Operation/Friction coefficient=-0")
        self.assertRegex(process.stdout, r"set Friction coefficient += 0\n")
        self.assertIn("mu = 0,", self.screen("Operation/Friction coefficient=-0").replace("\n", ","))

    def test_long_values_are_cut(self):
        name = self.write("long.prm", "set Study = " + 100000 * "x")
        message = self.message(name)
        self.assertLess(len(message), 500)
        self.assertIn("(100000 characters)", message)

    def test_printed_parameters_say_what_they_accept(self):
        text = re.sub(r"\s*\n\s*#? *", " ", self.call("--print-parameters").stdout)
        self.assertIn("Coulomb's coefficient mu. Units: none. Accepts a number in 0 ... 10. set Friction coefficient", text)
        self.assertIn("Accepts one of stability, reduction, sweep, sensitivity, accuracy, ingredients, geometry, search. set Study", text)

    # ------------------------------------------------------------------- files

    def test_includes(self):
        self.write("outer.prm", "include inner.prm\nset Study = stability\n")
        self.write("inner.prm", "subsection Operation\n  set Friction coeff = 0.3\nend\n")
        message = self.message("outer.prm")
        self.assertIn("`Operation/Friction coeff`", message)
        self.assertIn("inner.prm, line 2", message)

    def test_files_that_include_themselves(self):
        self.write("a.prm", "include b.prm\n")
        self.write("b.prm", "\ninclude a.prm\n")
        message = self.message("a.prm")
        self.assertIn("a parameter file includes itself: a.prm -> b.prm -> a.prm", message)
        self.assertIn("b.prm, line 2", message)

    def test_files_that_are_no_text(self):
        text = "set Study = sweep\n"
        self.assertIn("dry run", self.call(self.write("mark.prm", b"\xef\xbb\xbf" + text.encode()), "--dry-run").stdout)
        self.assertIn("encoded as UTF-16", self.message(self.write("wide.prm", text.encode("utf-16"))))
        self.assertIn("zero byte", self.message(self.write("zero.prm", text.encode() + b"\0")))
        self.assertIn("is a directory", self.message("."))

    # ------------------------------------------------------- parameters in vain

    def test_parameters_that_change_nothing(self):
        """They are named once, before the work, and indeed change nothing."""
        in_vain = {"Operation/Load per side": "500", "Operation/Rotation speed": "7", "Steady sliding/Gaps": "pin_top_1: 1e-5",
                   "Sweep/Tolerance": "1e-5", "Reduction/POD tolerance": "1e-3", "Complex modes/Iteration tolerance": "1e-5"}
        screen = self.screen(*(f"{name}={value}" for name, value in in_vain.items()), output="in_vain")
        notes = [line for line in screen.splitlines() if "not used here" in line]
        self.assertEqual(len(notes), 1, screen)
        self.assertLess(screen.index("not used here"), screen.index("  Mesh "))
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
        """The two of a pair travel opposite ways, and that with regard to the sense in which the disc turns."""
        self.write("default.prm", "")
        for rotation in ("positive", "negative"):
            results = self.run_scene("waves", *COARSE, f"Operation/Rotation={rotation}", file="default.prm")
            rows = {row["label"]: row for row in read_table(results / "complex_modes.csv")}
            for shape in ("A0-4", "A0-5"):
                growing, decaying = rows[f"{shape} +"], rows[f"{shape} -"]
                self.assertEqual((growing["unstable [-]"], decaying["unstable [-]"]), ("1", "0"))
                for one, other in (("with", "against"), ("against", "with")):
                    self.assertAlmostEqual(float(growing[f"wave {one} rotation [-]"]), float(decaying[f"wave {other} rotation [-]"]), places=5)
            self.assertGreater(float(rows["A0-4 +"]["wave with rotation [-]"]), 0.8, rotation)

    def test_growing_modes_have_one_name(self):
        """Of a doublet the one that grows is `+` in every study."""
        self.write("default.prm", "")
        sweep = ["Study=sweep", "Sweep/First friction coefficient=0.3", "Sweep/Last friction coefficient=0.4",
                   "Sweep/Number of friction coefficients=3"]
        studies = {"stability": read_table(self.run_scene("names", *COARSE, file="default.prm") / "complex_modes.csv"),
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
