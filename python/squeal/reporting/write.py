"""Writes the report of a run."""

import pathlib

from squeal.errors import Error
from squeal.reporting import page
from squeal.results import replace

NAME = "report.html"


def write(results, output=None):
    """Writes the report; returns its file and remarks."""
    from squeal.reporting import content

    text = page.page(content.content(results)).encode()
    place = pathlib.Path(output) if output else results.folder / NAME
    try:
        remarks = [] if output else results.enlist({NAME: text})
        place.parent.mkdir(parents=True, exist_ok=True)
        replace(place, text)
    except OSError as problem:
        raise Error(f"the report cannot be written: {problem}", f"file {place}", "check permissions and free space, or give -o FILE") from problem
    return place, remarks
