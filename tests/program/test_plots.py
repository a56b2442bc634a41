"""The plots of every study: which there are, that what they show is what the tables hold, and what becomes of them."""

import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

from program import EXECUTABLE, SOURCE, ProgramTest, read_table

SCRIPTS = SOURCE / "scripts"
sys.path.insert(0, str(SCRIPTS))

try:
    import matplotlib.image

    import plot_results
    from plotting.results import Results, ResultsError
except ModuleNotFoundError as missing:
    if missing.name not in ("matplotlib", "numpy"):
        raise
    plot_results = None

CONSISTENT = "Operation/Radial dissipation=consistent"
SWEEP = ["Study=sweep", CONSISTENT, "Sweep/First friction coefficient=0", "Sweep/Last friction coefficient=0.45",
         "Sweep/Number of friction coefficients=10", "Sweep/Complex plane at=0.4, 0.22", "Sweep/Map parameter=load",
         "Sweep/First map value=250", "Sweep/Last map value=4000", "Sweep/Number of map values=3", "Sweep/Map friction coefficients=4"]
WITHOUT, WITH = "without radial dissipation", "with radial dissipation"


def draw(folder, *options, environment=None):
    """The finished script."""
    return subprocess.run([sys.executable, SCRIPTS / "plot_results.py", folder, *options], text=True, capture_output=True, check=False,
                          timeout=120, env={**os.environ, **(environment or {})})


def line_of(axes, label):
    """Points of all lines of a label, without breaks."""
    return [(float(x), float(y)) for line in axes.get_lines() if line.get_label() == label
            for x, y in zip(line.get_xdata(), line.get_ydata()) if not math.isnan(x)]


def columns(path, *names, condition=lambda row: True):
    """Numbers of some columns, for the rows that fulfil a condition."""
    return [tuple(float(row[name]) for name in names) for row in read_table(path) if condition(row)]


@unittest.skipIf(plot_results is None, "python3-matplotlib is not installed")
class PlotTest(ProgramTest):
    """A run, its results, and its figures by their names."""

    OVERRIDES = []
    WITH_NAMES_ABOVE = ()  # pictures whose names stand above each other

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.results = cls.run_scene("results", *cls.OVERRIDES)
        cls.figures = plot_results.figures(Results(cls.results))

    def assert_drawn(self, names):
        """The pictures are there, hold something, and say what their axes mean."""
        process = draw(self.results, "--format", "png", "--output", self.folder / "pictures")
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertEqual({path.stem for path in (self.folder / "pictures").iterdir()}, names)
        self.assertEqual(set(self.figures), names)
        for name in names:
            pixels = matplotlib.image.imread(self.folder / "pictures" / f"{name}.png")[..., :3]
            self.assertGreater(min(pixels.shape[:2]), 400, name)
            ink = pixels.min(axis=2) < 0.9
            self.assertTrue(0.01 < ink.mean() < 0.9, name)
            # Nothing is cut off at the rim of the picture
            for edge in (ink[0], ink[-1], ink[:, 0], ink[:, -1]):
                self.assertFalse(edge.any(), name)
        for name, figure in self.figures.items():
            self.assertTrue(any(text.get_text() for text in figure.texts), name)
            for axes in figure.axes:
                # Of names beside or above each other there is no unit
                if name not in self.WITH_NAMES_ABOVE:
                    self.assertRegex(axes.get_ylabel(), r" \[(%|Hz|N|-)\]$", name)
                if name in self.WITH_NAMES_ABOVE or axes.get_xlabel() not in ("", "criterion"):
                    self.assertRegex(axes.get_xlabel(), r" \[(kHz|s of CPU|%|points|-)\]$", name)
            key = {text.get_text() for legend in figure.legends for text in legend.get_texts()}
            labels = {label for axes in figure.axes for label in axes.get_legend_handles_labels()[1]}
            self.assertEqual(key, labels, name)

    def assert_same_points(self, actual, expected):
        self.assertEqual(len(actual), len(expected))
        for a, b in zip(sorted(actual), sorted(expected)):
            for x, y in zip(a, b):
                self.assertAlmostEqual(x, y, delta=1e-12 + 1e-12 * abs(y))


