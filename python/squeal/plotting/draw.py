"""Draws all plots of a run."""

import io
import pathlib

from squeal.errors import Error
from squeal.results import replace

FOLDER = "plots"
DOTS_PER_INCH = 150
# The same tables give the same bytes
UNDATED = {"svg": {"Date": None}, "png": {}, "pdf": {"CreationDate": None}}


def figures(results):
    """All figures of a run by their names. Throws Error if its tables give none."""
    from squeal.plotting import accuracy, branches, complex_plane, designs, ingredients, reduction, sensitivity, stability_map

    found = {}
    for plots in (complex_plane, branches, stability_map, reduction, ingredients, sensitivity, accuracy, designs):
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


def draw(results, ending="svg", output=None):
    """Draws all plots of a run; returns their files and remarks."""
    pictures = {f"{name}.{ending}": render(figure, ending) for name, figure in figures(results).items()}
    place = pathlib.Path(output) if output else results.folder / FOLDER
    try:
        place.mkdir(parents=True, exist_ok=True)
        remarks = [] if output else results.enlist({f"{FOLDER}/{name}": content for name, content in pictures.items()})
        for name, content in pictures.items():
            replace(place / name, content)
    except OSError as problem:
        change = "check permissions and free space, or give --output DIR"
        raise Error(f"the plots cannot be written: {problem}", f"folder {place}", change) from problem
    return [place / name for name in pictures], remarks
