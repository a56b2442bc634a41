#!/usr/bin/python3
"""Compares the tables of two result folders and prints the largest difference of each.

    scripts/compare_results.py OLD NEW [--tolerance 1e-9] [--ignore COLUMN]... [--tables PATTERN]

Every CSV file below OLD is held against the one of the same name below NEW, cell by cell: numbers by their
difference relative to the largest number of their column in OLD, so that a column of rounding errors beside zero
does not count, texts letter by letter. Columns of what varies from run to run (times, memory, residuals, the
eps_ estimates at the level of rounding) are left out unless --all is given. The exit status is 1 when a table or
a column is missing, a text differs or a number differs by more than the tolerance; columns that only NEW has do not
count.
"""

import argparse
import csv
import math
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from squeal.command_line import exit_on_error
from squeal.errors import Error

VARYING = re.compile(r"time|CPU|wall|memory|residual|eps_res|speed-up|orthonormality", re.IGNORECASE)


def read_table(path):
    """Header and rows; lines that start with # are no data."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(line for line in file if line.strip() and not line.startswith("#")))
    return (rows[0], rows[1:]) if rows else ([], [])


def number(text):
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def compare_columns(name, old, new, tolerance):
    """The largest relative difference of a column, and complaints."""
    scale = max((abs(number(text)) for text in old if number(text) is not None), default=0.0)
    largest, complaints = 0.0, []
    for row, (a, b) in enumerate(zip(old, new), start=1):
        x, y = number(a), number(b)
        if x is None or y is None:
            if a != b:
                complaints.append(f"{name}, row {row}: `{a}` became `{b}`")
        elif x != y:
            difference = abs(x - y) / scale if scale > 0 else abs(y)
            largest = max(largest, difference)
            if difference > tolerance:
                complaints.append(f"{name}, row {row}: {a} became {b}, {difference:.1e}")
    return largest, complaints


def with_occurrence(names):
    """Names of columns, of which some may be equal, each with the number of equal ones before it."""
    return [(name, names[:column].count(name)) for column, name in enumerate(names)]


def compare_tables(old_file, new_file, tolerance, ignored, everything):
    (old_names, old), (new_names, new) = read_table(old_file), read_table(new_file)
    places = dict(zip(with_occurrence(new_names), range(len(new_names))))
    missing = [name for name, occurrence in with_occurrence(old_names) if (name, occurrence) not in places]
    if missing:
        return 0.0, [f"columns are missing: {', '.join(missing)}"]
    if len(old) != len(new):
        return 0.0, [f"{len(old)} rows became {len(new)}"]
    largest, complaints = 0.0, []
    for column, (name, occurrence) in enumerate(with_occurrence(old_names)):
        if name in ignored or (not everything and VARYING.search(name)):
            continue
        place = places[name, occurrence]
        difference, found = compare_columns(name, [row[column] for row in old], [row[place] for row in new], tolerance)
        largest = max(largest, difference)
        complaints += found
    return largest, complaints


@exit_on_error()
def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", metavar="OLD", type=pathlib.Path)
    parser.add_argument("new", metavar="NEW", type=pathlib.Path)
    parser.add_argument("--tolerance", type=float, default=1e-9, help="relative to the largest of a column (default: %(default)s)")
    parser.add_argument("--ignore", action="append", default=[], metavar="COLUMN", help="a column to leave out; may be repeated")
    parser.add_argument("--tables", default="*.csv", metavar="PATTERN", help="which tables (default: %(default)s)")
    parser.add_argument("--all", action="store_true", help="also the columns that vary from run to run")
    arguments = parser.parse_args()

    files = sorted(path.relative_to(arguments.old) for path in arguments.old.rglob(arguments.tables))
    if not files:
        raise Error(f"there is no table {arguments.tables}", arguments.old, "name a folder of results")
    agree = True
    for file in files:
        if not (arguments.new / file).is_file():
            print(f"{str(file):<36} missing in {arguments.new}")
            agree = False
            continue
        largest, complaints = compare_tables(arguments.old / file, arguments.new / file, arguments.tolerance, arguments.ignore, arguments.all)
        print(f"{str(file):<36} {largest:8.1e}" + (f"   {len(complaints)} cells differ" if complaints else ""))
        for complaint in complaints[:5]:
            print(f"    {complaint}")
        agree = agree and not complaints
    for path in sorted(path.relative_to(arguments.new) for path in arguments.new.rglob(arguments.tables)):
        if path not in files:
            print(f"{str(path):<36} new")
    sys.exit(0 if agree else 1)


if __name__ == "__main__":
    main()
