# SPDX-License-Identifier: GPL-3.0-or-later

"""`Study = accuracy` and `Accuracy = ...` on a small model."""

import math
import unittest

from program import COARSE, ProgramTest, numbers, read_table

BAND = 2500
STUDY = ["Study=accuracy", f"Band/Maximum frequency={BAND}", "Accuracy study/Mesh factors=1, 2, 5", "Accuracy study/Outlines=true area",
         "Accuracy study/Largest number of dofs=20000",
         "Accuracy study/Elements=trilinear, incompatible modes", "Accuracy study/Bases=real + 1st-ord. two-sided"]
# Settings equivalent to `Mesh factors = 2`
TWICE = ["Geometry/Nodes per pin face=19", "Geometry/Element size=0.04", "Geometry/Pin layers=4", "Geometry/Disc layers=2",
         "Geometry/Outlines=true area"]
METHODS = ["full order", "real + 1st-ord. two-sided"]


class Accuracy(ProgramTest):
    scene = COARSE

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.results = cls.run_scene("results", *STUDY)
        cls.meshes, cls.modes, cls.orders = (read_table(cls.results / f"accuracy{name}.csv") for name in ("", "_modes", "_orders"))

    def of(self, **condition):
        names = {"element": "element", "factor": "mesh factor [-]", "method": "method"}
        return [row for row in self.modes if all(row[names[key]] == value for key, value in condition.items())]

    def test_rows(self):
        """A row for each mesh, element and method, with consistent numbers."""
        self.assertEqual([(row["mesh factor [-]"], row["element"], row["method"]) for row in self.meshes],
                         [(factor, element, method) for factor in "12" for element in ("trilinear", "incompatible modes") for method in METHODS])
        for name in ("accuracy", "accuracy_modes", "accuracy_orders"):
            self.assertTrue(all(math.isfinite(number) for number in numbers(self.results / f"{name}.csv")), name)
        for row in self.meshes:
            self.assertLess(float(row["rms frequency error [%]"]), float(row["frequency error [%]"]) * (1 + 1e-12))
        self.assertIn("yes", [row["Pareto front"] for row in self.meshes])

    def test_frequencies_are_those_of_a_run_on_that_mesh(self):
        found = self.run_scene("twice", *TWICE, f"Band/Maximum frequency={1.1 * BAND}")
        expected = [float(row["frequency [Hz]"]) for row in read_table(found / "complex_modes.csv")]
        rows = self.of(element="trilinear", factor="2", method="full order")
        self.assertGreater(len(rows), 8)
        for row in rows:
            if row["frequency [Hz]"]:
                self.assertLess(min(abs(float(row["frequency [Hz]"]) / frequency - 1) for frequency in expected), 1e-8)

    def test_kinds(self):
        """Full order has no reduction error; a basis has the same discretisation error as full order."""
        for row in self.of(method="full order"):
            if row["counterpart"] != "none":
                self.assertEqual(float(row["reduction frequency error [%]"]), 0)
                self.assertEqual(row["frequency error [%]"], row["discretisation frequency error [%]"])
        full, reduced = (self.of(method=method) for method in METHODS)
        self.assertEqual([row["discretisation frequency error [%]"] for row in full], [row["discretisation frequency error [%]"] for row in reduced])
        self.assertTrue(any(float(row["reduction frequency error [%]"] or 0) > 0 for row in reduced))

    def test_finer_meshes_and_better_elements_are_closer(self):
        rms = {(row["element"], row["mesh factor [-]"]): float(row["rms frequency error [%]"]) for row in self.meshes
               if row["method"] == "full order"}
        self.assertLess(rms["trilinear", "2"], rms["trilinear", "1"])
        self.assertLess(rms["incompatible modes", "1"], rms["trilinear", "1"])

    def test_what_is_left_out_is_said(self):
        rows = read_table(self.results / "accuracy_left_out.csv")
        self.assertEqual([(row["mesh factor [-]"], row["element"]) for row in rows], [("5", "trilinear"), ("5", "incompatible modes")])
        for row in rows:
            self.assertIn("Largest number of dofs", row["reason"])

    def test_orders(self):
        """Two meshes do not determine an order of convergence."""
        self.assertEqual({row["family"] for row in self.orders}, {"trilinear, true area", "incompatible modes, true area"})
        self.assertEqual({row["order of frequency [-]"] for row in self.orders}, {""})
        self.assertEqual(sorted({row["reference"] for row in self.orders}), ["no", "yes"])


