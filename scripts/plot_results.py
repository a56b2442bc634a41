#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Draws the plots of a run from the tables in its folder.

    scripts/plot_results.py RESULTS [--format svg|png|pdf] [--output DIR]

Which plots there are follows from the tables. They go to RESULTS/plots and into the list of files in RESULTS/run.json: when the
run is repeated they go with its tables, and none of another run is left beside new ones. With --output DIR they go there
and are in no list. Needs Debian's python3-matplotlib (scripts/setup.sh).
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from squeal.command_line import Parser, exit_on_error, make_of_results


@exit_on_error()
def main():
    parser = Parser(__doc__)
    parser.add_argument("--format", choices=("svg", "png", "pdf"), default="svg", help="of the pictures (default: %(default)s)")
    parser.add_argument("--output", metavar="DIR", help="where to put them (default: RESULTS/plots)")
    make_of_results("plots", parser, lambda results, arguments: results.plot(arguments.format, arguments.output))


if __name__ == "__main__":
    main()
