# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/ingredients.md"""

from reproduction.numbers import Number, entry, several

TRIALS = ("Study=ingredients", "Ingredients/Trial friction slope=-0.01", "Ingredients/Trial damping ratio=0.001")
FREQUENCY, DIVERGENCE = "change of frequency [%]", "change of divergence rate [percentage points]"

# Frequency, divergence rate, unstable modes
QUOTED = {"consistent": ("0.49", "2.07", "12"),
          "steady sliding": ("0", "0", "9"),
          "-0.01 s/m": ("0.043", "0.065", "43"),
          "0.001": ("0.0008", "0.101", "5"),
          "on": ("0.106", "0.054", "25"),
          "incompatible modes": ("1.36", "0.040", "12"),
          "quadratic": ("2.97", "0.121", "13"),
          "true area": ("0.83", "0.039", "8"),
          "real modes alone": ("0.63", "0.33", "14"),
          "real modes to 7500 Hz": ("0.63", "0.33", "14"),
          "real modes + 1st order": ("0.15", "0.12", "9"),
          "to 2500 Hz": ("0", "0", "3")}
CHANGES = {"consistent", "-0.01 s/m", "on", "quadratic", "real modes alone", "real modes to 7500 Hz", "real modes + 1st order", "to 2500 Hz"}


def of_row(name, row, frequency, divergence, unstable, changes):
    yield from several(f"{name}, ", ("frequency [%]", "divergence rate [points]", "unstable modes", "verdict changes (1) or not (0)"),
                       (frequency, divergence, unstable, str(int(changes))),
                       (row[FREQUENCY], row[DIVERGENCE], row["unstable modes in variant [-]"], row["verdict changed [-]"]))


def rows_of(runs):
    rows = runs("ingredients", "disc_pins.prm", *TRIALS).rows("ingredients")
    # A table's numbers are numbers, also where they name what was tried
    return {row["variant"] if isinstance(row["variant"], str) else f"{row['tried']:g}": row for row in rows}


@entry("ingredients", "The table of the default scene")
def default_scene(runs):
    rows = rows_of(runs)
    for tried, quoted in QUOTED.items():
        yield from of_row(f"{rows[tried]['ingredient']}: {tried}", rows[tried], *quoted, tried in CHANGES)
    row = rows["residual iteration"]
    yield Number("residual iteration, frequency [%]", "0.000005", row[FREQUENCY])
    yield Number("residual iteration, divergence rate [points]", "0.000003", row[DIVERGENCE])
    yield Number("unstable modes of the scene", "9", row["unstable modes in reference [-]"])


@entry("ingredients", "First-order responses, a slope, and what half of the band loses")
def statements(runs):
    rows = rows_of(runs)
    real, response = rows["real modes alone"], rows["real modes + 1st order"]
    yield Number("error in divergence rate beside real modes alone", "0.37", response[DIVERGENCE] / real[DIVERGENCE])
    slope = rows["-0.01 s/m"]
    yield Number("more modes that grow with a slope", "34", slope["unstable modes in variant [-]"] - slope["unstable modes in reference [-]"])
    yield Number("modes that half of the band loses", "49", rows["to 2500 Hz"]["modes without counterpart [-]"])


# Frequency, divergence rate, unstable modes
QUOTED_WITH_DAMPING = {("radial dissipation", "none"): ("0.43", "1.80", "5"),
                       ("contact state", "equal load"): ("0.18", "0.69", "4"),
                       ("friction slope", "none"): ("0.007", "0.046", "3"),
                       ("Rayleigh damping", "none"): ("0.041", "0.56", "13"),
                       ("modal damping", "0.001"): ("0.003", "0.101", "3"),
                       ("rotation of the disc", "on"): ("0.106", "0.054", "5"),
                       ("element", "incompatible modes"): ("1.36", "0.075", "4"),
                       ("element", "quadratic"): ("3.43", "0.45", "4"),
                       ("outlines", "true area"): ("0.83", "0.085", "4"),
                       ("complex modes", "real modes alone"): ("0.67", "0.26", "4"),
                       ("complex modes", "real modes to 7500 Hz"): ("0.67", "0.26", "4"),
                       ("complex modes", "real modes + 1st order"): ("0.098", "0.076", "4"),
                       ("band", "to 2500 Hz"): ("0", "0", "2")}
CHANGES_WITH_DAMPING = {"Rayleigh damping", "rotation of the disc", "band"}


@entry("ingredients", "The table of the scene with all damping")
def with_all_damping(runs):
    rows = {(row["ingredient"], row["variant"] if isinstance(row["variant"], str) else f"{row['tried']:g}"): row
            for row in runs("ingredients_damped", "studies/ingredients.prm").rows("ingredients")}
    for (ingredient, tried), quoted in QUOTED_WITH_DAMPING.items():
        yield from of_row(f"{ingredient}: {tried}", rows[ingredient, tried], *quoted, ingredient in CHANGES_WITH_DAMPING)
    yield Number("unstable modes of the scene", "4", rows["friction slope", "none"]["unstable modes in reference [-]"])
