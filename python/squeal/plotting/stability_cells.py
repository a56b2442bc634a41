# SPDX-License-Identifier: GPL-3.0-or-later

"""Cells of a stability map: their edges and boundaries, regions with one leading mode, and positions of labels."""

import itertools
import math

import numpy as np
import scipy.ndimage

ISOLATED = 0.05  # half-width of the cell if there is only one value
WIDE = 1e4  # ratio of the ends of a logarithmic axis above which only powers of ten are labelled
ROOM_OF_LETTER, ROOM_OF_LINE = 0.02, 0.04  # size of a label as fractions of a panel

# From pale to dark, without white and grey, which mark other cells; black text is legible on every colour
COLOURS = ("#fff3c4", "#fdd27f", "#f9a052", "#e8673a", "#c43a24")
ORDINATES = ("load per side [N]", "rotation speed [rad/s]")


class StabilityMap:
    """The cells of a map as arrays, with rows for its second parameter and columns for its first."""

    def __init__(self, table):
        self.abscissa, self.ordinate = table.columns[:2]
        self.is_logarithmic = self.ordinate in ORDINATES  # values are geometrically spaced
        abscissae, ordinates = table.numbers(self.abscissa), table.numbers(self.ordinate)
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
        self.x_edges, self.y_edges = cell_edges(self.mus, False), cell_edges(self.values, self.is_logarithmic)

    def cells(self):
        return [(row, column) for row in range(len(self.values)) for column in range(len(self.mus))]


def cell_edges(values, logarithmic):
    """Cell edges halfway between values on the scale of the axis. Outer cells are symmetric about their values, but the
    first cell does not extend below zero unless its value is negative."""
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
    """1, 2, 5, 10, ... within a range; only powers of ten if it is wide."""
    digits = (1, 2, 5) if last < WIDE * first else (1,)
    powers = range(math.floor(math.log10(first)), math.floor(math.log10(last)) + 1)
    return [digit * 10.0**power for power in powers for digit in digits if first <= digit * 10.0**power <= last]


def limits(stability, differ):
    """Edges between known cells for which differ(cell, other) is true, as lines separated by NaN; adjacent edges are
    joined."""
    x, y = stability.x_edges, stability.y_edges
    n_rows, n_columns = stability.rate.shape
    # (start, end, cell, other) of the edges on each vertical and horizontal grid line
    grid_lines = [[((x[j + 1], y[i]), (x[j + 1], y[i + 1]), (i, j), (i, j + 1)) for i in range(n_rows)] for j in range(n_columns - 1)]
    grid_lines += [[((x[j], y[i + 1]), (x[j + 1], y[i + 1]), (i, j), (i + 1, j)) for j in range(n_columns)] for i in range(n_rows - 1)]

    def is_limit(edge):
        _, _, cell, other = edge
        return bool(stability.is_known[cell] and stability.is_known[other] and differ(cell, other))

    lines = []
    for grid_line in grid_lines:
        for found, edges in itertools.groupby(grid_line, is_limit):
            if found:
                starts, ends, *_ = zip(*edges)
                lines += [starts[0], *ends, (math.nan, math.nan)]
    return lines


def regions(stability):
    """Connected regions of unstable cells with the same most unstable mode."""
    for name in sorted(set(stability.leader[stability.is_unstable]) - {""}):
        numbers, n_regions = scipy.ndimage.label(stability.is_unstable & (stability.leader == name))
        for number in range(1, n_regions + 1):
            yield [(int(row), int(column)) for row, column in np.argwhere(numbers == number)]


def place_of_name(region, shape, length):
    """The cell of a region farthest from the boundary and, among equals, nearest to the centre; None if there is no
    space for the label."""
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
