# SPDX-License-Identifier: GPL-3.0-or-later

"""Designs that share a mesh and a basis: agreement with individually solved designs, resumption after interruptions."""

import signal

from program import COARSE, ProgramTest, design_tables, read_table, settings

STUDY = ["Study=geometry", "Sweep/Number of friction coefficients=4", "Band/Maximum frequency=4000", "Operation/Radial dissipation=none"]
VARIABLES = ("Designs/Variables=Pin material/Young modulus = 1.7e9, 1.9e9; Pin material/Density = 2900; "
             "Mounts/Elastic mounts[3] = 1.6e10, 1.88e10")


class FamiliesTest(ProgramTest):
    scene = COARSE

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.study = cls.run_scene("study", *STUDY, VARIABLES)

    def test_designs_are_those_that_are_solved_alone(self):
        together = {row["design [-]"]: row for row in read_table(self.study / "designs.csv")}
        thresholds = read_table(self.study / "design_thresholds.csv")
        modes = read_table(self.study / "design_modes.csv")
        self.assertEqual(len(together), 4)
        number = "4"
        single = self.run_design("single", number)
        row, alone = together[number], read_table(single / "designs.csv")[0]
        for name in ("outcome", "modes [-]", "modes counted [-]", "complete [-]", "modes that grow [-]", "unstable modes [-]",
                     "label of largest", "label of first onset", "dofs [-]"):
            self.assertEqual(row[name], alone[name], name)
        self.assertEqual(row["complete [-]"], "1")
        self.assertLessEqual(float(row["estimated error of lambda [-]"]), 1e-6)

        mine = [t for t in thresholds if t["design [-]"] == number]
        others = read_table(single / "design_thresholds.csv")
        self.assertEqual(len(mine), len(others))
        self.assertGreater(len(mine), 0)
        for one, other in zip(mine, others):
            self.assertEqual([one[name] for name in ("event", "mechanism")], [other[name] for name in ("event", "mechanism")])
            self.assertLessEqual(abs(float(one["mu [-]"]) - float(other["mu [-]"])),
                                 float(one["uncertainty [-]"]) + float(other["uncertainty [-]"]))

        # The estimated error of each of the two solutions is at most 1e-6
        frequencies = [[float(mode["frequency at smallest mu [Hz]"]) for mode in table if mode["design [-]"] == number]
                       for table in (modes, read_table(single / "design_modes.csv"))]
        self.assertEqual(len(frequencies[0]), len(frequencies[1]))
        for one, other in zip(*frequencies):
            self.assertAlmostEqual(one, other, delta=2e-6 * other)

    def test_killed_and_resumed(self):
        self.interrupt("killed", (*STUDY, VARIABLES), ((1, signal.SIGKILL), (2, signal.SIGTERM), (3, signal.SIGKILL)))
        again = self.run_scene("killed", *STUDY, VARIABLES)
        self.assertEqual(design_tables(again), design_tables(self.study))
        self.assertFalse((self.folder / "killed.checkpoint").exists())

    def test_damped_designs(self):
        damped = ["Study=geometry", "Sweep/Number of friction coefficients=4", "Operation/Radial dissipation=consistent",
                  "Pin material/Rayleigh beta=1e-6", "Geometry/Element size=0.04"]  # all designs are unstable on this mesh
        variables = "Designs/Variables=Pin material/Rayleigh beta = 1e-6, 2e-6; Operation/Load per side = 500, 1000"
        study = self.run_scene("damped", *damped, variables)
        single = self.run_design("damped_single", "3", *damped, variables)
        row, alone = read_table(study / "designs.csv")[2], read_table(single / "designs.csv")[0]
        for name in ("outcome", "modes [-]", "complete [-]", "modes that grow [-]", "unstable modes [-]"):
            self.assertEqual(row[name], alone[name], name)
        rates = {row["largest divergence rate [%]"] for row in read_table(study / "designs.csv")}
        self.assertEqual(len(rates), 4)
        self.assertAlmostEqual(float(row["largest divergence rate [%]"]), float(alone["largest divergence rate [%]"]),
                               delta=1e-3 * float(alone["largest divergence rate [%]"]))

    def test_orthotropic_designs(self):
        """Designs that differ in a common factor of all moduli and in density."""
        moduli = ((2e9, 1.5e9, 1e9), (0.8e9, 0.4e9, 0.3e9))
        values = [", ".join(str(factor * E) for E in moduli[0]) + ", 0.25, 0.4, 0.3, " + ", ".join(str(factor * G) for G in moduli[1]) + f", {density}"
                  for factor in (1, 1.1) for density in (2900, 3070)]
        variables = "Designs/Variables=Materials/Orthotropic = " + " | ".join(f"pin_top_1: {value}" for value in values)
        study = self.run_scene("orthotropic", *STUDY, variables)
        rows = read_table(study / "designs.csv")
        self.assertEqual([row["outcome"] for row in rows], ["solved"] * 4)
        single = self.run_scene("orthotropic_single", file=str(study / "designs" / "4.prm"))
        largest = max(float(row["divergence rate [%]"]) for row in read_table(single / "branches.csv") if row["growing [-]"] == "1")
        self.assertAlmostEqual(float(rows[3]["largest divergence rate [%]"]), largest, delta=1e-3 * largest)
        self.assertEqual(len({row["largest divergence rate [%]"] for row in rows}), 4)

    def test_a_common_fault_is_told_in_every_row(self):
        study = self.run_scene("fault", *STUDY, VARIABLES, "Designs/Variables=Pin material/Young modulus = 1, 2")
        rows = read_table(study / "designs.csv")
        self.assertEqual([row["outcome"] for row in rows], ["refused"] * 2)
        self.assertNotIn("", [row["reason"] for row in rows])

    def run_design(self, output, number, *overrides):
        process = self.call("scene.prm", "--output", output, "--designs", number, *settings(overrides or (*STUDY, VARIABLES)))
        self.assertEqual(process.returncode, 0, process.stderr)
        return self.folder / output
