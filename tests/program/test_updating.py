# SPDX-License-Identifier: GPL-3.0-or-later

"""Fits to synthetic measured modes: true parameter values are recovered, undetermined parameters are reported."""

import collections
import csv
import math
import unittest

import numpy as np

from program import COARSE, ProgramTest, read_table
from squeal.vtu_file import VtuFile
import test_systems  # as a module, because importing its classes would run their tests again

BENDING = 3000.  # frequency of the bending modes of the pins [Hz]
FOUND = 1e-6  # largest relative error of a recovered parameter


def csv_text(rows, columns=("state", "label", "frequency [Hz]")):
    return "\n".join(",".join(map(str, row)) for row in (columns, *rows)) + "\n"


def unique_modes(results, state):
    """(state, label, frequency) and row of each mode with a unique label. Bending modes of the pins mix with disc modes
    and change their labels: only modes at lower frequencies are used."""
    rows = [row for row in read_table(results / f"{'real' if state == 'coupled' else state}_modes.csv")
            if (row.get("component"), row.get("contact")) in ((None, None), ("disc", "free"), ("pins", "sliding"))]
    number = collections.Counter(row["label"] for row in rows)
    return [((state, row["label"], row["frequency [Hz]"]), row) for row in rows
            if number[row["label"]] == 1 and row["label"] not in ("unnamed", "RB") and float(row["frequency [Hz]"]) < BENDING]


