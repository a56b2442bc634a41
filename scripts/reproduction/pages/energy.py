# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/energy.md"""

from reproduction.numbers import Number, entry

# Divergence rate [%], its share into the disc [%], body and share of two that feed most and of the one that feeds least
QUOTED = {17: ("0.680", "46", ("5", "13.2"), ("6", "12.8"), ("1", "3.6")),
          21: ("0.856", "0", ("5", "17.9"), ("6", "11.5"), ("1", "0.9")),
          37: ("0.322", "0", ("5", "22.5"), ("3", "10.3"), ("2", "0.4")),
          44: ("1.068", "-4", ("5", "15.7"), ("4", "14.9"), ("2", "1.9"))}


@entry("energy", "The table of the default scene")
def default_scene(runs):
    rows = runs("default", "disc_pins.prm", "Output/Mode shapes=none").rows("energy")
    for mode, (rate, into_disc, *shares) in QUOTED.items():
        own = {row["body"]: row for row in rows if row["mode [-]"] == mode}
        found = own["disc"]["divergence rate [%]"]
        yield Number(f"mode {mode}, divergence rate [%]", rate, found)
        yield Number("  into the disc [%]", into_disc, 100 * sum(row["friction into the disc [%]"] or 0 for row in own.values()) / found)
        for pin, share in shares:
            for side in ("top", "bottom"):
                yield Number(f"  pin_{side}_{pin} [%]", share, 100 * own[f"pin_{side}_{pin}"]["total [%]"] / found)


@entry("energy", "Powers add up; outer pins take energy from R0-2")
def sums(runs):
    results = runs("default", "disc_pins.prm", "Output/Mode shapes=none")
    difference = results.record["quantities"]["largest difference of a divergence rate from the sum of its contributions [-]"]
    yield Number("largest difference [-]", "1e-14", difference, bound=True)
    own = {row["body"]: row for row in results.rows("energy") if row["mode [-]"] == 13}
    for pin in (4, 5):
        yield Number(f"R0-2: pin_top_{pin} [%]", "-1.9",
                     100 * own[f"pin_top_{pin}"]["total [%]"] / own["disc"]["divergence rate [%]"])
