# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/accuracy.md"""

import statistics

import check_accuracy
from reproduction.numbers import Number, entry, numbers_in, several, table


@entry("accuracy", "Errors estimated by runs with a required accuracy, and errors relative to a finer mesh (40 min)")
def goals(runs):
    reference = runs("accuracy_reference", "accuracy/reference.prm")
    for goal, *cells in table("accuracy", "found f [%]"):
        goal, = numbers_in(goal)
        results = runs(f"accuracy_{goal}", f"accuracy/{goal}_percent.prm", "Output/Mode shapes=none")
        counts, quantities = results.record["counts"], results.record["quantities"]
        errors = check_accuracy.compare(results, reference).query("converged == 1")
        found = [counts["dofs"], counts["dofs of the coarser mesh"],
                 100 * quantities["largest estimated error of a frequency by the mesh [-]"],
                 100 * quantities["largest estimated error of a divergence rate by the mesh [-]"],
                 *(errors[column].max() for column in check_accuracy.FOUND), counts["modes converged on the mesh"],
                 *(counts[f"modes {verdict} with the error of the mesh"] for verdict in ("unstable", "stable", "undecided"))]
        yield from several(f"Accuracy = {goal} %: ", ("dofs", "dofs of the coarser mesh", "estimated f [%]", "estimated xi [points]", "found f [%]",
                                                      "found xi [points]", "converged", "unstable", "stable", "undecided"),
                           numbers_in(*cells[:7], cells[8]), found)


BRAKE = (7, 8, 10, 12, 17)  # row numbers in complex_modes.csv
WHICH = ("found", "2 times", "1.3 times")


@entry("accuracy", "Disc brake: difference from coarser meshes and distance from a finer mesh")
def brake(runs):
    shapes, coarser = "Output/Mode shapes=none", "Discretization/Coarser mesh=disc_size = {}, pad_size = {}".format
    fine = runs("brake_fine", "brake.prm", shapes, "Geometry/disc_size=0.0063", "Geometry/pad_size=0.004").rows("complex_modes")
    twice, slightly = (runs(f"brake_{disc}", "brake.prm", shapes, coarser(disc, pad)).rows("complex_modes")
                       for disc, pad in ((0.019, 0.012), (0.0125, 0.0078)))
    estimated = "estimated frequency error by the mesh [%]"
    *frequencies, divergence = table("accuracy", "1.3 times")
    for row, (_, _, *quoted) in zip(BRAKE, frequencies, strict=True):
        found = 100 * abs(twice[row]["frequency [Hz]"] / fine[row]["frequency [Hz]"] - 1)
        yield from several(f"{fine[row]['label']} [%], ", WHICH, quoted, (found, twice[row][estimated], slightly[row][estimated]))
    found = abs(twice[17]["divergence rate [%]"] - fine[17]["divergence rate [%]"])
    estimated = "estimated divergence rate error by the mesh [%]"
    yield from several(f"{fine[17]['label']}, divergence rate [points], ", WHICH, divergence[2:], (found, twice[17][estimated], slightly[17][estimated]))


LARGEST, RMS = "frequency error [%]", "rms frequency error [%]"


def compared(results, quoted, columns):
    """Errors at full order, compared with quoted rows: element, mesh factor, and values of `columns`."""
    rows = {(row["element"], row["mesh factor [-]"]): row for row in results.rows("accuracy") if row["method"] == "full order"}
    for element, factor, *texts in quoted:
        yield from several(f"{element}, mesh factor {factor}: ", columns, texts, map(rows[element, float(factor)].get, columns))


@entry("accuracy", "Errors of every element on three meshes of the default model (20 min)")
def default_scene(runs):
    results = runs("accuracy", "studies/accuracy.prm")
    yield from compared(results, (cells[:6] for cells in table("accuracy", "memory [GB]")), ("dofs [-]", LARGEST, RMS, "divergence error [percentage points]"))
    orders = [row["order of frequency [-]"] for row in results.rows("accuracy_orders") if row["family"].startswith("quadratic")]
    yield Number("modes whose frequency shows an order", "66", sum(isinstance(order, float) for order in orders))
    yield Number("their median order", "2.4", statistics.median(orders))


@entry("accuracy", "Errors with one pin on each side")
def one_pin(runs):
    quoted = ((*cells[:4], cells[5]) for cells in table("accuracy", "without counterpart"))
    yield from compared(runs("accuracy_one_pin", "studies/accuracy_one_pin.prm"), quoted, (LARGEST, RMS, "modes without counterpart [-]"))