class OfScene(ProgramTest):
    scene = COARSE

    def measure(self, states, *truth):
        """Modes of the model with the true values of the fitted parameters."""
        results = self.shared(*truth)
        return [mode for state in states for mode in unique_modes(results, state)]

    def fit(self, variables, *overrides, output="results"):
        return self.run_scene(output, "Study=updating", "Updating/Measured modes=modes.csv", f"Designs/Variables={variables}", *overrides)

    def assert_found(self, results, values):
        rows = {row["parameter"]: row for row in read_table(results / "updated_parameters.csv")}
        self.assertEqual(set(rows), set(values))
        for name, value in values.items():
            self.assertEqual(rows[name]["status"], "determined", name)
            self.assertAlmostEqual(float(rows[name]["value"]) / value, 1., delta=FOUND, msg=name)

    def test_materials_and_mount(self):
        values = {"Pin material/Young modulus": 2.09e9, "Pin material/Density": 2800., "Mounts/Elastic mounts[3]": 1.7e10}
        truth = ("Pin material/Young modulus=2.09e9", "Pin material/Density=2800", "Mounts/Elastic mounts=disc_bore: 0, 7.8e10, 1.7e10")
        modes = self.measure(("component", "coupled"), *truth)
        bending = [float(row["frequency [Hz]"]) for row in read_table(self.shared(*truth) / "component_modes.csv")
                   if (row["contact"], row["label"]) == ("sliding", "F1")]
        modes.append((("component", "F1", repr(sum(bending) / len(bending))), None))
        self.write("modes.csv", csv_text(mode for mode, _ in modes))
        results = self.fit("Pin material/Young modulus = 1.5e9 to 2.5e9; Pin material/Density = 2500 to 3500; Mounts/Elastic mounts[3] = 1e10 to 3e10")
        self.assert_found(results, values)
        fit = read_table(results / "fit.csv")
        self.assertEqual(len(fit), len(modes))
        self.assertLess(max(abs(float(row["residual after the fit [-]"])) for row in fit), 1e-6)
        self.assertGreater(max(abs(float(row["residual at start [-]"])) for row in fit), 1.)
        # A run of the written parameter file reproduces the measured modes
        again = self.run_scene("again", file=str(results / "updated.prm"))
        found = {label: float(frequency) for (_, label, frequency), _ in unique_modes(again, "coupled")}
        for (state, label, frequency), _ in modes:
            if state == "coupled":
                self.assertAlmostEqual(found[label] / float(frequency), 1., delta=FOUND)

    def test_matrices_and_meshes(self):
        values = {"Disc material/Poisson ratio": 0.27, "Geometry/Pin height": 0.033, "Geometry/Disc thickness": 0.045}
        modes = self.measure(("component", "coupled"), *(f"{name}={value}" for name, value in values.items()))
        self.write("modes.csv", csv_text(mode for mode, _ in modes))
        results = self.fit("Disc material/Poisson ratio = 0.2 to 0.4; Geometry/Pin height = 0.03 to 0.035; Geometry/Disc thickness = 0.04 to 0.05")
        self.assert_found(results, values)

    def test_damping(self):
        values = {"Disc material/Rayleigh beta": 2e-7, "Operation/Friction coefficient": 0.3}
        truth = [f"{name}={value}" for name, value in values.items()]
        rows = []
        for (state, label, frequency), row in self.measure(("complex",), *truth):
            growth, omega = float(row["growth rate [1/s]"]), 2 * math.pi * float(frequency)
            rows.append((state, label, frequency, 1., -100 * growth / math.hypot(growth, omega), 0.01))
        columns = ("state", "label", "frequency [Hz]", "deviation [Hz]", "damping ratio [%]", "damping deviation [%]")
        self.write("modes.csv", csv_text(rows, columns))
        results = self.fit("Disc material/Rayleigh beta = 1e-8 to 1e-6; Operation/Friction coefficient = 0.1 to 0.35",
                           "Disc material/Rayleigh beta=1e-7", "Operation/Friction coefficient=0.28")
        self.assert_found(results, values)
        self.assertEqual(sum(row["quantity"] == "damping ratio" for row in read_table(results / "fit.csv")), len(rows))

    def test_shapes_at_sensors(self):
        """Modes without labels are identified by their shapes at fourteen sensors; wrong shapes are rejected."""
        value = 2800.
        truth = self.run_scene("truth", f"Pin material/Density={value}", "Output/Real mode shapes=true", "Output/Mode shapes=all")
        random = np.random.default_rng(1)
        columns, rows = {}, []
        for state, kind, parts in (("coupled", "real", ("displacement",)), ("complex", "complex", ("displacement_real", "displacement_imag"))):
            table = [row for row in read_table(truth / f"{kind}_modes.csv") if float(row["frequency [Hz]"]) < BENDING]
            for number, row in enumerate(table, start=1):
                path, = [path for path in (truth / "modes").glob(f"{kind}_{number:03d}_*.vtu") if not path.stem.endswith("_contact")]
                fields = VtuFile(path)
                if not columns:
                    rim = np.flatnonzero(np.hypot(*np.array(fields.points).T[:2]) > 0.27)
                    chosen = random.choice(rim, 14, replace=False)
                    directions = random.standard_normal((len(chosen), 3))
                    directions /= np.linalg.norm(directions, axis=1)[:, None]
                    for axis in range(3):
                        columns[f"{'xyz'[axis]} [m]"] = np.array(fields.points)[chosen, axis]
                        columns[f"direction {'xyz'[axis]}"] = directions[:, axis]
                for part, ending in zip(parts, ("", " imaginary")):
                    columns[f"{state} {number}{ending}"] = -3. * np.sum(fields.field(part)[chosen] * directions, axis=1)
                rows.append((state, f"{state} {number}", row["frequency [Hz]"]))
        self.write("modes.csv", csv_text(rows))
        sensors = csv_text(zip(*columns.values()), columns)
        self.write("sensors.csv", sensors)
        results = self.fit("Pin material/Density = 2500 to 3500", "Updating/Sensors=sensors.csv", "Updating/Least MAC=0.6")
        self.assert_found(results, {"Pin material/Density": value})
        self.assertGreater(min(float(row["MAC [-]"]) for row in read_table(results / "fit.csv")), 0.999)
        fit = ["Study=updating", "Updating/Measured modes=modes.csv", "Updating/Sensors=sensors.csv", "Updating/Least MAC=0.9",
               "Designs/Variables=Pin material/Density = 2500 to 3500"]
        wrong = {**columns, "coupled 3": random.standard_normal(14)}
        for content, words in ((csv_text(zip(*wrong.values()), wrong), ["coupled 3", "MAC", "Updating/Least MAC"]),
                               (sensors.replace("z [m]", "z"), ["`z [m]`", "line 1"]),
                               (csv_text([*zip(*columns.values()), [float("direction" not in name) for name in columns]], columns),
                                ["direction", "line 16"]),
                               (sensors.replace("complex 2,", "complex 2 real,"), ["complex 2 imaginary"])):
            self.write("sensors.csv", content)
            self.assert_refused(words, *fit)

    def test_parameters_that_act_alike(self):
        modes = [mode for mode, _ in self.measure(("component",)) if mode[1][0] in "ARC"]
        results = self.shared()
        pins = {}
        for row in read_table(results / "component_modes.csv"):
            if (row["component"], row["contact"]) == ("pins", "sliding"):
                pins.setdefault(row["label"], []).append(float(row["frequency [Hz]"]))
        # Frequencies of clamped pins determine only the ratio of modulus to density
        rows = [("component", label, 1.01 * sum(found) / len(found)) for label, found in pins.items()]
        self.write("modes.csv", csv_text([*rows, *modes]))
        process = self.call_scene("alike", "Study=updating", "Updating/Measured modes=modes.csv",
                                  "Designs/Variables=Pin material/Young modulus = 1e9 to 3e9; Pin material/Density = 2000 to 4000; "
                                  "Mounts/Elastic mounts[3] = 1e10 to 3e10")
        self.assertEqual(process.returncode, 0, process.stderr)
        status = {row["parameter"]: row["status"] for row in read_table(self.folder / "alike" / "updated_parameters.csv")}
        self.assertEqual(status, {"Pin material/Young modulus": "not determined", "Pin material/Density": "not determined",
                                  "Mounts/Elastic mounts[3]": "determined"})
        warning = next(line for line in process.stdout.splitlines() if "do not determine" in line)
        self.assertIn("Pin material/Young modulus, Pin material/Density", warning)
        self.assertNotIn("Mounts", warning)

    def test_limits(self):
        modes = self.measure(("coupled",), "Pin material/Density=2800")
        self.write("modes.csv", csv_text(mode for mode, _ in modes))
        row, = read_table(self.fit("Pin material/Density = 2900 to 3500") / "updated_parameters.csv")
        self.assertEqual((row["status"], float(row["value"]), row["standard deviation"]), ("at lower limit", 2900., ""))

    def test_refusals_of_files(self):
        variables = "Designs/Variables=Pin material/Density = 2500 to 3500"
        good = ("coupled", "A0-4 -", 2200)
        for content, words in ((csv_text([good[:2]], ("state", "label")), ["frequency [Hz]", "line 1"]),
                               (csv_text([(*good, 1)], ("state", "label", "frequency [Hz]", "colour")), ["`colour`"]),
                               (csv_text([("coupled", "A0-4 -", "nan")]), ["`nan`", "line 2"]),
                               (csv_text([("coupled", "A0-4 -", -3)]), ["-3", "line 2"]),
                               (csv_text([("coupled", "A0-4 -", "\"2200,5\"")]), ["`2200,5`", "2200.5"]),
                               (csv_text([("coupled", "A0-4 -", "2200,5")]), ["4 values"]),
                               (csv_text([("joined", "A0-4 -", 2200)]), ["`joined`", "coupled"]),
                               (csv_text([("coupled", "", 2200)]), ["label"]),
                               (csv_text([(*good, "second")], ("state", "label", "frequency [Hz]", "member")), ["`second`"]),
                               (csv_text([(*good, 1, 0.1, 1)], ("state", "label", "frequency [Hz]", "deviation [Hz]", "damping ratio [%]",
                                                                "damping deviation [%]")), ["damping", "complex"]),
                               (csv_text([(*good, 1), (*good, "")], ("state", "label", "frequency [Hz]", "deviation [Hz]")), ["deviation", "line 3"]),
                               (csv_text([]), ["no measured mode"])):
            with self.subTest(words):
                self.write("modes.csv", content)
                self.assert_refused(words, "Study=updating", "Updating/Measured modes=modes.csv", variables)
        self.assert_refused(["Updating/Measured modes"], "Study=updating", variables)

    def test_refusals_of_parameters(self):
        self.write("modes.csv", csv_text([("coupled", "A0-4 -", 2200)]))
        for variables, words in (("Pin material/Density = 3500 to 4500", ["3070", "outside"]),
                                 ("Pin material/Density = 2500, 3500", ["range"]),
                                 ("Pin material/Density = 2500 to 3500 in 3", ["range"]),
                                 ("Mounts/Elastic mounts = 1 to 2", ["number"]),
                                 ("Discretization/Coarser mesh = 1 to 2", ["Coarser mesh"]),
                                 ("Geometry/Element size = 0.06 to 0.08", ["Element size", "derivatives"])):
            with self.subTest(variables):
                self.assert_refused(words, "Study=updating", "Updating/Measured modes=modes.csv", f"Designs/Variables={variables}")
        self.write("modes.csv", csv_text([("coupled", "A9-9 -", 2200)]))
        self.assert_refused(["A9-9 -", "line 2", "A0-4"], "Study=updating", "Updating/Measured modes=modes.csv",
                            "Designs/Variables=Pin material/Density = 2500 to 3500")

    def test_it_says_where_it_has_not_converged(self):
        modes = self.measure(("coupled",), "Pin material/Density=2800")
        self.write("modes.csv", csv_text(mode for mode, _ in modes))
        self.assert_refused(["not converged", "Updating/Iterations"], "Study=updating", "Updating/Measured modes=modes.csv",
                            "Designs/Variables=Pin material/Density = 2500 to 3500", "Updating/Iterations=1")


