# SPDX-License-Identifier: GPL-3.0-or-later

"""Sweeps of the friction coefficient, compared with runs at single friction coefficients."""

import json
import math
import re

from program import COARSE, ProgramTest, distance, eigenvalues, numbers, read_table

SWEEP = "Study=sweep"
CONSISTENT = "Operation/Radial dissipation=consistent"
STEADY = "Steady sliding/Contact state=steady sliding"
GRID = ["Sweep/First friction coefficient=0", "Sweep/Last friction coefficient=0.45", "Sweep/Number of friction coefficients=10"]
MAP = ["Sweep/Number of map values=3", "Sweep/Map friction coefficients=4"]
KRYLOV = ["Complex modes/Solver=Krylov", "Complex modes/Tolerance=1e-11"]

# Default parameters
SPEED, LOAD, TOLERANCE, THRESHOLD_TOLERANCE = 4.0, 1000.0, 1e-6, 1e-6

# Twice the tolerance, because estimates are not bounds [-]
DEFAULT_ACCURACY = 2 * TOLERANCE

# Smallest R / omega of a growing mode, and rounding error of numbers in tables [-]
GROWING, PRINTED = 1e-8, 1e-10


def eigenvalue(row):
    return complex(float(row["growth rate [1/s]"]), 2 * math.pi * float(row["frequency [Hz]"]))


def divergence(value):
    """Divergence rate R / omega of an eigenvalue [-]."""
    return value.real / value.imag


def by_mu(rows):
    """Rows of a table by friction coefficient, in the order of the table."""
    result = {}
    for row in rows:
        result.setdefault(float(row["mu [-]"]), []).append(row)
    return result


def modes_by_mu(folder, table="branches.csv"):
    """lambda of the modes by friction coefficient."""
    return {mu: [eigenvalue(row) for row in rows] for mu, rows in by_mu(read_table(folder / table)).items()}


def grid_of(folder, table="branches.csv"):
    return list(by_mu(row for row in read_table(folder / table) if row["refinement [-]"] == "0"))


def thresholds(folder, table="thresholds.csv"):
    return [{name: float(text) if name in ("mu [-]", "uncertainty [-]", "frequency [Hz]") else text for name, text in row.items()}
            for row in read_table(folder / table)]


class SweepTest(ProgramTest):
    @classmethod
    def sweep(cls, output, *overrides, n_processes=1):
        return cls.run_scene(output, SWEEP, *GRID, *overrides, n_processes=n_processes)

    @classmethod
    def alone(cls, mu, *overrides):
        """Result folder of a run at one friction coefficient, at full order."""
        return cls.shared(*KRYLOV, f"Operation/Friction coefficient={mu!r}", *overrides)

    @classmethod
    def modes_at(cls, mu, *overrides):
        return eigenvalues(cls.alone(mu, *overrides))

    def assert_same_modes(self, actual, expected, tolerance):
        """Compares lambda and divergence rates with the results of another run."""
        self.assert_same_eigenvalues(actual, expected, tolerance)
        left = list(expected)
        for value in actual:
            nearest = min(left, key=lambda other: abs(other - value))
            left.remove(nearest)
            self.assertAlmostEqual(divergence(value), divergence(nearest), delta=tolerance)

    def assert_complete(self, folder, suffix=""):
        """Checks that the branches have the numbers of modes in counts.csv, and that no branch occurs twice at one friction
        coefficient."""
        rows = by_mu(read_table(folder / f"branches{suffix}.csv"))
        counts = read_table(folder / f"counts{suffix}.csv")
        self.assertEqual([float(row["mu [-]"]) for row in counts], list(rows))
        for row in counts:
            self.assertEqual(row["modes [-]"], row["expected [-]"], row)
            self.assertEqual(int(row["modes [-]"]), len(rows[float(row["mu [-]"])]), row)
        for mu, here in rows.items():
            self.assertEqual(len({row["branch [-]"] for row in here}), len(here), mu)
        return rows

    def assert_within_tolerance(self, folder, tolerance=TOLERANCE, suffix=""):
        rows = [row for row in read_table(folder / f"branches{suffix}.csv") if row["refinement [-]"] == "0"]
        self.assertGreater(len(rows), 0)
        for row in rows:
            self.assertTrue(0 <= float(row["estimated error of lambda [-]"]) <= tolerance, row)

    def call_sweep(self, output, *overrides):
        return self.call_scene(output, SWEEP, *GRID, *overrides)

    def screen_of(self, output, *overrides):
        """Output of a successful sweep."""
        process = self.call_sweep(output, *overrides)
        self.assertEqual(process.returncode, 0, process.stderr)
        return process.stdout + process.stderr


