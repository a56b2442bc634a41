#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Measures time and memory of the default model on successively finer meshes.

    scripts/measure_scaling.py [--sizes 32,78,138,281,670,1000] [--study stability|sweep]

Sizes are given in thousands of coupled dofs. Each size is one run of a process that may use all cores and writes no fields.
Prints for each run the wall time, the peak memory and the memory expected by `squeal --dry-run`, the steps, and the
exponent of a power law through this size and the previous one.
"""

import math
import tempfile

import benchmarking
import squeal
from squeal.command_line import Parser, exit_on_error

# Element size [m], layers of the disc, nodes per pin face, layers of the pins
MESHES = {"32": (0.0115, 3, 19, 4), "78": (0.008, 4, 37, 6), "138": (0.006, 4, 61, 6), "281": (0.0045, 5, 91, 8),
          "670": (0.0032, 7, 91, 10), "1000": (0.0029, 9, 91, 10)}
STUDIES = {"stability": "disc_pins.prm", "sweep": "sweep.prm"}
STEPS = ("Mode count", "Component modes", "Factorisation", "Real modes", "Complex modes", "Reduced model", "Sweep", "Branches")


def run(study, mesh):
    """The record of one run."""
    names = ("Element size", "Disc layers", "Nodes per pin face", "Pin layers")
    settings = {f"Geometry/{name}": value for name, value in zip(names, mesh)}
    with tempfile.TemporaryDirectory() as folder:
        file = benchmarking.SOURCE / "prm" / STUDIES[study]
        return squeal.run(file, {**settings, "Output/Mode shapes": "none"}, f"{folder}/run").record


def columns(record):
    """Printed quantities of a run, name -> value."""
    result = {"coupled dofs": record["counts"]["coupled dofs"], "contact nodes": record["counts"]["contact nodes"],
              "entries of the factor [million]": record["quantities"]["entries of the Cholesky factor"] / 1e6,
              "whole run [s]": record["wall time [s]"],
              "peak [GB]": max(step["peak memory so far [byte]"] for step in record["steps"]) / 1e9,
              "expected [GB]": record["quantities"]["expected memory [byte]"] / 1e9}
    for name in STEPS:
        if steps := [step for step in record["steps"] if step["name"] == name]:
            result[f"{name} [s]"] = sum(step["wall time [s]"] for step in steps)
            result[f"{name}, peak so far [GB]"] = steps[-1]["peak memory so far [byte]"] / 1e9
    return result


@exit_on_error()
def main():
    parser = Parser(__doc__)
    parser.add_argument("--sizes", default="32,78,138,281", help="thousands of coupled dofs (default: %(default)s)")
    parser.add_argument("--study", default="stability", choices=STUDIES)
    arguments = parser.parse_args()
    names = arguments.sizes.split(",")
    if unknown := [name for name in names if name not in MESHES]:
        raise squeal.Error(f"there is no mesh {unknown[0]}", "--sizes", f"choose from {', '.join(MESHES)}")
    print(benchmarking.describe_machine("all"), flush=True)
    before = None
    for name in names:
        found = columns(run(arguments.study, MESHES[name]))
        print(f"\n{name} 000 dofs")
        for column, value in found.items():
            exponent = ""
            if before and column != "coupled dofs" and before.get(column, 0.) > 0. and value > 0.:
                exponent = f"  ~ n^{math.log(value / before[column]) / math.log(found['coupled dofs'] / before['coupled dofs']):.2f}"
            print(f"  {column:<32} {value:12.5g}{exponent}", flush=True)
        before = found


if __name__ == "__main__":
    main()