class OfSystem(test_systems.SystemTest):
    """System of two masses with stiffnesses a and b and damping c."""

    A, B = [[2., -1.], [-1., 2.]], [[1., 0.], [0., 3.]]

    def setUp(self):
        self.write_system({"a": (90., 50., 150.), "b": (20., 5., 40.), "c": (0.02, 0.001, 0.1)},
                          [(2, "1", [[1., 0.], [0., 1.]], "symmetric"), (0, "a", self.A, "symmetric"), (0, "b", self.B, "symmetric"),
                           (1, "c", [[1., 0.], [0., 2.]], "symmetric")])

    def write_modes(self, rows, columns):
        with open(self.folder / self.write("modes.csv", ""), "w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([columns, *rows])

    def fit(self, variables):
        results = self.study("updating", "Updating/Measured modes=modes.csv", f"Designs/Variables={variables}", band=10.)
        return {row["parameter"]: row for row in self.rows(results, "updated_parameters")}

    def test_stiffnesses_and_damping(self):
        found = self.lambdas(self.study("stability", "System values=a = 100, b = 10, c = 0.05", band=10.))
        self.write_modes([("complex", f"mode {j + 1}", value.imag / (2. * math.pi), 0.01, -100. * value.real / abs(value), 0.01)
                          for j, value in enumerate(found)],
                         ("state", "label", "frequency [Hz]", "deviation [Hz]", "damping ratio [%]", "damping deviation [%]"))
        rows = self.fit("a = 50 to 150; b = 5 to 40; c = 0.001 to 0.1")
        for name, value in (("a", 100.), ("b", 10.), ("c", 0.05)):
            self.assertAlmostEqual(rows[name]["value"] / value, 1., delta=FOUND, msg=name)
            self.assertEqual(rows[name]["status"], "determined")

    def test_standard_deviation_is_that_of_the_closed_form(self):
        # For one frequency f = sqrt(k / m) / 2 pi with deviation s, the deviation of k is 2 k s / f
        self.write_system({"k": (90., 50., 150.)}, [(2, "1", [[1.]], "symmetric"), (0, "k", [[1.]], "symmetric")])
        frequency = math.sqrt(100.) / (2. * math.pi)
        self.write_modes([("coupled", "mode 1", frequency, 0.01)], ("state", "label", "frequency [Hz]", "deviation [Hz]"))
        row = self.fit("k = 50 to 150")["k"]
        self.assertAlmostEqual(row["value"], 100., delta=1e-4)
        self.assertAlmostEqual(row["standard deviation"], 2. * 100. * 0.01 / frequency, delta=1e-6)

    def test_product_of_parameters(self):
        self.write_system({"k": (8., 5., 15.), "q": (9., 5., 15.)}, [(2, "1", [[1.]], "symmetric"), (0, "k*q", [[1.]], "symmetric")],
                          **{"measured modes": "../modes.csv"})
        self.write_modes([("coupled", "mode 1", math.sqrt(100.) / (2. * math.pi))], ("state", "label", "frequency [Hz]"))
        results = self.study("updating", "Designs/Variables=k = 5 to 15; q = 5 to 15", band=10.)
        rows = {row["parameter"]: row for row in self.rows(results, "updated_parameters")}
        self.assertAlmostEqual(rows["k"]["value"] * rows["q"]["value"], 100., delta=1e-4)
        self.assertEqual({row["status"] for row in rows.values()}, {"not determined"})

    def test_refusals(self):
        self.write_modes([("coupled", "mode 1", 1.)], ("state", "label", "frequency [Hz]"))
        self.write("study.prm", test_systems.STUDY.format(study="updating", band=10.))
        for variables, words in (("d = 1 to 2", "d"), ("a = 10 to 150", "a"), ("a = 100 to 150", "a = 90")):
            self.assert_message(self.call("study.prm", "--output", "refused", "--set", "Updating/Measured modes=modes.csv", "--set",
                                          f"Designs/Variables={variables}"), [words])
        self.write_modes([("component", "mode 1", 1.)], ("state", "label", "frequency [Hz]"))
        self.assert_message(self.call("study.prm", "--output", "refused", "--set", "Updating/Measured modes=modes.csv", "--set",
                                      "Designs/Variables=a = 50 to 150"), ["component"])
        self.assertFalse((self.folder / "refused").exists())


if __name__ == "__main__":
    unittest.main()
