# SPDX-License-Identifier: GPL-3.0-or-later

"""Plots of several studies: names, labels and files; repeated plotting."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

from program import COARSE, EXECUTABLE, SOURCE, ProgramTest, read_table

SCRIPTS = SOURCE / "scripts"

try:
    import matplotlib.image

    from squeal.plotting.draw import figures
    from squeal.results import Results
except ModuleNotFoundError as missing:
    if missing.name not in ("matplotlib", "numpy"):
        raise
    figures = None


def draw(folder, *options, environment=None):
    """Finished process of plot_results.py."""
    return subprocess.run([sys.executable, SCRIPTS / "plot_results.py", folder, *options], text=True, capture_output=True, check=False,
                          timeout=120, env={**os.environ, **(environment or {})})


@unittest.skipIf(figures is None, "python3-matplotlib is not installed")
class Studies(ProgramTest):
    """Plots of several studies; tests/scripts/test_plot_results.py checks their content for small tables."""

    scene = COARSE

    # Overrides and names of plots; sweep_families stands for one or several numbered plots
    STUDIES = {"stability": ([], {"complex_plane"}),
               "sweep": (["Study=sweep", "Operation/Radial dissipation=consistent", "Sweep/Last friction coefficient=0.45",
                          "Sweep/Number of friction coefficients=10", "Sweep/Complex plane at=0.4, 0.22", "Sweep/Map parameter=load",
                          "Sweep/Number of map values=3", "Sweep/Map friction coefficients=4", "Sweep/Tolerance=1e-4"],
                         {"complex_plane", "overview", "map", "sweep_families"}),
               "reduction": (["Study=reduction", "Reduction/Component modes=30, 36, 20", "Reduction/Grown tolerances=1e-4"],
                             {"reduction_errors", "reduction_cost"}),
               "ingredients": (["Study=ingredients", "Ingredients/Divergence tolerance=0.2"], {"ingredients"}),
               "sensitivity": (["Study=sensitivity", "Sensitivity/Thresholds=false"], {"sensitivity"})}
    WITH_NAMES_ABOVE = ("ingredients", "sensitivity")  # bar charts with a name for each row

    def test_pictures(self):
        for name, (overrides, expected) in self.STUDIES.items():
            with self.subTest(name):
                results = self.run_scene(name, *overrides)
                drawn = figures(Results(results))
                self.assertEqual({re.sub("_[0-9]+$", "", figure) for figure in drawn}, expected)
                process = draw(results, "--format", "png", "--output", self.folder / "pictures" / name)
                self.assertEqual(process.returncode, 0, process.stderr)
                self.assertEqual({path.stem for path in (self.folder / "pictures" / name).iterdir()}, set(drawn))
                for figure in drawn:
                    self.assert_holds_something(self.folder / "pictures" / name / f"{figure}.png")
                    self.assert_says_what_it_shows(figure, drawn[figure])
                if name in self.WITH_NAMES_ABOVE:
                    getattr(self, f"assert_bars_of_{name}")(results, drawn[name].axes)

    def assert_holds_something(self, picture):
        """Checks that the plot is neither empty nor cut off at its edges."""
        pixels = matplotlib.image.imread(picture)[..., :3]
        self.assertGreater(min(pixels.shape[:2]), 400, picture)
        ink = pixels.min(axis=2) < 0.9
        self.assertTrue(0.01 < ink.mean() < 0.9, picture)
        self.assertFalse(any(edge.any() for edge in (ink[0], ink[-1], ink[:, 0], ink[:, -1])), picture)

    def assert_says_what_it_shows(self, name, figure):
        """Checks that axes have units and the legend is complete."""
        self.assertTrue(any(text.get_text() for text in figure.texts), name)
        for axes in figure.axes:
            if name not in self.WITH_NAMES_ABOVE:
                self.assertRegex(axes.get_ylabel(), r" \[(%|Hz|N|-)\]$", name)
            if name in self.WITH_NAMES_ABOVE or axes.get_xlabel() not in ("", "criterion"):
                self.assertRegex(axes.get_xlabel(), r" \[(kHz|s|%|points|-)\]$", name)
        key = {text.get_text() for legend in figure.legends for text in legend.get_texts()}
        self.assertEqual(key, {label for axes in figure.axes for label in axes.get_legend_handles_labels()[1]}, name)

    def assert_bars_of_ingredients(self, results, panels):
        rows = read_table(results / "ingredients.csv")
        for axes, column in zip(panels, ("change of frequency [%]", "change of divergence rate [percentage points]",
                                         "cost relative to reference [-]"), strict=True):
            values = [float(row[column] or 0) for row in rows]
            self.assert_bars(axes, {place: value for place, value in enumerate(values) if value > 1e-6})
        self.assertEqual(len(panels[0].get_yticklabels()), len(rows))

    def assert_bars_of_sensitivity(self, results, panels):
        column = "divergence rate per 1 % [percentage points]"
        rows = [row for row in read_table(results / "sensitivities.csv") if not row["body"] and row[column]]
        self.assertEqual(len(panels), min(4, len({row["mode [-]"] for row in rows})))
        names = [label.get_text() for label in panels[0].get_yticklabels()]
        for mode, axes in enumerate(panels, start=1):
            of_mode = {names.index(row["parameter"]): float(row[column]) for row in rows if int(row["mode [-]"]) == mode}
            self.assertEqual(len(of_mode), len(names))
            self.assert_bars(axes, of_mode)

    def assert_bars(self, axes, expected):
        bars = {round(bar.get_y() + bar.get_height() / 2): bar.get_width() for bar in axes.patches}
        self.assertLessEqual({place for place, value in expected.items() if value != 0}, set(bars))
        for place in bars:
            self.assertAlmostEqual(bars[place], expected.get(place, 0.0), places=9)


@unittest.skipIf(figures is None, "python3-matplotlib is not installed")
class Pictures(ProgramTest):
    """Plots that are drawn again, and plots of a repeated run."""

    scene = COARSE

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

    def test_formats_and_places(self):
        elsewhere = self.folder / "elsewhere" / "deep"
        self.draw("--output", elsewhere)
        self.assertEqual([path.name for path in elsewhere.iterdir()], ["complex_plane.svg"])
        self.assertEqual(self.listed(), {})
        self.assertFalse(self.picture.parent.exists())
        for ending, start in (("svg", b"<?xml"), ("png", b"\x89PNG"), ("pdf", b"%PDF")):
            self.assertIn(f"complex_plane.{ending}", self.draw("--format", ending))
            self.assertTrue(self.picture.with_suffix(f".{ending}").read_bytes().startswith(start))
        self.assertEqual(self.listed(), {f"plots/{path.name}": path.stat().st_size for path in self.picture.parent.iterdir()})
        self.assertEqual(len(self.listed()), 3)
        # Identical tables give identical files
        self.assertEqual(self.picture.read_bytes(), (elsewhere / "complex_plane.svg").read_bytes())

    def test_pictures_of_the_user_stay_and_stale_ones_go(self):
        self.picture.parent.mkdir()
        self.picture.write_text("mine", encoding="utf-8")
        kept = "complex_plane.svg.kept"
        self.assertIn(kept, self.draw())
        self.assertNotIn("kept", self.draw())
        self.run_scene("results", "Operation/Friction coefficient=0.2")
        self.assertEqual([path.name for path in self.picture.parent.iterdir()], [kept])
        self.assertEqual((self.picture.parent / kept).read_text(encoding="utf-8"), "mine")
        self.draw()
        self.assertEqual(sorted(path.name for path in self.picture.parent.iterdir()), ["complex_plane.svg", kept])


@unittest.skipIf(figures is None, "python3-matplotlib is not installed")
class Refusals(ProgramTest):
    scene = COARSE

    def refused(self, folder, *words):
        process = draw(folder)
        self.assertEqual((process.returncode, len(process.stderr.splitlines())), (1, 3), process.stderr)
        self.assert_message(process, words)

    def test_folders(self):
        self.refused(self.folder / "none", "there is no folder")
        self.refused(self.folder, "run.json is missing")
        results = self.run_scene("results")
        (results / "plots").write_text("a file", encoding="utf-8")
        self.refused(results, "cannot be written", "plots")
        (results / "plots").unlink()
        (results / "complex_modes.csv").unlink()
        self.refused(results, "no table")
        (results / "run.json").write_text("{", encoding="utf-8")
        self.refused(results, "the record of the run", "results")
        self.assertFalse((results / "plots").exists())


class WithoutMatplotlib(ProgramTest):
    """scripts/run.sh in a fully built checkout, without matplotlib."""

    scene = COARSE

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.checkout = cls.folder / "checkout"
        for name in ("scripts", "python"):
            shutil.copytree(SOURCE / name, cls.checkout / name, ignore=shutil.ignore_patterns("__pycache__"))
        (cls.checkout / "scripts" / "setup.sh").write_text(
            'squeal_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)\ncomplain() { printf \'%s\\n\' "$*" >&2; }\nsetup() { :; }\n',
            encoding="utf-8")
        (cls.checkout / "build" / "release").mkdir(parents=True)
        (cls.checkout / "build" / "release" / "squeal").symlink_to(pathlib.Path(EXECUTABLE).resolve())
        # A module on the path that hides matplotlib
        (cls.folder / "nothing").mkdir()
        (cls.folder / "nothing" / "matplotlib.py").write_text("raise ModuleNotFoundError('none', name='matplotlib')\n", encoding="utf-8")

    def run_script(self, *options, **environment):
        process = subprocess.run([self.checkout / "scripts" / "run.sh", self.folder / "scene.prm", *options], text=True,
                                 capture_output=True, check=False, timeout=300, env={**os.environ, **environment})
        self.assertEqual(process.returncode, 0, process.stderr)
        return process

    def test_what_is_missing_is_said(self):
        # Hide matplotlib from Python, or make the shell's `command` fail
        for environment in ({"PYTHONPATH": str(self.folder / "nothing")}, {"BASH_FUNC_command%%": "() { return 1; }"}):
            process = self.run_script(**environment)
            line, = [line for line in process.stderr.splitlines() if "No plots" in line]
            for word in ("python3-matplotlib", "scripts/plot_results.py results/scene"):
                self.assertIn(word, line)
            self.assertNotIn("Traceback", process.stderr)
            results = self.checkout / "results" / "scene"
            self.assertTrue((results / "complex_modes.csv").is_file())
            self.assertFalse((results / "plots").exists())
            shutil.rmtree(results)

    @unittest.skipIf(figures is None, "python3-matplotlib is not installed")
    def test_plots_are_drawn(self):
        self.run_script()
        picture = self.checkout / "results" / "scene" / "plots" / "complex_plane.svg"
        self.assertTrue(picture.is_file())
        # A call without results draws no plot
        picture.unlink()
        self.assertNotIn("plots", self.run_script("--", "--dry-run").stdout)
        self.assertFalse(picture.exists())


if __name__ == "__main__":
    unittest.main()
