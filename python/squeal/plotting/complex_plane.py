# SPDX-License-Identifier: GPL-3.0-or-later

"""The complex plane, as in figure 6 of the paper: divergence rate versus frequency."""

import collections
import itertools

from matplotlib.transforms import Bbox

from squeal.plotting import charts, style
from squeal.results import symbol

ROUNDING = 1e-6  # largest absolute divergence rate that is treated as zero [%]
SAME_PLACE = 0.05  # fraction of the width within which modes of two series share a label

Series = collections.namedtuple("Series", "title modes")  # modes with or without radial dissipation


class NameRoom:
    """Finds positions for labels next to marks without overlaps, in points of the panel."""

    LETTER, LINE, GAP = 0.58 * style.SMALL, 1.25 * style.SMALL, 5.0

    def __init__(self, width, marks):
        self.width = width
        self.boxes = [Bbox.from_extents(x - self.GAP, y - self.GAP, x + self.GAP, y + self.GAP) for x, y in marks]

    def find(self, x, y, text):
        """Offset and horizontal alignment of a text next to a point; None if there is no space."""
        length = self.LETTER * len(text)
        for low, alignment in itertools.product((y, y - self.LINE), ("left", "right")):
            left = x + self.GAP if alignment == "left" else x - self.GAP - length
            box = Bbox.from_bounds(left, low, length, self.LINE)
            if left > 0 and box.x1 < self.width and not box.count_overlaps(self.boxes):
                self.boxes.append(box)
                return (self.GAP if alignment == "left" else -self.GAP, low - y + 0.3 * self.LINE), alignment
        return None


class Limits:
    """Limits of the axis of the divergence rate; modes that decay much faster than any mode grows are drawn at the
    lower edge."""

    def __init__(self, series):
        rates = [mode.divergence for one in series for mode in one.modes] + [0.0]
        highest, lowest = max(rates), min(rates)
        is_cut = highest > ROUNDING and lowest < -4 * highest
        self.edge = -2.5 * highest if is_cut else lowest
        if is_cut:
            self.ends = 1.08 * self.edge, 1.25 * highest
        elif highest > ROUNDING:
            self.ends = 1.15 * self.edge - 0.1 * highest, 1.25 * highest
        elif lowest < -ROUNDING:
            self.ends = 1.15 * lowest, -0.15 * lowest
        else:
            self.ends = -1, 1


class Plane:
    """A panel and its limits."""

    def __init__(self, panel, size, series, band_end, limits):
        self.panel, self.series, self.edge = panel, series, limits.edge
        panel.set_ylim(*limits.ends)
        panel.set_xlim(0, 1e-3 * band_end)
        # Size of the axes without labels and title
        self.points = ((size[0] - 0.9) * style.INCH, (size[1] - 0.9) * style.INCH)

    def place(self, mode):
        """Position of a mode in the panel [kHz, %]."""
        return 1e-3 * mode.frequency, max(mode.divergence, self.edge)

    def in_points(self, mode):
        x, y = self.place(mode)
        low, high = self.panel.get_ylim()
        return x / self.panel.get_xlim()[1] * self.points[0], (y - low) / (high - low) * self.points[1]

    def draw_modes(self):
        looks = ({"color": style.BLACK, "marker": "o", "markersize": 3.5}, {"color": style.GREY, "marker": "D", "markersize": 3.5})
        for number, (one, look) in enumerate(zip(self.series, looks)):
            inside = [self.place(mode) for mode in one.modes if mode.divergence >= self.edge]
            faster = [self.place(mode) for mode in one.modes if mode.divergence < self.edge]
            style.draw_points(self.panel, inside, label=one.title, zorder=4 - number, **look)
            style.draw_points(self.panel, faster, label="faster decay, " + one.title, zorder=4 - number, color=look["color"], marker="v",
                              markersize=6, clip_on=False)

    def draw_marks(self):
        """Draws rings around growing modes and squares around undecided modes."""
        growing = [self.place(mode) for one in self.series for mode in one.modes if mode.grows and not mode.is_undecided]
        undecided = [self.place(mode) for one in self.series for mode in one.modes if mode.is_undecided]
        for places, label, marker, colour in ((growing, "growing", "o", style.VERMILLION), (undecided, "undecided", "s", style.BLUE)):
            style.draw_points(self.panel, places, label=label, marker=marker, markersize=9, markerfacecolor="none", color=colour,
                              markeredgewidth=1.3, zorder=5)

    def draw_names(self):
        """Labels growing modes where there is space; the fastest growing modes come first."""
        room, named = NameRoom(self.points[0], [self.in_points(mode) for one in self.series for mode in one.modes]), []
        for one in self.series:
            for mode in sorted((mode for mode in one.modes if mode.grows and not mode.is_undecided), key=lambda mode: -mode.divergence):
                x, y = self.in_points(mode)
                # Do not repeat a label if a mode of the other series at nearly the same frequency has it already
                serves = any(other is not one and name == mode.label and abs(x - place) < SAME_PLACE * self.points[0]
                             for other, name, place in named)
                if not serves and (found := room.find(x, y, mode.label)):
                    offset, alignment = found
                    self.panel.annotate(mode.label, self.place(mode), xytext=offset, textcoords="offset points", fontsize=style.SMALL,
                                        horizontalalignment=alignment)
                    named.append((one, mode.label, x))