class Sweep(SweepTest):
    """A sweep with consistent radial dissipation, and its chart without dissipation."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.overrides = [CONSISTENT, "Sweep/Count modes at=0.2, 0.33", "Sweep/Mode shapes at=0, 0.4", "Output/Mode shapes=unstable",
                         "Sweep/Complex plane at=0.33, 0.4", "Sweep/Map parameter=load", "Sweep/First map value=250",
                         "Sweep/Last map value=4000", *MAP]
        cls.results = cls.sweep("results", *cls.overrides)
        cls.grid = grid_of(cls.results)

    def test_files(self):
        names = {path.name for path in self.results.iterdir()}
        tables = {f"{name}{suffix}.csv" for name in ("branches", "thresholds", "counts", "band_crossings")
                  for suffix in ("", "_without_dissipation")}
        self.assertEqual(names, tables | {"onsets.csv", "complex_plane.csv", "argument_counts.csv", "map.csv", "modes", "animations", "parameters.prm",
                                          "run.json"})
        for path in self.results.glob("*.csv"):
            self.assertTrue(all(math.isfinite(number) for number in numbers(path)), path)
        quantities = json.loads((self.results / "run.json").read_text(encoding="utf-8"))["quantities"]
        self.assertTrue(6 < quantities["digits of the eigenvalues [-]"] < 16)

    def test_values(self):
        for suffix in ("", "_without_dissipation"):
            rows = self.assert_complete(self.results, suffix)
            self.assert_within_tolerance(self.results, suffix=suffix)
            for k, mu in enumerate(grid_of(self.results, f"branches{suffix}.csv")):
                self.assertAlmostEqual(mu, 0.05 * k, delta=1e-11)
            for row in (row for here in rows.values() for row in here):
                rate = divergence(eigenvalue(row))
                self.assertAlmostEqual(float(row["divergence rate [%]"]), 100 * rate, delta=PRINTED)
                self.assertEqual(row["growing [-]"], "1" if rate > GROWING else "0", row)
                if row["verdict"] == "unstable":
                    self.assertGreater(rate, 0)
                # Near coalescence, larger rates may also be undecided
                elif row["refinement [-]"] == "0":
                    self.assertLess(rate, 10 * TOLERANCE, row)
            # Branches are complete, and each branch keeps its label
            branches = {}
            for row in (row for here in rows.values() for row in here):
                branches.setdefault(row["branch [-]"], []).append(row["label"])
            for labels in branches.values():
                self.assertEqual((len(labels), len(set(labels))), (len(rows), 1))

    def test_against_single_runs(self):
        for suffix, overrides in (("", [CONSISTENT]), ("_without_dissipation", [])):
            modes = modes_by_mu(self.results, f"branches{suffix}.csv")
            for mu in (self.grid[3], self.grid[6], self.grid[-1]):
                with self.subTest(suffix, mu=mu):
                    self.assert_same_modes(modes[mu], self.modes_at(mu, *overrides), DEFAULT_ACCURACY)

    def test_complex_plane(self):
        """Modes agree with a run at the same friction coefficient, also between values of the sweep."""
        rows = read_table(self.results / "complex_plane.csv")
        self.assertEqual(list(dict.fromkeys((float(row["mu [-]"]), row["radial dissipation"]) for row in rows)),
                         [(mu, dissipation) for mu in (0.33, 0.4) for dissipation in ("consistent", "none")])
        for dissipation, overrides in (("consistent", [CONSISTENT]), ("none", [])):
            here = [row for row in rows if row["mu [-]"] == "0.33" and row["radial dissipation"] == dissipation]
            with self.subTest(dissipation):
                self.assert_same_modes([eigenvalue(row) for row in here], self.modes_at(0.33, *overrides), DEFAULT_ACCURACY)
                self.assertLessEqual(max(float(row["estimated error of lambda [-]"]) for row in here), TOLERANCE)

    def test_counts_by_the_argument_principle(self):
        rows = read_table(self.results / "argument_counts.csv")
        self.assertEqual([float(row["mu [-]"]) for row in rows], [0.2, 0.33])
        modes = modes_by_mu(self.results)
        for row in rows:
            self.assertEqual(row["modes counted [-]"], row["modes of the sweep [-]"])
            self.assertEqual(int(row["modes counted [-]"]), len(modes[0.2]))
            self.assertLess(float(row["largest phase step [rad]"]), math.pi / 3 + 1e-9)

    def test_thresholds(self):
        for suffix, mechanism, overrides in (("", "zero growth", [CONSISTENT]), ("_without_dissipation", "coalescence", [])):
            found = [row for row in thresholds(self.results, f"thresholds{suffix}.csv") if row["mechanism"] == mechanism]
            self.assertGreater(len(found), 0)
            for row in found:
                self.assertIn(row["event"], ("onset", "restabilisation"))
                self.assertTrue(0 < row["uncertainty [-]"] < 1e-4, row)
                self.assertEqual(row["partner [-]"] != "", mechanism == "coalescence")
            # Use an isolated threshold: several pin modes begin to grow at nearly the same value
            row, = [row for row in found if row["label"] == "A1-2 +"]
            step = max(1e-5, row["uncertainty [-]"])
            below, above = (sum(divergence(value) > GROWING for value in self.modes_at(row["mu [-]"] + sign * step, *overrides)) for sign in (-1, 1))
            self.assertEqual(above - below, 1 if row["event"] == "onset" else -1, row)

    def test_thresholds_lie_between_the_values_of_the_sweep(self):
        """The verdict of a branch changes only at its thresholds."""
        for suffix in ("", "_without_dissipation"):
            rows = [row for row in read_table(self.results / f"branches{suffix}.csv") if row["refinement [-]"] == "0"]
            events = thresholds(self.results, f"thresholds{suffix}.csv")
            for branch in {row["branch [-]"] for row in rows}:
                growing = [(float(row["mu [-]"]), divergence(eigenvalue(row)) > GROWING) for row in rows if row["branch [-]"] == branch]
                for (a, before), (b, after) in zip(growing, growing[1:]):
                    between = [row for row in events if row["branch [-]"] == branch and a < row["mu [-]"] <= b]
                    onsets = [row["event"] for row in between].count("onset")
                    self.assertEqual(onsets - (len(between) - onsets), after - before, (suffix, branch, b))

    def test_mode_shapes(self):
        modes = sorted(path.name for path in (self.results / "modes").iterdir())
        # The file has the label of the mode at this friction coefficient, not at the start of the branch
        leader = max(read_table(self.alone(0.4, CONSISTENT) / "complex_modes.csv"), key=lambda row: float(row["divergence rate [%]"]))
        name = f"mu_0.4_{leader['label'].replace(' ', '_')}"
        self.assertEqual(modes, [f"{name}.vtu", f"{name}_contact.vtu"])
        self.assertEqual(sorted(path.name for path in (self.results / "animations").iterdir()), [f"{name}.pvd", f"{name}_frames"])

    def test_no_mode_shape_where_none_grows(self):
        """If only mode shapes are requested, the complex plane is written at their friction coefficient."""
        screen = self.screen_of("quiet", "Sweep/Last friction coefficient=0.1", "Sweep/Number of friction coefficients=2", CONSISTENT,
                                "Sweep/Compare dissipation=false", "Sweep/Mode shapes at=0.1", "Output/Mode shapes=unstable")
        self.assertIn("no mode grows at mu = 0.1", screen)
        self.assertFalse((self.folder / "quiet" / "modes").exists())
        self.assertFalse(list((self.folder / "quiet").glob("*_without_dissipation.csv")))
        rows = read_table(self.folder / "quiet" / "complex_plane.csv")
        self.assertEqual({(row["mu [-]"], row["radial dissipation"]) for row in rows}, {("0.1", "consistent")})

    def test_tolerance(self):
        fine = self.sweep("fine", "Sweep/Tolerance=1e-8", "Sweep/Number of friction coefficients=4", CONSISTENT,
                          "Sweep/Compare dissipation=false")
        self.assert_complete(fine)
        self.assert_within_tolerance(fine, 1e-8)
        modes = modes_by_mu(fine)
        for mu in grid_of(fine)[1:]:
            self.assert_same_modes(modes[mu], self.modes_at(mu, CONSISTENT), 2e-8)

    def test_map_of_rotating_disc(self):
        """Gyroscopic forces and convective stiffness follow the speed of the map."""
        rotating = "Operation/Gyroscopic forces=true"
        results = self.sweep("rotating", rotating, "Sweep/Number of friction coefficients=2", "Sweep/Map parameter=speed", "Sweep/First map value=4",
                             "Sweep/Last map value=100", "Sweep/Number of map values=2", "Sweep/Map friction coefficients=2")
        rows = [row for row in read_table(results / "map.csv") if row["unstable modes [-]"] != "0"]
        self.assertEqual({float(row["rotation speed [rad/s]"]) for row in rows}, {4, 100})
        for row in rows:
            single = self.modes_at(float(row["mu [-]"]), rotating, f"Operation/Rotation speed={row['rotation speed [rad/s]']}")
            leading = max(single, key=lambda value: value.real)
            self.assertLessEqual(abs(eigenvalue(row) - leading), DEFAULT_ACCURACY * abs(leading))

    def test_maps(self):
        """Contact damping is proportional to load over speed; without rotation terms, nothing else depends on load and speed."""
        by_load = read_table(self.results / "map.csv")
        fast = self.sweep("fast", CONSISTENT, "Sweep/Number of friction coefficients=4", "Sweep/Compare dissipation=false",
                          "Sweep/Map parameter=speed", "Sweep/First map value=1", "Sweep/Last map value=16", *MAP)
        by_speed = read_table(fast / "map.csv")
        places = {}
        for rows, name, ratio in ((by_load, "load per side [N]", lambda value: value / SPEED),
                                  (by_speed, "rotation speed [rad/s]", lambda value: LOAD / value)):
            self.assertEqual(len(rows), 12)
            for row in rows:
                self.assertEqual(row["open contact nodes [-]"], "0")
                self.assertTrue(0 <= float(row["estimated error of lambda [-]"]) <= TOLERANCE)
                place = round(float(row["mu [-]"]), 9), round(ratio(float(row[name])), 6)
                places.setdefault(place, []).append(row)
        self.assertEqual(len(places), 12)
        self.assertTrue(any(one["unstable modes [-]"] != "0" for one, _ in places.values()))
        for (mu, _), (one, other) in places.items():
            self.assertEqual(one["unstable modes [-]"], other["unstable modes [-]"])
            # If no mode grows, the leading mode depends on rounding
            if one["unstable modes [-]"] != "0":
                self.assertLessEqual(distance([eigenvalue(one)], [eigenvalue(other)]), DEFAULT_ACCURACY, mu)
                self.assertEqual(one["label"], other["label"])

        branches = {round(mu, 9): rows for mu, rows in by_mu(read_table(self.results / "branches.csv")).items()}
        for row in by_load:
            if float(row["load per side [N]"]) == LOAD:
                rows = branches[round(float(row["mu [-]"]), 9)]
                growth = max(float(other["divergence rate [%]"]) for other in rows)
                self.assertAlmostEqual(float(row["divergence rate [%]"]), growth, delta=100 * DEFAULT_ACCURACY)
                self.assertEqual(int(row["unstable modes [-]"]), sum(other["verdict"] == "unstable" for other in rows))


class Onsets(SweepTest):
    """Onset of squeal with unequal material damping: the summary, all tables and runs at single friction coefficients
    agree."""

    DAMPED = ["Disc material/Rayleigh beta=1.8e-8", "Pin material/Rayleigh beta=4.5e-7"]

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.screen = cls.call_scene("coarse", SWEEP, *GRID, *cls.DAMPED).stdout
        cls.coarse = cls.folder / "coarse"
        cls.growth, cls.weak = ((float(row["mu [-]"]), float(row["uncertainty [-]"]), row["label"]) for row in read_table(cls.coarse / "onsets.csv"))

    def assert_same_onset(self, row, mu, uncertainty, expected):
        self.assertLessEqual(abs(float(row[mu]) - expected[0]), float(row[uncertainty]) + expected[1])

    def test_summary_and_thresholds(self):
        self.assertEqual([row["divergence rate beyond [%]"] for row in read_table(self.coarse / "onsets.csv")], ["0", "0.01"])
        self.assertEqual(re.search(r"squeal begins at mu = (\S+) \((.*?)\), divergence rate exceeds 0.01 % at mu = (\S+) \((.*?)\)",
                                   self.screen).groups(),
                         (f"{self.growth[0]:.4g}", self.growth[2], f"{self.weak[0]:.4g}", self.weak[2]))
        first = thresholds(self.coarse)[0]
        self.assertEqual((first["mu [-]"], first["uncertainty [-]"], first["label"]), self.growth)
        self.assertLess(self.growth[0], self.weak[0])

    def test_other_values_of_the_sweep(self):
        fine = read_table(self.sweep("fine", *self.DAMPED, "Sweep/Number of friction coefficients=31") / "onsets.csv")
        for row, expected in zip(fine, (self.growth, self.weak)):
            self.assert_same_onset(row, "mu [-]", "uncertainty [-]", expected)

    def test_list_of_designs(self):
        folder = self.run_scene("designs", "Study=geometry", *GRID, *self.DAMPED, "Designs/Variables=Disc material/Rayleigh beta = 1.8e-8")
        row, = read_table(folder / "designs.csv")
        self.assert_same_onset(row, "first onset [-]", "uncertainty of first onset [-]", self.growth)
        self.assert_same_onset(row, "mu of 0.01 % [-]", "uncertainty of mu of 0.01 % [-]", self.weak)

    def test_single_runs_on_both_sides(self):
        for (mu, uncertainty, _), level in ((self.growth, 0.0), (self.weak, 1e-4)):
            self.assertLess(uncertainty, 1e-5)
            below, above = (max(divergence(value) for value in self.modes_at(mu + sign * uncertainty, *self.DAMPED)) for sign in (-1, 1))
            self.assertLess(below, level)
            self.assertGreater(above, level)

    def test_growth_at_the_only_value(self):
        """If the onset lies below the only value of the sweep, its uncertainty extends to zero."""
        results = self.sweep("late", *self.DAMPED, "Sweep/First friction coefficient=0.4", "Sweep/Number of friction coefficients=1")
        for row in read_table(results / "onsets.csv"):
            self.assertEqual((row["mu [-]"], row["uncertainty [-]"]), ("0.4", "0.4"))
        self.assertEqual(list(self.assert_complete(results)), [0.4])
        self.assert_within_tolerance(results)
        self.assertEqual(thresholds(results), [])
        self.assert_same_modes(modes_by_mu(results)[0.4], self.modes_at(0.4, *self.DAMPED), DEFAULT_ACCURACY)


class OtherSweeps(SweepTest):
    scene = COARSE

    def test_small_basis(self):
        screen = self.screen_of("small", CONSISTENT, "Sweep/Compare dissipation=false", "Sweep/Maximum basis=40", "Sweep/Tolerance=1e-9",
                                "Sweep/Count modes at=0.4", "Sweep/Mode shapes at=0.4", "Output/Mode shapes=unstable")
        # The error is reported once, although it affects three outputs
        self.assertEqual(len(re.findall("at mu = 0.4, the estimated error .* of the modes exceeds the tolerance", screen)), 1)
        self.assertIn("omitted operating points: ", screen)
        self.assertIn("Sweep/Maximum basis", screen)
        results = self.folder / "small"
        # Without friction, the real modes in the basis are exact
        self.assertEqual(list(grid_of(results)), [0.0])
        self.assertNotIn("stable: no mode", screen)
        self.assert_within_tolerance(results, 1e-9)
        self.assert_complete(results)

    def test_end_of_band(self):
        wide = self.sweep("wide", "Sweep/Number of friction coefficients=4")
        # Let the band end at the mean frequency of the branch whose frequency changes most
        branches = {}
        for row in read_table(wide / "branches.csv"):
            branches.setdefault(row["branch [-]"], []).append(float(row["frequency [Hz]"]))
        _, chosen = max(branches.items(), key=lambda item: max(item[1]) - min(item[1]))
        end = (chosen[0] + chosen[-1]) / 2
        self.assertGreater(abs(chosen[-1] - chosen[0]), 1)

        narrow = self.sweep("narrow", "Sweep/Number of friction coefficients=4", f"Band/Maximum frequency={end!r}")
        rows = self.assert_complete(narrow)
        self.assert_within_tolerance(narrow)
        crossings = read_table(narrow / "band_crossings.csv")
        self.assertGreater(len(crossings), 0)
        for row in crossings:
            self.assertEqual(row["edge"], "end of band")
            self.assertLess(float(row["uncertainty [-]"]), 1e-4)
            at_end = self.modes_at(float(row["mu [-]"]))
            nearest = min((value.imag / (2 * math.pi) for value in at_end), key=lambda frequency: abs(frequency - end))
            slope = max(abs(frequencies[-1] - frequencies[0]) for frequencies in branches.values()) / 0.45
            self.assertAlmostEqual(nearest, end, delta=DEFAULT_ACCURACY * end + 10 * slope * float(row["uncertainty [-]"]))
        for mu, values in rows.items():
            balance = sum(1 if row["direction"] == "enters" else -1 for row in crossings if float(row["mu [-]"]) <= mu)
            self.assertEqual(len(values), len(rows[0.0]) + balance, mu)
            self.assertLessEqual(max(float(row["frequency [Hz]"]) for row in values), end * (1 + PRINTED))

    def test_contact_sets(self):
        results = self.sweep("open", STEADY, CONSISTENT, "Sweep/Compare dissipation=false", "Sweep/First friction coefficient=0.4",
                             "Sweep/Last friction coefficient=0.8", "Sweep/Number of friction coefficients=5")
        sets = read_table(results / "contact_sets.csv")
        self.assertEqual(len(sets), 5)
        self.assertEqual(sets[0]["open contact nodes [-]"], "0")
        self.assertGreater(len({row["contact set [-]"] for row in sets}), 1)
        found = {}
        for path in sorted(results.glob("branches*.csv")):
            self.assert_complete(results, path.stem[len("branches"):])
            self.assert_within_tolerance(results, suffix=path.stem[len("branches"):])
            found.update(modes_by_mu(results, path.name))
        for row in (sets[0], sets[-1]):
            mu = float(row["mu [-]"])
            self.assert_same_modes(found[mu], self.modes_at(mu, STEADY, CONSISTENT), DEFAULT_ACCURACY)

    def test_chosen_values_between_contact_sets(self):
        # Some nodes are open at 0.8, none at 0.4, and more at 1.2
        screen = self.screen_of("between", STEADY, "Sweep/First friction coefficient=0.4", "Sweep/Last friction coefficient=1.2",
                                "Sweep/Number of friction coefficients=2", "Sweep/Count modes at=0.8", "Sweep/Mode shapes at=0.8",
                                "Output/Mode shapes=unstable")
        for message in ("modes are not counted", "no mode shape is written", "the complex plane is omitted"):
            self.assertEqual(screen.count(message), 1, screen)
        for name in ("argument_counts.csv", "complex_plane.csv", "modes"):
            self.assertFalse((self.folder / "between" / name).exists())


class Refusals(SweepTest):
    def test_parameters(self):
        load = ["Sweep/Map parameter=load", CONSISTENT]
        for mentions, *overrides in (
                (["ascend", "Sweep/First friction coefficient"], "Sweep/First friction coefficient=0.45"),
                (["0.5 is outside", "Sweep/Mode shapes at"], "Sweep/Mode shapes at=0.2, 0.5"),
                (["0.45 is outside", "Sweep/Count modes at"], "Sweep/Number of friction coefficients=1", "Sweep/Count modes at=0.45"),
                (["no term", "speed", "Sweep/Map parameter"], "Sweep/Map parameter=speed"),
                (["begins at zero", "Sweep/First map value"], *load, "Sweep/First map value=0"),
                (["ascend", "Sweep/First map value"], *load, "Sweep/First map value=2000", "Sweep/Last map value=1000"),
                (["ascend", "Map friction coefficients"], *load, "Sweep/First friction coefficient=0.5",
                 "Sweep/Number of friction coefficients=1"),
                (["Steady sliding/Control"], *load, STEADY, "Steady sliding/Control=displacement", "Steady sliding/Displacement=1e-5")):
            with self.subTest(mentions):
                self.assert_refused(mentions, SWEEP, *GRID, *overrides)
