#!/usr/bin/python3
"""Draws the plots of a run from the tables in its folder.

    scripts/plot_results.py RESULTS [--format svg|png|pdf] [--output DIR]

Which plots there are follows from the tables. They go to RESULTS/plots and into the list of files in RESULTS/run.json: when the
run is repeated they go with its tables, and none of another run is left beside new ones. With --output DIR they go there
and are in no list. Needs Debian's python3-matplotlib (scripts/setup.sh).
"""

import argparse
import io
import json
import os
import pathlib
import sys

from plotting.results import Results, ResultsError

FOLDER = "plots"
FILES = "files [byte]"  # in run.json
DOTS_PER_INCH = 150
# The same tables give the same bytes
UNDATED = {"svg": {"Date": None}, "png": {}, "pdf": {"CreationDate": None}}
# Which packages Python may lack
NEEDED = ("matplotlib", "numpy")


def figures(results):
    """All figures of a run by their names. Throws ResultsError if its tables give none."""
    from plotting import accuracy, branches, complex_plane, designs, ingredients, reduction, sensitivity, stability_map

    found = {}
    for plots in (complex_plane, branches, stability_map, reduction, ingredients, sensitivity, accuracy, designs):
        found.update(plots.figures(results))
    if not found:
        raise ResultsError("no table is there of which a plot is known", f"folder {results.folder}", "run squeal again")
    return found


def render(figure, ending):
    """The picture as bytes."""
    import matplotlib

    stream = io.BytesIO()
    with matplotlib.rc_context({"svg.hashsalt": "squeal"}):
        figure.savefig(stream, format=ending, dpi=DOTS_PER_INCH, metadata=UNDATED[ending])
    return stream.getvalue()


def replace(path, content):
    """Writes a file in one step."""
    temporary = path.with_name(path.name + ".unfinished")
    temporary.write_bytes(content)
    os.replace(temporary, path)


def make_way(path):
    """Renames a file of the user whose name is needed; returns what to say."""
    kept = path.with_name(path.name + ".kept")
    number = 1
    while kept.exists():
        number += 1
        kept = path.with_name(f"{path.name}.kept-{number}")
    path.rename(kept)
    return f"note: {path} is no file of this run and is {kept.name} now"


def enlist(results, pictures):
    """Adds pictures, or a report, to the files of the run in run.json; returns what to say."""
    files = results.record[FILES]
    remarks = [make_way(results.folder / name) for name in pictures if name not in files and (results.folder / name).exists()]
    results.record[FILES] = dict(sorted({**files, **{name: len(content) for name, content in pictures.items()}}.items()))
    replace(results.record_file, (json.dumps(results.record, indent=2, ensure_ascii=False) + "\n").encode())
    return remarks


def draw(folder, ending, output):
    """Draws all plots of a run; returns their files and remarks."""
    results = Results(folder)
    pictures = {f"{name}.{ending}": render(figure, ending) for name, figure in figures(results).items()}
    place = pathlib.Path(output) if output else results.folder / FOLDER
    try:
        place.mkdir(parents=True, exist_ok=True)
        remarks = [] if output else enlist(results, {f"{FOLDER}/{name}": content for name, content in pictures.items()})
        for name, content in pictures.items():
            replace(place / name, content)
    except OSError as problem:
        change = "check permissions and free space, or give --output DIR"
        raise ResultsError(f"the plots cannot be written: {problem}", f"folder {place}", change) from problem
    return [place / name for name in pictures], remarks


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", metavar="RESULTS", help="folder that a run has left")
    parser.add_argument("--format", choices=("svg", "png", "pdf"), default="svg", help="of the pictures (default: %(default)s)")
    parser.add_argument("--output", metavar="DIR", help="where to put them (default: RESULTS/plots)")
    arguments = parser.parse_args(words)
    try:
        files, remarks = draw(arguments.results, arguments.format, arguments.output)
    except ResultsError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except ModuleNotFoundError as missing:
        if missing.name not in NEEDED:
            raise
        print(f"No plots: Python has no {missing.name}. Install python3-matplotlib, then: scripts/plot_results.py {arguments.results}",
              file=sys.stderr)
        return 1
    for remark in remarks:
        print(remark)
    print(f"  plots: {', '.join(str(file) for file in files)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
