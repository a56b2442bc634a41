# SPDX-License-Identifier: GPL-3.0-or-later

"""Samples of uncertain parameters, compared with closed forms and with runs at full order."""

import json
import math
import signal
import unittest

from program import ProgramTest, read_table, settings
from squeal.plotting import draw
from squeal.reporting import content
from squeal.results import Results
import squeal
import test_systems  # as a module, because importing its classes would run their tests again
from test_systems import FLUTTER, flutter_terms

BOX = ("Operation/Friction coefficient = uniform 0.1 to 0.6; Pin material/Young modulus = normal 100 %, 5 % for each pin; "
       "Disc material/Young modulus = uniform 95 % to 105 %; Mounts/Elastic mounts[2] = lognormal 7.8e10, 1e10")


def quantile(values, part, n):
    """Quantile of n values, given the smallest of them; None if the quantile exceeds the given values."""
    place = part * (n - 1)
    number = int(place)
    values = sorted(values)
    if number + 1 >= len(values):
        return None
    return values[number] + (place - number) * (values[number + 1] - values[number])


class OfSystem(test_systems.SystemTest):
    """Samples of a system that is unstable for mu kappa > c, with mu uniform in (0, 1) and kappa in (0.5, 2)."""

    def setUp(self):
        self.write_system({"mu": (0.6, 0., 1.), "kappa": (1., 0.5, 2.)}, flutter_terms())

    def solve(self, *overrides):
        return self.study("robustness", "Robustness/Distributions=mu = uniform 0 to 1; kappa = uniform 0.5 to 2", *overrides)

    def test_probability_is_the_integral(self):
        results = self.solve("Robustness/Number of samples=1000", "Robustness/Frequency bands=0, 1, 2")
        c = test_systems.Flutter.MU_C
        exact = (2. - c - c * math.log(2. / c)) / 1.5
        bands = self.rows(results, "probabilities")
        self.assertLess(bands[0]["lower confidence limit [%]"], 100. * exact)
        self.assertGreater(bands[0]["upper confidence limit [%]"], 100. * exact)
        self.assertEqual([(row["from [Hz]"], row["to [Hz]"]) for row in bands], [(0., 3.), (0., 1.), (1., 2.)])
        samples = self.rows(results, "samples")
        self.assertEqual(len(samples), 500 * 4)
        for row in samples:
            self.assertEqual(row["unstable modes [-]"], 1. if row["mu"] * row["kappa"] > c else 0.)
            k11, k22, k12, k_c = FLUTTER
            discriminant = ((k11 - k22) / 2.) ** 2 + k12 * (k12 + row["mu"] * row["kappa"] * k_c)
            if discriminant < 0.:
                growth = complex(-(k11 + k22) / 2., math.sqrt(-discriminant)) ** 0.5
                self.assertAlmostEqual(row["growth rate [1/s]"], abs(growth.real), delta=1e-9)
        worst = max(samples, key=lambda row: row["divergence rate [%]"] or 0.)
        self.assertTrue((results / "worst" / f"{int(worst['sample [-]'])}.prm").exists())
        indices = [row for row in self.rows(results, "sobol_indices") if row["quantity"] == "largest divergence rate"]
        self.assertEqual([row["uncertain parameter"] for row in indices], ["mu", "kappa"])
        self.assertTrue(all(row["total index [-]"] > row["first-order index [-]"] - 0.1 for row in indices))
        self.assertEqual(list(draw.figures(Results(results))), ["robustness"])

    def test_onsets_are_those_of_the_closed_form(self):
        """Growth begins at mu kappa = c, whether the sweep varies mu or kappa."""
        c = test_systems.Flutter.MU_C
        for other, uncertain, swept in (("kappa", "kappa = uniform 0.5 to 2", "mu, 0, 1, 11"), ("mu", "mu = uniform 0.1 to 1", "kappa, 0.5, 2, 11")):
            name, first, last = swept.split(", ")[0], float(swept.split(", ")[1]), float(swept.split(", ")[2])
            results = self.study("robustness", f"Robustness/Distributions={uncertain}", "Robustness/Number of samples=40",
                                 "Robustness/Samples with onsets=30", f"Sweep/Parameter={swept}", "Sweep/Threshold tolerance=1e-10")
            numbers = [row[other] for row in self.rows(results, "samples")]
            onsets = self.rows(results, "sample_onsets")
            self.assertEqual(len(onsets), 30)
            expected = []
            for number, row in zip(numbers, onsets):
                if c / number >= last:
                    self.assertEqual((row[f"{name} of growth [-]"], row[f"{name} of 0.01 % [-]"]), ("", ""))
                    continue
                expected.append(max(first, c / number))
                self.assertAlmostEqual(row[f"{name} of growth [-]"], expected[-1], delta=1e-8)
                if c / number > first:
                    self.assertLess(row[f"uncertainty of {name} of growth [-]"], 1e-6)
                    root = next(square ** 0.5 for square in test_systems.flutter_squares(row[f"{name} of 0.01 % [-]"] * number) if square.imag != 0.)
                    self.assertAlmostEqual(abs(root.real / root.imag), 1e-4, delta=1e-7)
            self.assertTrue(0 < len(expected) < 30)
            all_modes = self.rows(results, "onset_distributions")[0]
            self.assertEqual((all_modes["label"], all_modes["samples [-]"]), ("all modes", 30.))
            self.assertAlmostEqual(all_modes["samples with an onset [%]"], 100. * len(expected) / 30., delta=1e-8)
            self.assertAlmostEqual(all_modes["mean of the onsets [-]"], sum(expected) / len(expected), delta=1e-7)
            for percent in (5, 25, 50, 75, 95):
                found, exact = all_modes[f"{name} of {percent} % of all samples [-]"], quantile(expected, percent / 100., 30)
                if exact is None:
                    self.assertEqual(found, "")
                else:
                    self.assertAlmostEqual(found, exact, delta=1e-7)
        self.assert_message(self.call("study.prm", "--output", "refused", *settings(
            ["Robustness/Distributions=mu = uniform 0 to 1", "Robustness/Samples with onsets=10", "Sweep/Parameter=nu, 0, 1, 11"])), ["nu"])

    def test_lists_of_values(self):
        results = self.study("geometry", "Designs/Variables=mu = 0.2, 0.5, 0.8; kappa = 0.5 to 2 in 4", "Band/Maximum rate=10")
        samples = self.rows(results, "samples")
        self.assertEqual([(row["mu"], row["kappa"]) for row in samples], [(mu, kappa) for mu in (0.2, 0.5, 0.8) for kappa in (0.5, 1., 1.5, 2.)])
        for row in samples:
            self.assertEqual(row["unstable modes [-]"], 1. if row["mu"] * row["kappa"] > test_systems.Flutter.MU_C else 0.)
        self.assertEqual(len(self.rows(results, "sample_modes")), 24)
        for override, words in (("Variables=nu = 0.2, 0.5", "nu"), ("Variables=mu = 0.2, 5", "mu"), ("Variables=mu = a, b", "mu")):
            self.assert_message(self.call("study.prm", "--output", "refused", "--set", f"Designs/{override}"), [words])

    def test_refusals(self):
        self.write("study.prm", "set System = system\nset Study = robustness\nsubsection Robustness\n"
                                "  set Distributions = mu = uniform 0 to 1\nend\n")
        for override, words in (("Distributions=nu = uniform 0 to 1", "nu"), ("Distributions=mu = uniform 0 to 3", "mu"),
                                ("Distributions=mu = uniform 0 to 1 for each pin", "for each pin"),
                                ("Distributions=mu = exponential 1", "exponential"), ("Correlations=mu, nu = 0.3", "nu"),
                                ("Samples with onsets=5000", "5000")):
            self.assert_message(self.call("study.prm", "--output", "refused", "--set", f"Robustness/{override}"), [words])
            self.assertFalse((self.folder / "refused").exists())


