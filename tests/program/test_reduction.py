"""The study of reduced bases: sizes, errors, verdicts, and what it refuses."""

import math
import unittest

from program import ProgramTest, header, numbers, read_table

STUDY = "Study=reduction"
COUNTS = "Reduction/Component modes=30, 36, 20"
ERROR_COLUMNS = ["basis", "n_r0 [-]", "n_r [-]", "group", "res [-]", "mac [-]", "frq [-]", "div [-]", "div estimated [-]",
                 "div corrected [-]", "build time [s]", "solve time [s]"]
N_CONTACT = 28
DISC, PINS_FREE, PINS_SLIDING = 30, 36, 20


def by_basis(path):
    """Rows of a table with one row for each basis."""
    return {row["basis"]: row for row in read_table(path)}


class Friction(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.results = cls.run_scene("results", STUDY, COUNTS, "Operation/Radial dissipation=consistent",
                                    "Reduction/Grown tolerances=1e-4, 1e-7")
        cls.bases = by_basis(cls.results / "reduction_bases.csv")
        cls.n_real = int(cls.bases["real"]["n_r0 [-]"])

    def test_files(self):
        self.assertEqual(header(self.results / "reduction_errors.csv").split(",")[:len(ERROR_COLUMNS)], ERROR_COLUMNS)
        for name in ("reduction_errors", "reduction_bases", "reduction_estimates", "reduction_modes"):
            self.assertTrue(all(math.isfinite(number) for number in numbers(self.results / f"{name}.csv")), name)

    def test_sizes(self):
        """Tables 2, 4 and 5 of the paper: columns of T_r0 and of T_r."""
        n_c, n_r = N_CONTACT, self.n_real
        sizes = {"free": (DISC + PINS_FREE + n_c, DISC + PINS_FREE),
                 "fixed": (DISC + PINS_SLIDING + 2 * n_c, DISC + PINS_SLIDING + n_c),
                 "mixed": (DISC + PINS_SLIDING + 2 * n_c, DISC + PINS_SLIDING + n_c),
                 "free + t.a.m.": (DISC + PINS_FREE + 2 * n_c, DISC + PINS_FREE + n_c),
                 "free with r.a.m.": (DISC + PINS_FREE + n_c, DISC + PINS_FREE),
                 "fixed + t.a.m.": (DISC + PINS_SLIDING + 3 * n_c, DISC + PINS_SLIDING + 2 * n_c),
                 "mixed + t.a.m.": (DISC + PINS_SLIDING + 3 * n_c, DISC + PINS_SLIDING + 2 * n_c),
                 "real": (n_r, n_r), "real + t.a.m.": (n_r + n_c, n_r + n_c), "real + 1st-ord.": (2 * n_r, 2 * n_r),
                 "real + 1st-ord. two-sided": (3 * n_r, 3 * n_r), "real + 1st-ord. two-sided + damping": (4 * n_r, 4 * n_r)}
        for name, (n_r0, n) in sizes.items():
            with self.subTest(name):
                row = self.bases[name]
                self.assertEqual((int(row["n_r0 [-]"]), int(row["n_r by formula [-]"])), (n_r0, n))
                self.assertEqual(int(row["n_r [-]"]), n - int(row["dropped [-]"]))
                self.assertLess(float(row["orthonormality [-]"]), 1e-10)

    def test_errors(self):
        worst = {}
        for row in read_table(self.results / "reduction_errors.csv"):
            worst.setdefault(row["basis"], []).append(float(row["lambda [-]"]))
        worst = {name: max(values) for name, values in worst.items()}
        self.assertLess(worst["real + 1st-ord."], worst["real"])
        self.assertLess(10 * worst["real + 1st-ord. two-sided + damping"], worst["real + 1st-ord."])
        self.assertLess(worst["residual-grown 1e-07"], 3e-7)
        self.assertLess(worst["residual-grown 1e-07"], worst["residual-grown 0.0001"])

    def test_verdicts(self):
        """Where a basis decides it decides as the reference does, and the accurate one decides all modes that matter."""
        verdicts = set()
        for row in read_table(self.results / "reduction_modes.csv"):
            rate = float(row["reference divergence rate [%]"])
            if row["basis"] == "residual-grown 1e-07" and abs(rate) > 1e-3:
                self.assertEqual(row["verdict"], "unstable" if rate > 0 else "stable", row["label"])
                verdicts.add(row["verdict"])
        self.assertEqual(verdicts, {"unstable", "stable"})

    def test_estimates(self):
        judged = {name: row for name, row in by_basis(self.results / "reduction_estimates.csv").items() if int(row["judged [-]"]) >= 10}
        self.assertGreaterEqual(len(judged), 3)
        for name, row in judged.items():
            with self.subTest(name):
                self.assertGreaterEqual(float(row["within a factor of 3 [%]"]), 80)

    def test_repeats(self):
        again = self.run_scene("again", STUDY, "Reduction/Bases=real, real + 1st-ord.", "Operation/Radial dissipation=consistent")
        self.assertEqual(sorted(by_basis(again / "reduction_bases.csv")), ["real", "real + 1st-ord."])
        rows = {(row["basis"], row["group"]): row for row in read_table(self.results / "reduction_errors.csv")}
        for row in read_table(again / "reduction_errors.csv"):
            expected = float(rows[row["basis"], row["group"]]["div [-]"])
            self.assertAlmostEqual(float(row["div [-]"]), expected, delta=1e-6 * expected + 1e-12)


class Frictionless(ProgramTest):
    def test_study(self):
        results = self.run_scene("results", STUDY, "Reduction/Problem=frictionless",
                                 "Reduction/Component modes=28, 20, 12; 36, 36, 16; 9000")
        rows = read_table(results / "reduction_bases.csv")
        self.assertEqual([row["component modes"] for row in rows if row["basis"] == "mixed"], ["28/20/12", "36/36/16", "9000 Hz"])
        self.assertEqual({row["basis"] for row in rows} & {"free + t.a.m.", "real + 1st-ord.", "free with r.a.m."}, set())
        # More component modes, nearer frequencies; and no Ritz value below the exact one
        frequency = {}
        for row in read_table(results / "reduction_modes.csv"):
            self.assertGreater(float(row["frequency [Hz]"]), float(row["reference frequency [Hz]"]) * (1 - 1e-9))
            key = row["basis"], row["component modes"]
            frequency[key] = max(frequency.get(key, 0), float(row["eps_frq [-]"]))
        self.assertLess(frequency["free", "36/36/16"], frequency["free", "28/20/12"])


class Refusals(ProgramTest):
    def refused(self, mentions, *overrides):
        settings = [word for override in (STUDY, *overrides) for word in ("--set", override)]
        process = self.call("scene.prm", "--output", "refused", *settings)
        self.assertNotEqual(process.returncode, 0)
        self.assertEqual(process.stderr.count("error: "), 1)
        for text in mentions:
            self.assertIn(text, process.stderr)
        self.assertFalse((self.folder / "refused").exists())

    def test_parameters(self):
        self.refused(["no basis `reel`", "Reduction/Bases", "real + 1st-ord."], "Reduction/Bases=reel")
        self.refused(["leaves no modes", "Reduction/Component modes"], "Reduction/Component modes=0, 3, 3")
        self.refused(["neither a frequency nor three numbers", "Reduction/Component modes"], "Reduction/Component modes=3, 4")
        self.refused(["no truncation"], "Reduction/Component modes=")
        self.refused(["is out of reach"], "Reduction/Grown tolerances=1e-20")
        self.refused(["needs damping"], "Reduction/Bases=real + 1st-ord. two-sided + damping")
        self.refused(["belongs to the problem with friction"], "Reduction/Problem=frictionless", "Reduction/Bases=real + 1st-ord.")
        self.refused(["no snapshots", "Reduction/Snapshots"], "Reduction/Bases=POD", "Reduction/Snapshots=")

    def test_modes(self):
        self.refused(["none lies below 1 Hz", "raise the truncation frequency"], "Reduction/Bases=free", "Reduction/Component modes=1")


if __name__ == "__main__":
    unittest.main()
