# SPDX-License-Identifier: GPL-3.0-or-later

"""Study of reduced bases: sizes, errors, verdicts, and rejected parameters."""

import math
import unittest

from program import ProgramTest, numbers, read_table

STUDY = "Study=reduction"
COUNTS = "Reduction/Component modes=30, 36, 20"
N_CONTACT = 28
DISC, PINS_FREE, PINS_SLIDING = 30, 36, 20


def by_basis(path):
    """Rows of a table by the name of the basis."""
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
        for name in ("reduction_errors", "reduction_bases", "reduction_costs", "reduction_truncations", "reduction_estimates",
                     "reduction_modes"):
            self.assertTrue(all(math.isfinite(number) for number in numbers(self.results / f"{name}.csv")), name)

    def test_sizes(self):
        """Sizes agree with Tables 2, 4 and 5 of the paper: columns of T_r0 and of T_r."""
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

    def test_charges(self):
        """The build time of a basis includes its sets. Modes are computed up to the group that contains the last required mode."""
        costs = {row["set"]: row for row in read_table(self.results / "reduction_costs.csv")}
        for name, wanted in (("free modes of the disc", DISC), ("free modes of the pins", PINS_FREE),
                             ("sliding modes of the pins", PINS_SLIDING), ("real coupled modes", self.n_real)):
            row = costs[name]
            self.assertEqual(int(row["vectors [-]"]), wanted, name)
            # Multiplicities: four for modes of the pins, eight for their bending modes, two for modes of the disc
            self.assertTrue(wanted <= int(row["modes in the band [-]"]) < wanted + (8 if "pins" in name else 2), name)
        self.assertEqual(int(costs["coupled tangential attachment modes"]["vectors [-]"]), N_CONTACT)

        for name, sets in (("free", ("free modes of the disc", "free modes of the pins", "factor of K", "normal attachment modes")),
                           ("real + t.a.m.", ("real coupled modes", "factor of K_c", "coupled tangential attachment modes"))):
            build, seconds = float(self.bases[name]["build time [s]"]), sum(float(costs[each]["time [s]"]) for each in sets)
            self.assertGreater(build, seconds * (1 - 1e-9), name)
            self.assertLess(build, seconds + 5, name)

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
        """An accurate basis gives the verdict of the reference for all modes with an absolute rate above 0.001 %."""
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


class CoupledFrequencies(ProgramTest):
    def test_sets_of_real_modes(self):
        results = self.run_scene("results", STUDY, "Reduction/Bases=real, real + 1st-ord., residual-grown", "Reduction/Grown tolerances=1e-4",
                                 "Reduction/Coupled frequency=0, 9000")
        bases = by_basis(results / "reduction_bases.csv")
        self.assertEqual(list(bases), ["real", "real + 1st-ord.", "real (9000 Hz)", "real + 1st-ord. (9000 Hz)", "residual-grown 0.0001"])
        self.assertGreater(int(bases["real (9000 Hz)"]["n_r0 [-]"]), int(bases["real"]["n_r0 [-]"]))
        costs = [row for row in read_table(results / "reduction_costs.csv") if row["set"] == "real coupled modes"]
        self.assertEqual([(row["variant"], int(row["vectors [-]"])) for row in costs],
                         [("", int(bases["real"]["n_r0 [-]"])), ("9000 Hz", int(bases["real (9000 Hz)"]["n_r0 [-]"]))])
        self.assertFalse((results / "reduction_truncations.csv").exists())


class Frictionless(ProgramTest):
    def test_study(self):
        results = self.run_scene("results", STUDY, "Reduction/Problem=frictionless",
                                 "Reduction/Component modes=28, 20, 12; 36, 36, 16; 9000")
        rows = read_table(results / "reduction_bases.csv")
        self.assertEqual([row["component modes"] for row in rows if row["basis"] == "mixed"], ["28/20/12", "36/36/16", "9000 Hz"])
        truncations = [tuple(row.values()) for row in read_table(results / "reduction_truncations.csv")]
        self.assertEqual(truncations[:2], [("28/20/12", "28", "20", "12"), ("36/36/16", "36", "36", "16")])
        # More component modes reduce the error, because Ritz values are upper bounds
        frequency = {}
        for row in read_table(results / "reduction_modes.csv"):
            self.assertGreater(float(row["frequency [Hz]"]), float(row["reference frequency [Hz]"]) * (1 - 1e-9))
            key = row["basis"], row["component modes"]
            frequency[key] = max(frequency.get(key, 0), float(row["eps_frq [-]"]))
        self.assertLess(frequency["free", "36/36/16"], frequency["free", "28/20/12"])


class Refusals(ProgramTest):
    def test_parameters(self):
        for mentions, *overrides in (
                (["no basis `reel`", "Reduction/Bases", "real + 1st-ord."], "Reduction/Bases=reel"),
                (["has no modes", "Reduction/Component modes"], "Reduction/Component modes=0, 3, 3"),
                (["is not between 1e-11 and 0.1"], "Reduction/Grown tolerances=1e-20"),
                (["needs damping"], "Reduction/Bases=real + 1st-ord. two-sided + damping"),
                (["requires friction"], "Reduction/Problem=frictionless", "Reduction/Bases=real + 1st-ord."),
                (["given twice", "Reduction/Coupled frequency"], "Reduction/Coupled frequency=0, 9000, 9000"),
                (["no snapshots", "Reduction/Snapshots"], "Reduction/Bases=POD", "Reduction/Snapshots=")):
            with self.subTest(mentions):
                self.assert_refused(mentions, STUDY, *overrides)

    def test_modes(self):
        for mentions, modes in ((["Hz is less than 90000", "lower the number of modes"], "90000, 3, 3"),
                                (["for reduced bases below 1 Hz", "raise the truncation frequency"], "1")):
            process = self.call_scene("refused", STUDY, "Reduction/Bases=free", f"Reduction/Component modes={modes}")
            self.assertEqual(process.returncode, 1)
            for text in mentions:
                self.assertIn(text, process.stderr)
            self.assertFalse((self.folder / "refused").exists())


if __name__ == "__main__":
    unittest.main()
