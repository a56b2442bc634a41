"""Stability over the friction coefficient and the load or the rotation speed."""

import collections
import math

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, LinearSegmentedColormap, Normalize
from matplotlib.patches import Rectangle
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from plotting import style

# From pale to dark, without white and grey, which cells of other meanings have; black texts are legible on all of it.
SCALE = LinearSegmentedColormap.from_list("growth", ["#fff3c4", "#fdd27f", "#f9a052", "#e8673a", "#c43a24"])
MOST_STEPS = 12  # numbers of modes up to this have a colour each
ISOLATED = 0.05  # half-width of the cell of a value without neighbours
WIDE = 1e4  # ratio of the ends of a logarithmic axis from which on only powers of ten are named
ROOM_OF_LETTER, ROOM_OF_LINE = 0.02, 0.04  # shares of a panel

ORDINATES = ("load per side [N]", "rotation speed [rad/s]")


class StabilityMap:
    """The cells of a map as arrays, rows by load or speed, columns by friction coefficient."""

    def __init__(self, table):
        self.ordinate = next((name for name in ORDINATES if name in table.columns), ORDINATES[0])
        abscissae, ordinates = table.numbers("mu [-]"), table.numbers(self.ordinate)
        self.mus, self.values = sorted(set(abscissae)), sorted(set(ordinates))
        shape = len(self.values), len(self.mus)
        place = [(self.values.index(value), self.mus.index(mu)) for mu, value in zip(abscissae, ordinates)]

        def array(cells, empty):
            result = np.full(shape, empty, dtype=object if isinstance(empty, str) else float)
            for (row, column), cell in zip(place, cells):
                result[row, column] = cell
            return result

        self.rate = array(table.numbers("divergence rate [%]"), math.nan)
        self.n_unstable = array(table.numbers("unstable modes [-]"), math.nan)
        self.n_undecided = array(table.numbers("undecided modes [-]"), math.nan)
        self.n_open = array(table.numbers("open contact nodes [-]"), math.nan)
        self.leader = array(table.texts("label"), "")
        self.is_known = ~np.isnan(self.n_unstable)
        self.is_unstable = np.nan_to_num(self.n_unstable) > 0
        self.is_undecided = self.is_known & ~self.is_unstable & (np.nan_to_num(self.n_undecided) > 0)
        self.x_edges, self.y_edges = cell_edges(self.mus, False), cell_edges(self.values, True)

    def cells(self):
        return [(row, column) for row in range(len(self.values)) for column in range(len(self.mus))]


def cell_edges(values, logarithmic):
    """Edges half-way between values, the outer ones as far from their value; not across zero."""
    v = np.log(values) if logarithmic else np.asarray(values)
    if len(v) > 1:
        edges = np.concatenate([[1.5 * v[0] - 0.5 * v[1]], 0.5 * (v[:-1] + v[1:]), [1.5 * v[-1] - 0.5 * v[-2]]])
    else:
        edges = np.array([v[0] - ISOLATED, v[0] + ISOLATED])
    edges = np.exp(edges) if logarithmic else edges
    if values[0] >= 0:
        edges[0] = max(edges[0], 0.0)
    return edges


def logarithmic_ticks(first, last):
    """1, 2, 5, 10, ... within a range; powers of ten alone if it is wide."""
    digits = (1, 2, 5) if last < WIDE * first else (1,)
    powers = range(math.floor(math.log10(first)), math.floor(math.log10(last)) + 1)
    return [digit * 10.0**power for power in powers for digit in digits if first <= digit * 10.0**power <= last]


def limits(stability, differ):
    """Edges between known cells of which differ(cell, other) is true, as a line broken by NaN; edges in a row are one line."""
    lines = []

    def follow(ends_of, pairs):
        for (start, end), (cell, other) in zip(ends_of, pairs):
            if stability.is_known[cell] and stability.is_known[other] and differ(cell, other):
                if not lines or math.isnan(lines[-1][0]):
                    lines.append(start)
                lines.append(end)
            elif lines and not math.isnan(lines[-1][0]):
                lines.append((math.nan, math.nan))
        if lines and not math.isnan(lines[-1][0]):
            lines.append((math.nan, math.nan))

    x, y = stability.x_edges, stability.y_edges
    n_rows, n_columns = stability.rate.shape
    for column in range(n_columns - 1):
        follow([((x[column + 1], y[row]), (x[column + 1], y[row + 1])) for row in range(n_rows)],
               [((row, column), (row, column + 1)) for row in range(n_rows)])
    for row in range(n_rows - 1):
        follow([((x[column], y[row + 1]), (x[column + 1], y[row + 1])) for column in range(n_columns)],
               [((row, column), (row + 1, column)) for column in range(n_columns)])
    return lines