class SearchOfSystem(test_systems.SystemTest):
    """System that is unstable for mu kappa g > c, with mu uniform in (0, 1) and g = 0.8 + 4 (x - 0.3)^2."""

    SEARCH = ("Robustness/Number of samples=300", "Search/Samples=5", "Search/Evaluations=30")

    def setUp(self):
        mass, stiffness, (power, _, matrix, symmetry) = flutter_terms()
        self.write_system({"mu": (0.6, 0., 1.), "x": (0., 0., 1.), "kappa": (1., 0.5, 2.)},
                          [mass, stiffness, (power, "mu*kappa*(0.8 + 4*(x - 0.3)^2)", matrix, symmetry)])

    def test_the_best_design_is_that_of_the_closed_form(self):
        c = test_systems.Flutter.MU_C
        for goal, column in (("quantile", "divergence rate at 90 % of the samples [%]"), ("probability", "probability of squeal or doubt [%]")):
            results = self.study("search", "Robustness/Distributions=mu = uniform 0 to 1", "Designs/Variables=x = 0 to 1",
                                 f"Search/Goal={goal}", "Search/Quantile=0.9", *self.SEARCH)
            rows = self.rows(results, "search")
            self.assertLessEqual(len(rows), 30)
            for row in rows:
                exact = 100. * max(0., 1. - c / (0.8 + 4. * (row["x"] - 0.3) ** 2))
                self.assertLessEqual(row["lower confidence limit [%]"] - 1., exact)
                self.assertGreaterEqual(row["upper confidence limit [%]"] + 1., exact)
                self.assertEqual(row["probability of squeal or doubt [%]"], row["probability of squeal [%]"] + row["undecided samples [%]"])
            best = min(rows, key=lambda row: row[column])
            self.assertEqual(rows[-1][f"best {column}"], best[column])
            # The probability estimated from 300 samples is piecewise constant
            self.assertAlmostEqual(best["x"], 0.3, delta=0.01 if goal == "quantile" else 0.05)

            said = content.content(Results(results))
            self.assertIn(f"number {int(best['design [-]'])} is the best", json.dumps(said, ensure_ascii=False))

            # A robustness study of best.prm has the same samples
            again = self.run_scene("again", "Robustness/Sobol indices=false", file=str(results / "best.prm"))
            squeal = self.rows(again, "probabilities")[0]
            self.assertEqual(squeal["probability of squeal [%]"], best["probability of squeal [%]"])
            rates = [row["divergence rate [%]"] or 0. for row in self.rows(again, "samples")]
            self.assertAlmostEqual(best["divergence rate at 90 % of the samples [%]"], quantile(rates, 0.9, 300), delta=1e-6)
            # Seed 2 gives other samples; the worst of them is also solved at full order
            checked = self.rows(results, "best_design")
            self.assertEqual([row["seed [-]"] for row in checked], [1., 2.])
            self.assertEqual(checked[0][column], best[column])
            others = self.run_scene("others", "Robustness/Sobol indices=false", "Robustness/Seed=2", file=str(results / "best.prm"))
            self.assertEqual(checked[1]["probability of squeal [%]"], self.rows(others, "probabilities")[0]["probability of squeal [%]"])
            worst = max(row["divergence rate [%]"] or 0. for row in self.rows(others, "samples"))
            self.assertAlmostEqual(self.rows(results, "full_order")[0]["divergence rate [%]"], worst, delta=1e-6)

    def test_numbers_in_percent_follow_the_design(self):
        """P(mu kappa r g > c) = 1 - c/(g kappa) E(1/r), with r uniform in (0.9, 1.1), increases with kappa."""
        c = test_systems.Flutter.MU_C
        results = self.study("search", "Robustness/Distributions=mu = uniform 0 to 1; kappa = uniform 90 % to 110 %", "Designs/Variables=kappa = 0.9 to 1.8",
                             "Search/Goal=probability", *self.SEARCH)
        rows = self.rows(results, "search")
        for row in rows:
            exact = 100. * (1. - c / (1.16 * row["kappa"]) * math.log(1.1 / 0.9) / 0.2)
            self.assertLessEqual(row["lower confidence limit [%]"] - 1., exact)
            self.assertGreaterEqual(row["upper confidence limit [%]"] + 1., exact)
        self.assertAlmostEqual(min(rows, key=lambda row: row["probability of squeal [%]"])["kappa"], 0.9, delta=0.01)

    def test_refusals(self):
        self.write("study.prm", "set System = system\nset Study = search\n")
        good = {"Robustness/Distributions": "mu = uniform 0 to 1", "Designs/Variables": "x = 0 to 1", "Search/Goal": "quantile"}
        for path, value, words in (("Designs/Variables", "x = 0, 1", "ranges"), ("Designs/Variables", "y = 0 to 1", "y"),
                                   ("Designs/Variables", "mu = 0.1 to 0.2", "mu"), ("Search/Goal", "onset", "onset"),
                                   ("Robustness/Distributions", "", "uncertain"), ("Search/Samples", "50", "50")):
            given = [f"{name}={text}" for name, text in {**good, path: value}.items()]
            self.assert_message(self.call("study.prm", "--output", "refused", *settings(given)), [words])
            self.assertFalse((self.folder / "refused").exists())


