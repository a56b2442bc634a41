"""Runs that sweep the friction coefficient, held against runs at single friction coefficients."""

import json
import math
import re
import subprocess
import time

from program import EXECUTABLE, ProgramTest, contents, distance, eigenvalues, header, numbers, read_table

SWEEP = "Study=sweep"
CONSISTENT = "Operation/Radial dissipation=consistent"
STEADY = "Steady sliding/Contact state=steady sliding"
GRID = ["Sweep/First friction coefficient=0", "Sweep/Last friction coefficient=0.45", "Sweep/Number of friction coefficients=10"]
MAP = ["Sweep/Number of map values=3", "Sweep/Map friction coefficients=4"]
KRYLOV = ["Complex modes/Solver=Krylov", "Complex modes/Tolerance=1e-11"]

# Of the default parameters
SPEED, LOAD, TOLERANCE, THRESHOLD_TOLERANCE = 4.0, 1000.0, 1e-6, 1e-6

# Twice the tolerance: an estimate is no bound [-]
DEFAULT_ACCURACY = 2 * TOLERANCE

# Of a growing mode, per radian, and what numbers of a table have lost [-]
GROWING, PRINTED = 1e-8, 1e-10

BRANCHES = ("mu [-],branch [-],label,frequency [Hz],growth rate [1/s],divergence rate [%],eps_res right [-],eps_res left [-],"
            "estimated error of lambda [-],verdict,refinement [-],growing [-]")
THRESHOLDS = "mu [-],uncertainty [-],event,mechanism,branch [-],label,partner [-],label of partner,frequency [Hz]"
COUNTS = "mu [-],modes [-],expected [-],overdamped pairs [-]"
PLANE = "mu [-],radial dissipation,label,frequency [Hz],growth rate [1/s],divergence rate [%],estimated error of lambda [-],verdict"
CROSSINGS = "mu [-],uncertainty [-],branch [-],label,direction,edge"


def eigenvalue(row):
    return complex(float(row["growth rate [1/s]"]), 2 * math.pi * float(row["frequency [Hz]"]))


def divergence(value):
    """Growth per radian."""
    return value.real / value.imag


def by_mu(rows):
    """Rows of a table in lists by friction coefficient, ascending as in the table."""
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
    # lambda of runs at one friction coefficient by what they were asked: more than one test looks at them.
    single_runs = {}

    @classmethod
    def sweep(cls, output, *overrides, n_processes=1):
        return cls.run_scene(output, SWEEP, *GRID, *overrides, n_processes=n_processes)

    @classmethod
    def modes_at(cls, mu, *overrides):
        """lambda of a run at one friction coefficient, at full order."""
        if (mu, overrides) not in cls.single_runs:
            folder = cls.run_scene("alone", *KRYLOV, f"Operation/Friction coefficient={mu!r}", *overrides)
            cls.single_runs[mu, overrides] = eigenvalues(folder)
        return cls.single_runs[mu, overrides]

    def assert_same_modes(self, actual, expected, tolerance):
        """Holds lambda and growth per radian against those of another run."""
        self.assert_same_eigenvalues(actual, expected, tolerance)
        left = list(expected)
        for value in actual:
            nearest = min(left, key=lambda other: abs(other - value))
            left.remove(nearest)
            self.assertAlmostEqual(divergence(value), divergence(nearest), delta=tolerance)

    def assert_complete(self, folder, suffix=""):
        """As many modes as counts.csv says, each once, with everything it says in order."""
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
        settings = [word for override in (SWEEP, *GRID, *overrides) for word in ("--set", override)]
        return self.call("scene.prm", "--output", output, *settings)


