#!/usr/bin/python3
"""Turns a folder of results into one HTML file that needs no network.

    scripts/report.py RESULTS [-o FILE.html]

The verdict comes first, then charts, growing modes that move and turn, where their energy enters, tables that sort, what was checked, and how to
repeat the run. The file is RESULTS/report.html, which goes into the list of files in RESULTS/run.json, so that a rerun replaces it; one
that -o names goes into no list. Needs Debian's python3-plotly, libjs-three, libjs-jquery, libjs-jquery-datatables and python3-numpy
(scripts/setup.sh).
"""

import argparse
import pathlib
import sys

from plot_results import enlist, replace
from plotting.results import Results, ResultsError
from reporting import page

NAME = "report.html"


def write(folder, output):
    """Writes the report; returns its file and remarks."""
    from reporting import content

    results = Results(folder)
    text = page.page(content.content(results)).encode()
    place = pathlib.Path(output) if output else results.folder / NAME
    try:
        remarks = [] if output else enlist(results, {NAME: text})
        place.parent.mkdir(parents=True, exist_ok=True)
        replace(place, text)
    except OSError as problem:
        raise ResultsError(f"the report cannot be written: {problem}", f"file {place}", "check permissions and free space, or give -o FILE") from problem
    return place, remarks


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", metavar="RESULTS", help="folder that a run has left")
    parser.add_argument("-o", "--output", metavar="FILE.html", help="(default: RESULTS/report.html)")
    arguments = parser.parse_args(words)
    try:
        place, remarks = write(arguments.results, arguments.output)
    except ResultsError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except page.MissingLibraries as missing:
        print(f"No report: install {' '.join(missing.args[0])} (or call scripts/setup.sh), then: scripts/report.py {arguments.results}", file=sys.stderr)
        return 1
    except ModuleNotFoundError as missing:
        if missing.name != "numpy":
            raise
        print(f"No report: install python3-{missing.name} (or call scripts/setup.sh), then: scripts/report.py {arguments.results}", file=sys.stderr)
        return 1
    for remark in remarks:
        print(remark)
    print(f"  report: {place}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