def draw(panel, size, title, series, band_end, limits=None):
    """Draws the modes up to `band_end` [Hz] into a panel of a picture; panels may share `limits`."""
    style.prepare(panel, title, "frequency [kHz]", style.DIVERGENCE)
    style.zero_line(panel)
    plane = Plane(panel, size, series, band_end, limits or Limits(series))
    plane.draw_modes()
    plane.draw_marks()
    plane.draw_names()


def planes_of_table(table):
    """Value of the swept parameter -> series, in the order of the table complex_plane; series without radial dissipation come
    first."""
    planes = {}
    columns = (table.numbers(table.parameter), table.texts("radial dissipation"), table.texts("label"), table.numbers("frequency [Hz]"),
               table.numbers("divergence rate [%]"), table.texts("verdict"))
    for mu, dissipation, label, frequency, divergence, verdict in zip(*columns):
        title = charts.WITHOUT if dissipation == "none" else charts.WITH
        mode = charts.Mode(label, frequency, divergence, verdict == "unstable", verdict == "undecided")
        planes.setdefault(mu, {}).setdefault(title, []).append(mode)
    return {mu: [Series(title, found[title]) for title in (charts.WITHOUT, charts.WITH) if title in found] for mu, found in planes.items()}


def last_plane(all_charts):
    """Series at the last value of a sweep."""
    mu = max(mu for chart in all_charts for mu in chart.mus)
    return {mu: [Series(chart.title, chart.modes_at(mu)) for chart in all_charts if mu in chart.mus]}


def sweep_figure(results, all_charts, band_end):
    """A panel for each value in the table complex_plane or, without this table, for the last value of the sweep."""
    planes = planes_of_table(results.table("complex_plane")) if results.has("complex_plane") else last_plane(all_charts)
    picture = style.Picture("Modes in the complex plane", len(planes), 2, (5.2, 3.6))
    for panel, (mu, series) in zip(picture.panels, planes.items()):
        draw(panel, picture.size, f"{symbol(all_charts[0].parameter)} = {mu:.6g}", series, band_end)
    return picture.add_key()


def series_of_run(results):
    """Modes of a run at one friction coefficient."""
    title, table = charts.WITHOUT if results.parameter("Operation/Radial dissipation") == "none" else charts.WITH, results.table("complex_modes")
    columns = (table.texts("label"), table.numbers("frequency [Hz]"), table.numbers("divergence rate [%]"), table.flags("unstable [-]"))
    return Series(title, [charts.Mode(*row, False) for row in zip(*columns)])


def paper_figure(without, damped):
    """Figure 6 of the paper: results without and with radial dissipation side by side on equal axes."""
    series = [series_of_run(results) for results in (without, damped)]
    picture = style.Picture(f"Stability charts for \u03bc = {without.number('Operation/Friction coefficient'):g}", 2, 2, (5.6, 4.4))
    for panel, caption, one in zip(picture.panels, ("(a) $C_b = 0$", "(b) $C_b \\neq 0$"), series):
        draw(panel, picture.size, caption, [one], without.number("Band/Maximum frequency"), Limits(series))
    return picture.add_key()


def run_figure(results):
    """Figure of the complex modes of a run at one friction coefficient."""
    picture = style.Picture("Modes in the complex plane", 1, 1, (7.0, 4.4))
    panel, = picture.panels
    title = f"\u03bc = {results.number('Operation/Friction coefficient'):g}"
    draw(panel, picture.size, title, [series_of_run(results)], results.number("Band/Maximum frequency"))
    rates = results.table("real_eigenvalues").numbers("growth rate [1/s]") if results.has("real_eigenvalues") else []
    if growing := [rate for rate in rates if rate > 0]:
        text = f"and {len(growing)} real \u03bb > 0 (static divergence), up to {max(growing):.4g} 1/s"
        panel.text(0.02, 0.97, text, transform=panel.transAxes, verticalalignment="top", color=style.VERMILLION)
    return picture.add_key()


def figures(results):
    return {"complex_plane": run_figure(results)}
