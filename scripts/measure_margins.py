#!/usr/bin/env python3
"""How far the decisions of the program lie from falling the other way.

    scripts/measure_margins.py [--set "Section/Name=value"]... [PRM]...

runs squeal on parameter files, by default on all that are shipped, and prints for every decision that run.json lists the
smallest margin on either side of its threshold, in orders of magnitude, with the file in which it occurred. Exits with 1 if
one is below two orders.
"""

import argparse
import dataclasses
import json
import math
import pathlib
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[1]

# Orders of magnitude: rounding errors of processors and libraries differ by less than one.
LEAST_MARGIN = 2.0

# Quantities that vary continuously over a sweep and pass through their threshold somewhere: what they decide is refined
# until it no longer matters (doc/decisions.md), but a margin they cannot have.
CONTINUOUS = {"difference of two eigenvalues / their modulus",
              "divergence rate of a mode among others of nearly the same lambda",
              "Im / modulus of the square of a difference of two eigenvalues",
              "growth rate of a mode / its uncertainty"}


@dataclasses.dataclass
class Margin:
    """The smallest margins of a decision over several runs."""
    threshold: float
    below: float = math.inf
    above: float = math.inf
    where_below: str = ""
    where_above: str = ""

    def add(self, decision, where):
        for side in ("below", "above"):
            value = decision[f"orders of magnitude {side}"]
            if value is not None and value < getattr(self, side):
                setattr(self, side, value)
                setattr(self, f"where_{side}", where)


def shipped():
    """Every shipped parameter file."""
    return sorted([*SOURCE.glob("prm/*.prm"), *SOURCE.glob("prm/studies/*.prm")])


def decisions(executable, parameter_file, overrides):
    """What run.json lists after a run with overrides "Section/Name=value"."""
    settings = [word for override in overrides for word in ("--set", override)]
    with tempfile.TemporaryDirectory() as folder:
        process = subprocess.run([executable, parameter_file, "--output", f"{folder}/results", *settings], text=True, capture_output=True,
                                 check=False)
        if process.returncode != 0:
            raise RuntimeError(f"squeal {parameter_file} failed:\n{process.stderr}")
        record = json.loads(pathlib.Path(folder, "results", "run.json").read_text(encoding="utf-8"))
    return record["decisions"]


def add_margins(margins, found, where):
    """Takes the decisions of a run into the margins by quantity."""
    for decision in found:
        margins.setdefault(decision["quantity"], Margin(decision["threshold"])).add(decision, where)


def small_margins(margins):
    """Quantities that come closer to their threshold than they may."""
    return [quantity for quantity, margin in margins.items()
            if quantity not in CONTINUOUS and min(margin.below, margin.above) < LEAST_MARGIN]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("parameter_files", nargs="*", metavar="PRM", help="default: all that are shipped")
    parser.add_argument("--set", action="append", default=[], dest="overrides", metavar="Section/Name=value")
    parser.add_argument("--executable", default=str(SOURCE / "build" / "release" / "squeal"))
    arguments = parser.parse_args()

    margins = {}
    for file in arguments.parameter_files or map(str, shipped()):
        add_margins(margins, decisions(arguments.executable, file, arguments.overrides), pathlib.Path(file).stem)
    print("threshold  orders below            orders above            quantity")
    for quantity, margin in sorted(margins.items()):
        print(f"{margin.threshold:9.0e}  {margin.below:5.1f} {margin.where_below:17s} {margin.above:5.1f} {margin.where_above:17s} "
              f"{quantity}{' (continuous)' if quantity in CONTINUOUS else ''}")
    small = small_margins(margins)
    for quantity in small:
        print(f"less than {LEAST_MARGIN:g} orders: {quantity}", file=sys.stderr)
    return 1 if small else 0


if __name__ == "__main__":
    sys.exit(main())
