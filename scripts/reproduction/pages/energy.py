# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/energy.md"""

from reproduction.numbers import Number, entry, numbers_in, table

MODES = (17, 21, 37, 44)  # row numbers in complex_modes.csv


@entry("energy", "The table of the default model")
def default_scene(runs):
    rows = runs.default().rows("energy")
    for mode, (_, *cells) in zip(MODES, table("energy", "friction work on the disc"), strict=True):
        rate, into_disc, *shares = numbers_in(*cells)
        own = {row["body"]: row for row in rows if row["mode [-]"] == mode}
        found = own["disc"]["divergence rate [%]"]
        yield Number(f"mode {mode}, divergence rate [%]", rate, found)
        yield Number("  into the disc [%]", into_disc, 100 * sum(row["friction into the disc [%]"] or 0 for row in own.values()) / found)
        for pin, share in zip(shares[::2], shares[1::2]):
            for side in ("top", "bottom"):
                yield Number(f"  pin_{side}_{pin} [%]", share, 100 * own[f"pin_{side}_{pin}"]["total [%]"] / found)


@entry("energy", "Powers add up; outer pins take energy from R0-2")
def sums(runs):
    results = runs.default()
    difference = results.record["quantities"]["largest difference of a divergence rate from the sum of its contributions [-]"]
    yield Number("largest difference [-]", "1e-14", difference, bound=True)
    own = {row["body"]: row for row in results.rows("energy") if row["mode [-]"] == 13}
    for pin in (4, 5):
        yield Number(f"R0-2: pin_top_{pin} [%]", "-1.9",
                     100 * own[f"pin_top_{pin}"]["total [%]"] / own["disc"]["divergence rate [%]"])