class OfScene(ProgramTest):
    def test_killed_and_resumed(self):
        study = ("Study=robustness", "Robustness/Number of samples=700", "Robustness/Sobol indices=false", f"Robustness/Distributions={BOX}")
        whole = read_table(self.run_scene("whole", *study) / "samples.csv")
        self.interrupt("killed", study, ((1, signal.SIGKILL), (2, signal.SIGTERM)), "samples")
        self.assert_message(self.call("scene.prm", "--output", "killed", *settings((*study, "Robustness/Seed=2"))), ["an unfinished study with other parameters"])
        process = self.call("scene.prm", "--output", "killed", *settings(study))
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertIn("of 700 samples are finished", process.stdout)
        self.assertFalse((self.folder / "killed.checkpoint").exists())
        again = read_table(self.folder / "killed" / "samples.csv")
        self.assertEqual(len(again), 700)
        for row, other in zip(again, whole):
            self.assertEqual(row["Operation/Friction coefficient"], other["Operation/Friction coefficient"])
            # The reduced bases of both runs have the tolerance 1e-4
            rates = [float(r["divergence rate [%]"] or 0.) for r in (row, other)]
            self.assertAlmostEqual(*rates, delta=0.02)

    def test_onsets_are_those_of_sweeps(self):
        sweep = ["Sweep/Number of friction coefficients=5", "Sweep/Last friction coefficient=0.6", "Sweep/Tolerance=1e-8"]
        results = self.run_scene("onsets", "Study=robustness", "Robustness/Number of samples=10", "Robustness/Worst samples=10",
                                 "Robustness/Samples with onsets=3", "Robustness/Sobol indices=false", *sweep,
                                 "Robustness/Distributions=Operation/Friction coefficient = uniform 0.4 to 0.6; "
                                 "Pin material/Young modulus = normal 100 %, 5 %; Mounts/Elastic mounts[2] = lognormal 7.8e10, 1e10")
        rows = read_table(results / "sample_onsets.csv")
        self.assertEqual(len(rows), 3)
        modes = read_table(results / "mode_onsets.csv")
        n_compared = 0
        for row in rows:
            number = row["sample [-]"]
            self.assertEqual(row["values that miss the tolerance [-]"], "0")
            folder = self.run_scene(f"sweep_{number}", "Study=sweep", *sweep, file=str(results / "worst" / f"{number}.prm"))
            first = {float(onset["divergence rate beyond [%]"]): onset for onset in read_table(folder / "onsets.csv")}
            for rate, name in ((0., "growth"), (0.01, "0.01 %")):
                difference = abs(float(row[f"mu of {name} [-]"]) - float(first[rate]["mu [-]"]))
                self.assertLessEqual(difference, float(row[f"uncertainty of mu of {name} [-]"]) + float(first[rate]["uncertainty [-]"]))
            branches = {}
            for threshold in read_table(folder / "thresholds.csv"):
                if threshold["event"] == "onset":
                    branches.setdefault(threshold["label"], threshold)
            for onset in modes:
                if onset["sample [-]"] == number and float(onset["divergence rate beyond [%]"]) == 0. and onset["label"] in branches:
                    other = branches[onset["label"]]
                    self.assertLessEqual(abs(float(onset["mu [-]"]) - float(other["mu [-]"])),
                                         float(onset["uncertainty of mu [-]"]) + float(other["uncertainty [-]"]))
                    n_compared += 1
        self.assertGreater(n_compared, 3)

    def test_search_for_a_robust_design(self):
        search = ["Study=search", "Search/Goal=quantile", "Search/Quantile=0.8", "Search/Samples=3", "Search/Evaluations=6",
                  "Designs/Variables=Pin material/Young modulus = 1.6e9 to 2.4e9; Mounts/Elastic mounts[2] = 6e10 to 9e10",
                  "Robustness/Number of samples=12", "Robustness/Distributions=Operation/Friction coefficient = uniform 0.3 to 0.6; "
                  "Pin material/Young modulus = uniform 95 % to 105 % for each pin; Disc material/Young modulus = normal 100 %, 1 %"]
        results = self.run_scene("search", *search)
        rows = read_table(results / "search.csv")
        column = "divergence rate at 80 % of the samples [%]"
        self.assertTrue(3 < len(rows) <= 6)
        self.assertEqual([row["phase"] for row in rows], ["sample"] * 3 + ["search"] * (len(rows) - 3))
        best = min(rows, key=lambda row: float(row[column]))
        for seed, row in zip((1, 2), read_table(results / "best_design.csv")):
            again = self.run_scene(f"again_{seed}", "Robustness/Sobol indices=false", f"Robustness/Seed={seed}", file=str(results / "best.prm"))
            # Probabilities agree except for samples that are undecided in one of the two bases
            squeal = read_table(again / "probabilities.csv")[0]
            for one, other in ((row, squeal), (squeal, row)):
                doubt = float(other["undecided samples [%]"]) + 1e-6
                self.assertLessEqual(float(one["probability of squeal [%]"]), float(other["probability of squeal [%]"]) + doubt)
            rates = sorted(float(sample["divergence rate [%]"] or 0.) for sample in read_table(again / "samples.csv"))
            self.assertAlmostEqual(float(row[column]), quantile(rates, 0.8, 12), delta=0.01)  # tolerance 1e-4
        self.assertEqual(read_table(results / "best_design.csv")[0][column], best[column])
        self.assertAlmostEqual(float(read_table(results / "full_order.csv")[0]["divergence rate [%]"]), rates[-1], delta=0.01)

    def test_refused_searches(self):
        good = {"Study": "search", "Search/Goal": "probability", "Designs/Variables": "Pin material/Young modulus = 1.6e9 to 2.4e9",
                "Robustness/Distributions": "Operation/Friction coefficient = uniform 0.3 to 0.6"}
        for path, value, words in (("Designs/Variables", "Geometry/Pin height = 0.029 to 0.035", "Pin height"),
                                   ("Robustness/Distributions", "Pin material/Young modulus = uniform 1.6e9 to 2e9", "Young modulus"),
                                   ("Steady sliding/Contact state", "steady sliding", "steady sliding")):
            self.assert_refused([words], *(f"{name}={text}" for name, text in {**good, path: value}.items()))

    def test_worst_samples_at_full_order(self):
        results = self.run_scene("box", "Study=robustness", f"Robustness/Distributions={BOX}", "Robustness/Number of samples=24",
                                 "Robustness/Worst samples=2", "Robustness/Sobol indices=false")
        samples = read_table(results / "samples.csv")
        self.assertEqual(len(samples), 24)
        modes = read_table(results / "sample_modes.csv")
        self.assertLessEqual(max(float(row["estimated error of lambda [-]"]) for row in modes), 1e-4)
        files = sorted((results / "worst").glob("*.prm"))
        self.assertEqual(len(files), 2)
        for file in files:
            full = read_table(self.run_scene(f"full_{file.stem}", file=str(file)) / "complex_modes.csv")
            reduced = [row for row in modes if row["sample [-]"] == file.stem]
            self.assertEqual(len(full), len(reduced))
            for one, other in zip(full, reduced):
                size = 2. * math.pi * float(one["frequency [Hz]"])
                difference = math.hypot(2. * math.pi * float(other["frequency [Hz]"]) - size,
                                        float(other["growth rate [1/s]"]) - float(one["growth rate [1/s]"]))
                self.assertLessEqual(difference / size, 2. * float(other["estimated error of lambda [-]"]) + 1e-8)

    @unittest.skipUnless(test_systems.HAS_NUMPY, "needs NumPy")
    def test_reduced_model_of_the_box(self):
        """The written model gives the modes of sample 1 in NumPy, and its parameter ranges contain all samples."""
        results = self.run_scene("written", "Study=robustness", f"Robustness/Distributions={BOX}", "Robustness/Number of samples=24",
                                 "Robustness/Sobol indices=false", "Output/Write system=reduced")
        system = squeal.System.read(results / "system")
        names = {"mu": "Operation/Friction coefficient", "disc_young_modulus": "Disc material/Young modulus",
                 "tangential_stiffness_disc_bore": "Mounts/Elastic mounts[2]",
                 **{f"{pin}_young_modulus": f"Pin material/Young modulus of {pin}" for pin in ("pin_top_1", "pin_top_2", "pin_bottom_1", "pin_bottom_2")}}
        self.assertEqual(set(system.parameters), set(names))
        samples, modes = read_table(results / "samples.csv"), read_table(results / "sample_modes.csv")
        for row, point in zip(samples, system.reduction["points"]):
            system.values({name: float(row[column]) for name, column in names.items()})
            self.assertEqual(point["largest estimated error of lambda [-]"], float(row["largest estimated error of lambda [-]"]))
        # Defaults are the exact values of sample 1; rounded values of the table would change frequencies of doublets
        eigenvalues = system.solve().eigenvalues
        first = [row for row in modes if row["sample [-]"] == "1"]
        self.assertGreater(len(first), 30)
        for row in first:
            value = complex(float(row["growth rate [1/s]"]), 2. * math.pi * float(row["frequency [Hz]"]))
            self.assertLess(min(abs(eigenvalues - value)), 1e-10 * abs(value))

    def test_refusals(self):
        for distributions, words in (("Pin material/Poisson ratio = uniform 0.2 to 0.3", "Poisson ratio"),
                                     ("Geometry/Pin height = uniform 0.03 to 0.031", "Pin height"),
                                     ("Disc material/Rayleigh alpha = uniform 0 to 1", "Rayleigh alpha"),
                                     ("Disc material/Density = uniform 80 % to 120 % for each pin", "for each pin"),
                                     ("Pin material/Young modulus = normal 1e9, 1e9", "Young"),
                                     ("Mounts/Elastic mounts = uniform 1 to 2", "Elastic mounts"),
                                     ("Pin material/Stiffness = uniform 1 to 2", "Stiffness")):
            self.assert_refused([words], "Study=robustness", f"Robustness/Distributions={distributions}")
        self.assert_refused(["Radial dissipation"], "Study=robustness", "Robustness/Distributions=Operation/Friction coefficient = uniform 0.1 to 0.6",
                            "Output/Write system=reduced", "Operation/Radial dissipation=consistent")


if __name__ == "__main__":
    unittest.main()
