# SPDX-License-Identifier: GPL-3.0-or-later

"""Common style of all plots: colours, markers, sizes, and the legend below the panels."""

import math

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

# Colours for readers with colour-vision deficiencies, based on Okabe and Ito; markers, widths and dashes carry the same
# information
BLACK, GREY, BLUE, VERMILLION, GREEN = "#000000", "#8c8c8c", "#0072b2", "#d55e00", "#009e73"
PURPLE, ORANGE, SKY, BROWN = "#cc79a7", "#e69f00", "#56b4e9", "#7f5539"
SERIES = (BLACK, BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, BROWN)
MARKERS = ("o", "s", "^", "v", "D", "P", "X", "<", ">", "p", "*", "h")

FONT_SIZE, SMALL = 10, 8  # font sizes [points]
INCH = 72  # an inch [points]
BAR = 0.24  # height of a row of bars [inches]
WIDE = 1e3  # ratio of the ends of a cost axis above which only powers of ten are labelled
KEY_LINE, KEY_MARK, KEY_LETTER, TITLE = 0.22, 0.75, 0.063, 0.35  # line, mark, letter of the legend; title [inches]

FREQUENCY, DIVERGENCE = "frequency [Hz]", "divergence rate R/\u03c9 [%]"


def mark_of(number):
    """Colour, marker and face colour of a series: 12 styles with filled markers, then 12 with open markers."""
    colour = SERIES[number % len(SERIES)]
    return {"color": colour, "marker": MARKERS[number % len(MARKERS)],
            "markerfacecolor": "white" if number // len(MARKERS) % 2 else colour}


class Picture:
    """A grid of panels with a title above and one legend below; `size`: size of a panel with its labels [inches]."""

    def __init__(self, title, n_panels, n_columns, size=(4.6, 3.4)):
        self.size = size
        n_columns = min(n_columns, n_panels)
        n_rows = math.ceil(n_panels / n_columns)
        self.figure = Figure(figsize=(n_columns * size[0], n_rows * size[1] + TITLE), layout="constrained")
        FigureCanvasAgg(self.figure)
        grid = self.figure.subplots(n_rows, n_columns, squeeze=False)
        self.panels = list(grid.flat)[:n_panels]
        for unused in list(grid.flat)[n_panels:]:
            unused.remove()
        self.figure.suptitle(title, fontsize=FONT_SIZE + 2)

    def add_key(self):
        """Adds a legend below the panels in which every label occurs once; call after drawing."""
        entries = {}
        for panel in self.panels:
            for handle, label in zip(*panel.get_legend_handles_labels()):
                entries.setdefault(label, handle)
        width, height = self.figure.get_size_inches()
        strip = 0.08
        if entries:
            entry_width = KEY_MARK + KEY_LETTER * max(len(label) for label in entries)
            n_columns = min(len(entries), max(1, int(width / entry_width)))
            strip += math.ceil(len(entries) / n_columns) * KEY_LINE
            # Arrange entries by rows; matplotlib fills columns
            labels = list(entries)
            labels = [label for column in range(n_columns) for label in labels[column::n_columns]]
        self.figure.set_size_inches(width, height + strip)
        share = strip / (height + strip)
        if entries:
            self.figure.legend([entries[label] for label in labels], labels, loc="lower center", ncol=n_columns, frameon=False,
                               fontsize=FONT_SIZE - 1, borderaxespad=0.3, handlelength=2.6)
        self.figure.get_layout_engine().set(rect=(0, share, 1, 1 - share))
        return self.figure


def prepare(panel, title, x_label, y_label):
    """Sets title, labels and grid of a panel."""
    panel.set_title(title, fontsize=FONT_SIZE + 1)
    panel.set(xlabel=x_label, ylabel=y_label, axisbelow=True)
    panel.grid(color="#dddddd", linewidth=0.6)
    panel.spines[["top", "right"]].set_visible(False)


def draw_points(panel, points, **look):
    """Draws marks at the points, or a line through them; draws nothing if there are no points."""
    if points:
        panel.plot(*zip(*points), **{"linestyle": "none", **look})


def zero_line(panel):
    panel.axhline(0, color="#555555", linewidth=0.9, zorder=1, gid="zero")


def cost_axes(panel, costs):
    """Sets logarithmic axes for errors versus costs, with plain numbers on the cost axis."""
    panel.set_xscale("log")
    panel.set_yscale("log")
    panel.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5) if max(costs) < WIDE * min(costs) else (1,)))
    panel.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    panel.xaxis.set_minor_formatter(NullFormatter())


def draw_bars(panel, places, values, colour, label, is_hatched):
    """Draws horizontal bars in rows counted from the top; draws nothing if there are no values."""
    if places:
        panel.barh(places, values, height=0.62, color=colour, label=label, hatch="///" if is_hatched else None, edgecolor="white", linewidth=0)


def name_rows(panel, names):
    """Labels the rows of bars; names are empty if another panel shows them."""
    panel.set_ylim(len(names) - 0.4, -0.6)
    panel.set_yticks(range(len(names)), names, fontsize=SMALL)
    panel.grid(axis="y", visible=False)
