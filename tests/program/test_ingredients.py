# SPDX-License-Identifier: GPL-3.0-or-later

"""`Study = ingredients`: effects of variants compared with separate runs, and the cheapest model."""

import math
import unittest

from program import COARSE, ProgramTest, distance, eigenvalues, read_table

RICH = ["Operation/Radial dissipation=consistent", "Operation/Friction slope=-1e-4", "Damping/Modal damping ratio=0: 1e-5",
        "Steady sliding/Contact state=steady sliding"]


def tried_eigenvalues(folder, ingredient, tried=None):
    """lambda [rad/s] of a variant from the table of modes."""
    result = []
    for row in read_table(folder / "ingredients_modes.csv"):
        if row["ingredient"] == ingredient and tried in (None, row["variant"]) and row["variant frequency [Hz]"]:
            omega = 2 * math.pi * float(row["variant frequency [Hz]"])
            result.append(complex(float(row["variant divergence rate [%]"]) / 100 * omega, omega))
    return result


class Ingredients(ProgramTest):
    scene = COARSE

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.study = cls.run_scene("study", "Study=ingredients", *RICH)
        cls.here = eigenvalues(cls.run_scene("here", *RICH))

    def rows(self, folder):
        return {(row["ingredient"], row["variant"]): row for row in read_table(folder / "ingredients.csv")}

    def test_effects_are_those_of_single_runs(self):
        study, here, modes = self.study, self.here, read_table(self.study / "ingredients_modes.csv")
        for (ingredient, tried), override in {("radial dissipation", "none"): "Operation/Radial dissipation=none",
                                              ("contact state", "equal load"): "Steady sliding/Contact state=equal load",
                                              ("rotation of the disc", "on"): "Operation/Gyroscopic forces=true",
                                              ("band", "to 2500 Hz"): "Band/Maximum frequency=2500"}.items():
            with self.subTest(ingredient):
                alone = self.run_scene("alone", *RICH, override)
                self.assert_same_eigenvalues(tried_eigenvalues(study, ingredient, tried), eigenvalues(alone), 1e-7)
                row = self.rows(study)[ingredient, tried]
                unstable = [sum(table_row["unstable [-]"] == "1" for table_row in read_table(folder / "complex_modes.csv"))
                            for folder in (self.folder / "here", alone)]
                self.assertEqual([int(row["unstable modes in reference [-]"]), int(row["unstable modes in variant [-]"])], unstable)
        # Every variant that was tried lists all modes of the reference
        for variant, row in self.rows(study).items():
            listed = [mode["reference frequency [Hz]"] for mode in modes if (mode["ingredient"], mode["variant"]) == variant]
            self.assertEqual(sum(frequency != "" for frequency in listed), 0 if row["reason not tried"] else len(here), variant)

    def test_the_cheapest_model_runs_and_keeps_its_promise(self):
        study = self.study
        text = (study / "cheapest.prm").read_text(encoding="utf-8")
        self.assertIn("# cheapest model within 1 % and 0.05 percentage points: friction slope = none, modal damping = none", text)
        self.assertNotIn("Friction slope", text.split("subsection", 1)[1])
        process = self.call(str(study / "cheapest.prm"), "--output", "cheapest")
        self.assertEqual((process.returncode, process.stderr), (0, ""))
        self.assertNotIn("unused parameters", process.stdout)
        promise = next(line for line in text.splitlines() if line.startswith("# squeal: "))
        self.assertIn(promise[1:], process.stdout)
        found, promised = eigenvalues(self.folder / "cheapest"), tried_eigenvalues(study, "together")
        self.assert_same_eigenvalues(promised, found, 1e-7)
        reference = self.here
        self.assertEqual(len(found), len(reference))
        self.assertLess(distance(found, reference), 0.01)
        together = next(row for (ingredient, _), row in self.rows(study).items() if ingredient == "together")
        self.assertLess(float(together["change of frequency [%]"]), 1)
        self.assertLess(float(together["change of divergence rate [percentage points]"]), 0.05)
        self.assertEqual(together["verdict changed [-]"], "0")

    def test_what_a_scene_cannot_have(self):
        study = self.run_scene("plain", "Study=ingredients")
        why = {ingredient: row["reason not tried"] for (ingredient, _), row in self.rows(study).items()}
        self.assertIn("equal load", why["lift-off"])
        self.assertIn("Ingredients/Trial friction slope", why["friction slope"])
        self.assertEqual(why["radial dissipation"], "")
        self.assertIn("the given model", (study / "cheapest.prm").read_text(encoding="utf-8"))
        # Rotation of a free disc is not supported in the fixed frame
        free = self.run_scene("free", "Study=ingredients", "Mounts/Elastic mounts=", "Band/Maximum frequency=2000")
        self.assertIn("rigid-body", self.rows(free)["rotation of the disc", "on"]["reason not tried"])


if __name__ == "__main__":
    unittest.main()
