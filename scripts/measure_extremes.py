#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Runs the cases of doc/extremes.md, compares each with an independent solution, and prints the table of that page.

    scripts/measure_extremes.py                    # all cases, about twenty minutes on two idle cores
    scripts/measure_extremes.py --only mounts      # cases whose names contain `mounts`
    scripts/measure_extremes.py --missing          # cases that are not in the table of the page
    scripts/measure_extremes.py --write            # all cases; also updates the table of the page

The exit status is 1 if a case is neither right nor refused as expected. The environment variable SQUEAL may specify the
path of the program.
"""

import collections
import concurrent.futures
import dataclasses
import os
import pathlib
import re
import sys
import tempfile

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from extremes.cases import CASES
from extremes.judge import judge
from squeal.command_line import Parser, exit_on_error

PAGE = pathlib.Path(__file__).resolve().parents[1] / "doc" / "extremes.md"
BEGIN, END = "<!-- cases -->", "<!-- end of cases -->"
# Headings of the attributes of judge.Row, in the same order
COLUMNS = ("case", "value", "outcome", "modes", "residual", "count", "oracle", "deviation", "digits", "remark")
HEAD = "| " + " | ".join(COLUMNS) + " |\n" + "|---" * len(COLUMNS) + "|"


def line(row):
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in dataclasses.astuple(row)) + " |"


def known_lines():
    """Lines of the table in the page, by group and value of their cases."""
    table = re.split(f"{BEGIN}|{END}", PAGE.read_text(encoding="utf-8"))[1]
    return {tuple(cell.strip() for cell in text.strip("| ").split(" | ")[:2]): text
            for text in table.strip().splitlines()[2:]}


def write(rows):
    """Replaces the rows of the measured cases, keeps other rows, and removes rows of cases that no longer exist."""
    lines = {**known_lines(), **{(row.group, row.value): line(row) for row in rows}}
    before, _, after = re.split(f"{BEGIN}|{END}", PAGE.read_text(encoding="utf-8"))
    names = [(case.group, case.value) for case in CASES]
    table = "\n".join([HEAD, *(lines[name] for name in names if name in lines)])
    PAGE.write_text(f"{before}{BEGIN}\n{table}\n{END}{after}", encoding="utf-8")


def judge_in_folder(case):
    """Runs a case in its own folder; returns its row."""
    with tempfile.TemporaryDirectory() as folder:
        return judge(case, pathlib.Path(folder))


@exit_on_error()
def main():
    parser = Parser(__doc__)
    parser.add_argument("--only", default="", metavar="WORDS", help="run only the cases whose names contain WORDS")
    parser.add_argument("--missing", action="store_true", help="run only the cases that are not in the table of doc/extremes.md")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), metavar="N", help="number of concurrent cases (default: %(default)s)")
    parser.add_argument("--write", action="store_true", help="update the measured rows of the table of doc/extremes.md")
    arguments = parser.parse_args()
    known = known_lines() if arguments.missing else ()
    chosen = [case for case in CASES if arguments.only in case.name and (case.group, case.value) not in known]
    rows = []
    print(HEAD)
    with concurrent.futures.ProcessPoolExecutor(arguments.jobs) as pool:
        for row in pool.map(judge_in_folder, chosen):
            rows.append(row)
            print(line(row), flush=True)
    outcomes = collections.Counter(row.outcome for row in rows)
    print(f"\n{len(rows)} cases: " + ", ".join(f"{count} {outcome}" for outcome, count in outcomes.items()))
    if arguments.write:
        write(rows)
    return 0 if all(row.is_as_expected for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
