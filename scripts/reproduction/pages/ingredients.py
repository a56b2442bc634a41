# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/ingredients.md"""

from reproduction.numbers import Number, entry, several, table

DEFAULT = ("ingredients", "disc_pins.prm", "Study=ingredients", "Ingredients/Trial friction slope=-0.01", "Ingredients/Trial damping ratio=0.001")
FREQUENCY, DIVERGENCE = "change of frequency [%]", "change of divergence rate [percentage points]"


def of_table(rows, head):
    """Numbers for frequency, divergence rate, unstable modes and verdict in the rows of a table of the page."""
    for feature, tried, frequency, _, divergence, _, unstable, verdict, *_ in table("ingredients", head):
        row = rows[feature, tried]
        yield from several(f"{feature}: {tried}, ", ("frequency [%]", "divergence rate [points]", "unstable modes", "verdict changes (1) or not (0)"),
                           (frequency, divergence, unstable, str(int(verdict == "changes"))),
                           (row[FREQUENCY], row[DIVERGENCE], row["unstable modes in variant [-]"], row["verdict changed [-]"]))


def rows_of(runs, *run):
    """Rows of a run by feature and variant; a variant may be a number."""
    rows = runs(*run).rows("ingredients")
    return {(row["ingredient"], row["variant"] if isinstance(row["variant"], str) else f"{row['variant']:g}"): row for row in rows}


@entry("ingredients", "The table of the default model")
def default_scene(runs):
    rows = rows_of(runs, *DEFAULT)
    yield from of_table(rows, "unstable | verdict")
    yield Number("unstable modes of the model", "9", rows["complex modes", "residual iteration"]["unstable modes in reference [-]"])


@entry("ingredients", "First-order responses, a friction slope, and modes lost by halving the band")
def statements(runs):
    rows = rows_of(runs, *DEFAULT)
    real, response = rows["complex modes", "real modes alone"], rows["complex modes", "real modes + 1st order"]
    yield Number("error of the divergence rate over the error of real modes alone", "0.37", response[DIVERGENCE] / real[DIVERGENCE])
    slope = rows["friction slope", "-0.01 s/m"]
    yield Number("additional growing modes with a slope", "34", slope["unstable modes in variant [-]"] - slope["unstable modes in reference [-]"])
    yield Number("modes lost by halving the band", "49", rows["band", "to 2500 Hz"]["modes without counterpart [-]"])


@entry("ingredients", "The table of the model with all damping")
def with_all_damping(runs):
    rows = rows_of(runs, "ingredients_damped", "studies/ingredients.prm")
    yield from of_table(rows, "verdict | cost")
    yield Number("unstable modes of the model", "4", rows["friction slope", "none"]["unstable modes in reference [-]"])