def regions(stability):
    """Connected unstable cells with the same most unstable mode."""
    left = {cell for cell in stability.cells() if stability.is_unstable[cell] and stability.leader[cell]}
    while left:
        queue = collections.deque([min(left)])
        left.remove(queue[0])
        region = []
        while queue:
            row, column = queue.popleft()
            region.append((row, column))
            for other in ((row - 1, column), (row + 1, column), (row, column - 1), (row, column + 1)):
                if other in left and stability.leader[other] == stability.leader[row, column]:
                    left.remove(other)
                    queue.append(other)
        yield region


def place_of_name(region, shape, length):
    """The cell of a region farthest from its rim, of several the one nearest to its middle; None without room for the name."""
    inside = set(region)
    middle = np.mean(region, axis=0)

    def reach(cell, row_step, column_step):
        steps = 0
        while (cell[0] + steps * row_step, cell[1] + steps * column_step) in inside:
            steps += 1
        return steps

    best = None
    for cell in region:
        width = (2 * min(reach(cell, 0, 1), reach(cell, 0, -1)) - 1) / shape[1]
        height = (2 * min(reach(cell, 1, 0), reach(cell, -1, 0)) - 1) / shape[0]
        distance = math.hypot((cell[0] - middle[0]) / shape[0], (cell[1] - middle[1]) / shape[1])
        if width > ROOM_OF_LETTER * length and height > ROOM_OF_LINE:
            best = min(best or (math.inf, 0, cell), (-min(width, height), distance, cell))
    return best[2] if best else None


def draw_cells(panel, stability, values, norm):
    """Unstable cells in colour; stable ones white, undecided and missing ones hatched."""
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
    """Lines between cells that differ in stability, contact set or most unstable mode."""
    is_unstable, leader, n_open = stability.is_unstable, stability.leader, stability.n_open
    lines = [("change of the contact set", {"linewidth": 1.4, "linestyle": (0, (5, 3))}, lambda a, b: n_open[a] != n_open[b]),
             ("limit of stability", {"linewidth": 2.8}, lambda a, b: is_unstable[a] != is_unstable[b])]
    if with_leaders:
        lines.insert(0, ("change of the most unstable mode", {"linewidth": 0.9},
                         lambda a, b: is_unstable[a] and is_unstable[b] and leader[a] != leader[b]))
    for label, look, differ in lines:
        if edges := limits(stability, differ):
            panel.plot(*zip(*edges), color=style.BLACK, label=label, **look)


def draw_leaders(panel, stability):
    """The name of the most unstable mode in the middle of each region, if there is room."""
    for region in regions(stability):
        name = stability.leader[region[0]]
        cell = place_of_name(region, stability.rate.shape, len(name))
        if cell:
            panel.text(stability.mus[cell[1]], stability.values[cell[0]], name, horizontalalignment="center", verticalalignment="center")


def draw_counts(panel, stability, size):
    """Numbers in the cells, if there is room."""
    n_rows, n_columns = stability.rate.shape
    if (size[0] - 1.7) * style.INCH / n_columns < 1.5 * style.SMALL or (size[1] - 1.0) * style.INCH / n_rows < 1.2 * style.SMALL:
        return
    for row, column in stability.cells():
        if stability.is_unstable[row, column]:
            panel.text(stability.mus[column], stability.values[row], f"{stability.n_unstable[row, column]:.0f}", fontsize=style.SMALL - 1,
                       horizontalalignment="center", verticalalignment="center")


def prepare(panel, stability, title):
    style.prepare(panel, title, style.FRICTION, stability.ordinate)
    panel.grid(False)
    for spine in panel.spines.values():
        spine.set_visible(True)
    panel.set_yscale("log")
    panel.set_xlim(stability.x_edges[0], stability.x_edges[-1])
    panel.set_ylim(stability.y_edges[0], stability.y_edges[-1])
    panel.yaxis.set_major_locator(FixedLocator(logarithmic_ticks(*panel.get_ylim())))
    panel.yaxis.set_minor_locator(NullLocator())
    panel.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))


def map_figure(table):
    """Divergence rate of the most unstable mode, and number of unstable modes."""
    stability = StabilityMap(table)
    picture = style.Picture("Stability over friction coefficient and " + stability.ordinate.split(" [")[0], 2, 2, (6.2, 4.6))
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
    """Of a sweep with a map."""
    return {"map": map_figure(results.table("map"))} if results.has("map") and len(results.table("map")) > 0 else {}