class Stability(PlotTest):
    def test_pictures(self):
        self.assert_drawn({"complex_plane"})

    def test_modes(self):
        axes, = self.figures["complex_plane"].axes
        table = self.results / "complex_modes.csv"
        kilohertz = [(1e-3 * frequency, rate) for frequency, rate in columns(table, "frequency [Hz]", "divergence rate [%]")]
        self.assert_same_points(line_of(axes, WITHOUT), kilohertz)
        record = json.loads((self.results / "run.json").read_text(encoding="utf-8"))
        self.assertEqual(len(line_of(axes, "growing")), record["counts"]["unstable modes"])
        leader = max(read_table(table), key=lambda row: float(row["divergence rate [%]"]))
        self.assertIn(leader["label"], [text.get_text() for text in axes.texts])
        self.assertIn("0.4", axes.get_title())


class Sweep(PlotTest):
    OVERRIDES = SWEEP

    def test_pictures(self):
        families = {name for name in self.figures if name.startswith("sweep_families")}
        self.assertTrue(families)
        self.assert_drawn({"complex_plane", "overview", "map"} | families)

    def test_curves(self):
        panels = self.figures["overview"].axes
        for title, suffix in ((WITH, ""), (WITHOUT, "_without_dissipation")):
            table = self.results / f"branches{suffix}.csv"
            events = read_table(self.results / f"thresholds{suffix}.csv")
            self.assertTrue(events)
            for axes, quantity in zip(panels, ("frequency [Hz]", "divergence rate [%]")):
                # A threshold is a point of the branch that grows, and of its partner
                neutral = [(float(row["mu [-]"]), float(row["frequency [Hz]"]) if quantity == "frequency [Hz]" else 0.0)
                           for row in events for _ in range(2 if row["partner [-]"] else 1)]
                everything = columns(table, "mu [-]", quantity)
                self.assert_same_points(line_of(axes, title), everything + neutral)
                growing = line_of(axes, f"growing, {title}")
                expected = columns(table, "mu [-]", quantity, condition=lambda row: row["growing [-]"] == "1")
                self.assertTrue(expected)
                self.assertLessEqual(set(expected), set(growing))
                self.assertLessEqual(set(growing) - set(expected), set(everything + neutral))
                for event in ("onset", "restabilisation"):
                    marks = [(float(row["mu [-]"]), float(row["frequency [Hz]"]) if quantity == "frequency [Hz]" else 0.0)
                             for row in events if row["event"] == event]
                    self.assert_same_points(line_of(axes, f"{event}, {title}"), marks)

    def test_families(self):
        """Every branch that grows is in one of the pictures."""
        titles = {axes.get_title() for name, figure in self.figures.items() if name.startswith("sweep_families") for axes in figure.axes}
        for suffix in ("", "_without_dissipation"):
            growing = {row["label"] for row in read_table(self.results / f"branches{suffix}.csv") if row["growing [-]"] == "1"}
            self.assertTrue(growing)
            self.assertLessEqual({label.removesuffix(" -").removesuffix(" +") for label in growing}, titles)

    def test_complex_plane(self):
        """At the values asked for, of which 0.22 is none of the sweep."""
        table = read_table(self.results / "complex_plane.csv")
        for axes, mu in zip(self.figures["complex_plane"].axes, (0.4, 0.22), strict=True):
            self.assertEqual(axes.get_title(), f"\u03bc = {mu}")
            n_growing = 0
            for title, dissipation in ((WITH, "consistent"), (WITHOUT, "none")):
                rows = [row for row in table if float(row["mu [-]"]) == mu and row["radial dissipation"] == dissipation]
                self.assertTrue(rows)
                shown = line_of(axes, title) + line_of(axes, "faster decay, " + title)
                self.assert_same_points([(x,) for x, _ in shown], [(1e-3 * float(row["frequency [Hz]"]),) for row in rows])
                self.assertLessEqual({y for _, y in line_of(axes, title)}, {float(row["divergence rate [%]"]) for row in rows})
                n_growing += sum(row["verdict"] == "unstable" for row in rows)
            self.assertEqual(len(line_of(axes, "growing")), n_growing)

    def test_map(self):
        rows = read_table(self.results / "map.csv")
        unstable = [row for row in rows if int(row["unstable modes [-]"]) > 0]
        for axes, name in zip(self.figures["map"].axes, ("divergence rate [%]", "unstable modes [-]")):
            cells = axes.collections[0].get_array().compressed()
            self.assert_same_points([(float(cell),) for cell in cells], [(float(row[name]),) for row in unstable])
            others = [patch for patch in axes.patches if patch.get_label() in ("stable", "undecided", "not computed")]
            self.assertEqual(len(others), len(rows) - len(unstable))


