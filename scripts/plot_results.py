#!/usr/bin/python3
"""Draws the plots of a run from the tables in its folder.

    scripts/plot_results.py RESULTS [--format svg|png|pdf] [--output DIR]

Which plots there are follows from the tables. They go to RESULTS/plots and into the list of files in RESULTS/run.json: when the
run is repeated they go with its tables, and none of another run is left beside new ones. With --output DIR they go there
and are in no list. Needs Debian's python3-matplotlib (scripts/setup.sh).
"""

import argparse
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from squeal.errors import Error
from squeal.results import Results

# Which packages Python may lack
NEEDED = ("matplotlib", "numpy")


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", metavar="RESULTS", help="folder that a run has left")
    parser.add_argument("--format", choices=("svg", "png", "pdf"), default="svg", help="of the pictures (default: %(default)s)")
    parser.add_argument("--output", metavar="DIR", help="where to put them (default: RESULTS/plots)")
    arguments = parser.parse_args(words)
    try:
        files, remarks = Results(arguments.results).plot(arguments.format, arguments.output)
    except Error as error:
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
