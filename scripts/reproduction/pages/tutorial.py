# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/tutorial.md"""

import math

from reproduction.numbers import Number, entry, of_mode

RATE = "divergence rate [%]"


@entry("tutorial", "Does it squeal?")
def first_run(runs):
    results = runs.default()
    yield Number("modes", "66", len(results.complex_modes()))
    yield Number("that grow", "9", results.n_unstable())
    for label, rate, frequency in (("F1", "1.068", "3569"), ("A0-5", "0.856", None), ("A0-4", "0.680", "2353")):
        yield from of_mode(label, results.leading(label), frequency, rate)
    yield Number("periods for a factor of e", "15", 1 / (2 * math.pi * results.leading("F1")[RATE] / 100))
    own = {row["body"]: row["total [%]"] / results.leading("F1")[RATE] for row in results.rows("energy") if row["mode [-]"] == 44}
    for pin, share in ((4, "14.9"), (5, "15.7"), (2, "1.9")):
        for side in ("top", "bottom"):
            yield Number(f"energy from pin_{side}_{pin} [%]", share, 100 * own[f"pin_{side}_{pin}"])


@entry("tutorial", "From which friction coefficient?")
def sweep(runs):
    results = runs("sweep", "sweep.prm", "Output/Mode shapes=none")
    thresholds = results.rows("thresholds")
    yield Number("thresholds", "24", sum(row["mechanism"] == "coalescence" for row in thresholds))
    for label, mu in (("A0-4", "0.0883"), ("A0-5", "0.0893")):
        yield Number(f"onset of {label}", mu, min(row["mu [-]"] for row in thresholds if row["label"].startswith(label)))
    leading = max(results.rows("branches"), key=lambda row: row[RATE])
    yield from of_mode("leading mode", leading, "3568", "1.168")
    yield Number("  friction coefficient", "0.45", leading["mu [-]"])


@entry("tutorial", "What would help?")
def derivatives(runs):
    rows = [row for row in runs("sensitivity", "studies/sensitivity.prm").rows("sensitivities") if row["mode [-]"] == 1 and not row["body"]]
    for parameter, change in (("Geometry/Disc outer radius", "-0.1276"), ("Geometry/Pin height", "0.0654"), ("Geometry/Disc thickness", "0.0301"),
                              ("Operation/Friction coefficient", "0.0084")):
        row = next(row for row in rows if row["parameter"] == parameter)
        yield Number(f"{parameter} [percentage points]", change, row["divergence rate per 1 % [percentage points]"])


@entry("tutorial", "Fifty designs")
def designs(runs):
    rows = runs("designs", "studies/designs.prm").rows("designs")
    rate = "largest divergence rate [%]"
    best, worst = min(rows, key=lambda row: row[rate]), max(rows, key=lambda row: row[rate])
    yield Number("best, design", "2", best["design [-]"])
    for design, value, height, diameter in ((best, "0.608", "28.6", "46"), (worst, "1.756", "35", "54")):
        yield Number("largest divergence rate [%]", value, design[rate])
        yield Number("  height [mm]", height, 1000 * design["Geometry/Pin height"])
        yield Number("  diameter [mm]", diameter, 1000 * design["Geometry/Pin diameter"])
    yield Number("frequency of the best [Hz]", "2344", best["frequency of largest [Hz]"])