class Reduction(PlotTest):
    OVERRIDES = ["Study=reduction", "Reduction/Component modes=30, 36, 20", "Reduction/Grown tolerances=1e-4"]

    def test_pictures(self):
        self.assert_drawn({"reduction_errors", "reduction_cost"})

    def test_errors(self):
        names = ("res [-]", "mac [-]", "frq [-]", "div [-]")
        rows = read_table(self.results / "reduction_errors.csv")
        panels = {axes.get_title(): axes for axes in self.figures["reduction_errors"].axes}
        self.assertEqual(set(panels), {row["group"] for row in rows})
        for row in rows:
            shown = [y for _, y in line_of(panels[row["group"]], row["basis"])]
            self.assertEqual(shown, [max(float(row[name]), 1e-16) for name in names])

    def test_costs(self):
        worst = {}
        for row in read_table(self.results / "reduction_modes.csv"):
            worst[row["basis"]] = max(worst.get(row["basis"], 0), float(row["eps_div [-]"]))
        for axes, time in zip(self.figures["reduction_cost"].axes, ("solve time [s]", "build time [s]")):
            for row in read_table(self.results / "reduction_bases.csv"):
                title = f"{row['basis']} {row['component modes']}".strip()
                self.assert_same_points(line_of(axes, title), [(float(row[time]), worst[row["basis"]])])
            self.assertTrue(line_of(axes, "Pareto front"))


class Frictionless(PlotTest):
    OVERRIDES = ["Study=reduction", "Reduction/Problem=frictionless", "Reduction/Component modes=28, 20, 12; 36, 36, 16"]

    def test_pictures(self):
        self.assert_drawn({"reduction_errors", "reduction_cost"})
        titles = [axes.get_title() for axes in self.figures["reduction_errors"].axes]
        for truncation in ("28/20/12", "36/36/16"):
            self.assertTrue(any(truncation in title for title in titles), titles)


class Ingredients(PlotTest):
    OVERRIDES = ["Study=ingredients", "Ingredients/Divergence tolerance=0.2"]
    WITH_NAMES_ABOVE = ("ingredients",)

    def test_bars(self):
        self.assert_drawn({"ingredients"})
        rows = read_table(self.results / "ingredients.csv")
        panels = self.figures["ingredients"].axes
        for axes, column in zip(panels, ("change of frequency [%]", "change of divergence rate [percentage points]",
                                         "cost beside the reference [-]"), strict=True):
            expected = {place: float(row[column]) for place, row in enumerate(rows) if row[column] and float(row[column]) > 1e-6}
            bars = {round(bar.get_y() + bar.get_height() / 2): bar.get_width() for bar in axes.patches}
            self.assertEqual(set(bars), set(expected))
            for place, value in expected.items():
                self.assertAlmostEqual(bars[place], value, places=9)
        self.assertEqual(len(panels[0].get_yticklabels()), len(rows))
        self.assertEqual([x for x, _ in line_of(panels[1], "accuracy asked for")], [0.2, 0.2])


class Sensitivity(PlotTest):
    OVERRIDES = ["Study=sensitivity", "Sensitivity/Thresholds=false"]
    WITH_NAMES_ABOVE = ("sensitivity",)

    def test_bars(self):
        self.assert_drawn({"sensitivity"})
        rows = [row for row in read_table(self.results / "sensitivities.csv")
                if not row["only of"] and row["divergence rate per 1 % [percentage points]"]]
        panels = self.figures["sensitivity"].axes
        self.assertEqual(len(panels), min(4, len({row["mode [-]"] for row in rows})))
        names = [label.get_text() for label in panels[0].get_yticklabels()]
        for mode, axes in enumerate(panels, start=1):
            expected = {names.index(row["parameter"]): float(row["divergence rate per 1 % [percentage points]"])
                        for row in rows if int(row["mode [-]"]) == mode}
            self.assertEqual(len(expected), len(names))
            bars = {round(bar.get_y() + bar.get_height() / 2): bar.get_width() for bar in axes.patches}
            for place, value in expected.items():
                self.assertAlmostEqual(bars.get(place, 0.0), value, places=12)


