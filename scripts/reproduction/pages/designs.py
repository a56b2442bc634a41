# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/designs.md"""

from reproduction.numbers import Number, entry, numbers_in, of_mode, table

RATE, HEIGHT = "largest divergence rate [%]", "Geometry/Pin height"


@entry("designs", "Fifty designs of the default model")
def fifty(runs):
    rows = runs("designs", "studies/designs.prm").rows("designs")
    yield Number("designs", "50", len(rows))
    yield Number("with first onset in the pins", "48", sum(row["label at 0.01 %"] == "F1" for row in rows))
    for name, cell in table("designs", "height of the pins [mm]"):
        height, (least, greatest) = numbers_in(name)[0], numbers_in(cell)
        rates = [row[RATE] for row in rows if abs(1000 * row[HEIGHT] - float(height)) < 1e-6]
        yield Number(f"height {height} mm, least", least, min(rates))
        yield Number("  greatest", greatest, max(rates))
    yield Number("modes", "66", rows[0]["modes [-]"])


@entry("designs", "Fifty designs on one mesh")
def one_mesh(runs):
    rows = runs("materials", "studies/materials.prm").rows("designs")
    best, worst = min(rows, key=lambda row: row[RATE]), max(rows, key=lambda row: row[RATE])
    yield Number("modes found in each", "66", min(row["modes [-]"] for row in rows))
    yield Number("  counted", "66", min(row["modes counted [-]"] for row in rows))
    yield Number("estimated error of lambda", "1.0e-6", max(row["estimated error of lambda [-]"] for row in rows), bound=True)
    for design, number, rate in ((best, "10", "0.666"), (worst, "17", "1.543")):
        yield Number("design", number, design["design [-]"])
        yield Number("  largest divergence rate [%]", rate, design[RATE])


SEARCHED = ("Pin material/Rayleigh beta=2e-6", "Sweep/Number of friction coefficients=20", "Output/Mode shapes=none")
BEST = ("Geometry/Pin height=0.0318568", "Geometry/Pin diameter=0.0500913", "Pin material/Young modulus=1560970000",
        "Geometry/Top pin angles=-18.4, 0, 23.3242, -18.4, 0, 23.3242", "Geometry/Bottom pin angles=-18.4, 0, 23.3242, -18.4, 0, 23.3242")
DAMPED_DISC = "Disc material/Rayleigh beta=4.5e-7"


@entry("designs", "A silent design: the search")
def searched(runs):
    baseline = runs("search_scene", "sweep.prm", *SEARCHED, "Disc material/Rayleigh beta=1e-7").rows("branches")
    leading = max(baseline, key=lambda row: row["divergence rate [%]"])
    yield from of_mode("leading mode of the baseline", leading, "2354", "0.611")
    results = runs("search", "studies/search.prm")
    best = min(results.rows("designs"), key=lambda row: row[RATE])
    yield Number("best, design", "4", best["design [-]"])
    for name, value, factor in ((RATE, "0.229", 1), ("mu of 0.01 % [-]", "0.374", 1), (HEIGHT, "31.9", 1000), ("Geometry/Pin diameter", "50.1", 1000),
                                ("Pin material/Young modulus", "1.56", 1e-9)):
        yield Number(f"  {name}", value, factor * best[name])
    check = results.rows("full_order")[0]
    yield Number("divergence rate at full order [%]", "0.2289", check["divergence rate [%]"])
    yield Number("unstable modes at full order", "2", check["unstable modes [-]"])


@entry("designs", "A silent design: with more damping in the disc")
def silent(runs):
    quiet = runs("quiet", "sweep.prm", *SEARCHED, *BEST, DAMPED_DISC)
    yield Number("modes that grow at some friction coefficient", "0", sum(row["growing [-]"] for row in quiet.rows("branches")))
    full = runs("quiet_full_order", "disc_pins.prm", *SEARCHED[:1], *BEST, DAMPED_DISC, "Complex modes/Solver=Krylov",
                "Operation/Friction coefficient=0.45", "Output/Mode shapes=none")
    yield Number("unstable modes at full order", "0", full.n_unstable())
    other = runs("damped_disc_alone", "sweep.prm", *SEARCHED, DAMPED_DISC)
    yield Number("original pins: squeal from", "0.254", min(row["mu [-]"] for row in other.rows("thresholds")))
    yield Number("  largest divergence rate [%]", "0.371", max(row["divergence rate [%]"] for row in other.rows("branches")))
