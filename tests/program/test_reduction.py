"""The study of reduced bases: sizes, errors, verdicts, and what it refuses."""

import json
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
        for name in ("reduction_errors", "reduction_bases", "reduction_costs", "reduction_truncations", "reduction_estimates",
                     "reduction_modes"):
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

    def test_charges(self):
        """A basis is charged for what it rests on; modes for one solution that holds no more than the wanted ones."""
        costs = {row["set"]: row for row in read_table(self.results / "reduction_costs.csv")}
        for name, wanted in (("free modes of the disc", DISC), ("sliding modes of the disc", DISC), ("free modes of the pins", PINS_FREE),
                             ("sliding modes of the pins", PINS_SLIDING), ("real coupled modes", self.n_real)):
            with self.subTest(name):
                row = costs[name]
                self.assertEqual(int(row["vectors [-]"]), wanted)
                # Modes of the pins come in fours, bending modes in eights, those of the disc in pairs
                self.assertGreaterEqual(int(row["modes in the band [-]"]), wanted)
                self.assertLess(int(row["modes in the band [-]"]), wanted + (8 if "pins" in name else 2))
                self.assertGreater(float(row["end of the band [Hz]"]), 0)
        self.assertEqual(int(costs["coupled tangential attachment modes"]["vectors [-]"]), N_CONTACT)

        seconds = {name: float(row["time [s]"]) for name, row in costs.items()}
        rests_on = {"free": ("free modes of the disc", "free modes of the pins", "factor of K", "normal attachment modes"),
                    "real": ("real coupled modes", "factor of K_c"),
                    "real + t.a.m.": ("real coupled modes", "factor of K_c", "coupled tangential attachment modes")}
        for name, sets in rests_on.items():
            build = float(self.bases[name]["build time [s]"])
            self.assertGreater(build, sum(seconds[each] for each in sets) * (1 - 1e-9), name)
            self.assertLess(build, sum(seconds[each] for each in sets) + 5, name)

    def test_gain_in_size(self):
        """G_n = n / n_r with the dofs of the whole structure, before it is coupled."""
        n = {float(row["G_n [-]"]) * int(row["n_r [-]"]) for row in self.bases.values()}
        counts = json.loads((self.results / "run.json").read_text(encoding="utf-8"))["counts"]
        for value in n:
            self.assertAlmostEqual(value, counts["dofs"], delta=1e-6 * value)

    def test_groups(self):
        modes = [row for row in read_table(self.results / "reduction_modes.csv") if row["basis"] == "real"]
        for row in modes:
            is_disc = float(row["share of the disc [-]"]) >= 0.5
            rate = float(row["reference divergence rate [%]"])
            expected = "disc" if is_disc else "unstable pins" if rate > 0.01 else "weakly unstable pins" if rate > 1e-6 else "other pins"
            self.assertEqual(row["group"], expected, row["label"])

    def test_joined_groups(self):
        rows = {(row["basis"], row["group"]): row for row in read_table(self.results / "reduction_errors.csv")}
        joined = [key for key in rows if key[1] == "disc and unstable pins"]
        self.assertTrue(joined)
        for basis, group in joined:
            for column in ("res [-]", "div [-]", "mac by eq. 17 [-]"):
                parts = [float(rows[basis, part][column]) for part in ("disc", "unstable pins")]
                self.assertEqual(float(rows[basis, group][column]), max(parts))

    def test_criterion_of_the_paper(self):
        """Eq. (17) takes the largest MAC-M, so that its error is never the larger one; one-to-one no mode serves twice."""
        served = {}
        for row in read_table(self.results / "reduction_modes.csv"):
            self.assertLessEqual(float(row["eps_mac by eq. 17 [-]"]), float(row["eps_mac [-]"]) + 1e-12)
            if row["reduced mode [-]"] == row["reduced mode by eq. 17 [-]"]:
                self.assertEqual(row["eps_div by eq. 17 [-]"], row["eps_div [-]"])
            served.setdefault(row["basis"], []).append(row["reduced mode [-]"])
        for basis, numbers_of_modes in served.items():
            self.assertEqual(len(set(numbers_of_modes)), len(numbers_of_modes), basis)

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
        self.assertEqual({row["basis"] for row in rows} & {"free + t.a.m.", "real + 1st-ord.", "free with r.a.m."}, set())
        truncations = read_table(results / "reduction_truncations.csv")
        self.assertEqual(list(truncations[0]), ["component modes", "disc [-]", "pins free [-]", "pins sliding [-]"])
        self.assertEqual([tuple(row.values()) for row in truncations[:2]], [("28/20/12", "28", "20", "12"), ("36/36/16", "36", "36", "16")])
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
        self.refused(["no frequency up to which", "Reduction/Coupled frequency"], "Reduction/Coupled frequency=")
        self.refused(["given twice", "Reduction/Coupled frequency"], "Reduction/Coupled frequency=0, 9000, 9000")
        self.refused(["no snapshots", "Reduction/Snapshots"], "Reduction/Bases=POD", "Reduction/Snapshots=")

    def test_modes(self):
        self.refused(["fewer than 90000 lie below", "lower the number of modes"], "Reduction/Bases=free",
                     "Reduction/Component modes=90000, 3, 3")
        self.refused(["none lies below 1 Hz", "raise the truncation frequency"], "Reduction/Bases=free", "Reduction/Component modes=1")


if __name__ == "__main__":
    unittest.main()
