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

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from squeal.errors import Error
from squeal.reporting.page import MissingLibraries
from squeal.results import Results


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", metavar="RESULTS", help="folder that a run has left")
    parser.add_argument("-o", "--output", metavar="FILE.html", help="(default: RESULTS/report.html)")
    arguments = parser.parse_args(words)
    try:
        place, remarks = Results(arguments.results).report(arguments.output)
    except MissingLibraries as missing:
        print(f"No report: install {' '.join(missing.packages)} (or call scripts/setup.sh), then: scripts/report.py {arguments.results}", file=sys.stderr)
        return 1
    except Error as error:
        print(f"error: {error}", file=sys.stderr)
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
