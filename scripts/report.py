#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Converts a result folder to a single HTML file that does not load anything from the network.

    scripts/report.py RESULTS [-o FILE.html]

The file contains the verdict, charts, animations and energy sources of growing modes, sortable tables, checks, and how
to repeat the run. The default file RESULTS/report.html is listed in RESULTS/run.json, so that a repeated run removes it; a
file given by -o is not listed. Requires Debian's python3-plotly, libjs-three, libjs-jquery, libjs-jquery-datatables and
python3-scipy (scripts/setup.sh).
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from squeal.command_line import Parser, exit_on_error, make_of_results


@exit_on_error()
def main():
    parser = Parser(__doc__)
    parser.add_argument("-o", "--output", metavar="FILE.html", help="(default: RESULTS/report.html)")
    make_of_results("report", parser, lambda results, arguments: results.report(arguments.output))


if __name__ == "__main__":
    main()
