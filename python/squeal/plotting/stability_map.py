# SPDX-License-Identifier: GPL-3.0-or-later

"""Stability versus the two parameters of a map."""

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, LinearSegmentedColormap, Normalize
from matplotlib.patches import Rectangle
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from squeal.plotting import style
from squeal.plotting.stability_cells import COLOURS, StabilityMap, limits, logarithmic_ticks, place_of_name, regions
from squeal.results import axis_title

SCALE = LinearSegmentedColormap.from_list("growth", COLOURS)
MOST_STEPS = 12  # maximum number of unstable modes for which each number has its own colour


def draw_cells(panel, stability, values, norm):
    """Draws unstable cells in colour, stable cells in white, and undecided and missing cells with hatching."""
    x, y = stability.x_edges, stability.y_edges
    shown = np.where(stability.is_unstable, values, np.nan)
    panel.pcolormesh(x, y, np.ma.masked_invalid(shown), cmap=SCALE, norm=norm, edgecolors="face", linewidth=0.3)
    looks = (("stable", stability.is_known & ~stability.is_unstable & ~stability.is_undecided, "white", None),
             ("undecided", stability.is_undecided, "#bbbbbb", "///"), ("not computed", ~stability.is_known, "white", "xxx"))
    for label, mask, colour, hatch in looks:
        for row, column in stability.cells():
            if mask[row, column]:
                panel.add_patch(Rectangle((x[column], y[row]), x[column + 1] - x[column], y[row + 1] - y[row], facecolor=colour,
                                          hatch=hatch, edgecolor="#999999", linewidth=0.3, label=label))


def draw_limits(panel, stability, with_leaders):
    """Draws lines between cells that differ in stability, in the number of open nodes or in the most unstable mode."""
    is_unstable, leader, n_open = stability.is_unstable, stability.leader, stability.n_open
    lines = [("change in the contact set", {"linewidth": 1.4, "linestyle": (0, (5, 3))}, lambda a, b: n_open[a] != n_open[b]),
             ("stability boundary", {"linewidth": 2.8}, lambda a, b: is_unstable[a] != is_unstable[b])]
    if with_leaders:
        lines.insert(0, ("change in the most unstable mode", {"linewidth": 0.9},
                         lambda a, b: is_unstable[a] and is_unstable[b] and leader[a] != leader[b]))
    for label, look, differ in lines:
        style.draw_points(panel, limits(stability, differ), color=style.BLACK, label=label, **{"linestyle": "-", **look})


def draw_leaders(panel, stability):
    """Labels each region with its most unstable mode, if there is space."""
    for region in regions(stability):
        name = stability.leader[region[0]]
        cell = place_of_name(region, stability.rate.shape, len(name))
        if cell:
            panel.text(stability.mus[cell[1]], stability.values[cell[0]], name, horizontalalignment="center", verticalalignment="center")


def draw_counts(panel, stability, size):
    """Writes the number of unstable modes into the cells, if there is space."""
    n_rows, n_columns = stability.rate.shape
    if (size[0] - 1.7) * style.INCH / n_columns < 1.5 * style.SMALL or (size[1] - 1.0) * style.INCH / n_rows < 1.2 * style.SMALL:
        return
    for row, column in stability.cells():
        if stability.is_unstable[row, column]:
            panel.text(stability.mus[column], stability.values[row], f"{stability.n_unstable[row, column]:.0f}", fontsize=style.SMALL - 1,
                       horizontalalignment="center", verticalalignment="center")


def prepare(panel, stability, title):
    style.prepare(panel, title, axis_title(stability.abscissa), stability.ordinate)
    panel.grid(False)
    for spine in panel.spines.values():
        spine.set_visible(True)
    panel.set(xlim=stability.x_edges[[0, -1]], yscale="log" if stability.is_logarithmic else "linear")
    panel.set_ylim(stability.y_edges[[0, -1]])
    if stability.is_logarithmic:
        panel.yaxis.set_major_locator(FixedLocator(logarithmic_ticks(*panel.get_ylim())))
        panel.yaxis.set_minor_locator(NullLocator())
        panel.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))


def map_figure(table):
    """A panel for the divergence rate of the most unstable mode, and one for the number of unstable modes."""
    stability = StabilityMap(table)
    picture = style.Picture(f"Stability versus {axis_title(stability.abscissa).split(' [')[0]} and {stability.ordinate.split(' [')[0]}", 2, 2, (6.2, 4.6))
    rates, counts = picture.panels
    largest = np.where(stability.is_unstable, stability.rate, 0.0).max()
    n_largest = int(max(1, np.nan_to_num(stability.n_unstable).max()))
    rate_norm = Normalize(0, largest or 1.0)
    count_norm = (BoundaryNorm(np.arange(0.5, n_largest + 1), SCALE.N) if n_largest <= MOST_STEPS else Normalize(0.5, n_largest + 0.5))
    for panel, title, values, norm, label in ((rates, "Most unstable mode", stability.rate, rate_norm, style.DIVERGENCE),
                                              (counts, "Number of unstable modes", stability.n_unstable, count_norm, "unstable modes [-]")):
        prepare(panel, stability, title)
        draw_cells(panel, stability, values, norm)
        draw_limits(panel, stability, panel is rates)
        scale = picture.figure.colorbar(ScalarMappable(norm, SCALE), ax=panel, label=label)
        if norm is count_norm:
            scale.set_ticks([tick for tick in range(1, n_largest + 1) if n_largest <= MOST_STEPS or tick % 2 == 0])
            scale.ax.minorticks_off()
    draw_leaders(rates, stability)
    draw_counts(counts, stability, picture.size)
    return picture.add_key()


def figures(results):
    return {"map": map_figure(results.table("map"))}
