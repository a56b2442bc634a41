# SPDX-License-Identifier: GPL-3.0-or-later

"""A picture with colour scale, texts and colour bar, laid out in pixels. Requires python3-matplotlib."""

import math

import numpy as np
from matplotlib import colormaps
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

SIZE = (1600, 1000)
INK, GREY = "#212126", "#737378"
POINT = 0.72  # size of a pixel [points]
# Suitable for readers with colour-vision deficiencies. Pale colours mark zero; the colours of the phase are cyclic
ONE_SIGN, TWO_SIGNS, PHASE = colormaps["YlGnBu"], colormaps["RdBu_r"], colormaps["twilight"]


def nice_range(values):
    """Round limits of the values: starting at zero, or symmetric if some values are negative."""
    largest = abs(values).max() or 1.0
    unit = 10.0 ** math.floor(math.log10(largest))
    top = next(step for step in (1, 1.2, 1.6, 2, 2.4, 3, 4, 5, 6, 8, 10) if step * unit >= 0.999 * largest) * unit
    return (-top if values.min() < 0 else 0.0, top)


class Page:
    """A picture of a given size [pixels] with one colour scale; positions are fractions of the size from the lower left
    corner."""

    def __init__(self, colours, limits, size=SIZE):
        self.size, self.scale = size, ScalarMappable(Normalize(*limits), colours)
        self.figure = Figure(figsize=(size[0] / 100, size[1] / 100), dpi=100)
        FigureCanvasAgg(self.figure)

    def axes(self, left, bottom, right, top):
        """Axes without a frame between these positions."""
        axes = self.figure.add_axes((left, bottom, right - left, top - bottom))
        axes.set_axis_off()
        return axes

    def text(self, text, x, y, pixels=20, colour=GREY, **more):
        self.figure.text(x, y, text, fontsize=POINT * pixels, color=colour, **more)

    def title(self, text, x=0.03, y=0.945, pixels=30):
        self.text(text, x, y, pixels, INK, fontweight="bold")

    def colour_bar(self, caption):
        """Draws the colour bar at the lower edge, with five numbers."""
        axes = self.figure.add_axes((0.03, 48 / self.size[1], 0.4, 22 / self.size[1]))
        bar = self.figure.colorbar(self.scale, cax=axes, orientation="horizontal", ticks=np.linspace(*self.scale.get_clim(), 5), format="{x:.3g}")
        bar.outline.set_visible(False)
        axes.tick_params(length=0, labelsize=POINT * 20, labelcolor=INK)
        for label, alignment in zip(axes.get_xticklabels(), ("left", *3 * ["center"], "right")):
            label.set_horizontalalignment(alignment)
        self.text(caption, 0.03, 84 / self.size[1], 21, INK)

    def save(self, path, width=SIZE[0]):
        """Writes the page with a width of `width` pixels."""
        self.figure.savefig(path, dpi=100 * width / self.size[0])