class Sweep(SweepTest):
    """A sweep with consistent radial dissipation, and without it beside."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.overrides = [CONSISTENT, "Sweep/Count modes at=0.2, 0.33", "Sweep/Mode shapes at=0, 0.4", "Output/Mode shapes=unstable",
                         "Sweep/Complex plane at=0.33, 0.4", "Sweep/Map parameter=load", "Sweep/First map value=250",
                         "Sweep/Last map value=4000", *MAP]
        cls.results = cls.sweep("results", *cls.overrides)
        cls.grid = grid_of(cls.results)

    def test_says_how_many_digits_are_left(self):
        quantities = json.loads((self.results / "run.json").read_text(encoding="utf-8"))["quantities"]
        self.assertLess(6, quantities["digits of the eigenvalues [-]"])
        self.assertLess(quantities["digits of the eigenvalues [-]"], 16)
        self.assertLess(1, quantities["condition number of the stiffness [-]"])
        self.assertLess(1, quantities["largest condition number of an eigenvalue [-]"])

    def test_files(self):
        names = {path.name for path in self.results.iterdir()}
        tables = {f"{name}{suffix}.csv" for name in ("branches", "thresholds", "counts", "band_crossings")
                  for suffix in ("", "_without_dissipation")}
        self.assertEqual(names, tables | {"onsets.csv", "complex_plane.csv", "argument_counts.csv", "map.csv", "modes", "animations", "parameters.prm",
                                          "run.json"})
        for suffix in ("", "_without_dissipation"):
            for name, expected in (("branches", BRANCHES), ("thresholds", THRESHOLDS), ("counts", COUNTS), ("band_crossings", CROSSINGS)):
                self.assertEqual(header(self.results / f"{name}{suffix}.csv"), expected)
        self.assertEqual(header(self.results / "complex_plane.csv"), PLANE)
        for path in self.results.glob("*.csv"):
            self.assertTrue(all(math.isfinite(number) for number in numbers(path)), path)

    def test_values(self):
        for suffix in ("", "_without_dissipation"):
            rows = self.assert_complete(self.results, suffix)
            self.assert_within_tolerance(self.results, suffix=suffix)
            grid = grid_of(self.results, f"branches{suffix}.csv")
            self.assertEqual(len(grid), 10)
            for k, mu in enumerate(grid):
                self.assertAlmostEqual(mu, 0.05 * k, delta=1e-11)
            for here in rows.values():
                for row in here:
                    value = eigenvalue(row)
                    self.assertAlmostEqual(float(row["divergence rate [%]"]), 100 * divergence(value), delta=PRINTED)
                    for name in ("eps_res right [-]", "eps_res left [-]"):
                        self.assertGreaterEqual(float(row[name]), 0)
                    self.assertIn(row["verdict"], ("stable", "unstable", "undecided"))
                    self.assertEqual(row["growing [-]"], "1" if divergence(value) > GROWING else "0", row)
                    if row["verdict"] == "unstable":
                        self.assertGreater(divergence(value), 0)
                    # Close to where modes meet even larger rates are undecided.
                    elif row["refinement [-]"] == "0":
                        self.assertLess(divergence(value), 10 * TOLERANCE, row)
            # No branch ends before the band does, and each keeps its name.
            branches = {}
            for here in rows.values():
                for row in here:
                    branches.setdefault(row["branch [-]"], []).append(row["label"])
            for labels in branches.values():
                self.assertEqual(len(labels), len(rows))
                self.assertEqual(len(set(labels)), 1)

    def test_against_single_runs(self):
        for suffix, overrides in (("", [CONSISTENT]), ("_without_dissipation", [])):
            modes = modes_by_mu(self.results, f"branches{suffix}.csv")
            for mu in (self.grid[3], self.grid[6], self.grid[-1]):
                with self.subTest(suffix, mu=mu):
                    self.assert_same_modes(modes[mu], self.modes_at(mu, *overrides), DEFAULT_ACCURACY)

    def test_complex_plane(self):
        """The modes of a run at that friction coefficient, also between the values of the sweep."""
        rows = read_table(self.results / "complex_plane.csv")
        self.assertEqual(list(dict.fromkeys((float(row["mu [-]"]), row["radial dissipation"]) for row in rows)),
                         [(mu, dissipation) for mu in (0.33, 0.4) for dissipation in ("consistent", "none")])
        for dissipation, overrides in (("consistent", [CONSISTENT]), ("none", [])):
            here = [row for row in rows if row["mu [-]"] == "0.33" and row["radial dissipation"] == dissipation]
            with self.subTest(dissipation):
                self.assert_same_modes([eigenvalue(row) for row in here], self.modes_at(0.33, *overrides), DEFAULT_ACCURACY)
                self.assertLessEqual(max(float(row["estimated error of lambda [-]"]) for row in here), TOLERANCE)
                folder = self.run_scene("alone", *KRYLOV, "Operation/Friction coefficient=0.33", *overrides)
                alone = read_table(folder / "complex_modes.csv")
                growing = [row for row in here if row["verdict"] == "unstable"]
                self.assertTrue(growing)
                for row in growing:
                    nearest = min(alone, key=lambda other: abs(eigenvalue(other) - eigenvalue(row)))
                    self.assertEqual(row["label"], nearest["label"])

    def test_complex_plane_of_mode_shapes(self):
        """Whoever asks for shapes of leading modes and for no plane gets the plane there."""
        results = self.sweep("plane", "Sweep/Number of friction coefficients=3", "Sweep/Mode shapes at=0.1")
        rows = read_table(results / "complex_plane.csv")
        self.assertEqual({(row["mu [-]"], row["radial dissipation"]) for row in rows}, {("0.1", "none")})
        self.assertFalse((results / "modes").exists())

    def test_counts_by_the_argument_principle(self):
        rows = read_table(self.results / "argument_counts.csv")
        self.assertEqual([float(row["mu [-]"]) for row in rows], [0.2, 0.33])
        modes = modes_by_mu(self.results)
        for row in rows:
            self.assertEqual(row["modes counted [-]"], row["modes of the sweep [-]"])
            self.assertEqual(int(row["modes counted [-]"]), len(modes[0.2]))
            self.assertGreater(int(row["contour points [-]"]), 0)
            self.assertLess(float(row["largest phase step [rad]"]), math.pi / 3 + 1e-9)

    def n_growing(self, mu, *overrides):
        return sum(divergence(value) > GROWING for value in self.modes_at(mu, *overrides))

    def test_thresholds(self):
        for suffix, mechanism, overrides in (("", "zero growth", [CONSISTENT]), ("_without_dissipation", "coalescence", [])):
            found = [row for row in thresholds(self.results, f"thresholds{suffix}.csv") if row["mechanism"] == mechanism]
            self.assertGreater(len(found), 0)
            for row in found:
                self.assertIn(row["event"], ("onset", "restabilisation"))
                self.assertTrue(0 < row["uncertainty [-]"] < 1e-4, row)
                self.assertEqual(row["partner [-]"] != "", mechanism == "coalescence")
            # Where one mode of the disc meets one of the pins; of those of the pins several grow at nearly the same value.
            row, = [row for row in found if row["label"] == "A1-2 +"]
            step = max(1e-5, row["uncertainty [-]"])
            below, above = (self.n_growing(row["mu [-]"] + sign * step, *overrides) for sign in (-1, 1))
            self.assertEqual(above - below, 1 if row["event"] == "onset" else -1, row)

    def test_thresholds_lie_between_the_values_of_the_sweep(self):
        """The verdicts of a branch change at its thresholds only."""
        for suffix in ("", "_without_dissipation"):
            rows = [row for row in read_table(self.results / f"branches{suffix}.csv") if row["refinement [-]"] == "0"]
            events = thresholds(self.results, f"thresholds{suffix}.csv")
            for branch in {row["branch [-]"] for row in rows}:
                growing = [(float(row["mu [-]"]), divergence(eigenvalue(row)) > GROWING) for row in rows if row["branch [-]"] == branch]
                for (a, before), (b, after) in zip(growing, growing[1:]):
                    between = [row for row in events if row["branch [-]"] == branch and a < row["mu [-]"] <= b]
                    with self.subTest(suffix, branch=branch, mu=b):
                        onsets = [row["event"] for row in between].count("onset")
                        self.assertEqual(onsets - (len(between) - onsets), after - before)

    def test_mode_shapes(self):
        modes = sorted(path.name for path in (self.results / "modes").iterdir())
        # Named after the mode there, as in a run of its own; a branch is named after the mode with which it begins.
        alone = self.run_scene("alone", *KRYLOV, CONSISTENT, "Operation/Friction coefficient=0.4")
        leader = max(read_table(alone / "complex_modes.csv"), key=lambda row: float(row["divergence rate [%]"]))
        name = f"mu_0.4_{leader['label'].replace(' ', '_')}"
        self.assertEqual(modes, [f"{name}.vtu", f"{name}_contact.vtu"])
        self.assertEqual(sorted(path.name for path in (self.results / "animations").iterdir()), [f"{name}.pvd", f"{name}_frames"])

    def test_no_mode_shape_where_none_grows(self):
        process = self.call_sweep("quiet", "Sweep/Last friction coefficient=0.1", "Sweep/Number of friction coefficients=2", CONSISTENT,
                                  "Sweep/Compare dissipation=false", "Sweep/Mode shapes at=0.1", "Output/Mode shapes=unstable")
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertIn("no mode grows at mu = 0.1", process.stdout + process.stderr)
        self.assertFalse((self.folder / "quiet" / "modes").exists())
        self.assertFalse(list((self.folder / "quiet").glob("*_without_dissipation.csv")))

    def test_tolerance(self):
        fine = self.sweep("fine", "Sweep/Tolerance=1e-8", "Sweep/Number of friction coefficients=4", CONSISTENT)
        for suffix, overrides in (("", [CONSISTENT]), ("_without_dissipation", [])):
            self.assert_complete(fine, suffix)
            self.assert_within_tolerance(fine, 1e-8, suffix)
            modes = modes_by_mu(fine, f"branches{suffix}.csv")
            for mu in grid_of(fine)[1:]:
                with self.subTest(suffix, mu=mu):
                    self.assert_same_modes(modes[mu], self.modes_at(mu, *overrides), 2e-8)

    def test_maps(self):
        """Contact damps in proportion to load over speed, and nothing else depends on either."""
        by_load = read_table(self.results / "map.csv")
        fast = self.sweep("fast", CONSISTENT, "Sweep/Number of friction coefficients=4", "Sweep/Compare dissipation=false",
                          "Sweep/Map parameter=speed", "Sweep/First map value=1", "Sweep/Last map value=16", *MAP)
        by_speed = read_table(fast / "map.csv")
        places = {}
        for rows, name, ratio in ((by_load, "load per side [N]", lambda value: value / SPEED),
                                  (by_speed, "rotation speed [rad/s]", lambda value: LOAD / value)):
            self.assertEqual(len(rows), 12)
            self.assertEqual(len({(row["mu [-]"], row[name]) for row in rows}), 12)
            for row in rows:
                self.assertEqual(row["open contact nodes [-]"], "0")
                self.assertTrue(0 <= float(row["estimated error of lambda [-]"]) <= TOLERANCE)
                place = round(float(row["mu [-]"]), 9), round(ratio(float(row[name])), 6)
                places.setdefault(place, []).append(row)
        self.assertEqual(len(places), 12)
        self.assertTrue(any(one["unstable modes [-]"] != "0" for one, _ in places.values()))
        for (mu, _), (one, other) in places.items():
            self.assertEqual(one["unstable modes [-]"], other["unstable modes [-]"])
            # Which of several modes that do not grow is damped least is a matter of rounding.
            if one["unstable modes [-]"] != "0":
                self.assertLessEqual(distance([eigenvalue(one)], [eigenvalue(other)]), DEFAULT_ACCURACY, mu)
                self.assertEqual(one["label"], other["label"])

        branches = {round(mu, 9): rows for mu, rows in by_mu(read_table(self.results / "branches.csv")).items()}
        own = [row for row in by_load if float(row["load per side [N]"]) == LOAD]
        self.assertEqual(len(own), 4)
        for row in own:
            rows = branches[round(float(row["mu [-]"]), 9)]
            growth = max(float(other["divergence rate [%]"]) for other in rows)
            self.assertAlmostEqual(float(row["divergence rate [%]"]), growth, delta=100 * DEFAULT_ACCURACY)
            self.assertEqual(int(row["unstable modes [-]"]), sum(other["verdict"] == "unstable" for other in rows))


class Onsets(SweepTest):
    """Where squeal begins, of materials with unequal damping: the same in the summary, all tables and runs at single friction coefficients."""

    DAMPED = ["Disc material/Rayleigh beta=1.8e-8", "Pin material/Rayleigh beta=4.5e-7"]

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        settings = [word for override in (SWEEP, *GRID, *cls.DAMPED) for word in ("--set", override)]
        cls.screen = cls.call("scene.prm", "--output", "coarse", *settings).stdout
        cls.coarse = cls.folder / "coarse"
        cls.growth, cls.weak = ((float(row["mu [-]"]), float(row["uncertainty [-]"]), row["label"]) for row in read_table(cls.coarse / "onsets.csv"))

    def assert_same_onset(self, row, mu, uncertainty, expected):
        self.assertLessEqual(abs(float(row[mu]) - expected[0]), float(row[uncertainty]) + expected[1])

    def test_summary_and_thresholds(self):
        self.assertEqual([row["divergence rate beyond [%]"] for row in read_table(self.coarse / "onsets.csv")], ["0", "0.01"])
        self.assertEqual(re.search(r"squeal from mu = (\S+) on \((.*?)\), beyond 0.01 % from mu = (\S+) on \((.*?)\)", self.screen).groups(),
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

    def test_growth_at_the_first_value(self):
        """It began below: the uncertainty says so, and so does the summary."""
        results = self.sweep("late", *self.DAMPED, "Sweep/First friction coefficient=0.4", "Sweep/Number of friction coefficients=2")
        for row in read_table(results / "onsets.csv"):
            self.assertEqual((row["mu [-]"], row["uncertainty [-]"]), ("0.4", "0.4"))


class OtherSweeps(SweepTest):
    def test_one_value(self):
        results = self.sweep("one", "Sweep/First friction coefficient=0.4", "Sweep/Number of friction coefficients=1")
        rows = self.assert_complete(results)
        self.assertEqual(list(rows), [0.4])
        self.assert_within_tolerance(results)
        self.assertEqual(thresholds(results), [])
        self.assert_same_modes(modes_by_mu(results)[0.4], self.modes_at(0.4), DEFAULT_ACCURACY)

    def test_small_basis(self):
        process = self.call_sweep("small", CONSISTENT, "Sweep/Compare dissipation=false", "Sweep/Maximum basis=40", "Sweep/Tolerance=1e-9",
                                  "Sweep/Count modes at=0.4", "Sweep/Mode shapes at=0.4", "Output/Mode shapes=unstable")
        self.assertEqual(process.returncode, 0, process.stderr)
        screen = process.stdout + process.stderr
        # Once, although three tables and files are about them
        self.assertEqual(screen.count("at mu = 0.4 the modes miss the tolerance"), 1)
        self.assertIn("operating points miss the tolerance", screen)
        self.assertIn("Sweep/Maximum basis", screen)
        results = self.folder / "small"
        # Without friction the real modes, which every basis has, are exact
        self.assertEqual(list(grid_of(results)), [0.0])
        self.assertNotIn("stable: no mode", screen)
        self.assert_within_tolerance(results, 1e-9)
        self.assert_complete(results)

    def test_end_of_band(self):
        wide = self.sweep("wide", "Sweep/Number of friction coefficients=4")
        # The branch whose frequency changes most, away from thresholds: the band shall end where that is half way.
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
        modes, others = modes_by_mu(narrow), modes_by_mu(wide)
        for mu in grid_of(narrow):
            expected = [value for value in others[mu] if value.imag <= 2 * math.pi * end]
            self.assert_same_modes(modes[mu], expected, 2 * DEFAULT_ACCURACY)

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
        # Some nodes are open at 0.8, none at 0.4, and more at 1.2.
        process = self.call_sweep("between", STEADY, "Sweep/First friction coefficient=0.4", "Sweep/Last friction coefficient=1.2",
                                  "Sweep/Number of friction coefficients=2", "Sweep/Count modes at=0.8", "Sweep/Mode shapes at=0.8",
                                  "Output/Mode shapes=unstable")
        self.assertEqual(process.returncode, 0, process.stderr)
        screen = process.stdout + process.stderr
        for message in ("modes are not counted", "no mode shape is written", "the complex plane is left out"):
            self.assertEqual(screen.count(message), 1, screen)
        self.assertFalse((self.folder / "between" / "argument_counts.csv").exists())
        self.assertFalse((self.folder / "between" / "complex_plane.csv").exists())
        self.assertFalse((self.folder / "between" / "modes").exists())


class Refusals(SweepTest):
    def refused(self, mentions, *overrides):
        before = contents(self.folder)
        process = self.call_sweep("new", *overrides)
        self.assertEqual(contents(self.folder), before)
        self.assertEqual(process.returncode, 1)
        message = process.stderr.strip()
        lines = message.splitlines()
        for start in ("error: ", "  where:  ", "  change: "):
            self.assertEqual(sum(line.startswith(start) and len(line) > len(start) for line in lines), 1, message)
        for word in mentions:
            self.assertIn(word, message)

    def test_range(self):
        self.refused(["ascend", "Sweep/First friction coefficient"], "Sweep/First friction coefficient=0.5")
        self.refused(["ascend", "Sweep/First friction coefficient"], "Sweep/First friction coefficient=0.45")
        self.refused(["Number of friction coefficients"], "Sweep/Number of friction coefficients=0")
        self.refused(["First friction coefficient"], "Sweep/First friction coefficient=-0.1")

    def test_values_outside(self):
        for name in ("Mode shapes at", "Complex plane at", "Count modes at"):
            self.refused(["0.5 is outside", f"Sweep/{name}"], f"Sweep/{name}=0.2, 0.5")
            self.refused(["0.45 is outside", f"Sweep/{name}"], "Sweep/Number of friction coefficients=1", f"Sweep/{name}=0.45")

    def test_map(self):
        for parameter in ("load", "speed"):
            self.refused(["without contact damping", parameter, "Sweep/Map parameter"], f"Sweep/Map parameter={parameter}")
        load = ["Sweep/Map parameter=load", CONSISTENT]
        self.refused(["begins at zero", "Sweep/First map value"], *load, "Sweep/First map value=0")
        self.refused(["ascend", "Sweep/First map value"], *load, "Sweep/First map value=2000", "Sweep/Last map value=1000")
        self.refused(["Number of map values"], *load, "Sweep/Number of map values=0")
        self.refused(["Map friction coefficients"], *load, "Sweep/Map friction coefficients=0")
        self.refused(["ascend", "Map friction coefficients"], *load, "Sweep/First friction coefficient=0.5",
                     "Sweep/Number of friction coefficients=1")
        self.refused(["Steady sliding/Control"], *load, STEADY, "Steady sliding/Control=displacement", "Steady sliding/Displacement=1e-5")

    def test_options(self):
        self.refused(["Tolerance"], "Sweep/Tolerance=0")
        self.refused(["Maximum basis"], "Sweep/Maximum basis=0")
        self.refused(["Threshold tolerance"], "Sweep/Threshold tolerance=0")
