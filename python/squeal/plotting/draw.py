# SPDX-License-Identifier: GPL-3.0-or-later

"""Draws all plots of a run."""

import importlib
import io

from squeal.errors import Error

DOTS_PER_INCH = 150
# Omit dates, so that identical tables give identical files
UNDATED = {"svg": {"Date": None}, "png": {}, "pdf": {"CreationDate": None}}

# Module that draws plots -> the table that it requires
PLOTS = {"complex_plane": "complex_modes", "branches": "branches", "stability_map": "map", "reduction": "reduction_errors",
         "ingredients": "ingredients", "sensitivity": "sensitivities", "accuracy": "accuracy", "designs": "designs",
         "robustness": "sample_modes", "robust_search": "best_design", "updating": "fit"}


def figures(results):
    """All figures of a run by name. Raises Error if there is nothing to plot."""
    found = {}
    for name, table in PLOTS.items():
        if results.has(table):
            found.update(importlib.import_module(f"squeal.plotting.{name}").figures(results))
    if not found:
        raise Error("no table of this run contains data to plot", f"folder {results.folder}",
                    f"choose a run with results in one of the tables: {', '.join(PLOTS.values())}")
    return found


def render(figure, ending):
    """The picture as bytes in the format `ending`."""
    import matplotlib

    stream = io.BytesIO()
    with matplotlib.rc_context({"svg.hashsalt": "squeal"}):
        figure.savefig(stream, format=ending, dpi=DOTS_PER_INCH, metadata=UNDATED[ending])
    return stream.getvalue()
