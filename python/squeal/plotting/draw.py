# SPDX-License-Identifier: GPL-3.0-or-later

"""Draws all plots of a run."""

import io

from squeal.errors import Error

DOTS_PER_INCH = 150
# The same tables give the same bytes
UNDATED = {"svg": {"Date": None}, "png": {}, "pdf": {"CreationDate": None}}


def figures(results):
    """All figures of a run by their names. Throws Error if its tables give none."""
    from squeal.plotting import accuracy, branches, complex_plane, designs, ingredients, reduction, robust_search, robustness, sensitivity, stability_map, updating

    found = {}
    for plots in (complex_plane, branches, stability_map, reduction, ingredients, sensitivity, accuracy, designs, robustness, robust_search, updating):
        found.update(plots.figures(results))
    if not found:
        raise Error("no table is there of which a plot is known", f"folder {results.folder}", "run squeal again")
    return found


def render(figure, ending):
    """The picture as bytes."""
    import matplotlib

    stream = io.BytesIO()
    with matplotlib.rc_context({"svg.hashsalt": "squeal"}):
        figure.savefig(stream, format=ending, dpi=DOTS_PER_INCH, metadata=UNDATED[ending])
    return stream.getvalue()
