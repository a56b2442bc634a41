# SPDX-License-Identifier: GPL-3.0-or-later

"""Searches for quiet designs: budget, report, agreement with single runs and full order, resumption."""

import re
import signal
import unittest

from program import COARSE, ProgramTest, eigenvalues, read_table, settings

VARIABLES = "Designs/Variables=Geometry/Pin height = 0.029 to 0.035; Pin material/Young modulus = 1.5e9 to 2.5e9"
SEARCH = ["Study=search", VARIABLES, "Search/Samples=3", "Search/Evaluations=6", "Sweep/Number of friction coefficients=4", "Band/Maximum frequency=4000"]
RATE, BEST = "largest divergence rate [%]", "best largest divergence rate [%]"


class SearchTest(ProgramTest):
    scene = COARSE

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.search = cls.run_scene("search", *SEARCH)

    def test_it_keeps_its_budget_and_its_best(self):
        rows = read_table(self.search / "search.csv")
        self.assertEqual([int(row["design [-]"]) for row in rows], list(range(1, len(rows) + 1)))
        self.assertEqual([row["phase"] for row in rows[:3]], ["sample"] * 3)
        self.assertLessEqual(len(rows), 6)
        self.assertGreater(len(rows), 4)
        smallest = float("inf")
        for row in rows:
            smallest = min(smallest, float(row[RATE]))
            self.assertEqual(float(row[BEST]), smallest)
            self.assertTrue(0.029 <= float(row["Geometry/Pin height"]) <= 0.035)
            self.assertTrue(1.5e9 <= float(row["Pin material/Young modulus"]) <= 2.5e9)
        designs = {row["design [-]"]: row for row in read_table(self.search / "designs.csv")}
        for row in rows:
            self.assertAlmostEqual(float(row[RATE]), float(designs[row["design [-]"]][RATE] or 0), places=9)

    def test_the_best_design_is_that_of_a_sweep_and_at_full_order(self):
        best = min(float(row[RATE]) for row in read_table(self.search / "search.csv"))
        sweep = self.run_scene("best", file=str(self.search / "best.prm"))
        found = max(float(row["divergence rate [%]"]) for row in read_table(sweep / "branches.csv"))
        self.assertAlmostEqual(found, best, delta=1e-3 * best)
        rows = read_table(self.search / "full_order.csv")
        # The last row is the solution at the friction coefficient with the largest rate
        self.assertAlmostEqual(float(rows[-1]["divergence rate [%]"]), best, delta=1e-3 * best)
        for row in rows:
            self.assertLess(float(row["residual [-]"]), 1e-8)
        friction = f"Operation/Friction coefficient={rows[-1]['mu [-]']}"
        values = eigenvalues(self.run_scene("single", "Study=stability", friction, file=str(self.search / "best.prm")))
        self.assertEqual(len(values), int(rows[-1]["modes [-]"]))
        self.assertAlmostEqual(100 * max(value.real / value.imag for value in values), float(rows[-1]["divergence rate [%]"]), places=6)

    def test_another_goal_and_method(self):
        folder = self.run_scene("other", *SEARCH, "Search/Evaluations=5", "Search/Goal=onset", "Search/Method=COBYLA")
        rows = read_table(folder / "search.csv")
        self.assertTrue(3 < len(rows) <= 5)
        self.assertEqual(float(rows[-1]["best mu of 0.01 % [-]"]), max(float(row["mu of 0.01 % [-]"]) for row in rows))

    def test_killed_and_resumed(self):
        self.interrupt("killed", SEARCH, ((2, signal.SIGKILL), (4, signal.SIGTERM)))
        n_known = len(self.stored("killed"))
        process = self.call("scene.prm", "--output", "killed", *settings(SEARCH))
        self.assertEqual(process.returncode, 0, process.stderr)
        # The resumption is reported once, not in every repeated round
        self.assertEqual(re.findall("continuing an .*", process.stdout), [f"continuing an interrupted search: {n_known} designs are finished"])
        resumed = self.folder / "killed"
        self.assertEqual(read_table(resumed / "search.csv"), read_table(self.search / "search.csv"))
        self.assertFalse((self.folder / "killed.checkpoint").exists())

    def test_what_is_refused(self):
        """Invalid settings; tests/parameters covers invalid variables."""
        for overrides, what in ((["Designs/Variables=Geometry/Pin height = 0.03, 0.04"], "a search requires ranges"),
                                ([VARIABLES, "Search/Samples=20", "Search/Evaluations=10"], "samples, 20"),
                                ([VARIABLES, "Search/Smallest step=0.2"], "larger than the first")):
            with self.subTest(what):
                self.assert_message(self.call("scene.prm", "--output", "none", *settings(["Study=search", *overrides])), [what])
                self.assertFalse((self.folder / "none").exists())

    def test_designs_that_cannot_be_meshed_are_walls(self):
        """If part of the range cannot be meshed, the search continues and ends at a valid design."""
        folder = self.run_scene("walls", "Study=search", "Designs/Variables=Geometry/Pin diameter = 0.05 to 0.09", "Search/Samples=3",
                                "Search/Evaluations=6", "Sweep/Number of friction coefficients=4", "Band/Maximum frequency=4000")
        rows = read_table(folder / "designs.csv")
        self.assertIn("refused", {row["outcome"] for row in rows})
        solved = [row for row in rows if row["outcome"] == "solved"]
        self.assertGreater(len(solved), 0)
        best = min(float(row[RATE] or 0) for row in solved)
        self.assertEqual(float(read_table(folder / "search.csv")[-1][BEST]), best)


if __name__ == "__main__":
    unittest.main()
