# SPDX-License-Identifier: GPL-3.0-or-later

"""squeal.plotting on small tables with known figures; skipped without matplotlib."""

import math
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))

try:
    from squeal.plotting import branches, charts, complex_plane, reduction, stability_map, style
    from squeal.errors import Error
    from squeal.results import Results, Table
except ModuleNotFoundError as missing:
    if missing.name not in ("matplotlib", "numpy"):
        raise
    branches = None

BAND = 100.0  # end of the band [Hz]
PARAMETERS = {"Band": {"Maximum frequency": BAND}, "Operation": {"Radial dissipation": "none", "Friction coefficient": 0.4},
              "Reduction": {"Problem": "friction"}}
BRANCHES = ("mu [-]", "branch [-]", "label", "frequency [Hz]", "divergence rate [%]", "verdict", "growing [-]")
THRESHOLDS = ("mu [-]", "event", "branch [-]", "partner [-]", "frequency [Hz]")


def line_of(axes, label):
    """Points of the line with a label, with (NaN, NaN) at breaks; empty if there is no such line."""
    for line in axes.get_lines():
        if line.get_label() == label:
            return list(zip(line.get_xdata(), line.get_ydata()))
    return []


def points_and_parts(line):
    """Number of points, and number of parts between breaks."""
    is_there = [not math.isnan(x) for x, _ in line]
    return sum(is_there), sum(here and not before for before, here in zip([False, *is_there], is_there))


