# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/sweep.md"""

import math
import re

import numpy as np

from reproduction.numbers import Number, entry
from squeal import quadratic

NO_SHAPES = "Output/Mode shapes=none"
UNCOMPARED = "Sweep/Compare dissipation=false"
NO_COUNT = "Sweep/Count modes at="
GRID = [0.45 * place / 89 for place in (9, 27, 45, 62, 80)]
SWEEPS = {  # name -> parameter file, settings of the sweep, settings of single friction coefficients
    "without": ("sweep.prm", [], []),
    "consistent": ("sweep_damped.prm", [UNCOMPARED, NO_COUNT], ["Operation/Radial dissipation=consistent"]),
    "published": ("sweep_damped.prm", [UNCOMPARED, NO_COUNT, "Operation/Radial dissipation=published"],
                  ["Operation/Radial dissipation=published"]),
}


def sweep(runs, name, *settings, suffix=""):
    parameter_file, own, _ = SWEEPS[name]
    return runs(f"sweep_{name}{suffix}", parameter_file, NO_SHAPES, *own, *settings)


def full_order(runs, name, mu):
    """Modes at one friction coefficient by the Krylov solver."""
    settings = SWEEPS[name][2]
    return runs.default(f"full_{name}_{mu:.8f}", f"Operation/Friction coefficient={mu!r}", *settings)


def at_value(results, mu):
    """lambda of every branch at a friction coefficient of the grid."""
    rows = [row for row in results.rows("branches") if abs(row["mu [-]"] - mu) < 1e-9 and row["refinement [-]"] == 0]
    return np.array([complex(row["growth rate [1/s]"], 2 * math.pi * row["frequency [Hz]"]) for row in rows])


def largest_differences(runs, name, results):
    """Largest relative differences of lambda, and of the divergence rate, from full order at five friction
    coefficients."""
    of_lambda, of_divergence = 0.0, 0.0
    for mu in GRID:
        swept, full = at_value(results, mu), np.array(full_order(runs, name, mu).eigenvalues())
        if len(swept) != len(full):
            return math.inf, math.inf
        rows, columns, differences = quadratic.match(swept, full)
        of_lambda = max(of_lambda, float(differences.max()))
        rates = [values.real / values.imag for values in (swept[rows], full[columns])]
        of_divergence = max(of_divergence, float(abs(rates[0] - rates[1]).max()))
    return of_lambda, of_divergence


def step_number(results, step, pattern):
    """A number from the result of a step in the run record."""
    text = next(entry["result"] for entry in results.record["steps"] if entry["name"] == step)
    return float(re.search(pattern, text)[1])


@entry("sweep", "Numbers of basis vectors initially and at the end")
def vectors(runs):
    for name, start, end in (("without", "198", "220"), ("consistent", "263", "290")):
        results = sweep(runs, name)
        yield Number(f"{name}: vectors initially", start, step_number(results, "Reduced model", r"(\d+) vectors"))
        yield Number(f"{name}: vectors at the end", end, step_number(results, "Sweep", r"(\d+) vectors"), bound=True)


@entry("sweep", "Full-order modes at five values, without, with consistent and with published dissipation: at most the tolerance")
def against_full_order(runs):
    for name in SWEEPS:
        of_lambda, of_divergence = largest_differences(runs, name, sweep(runs, name))
        yield Number(f"{name}: largest relative difference of lambda", "1e-6", of_lambda, bound=True)
        yield Number(f"{name}: largest difference of xi", "5e-7", of_divergence, bound=True)


@entry("sweep", "The same at Sweep/Tolerance = 1e-8")
def against_full_order_tightly(runs):
    for name in ("without", "consistent"):
        results = sweep(runs, name, "Sweep/Tolerance=1e-8", suffix="_1e-8")
        of_lambda, of_divergence = largest_differences(runs, name, results)
        yield Number(f"{name}: largest relative difference of lambda", "1.1e-8", of_lambda, bound=True)
        yield Number(f"{name}: largest difference of xi", "6e-9", of_divergence, bound=True)


@entry("sweep", "At 1e-5 on either side of a threshold, the numbers of growing modes at full order differ by one")
def thresholds(runs):
    for name, label, quoted in (("without", "A0-5", "0.0893"), ("without", "F1", "0.0424"), ("without", "R0-2", "0.3987"),
                                ("without", "F1", "0.3785"), ("consistent", "A0-4", "0.0837"), ("consistent", "F1", "0.0496")):
        rows = [row for row in sweep(runs, name).rows("thresholds") if row["label"].startswith(label)]
        threshold = min(rows, key=lambda row: abs(row["mu [-]"] - float(quoted)))
        yield Number(f"{name}: threshold of {label}", quoted, threshold["mu [-]"])
        below, above = (full_order(runs, name, threshold["mu [-]"] + side * 1e-5).n_unstable() for side in (-1, 1))
        yield Number("  change of the number of growing modes", "1", abs(above - below))


@entry("sweep", "With 10 values instead of 90, 22 of the 24 thresholds are found")
def few_values(runs):
    yield Number("thresholds with 90 values", "24", len(sweep(runs, "without").rows("thresholds")))
    few = sweep(runs, "without", "Sweep/Number of friction coefficients=10", suffix="_10")
    yield Number("thresholds with 10 values", "22", len(few.rows("thresholds")))


@entry("sweep", "The argument principle at mu = 0.4 counts 66 modes without and with dissipation")
def counts(runs):
    for name, n_points, phase in (("without", "40", "0.17"), ("consistent", "81", "0.93")):
        results = sweep(runs, name, "Sweep/Number of friction coefficients=10", "Sweep/Count modes at=0.4", suffix="_counted")
        row = results.rows("argument_counts")[0]
        yield Number(f"{name}: modes counted", "66", row["modes counted [-]"])
        yield Number(f"{name}: points", n_points, row["contour points [-]"])
        yield Number(f"{name}: largest phase step [rad]", phase, row["largest phase step [rad]"])
