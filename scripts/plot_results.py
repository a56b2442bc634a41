#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Draws the plots of a run from the tables in its folder.

    scripts/plot_results.py RESULTS [--format svg|png|pdf] [--output DIR]

The plots depend on the tables in RESULTS. They are written to RESULTS/plots and listed in RESULTS/run.json, so that a
repeated run removes them together with its tables. Plots in --output DIR are not listed. Requires Debian's
python3-matplotlib (scripts/setup.sh).
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from squeal.command_line import Parser, exit_on_error, make_of_results


@exit_on_error()
def main():
    parser = Parser(__doc__)
    parser.add_argument("--format", choices=("svg", "png", "pdf"), default="svg", help="format of the plots (default: %(default)s)")
    parser.add_argument("--output", metavar="DIR", help="folder for the plots (default: RESULTS/plots)")
    make_of_results("plots", parser, lambda results, arguments: results.plot(arguments.format, arguments.output))


if __name__ == "__main__":
    main()