class Goal(ProgramTest):
    """`Accuracy = 5 %` compared with quadratic elements on an independent mesh."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        band = f"Band/Maximum frequency={BAND}"
        cls.results = cls.run_scene("goal", "Accuracy=5 %", band)
        cls.modes = read_table(cls.results / "complex_modes.csv")
        fine = cls.run_scene("fine", "Discretization/Element=quadratic", "Geometry/Nodes per pin face=19", "Geometry/Pin layers=3",
                             "Geometry/Pin rings=1", "Geometry/Element size=0.03", "Geometry/Disc layers=2", f"Band/Maximum frequency={1.1 * BAND}")
        cls.reference = read_table(fine / "complex_modes.csv")

    def test_modes_called_converged_are(self):
        by_label = {row["label"]: row for row in self.reference}
        n_compared = 0
        for row in self.modes:
            if row["converged [-]"] == "1" and row["counterpart on the coarser mesh"] == "by shape" and row["label"] in by_label:
                found, exact = ([float(mode[column]) for column in ("frequency [Hz]", "divergence rate [%]")] for mode in (row, by_label[row["label"]]))
                self.assertLess(abs(found[0] / exact[0] - 1), 0.05, row["label"])
                self.assertLess(abs(found[1] - exact[1]), 0.5, row["label"])
                # Allow twice the estimate, which is not a bound: frequencies on two meshes may agree by chance
                estimated = float(row["estimated frequency error by the mesh [%]"]) / 100
                self.assertLess(abs(found[0] / exact[0] - 1), 2 * estimated + 0.005, row["label"])
                n_compared += 1
        self.assertGreater(n_compared, 5)

    def test_what_it_replaces_is_named(self):
        process = self.call("scene.prm", "--dry-run", "--set", "Accuracy=5 %", "--set", "Geometry/Element size=0.01")
        self.assertIn("Geometry/Element size (set by Accuracy = 5 %)", process.stdout)
        process = self.call(self.results / "parameters.prm", "--dry-run")
        self.assertNotIn("set by Accuracy", process.stdout)

    def test_unstable_modes_that_are_not_converged_are_named(self):
        """The summary reports unstable modes that are not converged; strong friction on a coarse mesh may cause them."""
        process = self.call_scene("strong", "Accuracy=1 %", "Operation/Friction coefficient=1.5", f"Band/Maximum frequency={BAND}")
        self.assertEqual(process.returncode, 0, process.stderr)
        rows = read_table(self.folder / "strong" / "complex_modes.csv")
        n = sum(row["unstable [-]"] == "1" and row["converged [-]"] == "0" for row in rows)
        self.assertEqual("not converged on this mesh" in process.stdout, n > 0)


class Refusals(ProgramTest):
    def test_parameters(self):
        (self.folder / "bodies.msh").write_text("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"disc\"\n$EndPhysicalNames\n",
                                                encoding="utf-8")
        for mentions, *overrides in (
                (["Accuracy study/Mesh factors", "two or more"], *STUDY, "Accuracy study/Mesh factors=1"),
                (["`cubic`", "incompatible modes"], *STUDY, "Accuracy study/Elements=cubic"),
                (["there is no basis `best`"], *STUDY, "Accuracy study/Bases=best"),
                (["bodies.msh", "cannot be changed"], *STUDY, "Geometry/File=bodies.msh"),
                (["cannot be changed"], "Accuracy=1 %", "Geometry/File=bodies.msh"),
                (["`Element size`", "NAME = VALUE", "Discretization/Coarser mesh"], "Discretization/Coarser mesh=Pin layers = 1, Element size"),
                (["`Geometry/disk_size`", "Discretization/Coarser mesh"], "Discretization/Coarser mesh=disk_size = 0.1"),
                (["extrapolation requires two solved meshes", "Largest number of dofs"], *STUDY, "Accuracy study/Largest number of dofs=10")):
            with self.subTest(mentions):
                self.assert_refused(mentions, *overrides)


if __name__ == "__main__":
    unittest.main()