@unittest.skipIf(branches is None, "python3-matplotlib is not installed")
class PlotTest(unittest.TestCase):
    """Tests with a folder of tables."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        (self.folder / "run.json").write_text("{}", encoding="utf-8")
        self.write_parameters(PARAMETERS)

    def write_parameters(self, sections):
        text = "".join(f"subsection {section}\n" + "".join(f"  set {name} = {value}\n" for name, value in values.items()) + "end\n"
                       for section, values in sections.items())
        (self.folder / "parameters.prm").write_text(text, encoding="utf-8")

    def write(self, name, columns, rows):
        lines = [",".join(columns), *(",".join(str(cell) for cell in row) for row in rows)]
        (self.folder / f"{name}.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")

    def write_chart(self, suffix="", label_of_second="A0-4 +", with_threshold=True, undecided=()):
        """Writes a chart with two branches that coalesce at 0.25, and a third branch that is absent at 0.2."""
        rows = []
        for k in range(5):
            mu, root = 0.1 * k, math.sqrt(abs(0.25 - 0.1 * k))
            pair = [(10 - root, 0), (10 + root, 0)] if mu < 0.25 else [(10, root), (10, -root)]
            for branch, (frequency, rate) in enumerate(pair, start=1):
                label = "A0-4 -" if branch == 1 else label_of_second
                verdict = "undecided" if (branch, k) in undecided else "unstable" if rate > 0 else "stable"
                rows.append((mu, branch, label, frequency, rate, verdict, int(rate > 0)))
            if k != 2:
                rows.append((mu, 3, "F1", 50, -1, "undecided" if (3, k) in undecided else "stable", 0))
        self.write("branches" + suffix, BRANCHES, rows)
        events = [(0.25, "onset", 1, 2, 10), (0.3, "onset", 1, "", 2 * BAND)] if with_threshold else []
        self.write("thresholds" + suffix, THRESHOLDS, events)
        self.write("counts" + suffix, ("mu [-]",), [(0.1 * k,) for k in range(5)])

    def charts(self):
        return charts.read_charts(Results(self.folder))


class Charts(PlotTest):

    def test_curves_break_and_meet_at_thresholds(self):
        self.write_chart()
        upper, lower = branches.overview_figure(self.charts(), BAND).axes
        # Both branches of the pair have five points and the threshold; the third branch has two parts
        everything = line_of(upper, charts.WITHOUT)
        self.assertEqual(points_and_parts(everything), (6 + 6 + 4, 4))
        self.assertEqual(max(y for _, y in everything if not math.isnan(y)), 50)
        # One branch of the pair grows beyond the threshold
        growing = line_of(lower, "growing, " + charts.WITHOUT)
        self.assertEqual(points_and_parts(growing), (3, 1))
        self.assertEqual(growing[0], (0.25, 0.0))
        self.assertAlmostEqual(growing[2][1], math.sqrt(0.15))
        # The threshold above the band is omitted
        self.assertEqual(line_of(upper, "onset"), [(0.25, 10)])
        # Only families with growing modes are drawn
        figures = branches.family_figures(self.charts())
        self.assertEqual(list(figures), ["sweep_families"])
        upper, lower = figures["sweep_families"].axes
        self.assertEqual([axes.get_title() for axes in (upper, lower)], ["A0-4", "A0-4"])
        self.assertEqual(points_and_parts(line_of(upper, charts.WITHOUT)), (12, 2))
        self.assertEqual([text.get_text() for text in upper.texts], ["A0-4 -", "A0-4 +"])

    def test_one_value(self):
        """A single point needs a marker to be visible."""
        self.write("branches", BRANCHES, [(0.4, 1, "F1", 50, 0.5, "unstable", 1)])
        self.write("thresholds", THRESHOLDS, [])
        self.write("counts", ("mu [-]",), [(0.4,)])
        for figure in branches.figures(Results(self.folder)).values():
            for line in figure.axes[0].get_lines():
                self.assertTrue(line.get_gid() == "zero" or line.get_marker() not in ("", "None"), line)


class ComplexPlane(PlotTest):
    COLUMNS = ("mu [-]", "radial dissipation", "label", "frequency [Hz]", "divergence rate [%]", "verdict")

    def sweep_axes(self):
        return complex_plane.sweep_figure(Results(self.folder), self.charts(), BAND).axes

    def test_rings_squares_and_names(self):
        """If no values are requested, the last value of the sweep is drawn; undecided modes have no ring."""
        for undecided, growing in (((3, 4), [(0.010, math.sqrt(0.15))]), ((1, 4), [])):
            self.write_chart(undecided=[undecided])
            axes, = self.sweep_axes()
            self.assertEqual(axes.get_title(), "\u03bc = 0.4")
            self.assertEqual(line_of(axes, "growing"), growing)
            self.assertEqual(line_of(axes, "undecided"), [(0.050, -1.0)] if growing else [(0.010, math.sqrt(0.15))])
            self.assertEqual([text.get_text() for text in axes.texts], ["A0-4 -"] if growing else [])

    def test_values_that_are_asked_for(self):
        """Friction coefficients in the table complex_plane need not be values of the sweep."""
        self.write_chart()
        self.write("complex_plane", self.COLUMNS, [(0.33, "published", "A0-4 +", 20, 0.5, "unstable"),
                                                   (0.33, "none", "A0-4 +", 21, 0.7, "unstable"),
                                                   (0.33, "none", "F1", 30, 0, "stable"), (0.12, "published", "F1", 31, 0.2, "undecided")])
        first, second = self.sweep_axes()
        self.assertEqual([axes.get_title() for axes in (first, second)], ["\u03bc = 0.33", "\u03bc = 0.12"])
        self.assertEqual(line_of(first, charts.WITHOUT), [(0.021, 0.7), (0.030, 0.0)])
        self.assertEqual(line_of(first, charts.WITH), [(0.020, 0.5)])
        self.assertEqual(sorted(line_of(first, "growing")), [(0.020, 0.5), (0.021, 0.7)])
        self.assertEqual(line_of(second, "growing"), [])
        self.assertEqual(line_of(second, "undecided"), [(0.031, 0.2)])

    def test_faster_decay_lies_at_the_edge(self):
        modes = [charts.Mode("F1", 50, 0.1, True, False), charts.Mode("T1", 60, -5, False, False)]
        picture = style.Picture("", 1, 1)
        complex_plane.draw(picture.panels[0], picture.size, "", [complex_plane.Series("run", modes)], BAND)
        (x, y), = line_of(picture.panels[0], "faster decay, run")
        self.assertAlmostEqual(x, 0.060)
        self.assertAlmostEqual(y, -0.25)
        self.assertEqual(len(line_of(picture.panels[0], "run")), 1)

    def test_static_divergence_is_said(self):
        columns = ("label", "frequency [Hz]", "divergence rate [%]", "unstable [-]")
        self.write("complex_modes", columns, [("F1", 50, 0.1, 1), ("F1", 51, -0.1, 0)])
        self.write("real_eigenvalues", ("growth rate [1/s]", "kind"), [(12.5, "static divergence"), (-3, "decay")])
        axes, = complex_plane.figures(Results(self.folder))["complex_plane"].axes
        self.assertTrue(any("1 real" in text.get_text() and "12.5" in text.get_text() for text in axes.texts))


class Maps(PlotTest):
    COLUMNS = ("mu [-]", "load per side [N]", "unstable modes [-]", "undecided modes [-]", "label", "divergence rate [%]",
               "open contact nodes [-]")

    def read(self, change=lambda mu, load, row: row):
        """Reads a map that, for the larger load only, is unstable for mu >= 0.2 and undecided at 0.1."""
        rows = []
        for load in (100, 1000):
            for mu in (0, 0.1, 0.2, 0.3):
                grows, is_loaded = load > 500 and mu > 0.15, load > 500 and mu > 0.05
                rows.append(change(mu, load, (mu, load, 2 if grows else 0, int(is_loaded), "F1" if grows else "", 3 if grows else 0, 0)))
        self.write("map", self.COLUMNS, rows)
        return Table(self.folder / "map.csv")

    def patches(self, axes, label):
        return [patch.get_bbox().x0 + 0.5 * patch.get_width() for patch in axes.patches if patch.get_label() == label]

    def test_cells_and_limits(self):
        table = self.read()
        panel, counts, *bars = stability_map.map_figure(table).axes
        self.assertEqual([bar.get_ylabel() for bar in bars], [style.DIVERGENCE, "unstable modes [-]"])
        for axes, value in ((panel, 3), (counts, 2)):
            self.assertEqual(axes.get_ylabel(), "load per side [N]")
            self.assertEqual([cell for cell in axes.collections[0].get_array().ravel().tolist() if cell is not None], [value, value])
            undecided, = self.patches(axes, "undecided")
            self.assertAlmostEqual(undecided, 0.1)
            self.assertEqual(self.patches(axes, "not computed"), [])
            self.assertEqual(len(self.patches(axes, "stable")), 5)
            # The boundary runs along one vertical and two horizontal cell edges
            self.assertEqual(points_and_parts(line_of(axes, "stability boundary")), (2 + 3, 2))
            self.assertEqual(line_of(axes, "change in the contact set"), [])
        self.assertEqual([text.get_text() for text in panel.texts], ["F1"])
        self.assertEqual([text.get_text() for text in counts.texts], ["2", "2"])
        # Edges are halfway between neighbours on the scale of the axis
        edges = stability_map.StabilityMap(table)
        self.assertAlmostEqual(edges.x_edges[2], 0.15)
        self.assertAlmostEqual(edges.y_edges[1], math.sqrt(1e5))
        self.assertEqual(edges.x_edges[0], 0)

    def test_contact_sets_and_missing_cells(self):
        for is_missing in (False, True):
            def change(mu, load, row, is_missing=is_missing):
                if (mu, load) != (0, 100):
                    return row
                return (mu, load, "", "", "", "", 4) if is_missing else (*row[:-1], 4)

            axes = stability_map.map_figure(self.read(change)).axes[0]
            self.assertEqual(points_and_parts(line_of(axes, "change in the contact set")), (0, 0) if is_missing else (2 + 2, 2))
            self.assertEqual(len(self.patches(axes, "not computed")), int(is_missing))


class Reduction(PlotTest):
    def write_bases(self, errors):
        """Writes a table of one group; `errors`: rows of basis, component modes, solution time and the four errors."""
        self.write("reduction_bases", ("basis", "component modes", "build time [s]", "solve time [s]"),
                   [(name, truncation, 10 * seconds, seconds) for name, truncation, seconds, *_ in errors])
        self.write("reduction_errors", ("basis", "component modes", "group", "res [-]", "mac [-]", "frq [-]", "div [-]"),
                   [(name, truncation, "disc", *values) for name, truncation, _, *values in errors])
        return reduction.read_candidates(Results(self.folder))

    def test_zero_lies_at_the_floor(self):
        candidates = self.write_bases([("free", "", 1, 1e-3, 1e-3, 1e-5, 0), ("real", "", 2, 1e-3, 1e-3, 1e-4, 1e-6)])
        axes, = reduction.error_figure(candidates).axes
        self.assertEqual([y for _, y in line_of(axes, "free")], [1e-3, 1e-3, 1e-5, reduction.FLOOR])
        self.assertEqual(line_of(axes, reduction.AT_FLOOR)[0][1], reduction.FLOOR)
        self.assertEqual([text.get_text() for text in axes.get_xticklabels()], list(reduction.CRITERIA.values()))

    def test_pareto_front(self):
        rows = [("a", "", 1, 1, 1, 1, 1e-2), ("b", "", 3, 1, 1, 1, 1e-5), ("c", "", 2, 1, 1, 1, 1e-1)]
        axes = reduction.cost_figure(self.write_bases(rows), True).axes
        self.assertEqual(line_of(axes[0], "Pareto front"), [(1, 1e-2), (3, 1e-5)])
        self.assertEqual(line_of(axes[1], "b"), [(30, 1e-5)])


class Refusals(PlotTest):
    def refused(self, *words):
        with self.assertRaises(Error) as caught:
            self.charts()
        for word in words:
            self.assertIn(word, str(caught.exception))

    def test_tables(self):
        self.write_chart()
        file = self.folder / "branches.csv"
        text = file.read_text(encoding="utf-8")
        file.write_text(text.replace("growing [-]", "other"), encoding="utf-8")
        self.refused("no column `growing [-]`", "branches.csv")
        file.write_text(text.replace("9.5,", "9.5x,", 1), encoding="utf-8")
        self.refused("`9.5x` is not a number", "line 2", "column `frequency [Hz]`")
        file.write_text(text[:-4] + "\n", encoding="utf-8")
        self.refused("one cell for each column", f"line {len(text.splitlines())}")
        file.write_text(text, encoding="utf-8")
        self.write_parameters({"Operation": {"Radial dissipation": "none"}})
        self.refused("Band/Maximum frequency", "parameters.prm")


if __name__ == "__main__":
    unittest.main()