@unittest.skipIf(plot_results is None, "python3-matplotlib is not installed")
class Pictures(ProgramTest):
    """What becomes of pictures when they are drawn again and when the run is repeated."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.run_scene("original")

    def setUp(self):
        self.results = shutil.copytree(self.folder / "original", self.folder / "results")
        self.picture = self.results / "plots" / "complex_plane.svg"
        self.addCleanup(shutil.rmtree, self.results)

    def listed(self):
        files = json.loads((self.results / "run.json").read_text(encoding="utf-8"))["files [byte]"]
        return {name: size for name, size in files.items() if name.startswith("plots/")}

    def draw(self, *options):
        process = draw(self.results, *options)
        self.assertEqual(process.returncode, 0, process.stderr)
        return process.stdout

    def test_formats(self):
        for ending, start in (("svg", b"<?xml"), ("png", b"\x89PNG"), ("pdf", b"%PDF")):
            self.assertIn(f"complex_plane.{ending}", self.draw("--format", ending))
            self.assertTrue(self.picture.with_suffix(f".{ending}").read_bytes().startswith(start))
        self.assertEqual(self.listed(), {f"plots/{path.name}": path.stat().st_size for path in self.picture.parent.iterdir()})
        self.assertEqual(len(self.listed()), 3)

    def test_same_tables_same_bytes(self):
        self.draw()
        content = self.picture.read_bytes()
        self.picture.write_text("edited", encoding="utf-8")
        self.draw()
        self.assertEqual(self.picture.read_bytes(), content)
        self.assertEqual([path.name for path in self.picture.parent.iterdir()], ["complex_plane.svg"])

    def test_a_rerun_leaves_no_stale_picture(self):
        self.draw()
        (self.picture.parent / "mine.svg").write_text("mine", encoding="utf-8")
        record = (self.results / "run.json").read_text(encoding="utf-8")
        self.run_scene("results", "Operation/Friction coefficient=0.2")
        self.assertEqual([path.name for path in self.picture.parent.iterdir()], ["mine.svg"])
        self.assertNotEqual((self.results / "run.json").read_text(encoding="utf-8"), record)
        self.draw()
        self.assertEqual(sorted(path.name for path in self.picture.parent.iterdir()), ["complex_plane.svg", "mine.svg"])

    def test_the_record_stays_but_for_the_list(self):
        before = json.loads((self.results / "run.json").read_text(encoding="utf-8"))
        self.draw()
        after = json.loads((self.results / "run.json").read_text(encoding="utf-8"))
        self.assertEqual(after.pop("files [byte]"), {**before.pop("files [byte]"), **self.listed()})
        self.assertEqual(list(after.items()), list(before.items()))

    def test_a_picture_of_the_user_is_kept(self):
        self.picture.parent.mkdir()
        self.picture.write_text("mine", encoding="utf-8")
        self.assertIn("complex_plane.svg.kept", self.draw())
        self.assertEqual((self.picture.parent / "complex_plane.svg.kept").read_text(encoding="utf-8"), "mine")
        self.assertNotIn("kept", self.draw())

    def test_elsewhere(self):
        elsewhere = self.folder / "elsewhere" / "deep"
        self.draw("--output", elsewhere)
        self.assertEqual([path.name for path in elsewhere.iterdir()], ["complex_plane.svg"])
        self.assertEqual(self.listed(), {})
        self.assertFalse(self.picture.parent.exists())

    def test_results_of_earlier_versions(self):
        record = json.loads((self.results / "run.json").read_text(encoding="utf-8"))
        del record["files [byte]"]
        (self.results / "run.json").write_text(json.dumps(record), encoding="utf-8")
        self.draw()
        self.assertTrue(self.picture.is_file())
        self.assertEqual(json.loads((self.results / "run.json").read_text(encoding="utf-8")), record)


@unittest.skipIf(plot_results is None, "python3-matplotlib is not installed")
class Refusals(ProgramTest):
    def refused(self, folder, *words):
        process = draw(folder)
        self.assertEqual(process.returncode, 1)
        message = process.stderr.strip()
        for start in ("error: ", "  where:  ", "  change: "):
            self.assertEqual(sum(line.startswith(start) and len(line) > len(start) for line in message.splitlines()), 1, message)
        self.assertEqual(len(message.splitlines()), 3, message)
        for word in words:
            self.assertIn(word, message)

    def test_folders(self):
        self.refused(self.folder / "none", "there is no folder")
        self.refused(self.folder / "scene.prm", "there is no folder")
        self.refused(self.folder, "run.json is missing")
        results = self.run_scene("results")
        (results / "plots").write_text("a file", encoding="utf-8")
        self.refused(results, "cannot be written", "plots")
        (results / "plots").unlink()
        record = (results / "run.json").read_text(encoding="utf-8")
        for broken in ("{", "3"):
            (results / "run.json").write_text(broken, encoding="utf-8")
            self.refused(results, "the record of the run", "results")
        self.assertFalse((results / "plots").exists())
        (results / "run.json").write_text(record, encoding="utf-8")
        (results / "complex_modes.csv").unlink()
        self.refused(results, "no table")
        (results / "parameters.prm").unlink()
        self.refused(results, "parameters.prm is missing")

    def test_results_that_are_replaced_meanwhile(self):
        results = Results(self.run_scene("results"))
        self.run_scene("results")
        results.record_file.write_text(results.record_text + " ", encoding="utf-8")
        with self.assertRaises(ResultsError) as caught:
            plot_results.enlist(results, {"plots/complex_plane.svg": b""})
        self.assertIn("replaced meanwhile", str(caught.exception))

    def test_usage(self):
        self.assertEqual(draw(self.folder, "--format", "gif").returncode, 2)


class WithoutMatplotlib(ProgramTest):
    """scripts/run.sh in a checkout of which everything is built."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.checkout = cls.folder / "checkout"
        shutil.copytree(SCRIPTS, cls.checkout / "scripts", ignore=shutil.ignore_patterns("__pycache__"))
        (cls.checkout / "scripts" / "setup.sh").write_text(
            'squeal_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)\ncomplain() { printf \'%s\\n\' "$*" >&2; }\nsetup() { :; }\n',
            encoding="utf-8")
        (cls.checkout / "build" / "release").mkdir(parents=True)
        (cls.checkout / "build" / "release" / "squeal").symlink_to(pathlib.Path(EXECUTABLE).resolve())
        # In place of the package
        (cls.folder / "nothing").mkdir()
        (cls.folder / "nothing" / "matplotlib.py").write_text("raise ModuleNotFoundError('none', name='matplotlib')\n", encoding="utf-8")

    def run_script(self, *options, **environment):
        process = subprocess.run([self.checkout / "scripts" / "run.sh", self.folder / "scene.prm", *options], text=True,
                                 capture_output=True, check=False, timeout=300, env={**os.environ, **environment})
        self.assertEqual(process.returncode, 0, process.stderr)
        return process

    def assert_says_how(self, **environment):
        process = self.run_script(**environment)
        line, = [line for line in process.stderr.splitlines() if "No plots" in line]
        for word in ("python3-matplotlib", "scripts/plot_results.py results/scene"):
            self.assertIn(word, line)
        self.assertNotIn("Traceback", process.stderr)
        results = self.checkout / "results" / "scene"
        self.assertTrue((results / "complex_modes.csv").is_file())
        self.assertFalse((results / "plots").exists())

    def test_matplotlib_is_missing(self):
        self.assert_says_how(PYTHONPATH=str(self.folder / "nothing"))

    def test_python_is_missing(self):
        # A function of this name hides what bash would find
        self.assert_says_how(**{"BASH_FUNC_command%%": "() { return 1; }"})

    @unittest.skipIf(plot_results is None, "python3-matplotlib is not installed")
    def test_plots_are_drawn(self):
        self.run_script()
        picture = self.checkout / "results" / "scene" / "plots" / "complex_plane.svg"
        self.assertTrue(picture.is_file())
        # A call that leaves no results draws nothing
        picture.unlink()
        self.assertNotIn("plots", self.run_script("--", "--dry-run").stdout)
        self.assertFalse(picture.exists())


if __name__ == "__main__":
    unittest.main()
