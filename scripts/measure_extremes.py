#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Runs the cases of doc/extremes.md, compares each with an independent solution, and prints the table of that page.

    scripts/measure_extremes.py                    # all cases, about twenty minutes on two idle cores
    scripts/measure_extremes.py --only mounts      # cases whose name contains a word
    scripts/measure_extremes.py --missing          # cases that are missing in the table of the page
    scripts/measure_extremes.py --write            # all cases, and updates the table of the page

The exit status is 1 if a case is neither right nor refused as expected. The environment variable SQUEAL is the path of the program.
"""

import collections
import concurrent.futures
import os
import pathlib
import sys
import tempfile

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from extremes import page
from extremes.cases import CASES
from extremes.judge import judge
from squeal.command_line import Parser, exit_on_error


def judge_in(number, case, keep):
    """The row of a case, run in DIR/NUMBER or in a temporary folder."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = keep / f"{number:03d}" if keep else pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        return judge(case, folder)


@exit_on_error()
def main():
    parser = Parser(__doc__)
    parser.add_argument("--only", default="", metavar="WORDS", help="only the cases whose name contains WORDS")
    parser.add_argument("--quick", action="store_true", help="only the cases that the tests run")
    parser.add_argument("--missing", action="store_true", help="only the cases missing in the table of doc/extremes.md")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), metavar="N", help="number of concurrent cases (default: %(default)s)")
    parser.add_argument("--keep", type=pathlib.Path, metavar="DIR", help="folder in which the runs are kept")
    parser.add_argument("--write", action="store_true", help="updates the measured rows of the table of doc/extremes.md")
    arguments = parser.parse_args()
    known = page.known_lines() if arguments.missing else ()
    chosen = [case for case in CASES if arguments.only in case.name and (case.quick or not arguments.quick)
              and (case.group, case.value) not in known]
    rows = []
    print(page.HEAD)
    with concurrent.futures.ProcessPoolExecutor(arguments.jobs) as pool:
        for row in pool.map(judge_in, range(len(chosen)), chosen, [arguments.keep] * len(chosen)):
            rows.append(row)
            print(page.line(row), flush=True)
    outcomes = collections.Counter(row.outcome for row in rows)
    print(f"\n{len(rows)} cases: " + ", ".join(f"{count} {outcome}" for outcome, count in outcomes.items()))
    if arguments.write:
        page.write(rows, [(case.group, case.value) for case in CASES])
    return 0 if all(row.is_as_expected for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
