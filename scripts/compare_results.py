#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Compares the tables in two result folders and prints the largest difference in each table.

    scripts/compare_results.py OLD NEW [--tolerance 1e-9] [--all]

Every CSV file in OLD and its subfolders is compared, cell by cell, with the file of the same name in NEW: numbers by
their difference relative to the largest number of the column in OLD, texts exactly. Columns that vary from run to run
(times, memory, residuals, estimates at rounding level) are skipped unless --all is given. The exit status is 1 if a
table or column is missing, if the number of rows or a text differs, or if a number differs by more than the tolerance.
Additional columns in NEW are ignored.
"""

import pathlib
import re
import sys

import numpy as np
import pandas

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from squeal.command_line import Parser, exit_on_error
from squeal.errors import Error
from squeal.results import Table

VARYING = re.compile(r"time|CPU|wall|memory|residual|eps_res|speed-up|orthonormality", re.IGNORECASE)


def read_texts(path):
    """Cells of a table as texts."""
    table = Table(path)
    return pandas.DataFrame(table.rows, columns=table.columns, dtype=str)


def compare(old_file, new_file, arguments):
    """The largest relative difference between two tables, and messages about the differences."""
    old, new = read_texts(old_file), read_texts(new_file)
    if missing := [name for name in old.columns if name not in new.columns]:
        return 0.0, [f"columns are missing: {', '.join(missing)}"]
    if len(old) != len(new):
        return 0.0, [f"{len(old)} rows in OLD, {len(new)} in NEW"]
    names = [name for name in old.columns if arguments.all or not VARYING.search(name)]
    old, new = old[names], new[names]
    x, y = (frame.apply(pandas.to_numeric, errors="coerce").astype(float).replace([np.inf, -np.inf], np.nan)
            for frame in (old, new))
    are_numbers = x.notna() & y.notna()
    differences = ((x - y).abs() / x.abs().max().replace(0, np.nan).fillna(1.0)).where(are_numbers, 0.0)
    differs = ~are_numbers & (old != new) | (differences > arguments.tolerance)
    complaints = [f"{name}, row {row + 1}: {old[name][row]} in OLD, {new[name][row]} in NEW"
                  + (f", {differences[name][row]:.1e}" if are_numbers[name][row] else "")
                  for name in names for row in np.flatnonzero(differs[name])]
    return differences.to_numpy().max(initial=0.0), complaints


@exit_on_error()
def main():
    parser = Parser(__doc__)
    parser.add_argument("old", metavar="OLD", type=pathlib.Path)
    parser.add_argument("new", metavar="NEW", type=pathlib.Path)
    parser.add_argument("--tolerance", type=float, default=1e-9, help="relative to the largest number of a column (default: %(default)s)")
    parser.add_argument("--all", action="store_true", help="includes the columns that vary from run to run")
    arguments = parser.parse_args()

    files = sorted(path.relative_to(arguments.old) for path in arguments.old.rglob("*.csv"))
    if not files:
        raise Error("the folder is missing or contains no tables", arguments.old, "name a results folder")
    agree = True
    for file in files:
        if not (arguments.new / file).is_file():
            print(f"{str(file):<36} missing in {arguments.new}")
            agree = False
            continue
        largest, complaints = compare(arguments.old / file, arguments.new / file, arguments)
        print(f"{str(file):<36} {largest:8.1e}" + (f"   differences: {len(complaints)}" if complaints else ""))
        for complaint in complaints[:5]:
            print(f"    {complaint}")
        agree = agree and not complaints
    for path in sorted(path.relative_to(arguments.new) for path in arguments.new.rglob("*.csv")):
        if path not in files:
            print(f"{str(path):<36} new")
    sys.exit(0 if agree else 1)


if __name__ == "__main__":
    main()
