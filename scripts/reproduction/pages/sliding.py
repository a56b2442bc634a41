# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/sliding.md"""

import random

from reproduction.numbers import Number, entry, numbers_in, table

NO_SHAPES = "Output/Mode shapes=none"
FEW_MODES = "Band/Maximum frequency=600"
PINS = [f"pin_{side}_{number}" for side in ("top", "bottom") for number in range(1, 7)]
MEAN_PRESSURE = 1000.0 / (6 * 0.002028)  # load per side divided by the area of its pins, as printed by a run [Pa]


def steady(runs, name, *settings):
    """Steady sliding of the default model, with few modes."""
    return runs(name, "sliding.prm", NO_SHAPES, FEW_MODES, *settings)


def checks(results):
    return {row["quantity"]: row["value"] for row in results.rows("sliding_checks")}


@entry("sliding", "The checks at mu = 0.4, and the friction coefficient below which the state is unique")
def proof(runs):
    values = checks(steady(runs, "sliding_0.4", "Operation/Friction coefficient=0.4"))
    for quantity, bound in (("residual of the full system [-]", "1e-11"), ("error of the prescribed loads [-]", "1e-14"),
                            ("largest overlap over travel [-]", "1e-13"), ("complementarity |r_n g| over load and travel [-]", "1e-14"),
                            ("force balance with the supports [-]", "1e-11"), ("moment balance with the supports [-]", "1e-11")):
        yield Number(quantity, bound, values[quantity], bound=True)
    yield Number("largest tension over load", "-2e-5", values["largest tension over load [-]"])
    yield Number("the state is unique below mu =", "1.348", values["friction coefficient below which the state is unique [-]"])


@entry("sliding", "The table by mu: open nodes, ratio of largest to mean pressure, travel of the backplates")
def over_friction(runs):
    for cells in table("sliding", "open nodes of 228"):
        mu, n_open, ratio, travel = numbers_in(*cells)
        pins = steady(runs, f"sliding_{mu}", f"Operation/Friction coefficient={mu}").rows("sliding_pins")
        yield Number(f"mu = {mu}: open nodes", n_open, sum(pin["open nodes [-]"] for pin in pins))
        yield Number(f"mu = {mu}: largest pressure / mean", ratio, max(pin["largest pressure [Pa]"] for pin in pins) / MEAN_PRESSURE)
        yield Number(f"mu = {mu}: travel [um]", travel, 1e6 * max(pin["backplate travel [m]"] for pin in pins))


@entry("sliding", "Largest nodal pressure with 19, 37 and 61 nodes per face, open nodes of each pin, centres of pressure")
def meshes(runs):
    for nodes, pressure, n_open, centre in ((19, "220", "0", "-6.32"), (37, "284", "1", "-6.33"), (61, "364", "3", "-6.34")):
        pins = steady(runs, f"sliding_faces_{nodes}", f"Geometry/Nodes per pin face={nodes}").rows("sliding_pins")
        yield Number(f"{nodes} nodes: largest pressure [kPa]", pressure, 1e-3 * max(pin["largest pressure [Pa]"] for pin in pins))
        yield Number(f"{nodes} nodes: open nodes of a pin", n_open, max(pin["open nodes [-]"] for pin in pins))
        yield Number(f"{nodes} nodes: centre of pressure [mm]", centre, 1e3 * pins[0]["pressure offset along t [m]"])


def random_gaps(seed):
    """Random gaps [m] and tapers of every pin, and a friction coefficient."""
    generator = random.Random(seed)
    gaps = "; ".join(f"{pin}: {generator.uniform(0, 3e-6):.3e}, {generator.uniform(-5e-5, 5e-5):.3e}, {generator.uniform(-5e-5, 5e-5):.3e}"
                     for pin in PINS)
    return gaps, round(generator.uniform(0.03, 1.11), 3)


@entry("sliding", "20 random patterns of gaps: all solved, with unique states and small residuals")
def random_patterns(runs):
    residuals, overlaps, unique = [], [], 0
    for seed in range(20):
        gaps, mu = random_gaps(seed)
        values = checks(steady(runs, f"gaps_{seed}", f"Steady sliding/Gaps={gaps}", f"Operation/Friction coefficient={mu}"))
        residuals.append(values["residual of the full system [-]"])
        overlaps.append(values["largest overlap over travel [-]"])
        unique += values["friction coefficient below which the state is unique [-]"] > mu
    yield Number("solved patterns", "20", len(residuals))
    yield Number("  with a unique state", "20", unique)
    yield Number("largest residual", "1e-11", max(residuals), bound=True)
    yield Number("largest overlap", "1e-13", max(overlaps), bound=True)


@entry("sliding", "Pads of the disc brake that a pressure tilts")
def pressed_pads(runs):
    results = runs("brake_pressed", "brake.prm", NO_SHAPES, "Steady sliding/Contact state=steady sliding", "Steady sliding/Control=pressure",
                   "Steady sliding/Pressed faces=pad_outer_back, pad_inner_back",
                   "Mounts/Elastic mounts=disc_hub: 1e13, 1e13, 1e13; pad_outer_back: 5e9, 2e10, 0; pad_inner_back: 4e9, 1.5e10, 0")
    for pad in results.rows("sliding_pins"):
        yield Number(f"{pad['pin']}: centre of pressure towards the leading edge [mm]", "7.8", -1e3 * pad["pressure offset along t [m]"])
        yield Number(f"{pad['pin']}: outwards [mm]", "4.9", 1e3 * pad["pressure offset outwards [m]"])
        yield Number(f"{pad['pin']}: largest pressure [MPa]", "1.9", 1e-6 * pad["largest pressure [Pa]"])
