# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/accuracy.md"""

import statistics

import check_accuracy
from reproduction.numbers import Number, entry, several

# dofs, of the coarser mesh, estimated and found errors of f [%] and xi [points], converged, unstable, stable, undecided
GOALS = {"5": ("11952", "2520", "3.72", "0.747", "2.98", "0.171", "63", "5", "19", "42"),
         "1": ("52404", "21096", "0.791", "0.0936", "0.612", "0.0344", "66", "9", "47", "10"),
         "0.1": ("153012", "77292", "0.0518", "0.0187", "0.0432", "0.00211", "64", "9", "47", "10"),
         "0.01": ("265320", "153012", "0.0127", "0.000867", "0.0062", "0.0012", "62", "13", "53", "0")}


@entry("accuracy", "Errors that a run with an accuracy asked for estimates, and those that a finer mesh shows (40 min)")
def goals(runs):
    reference = runs("accuracy_reference", "accuracy/reference.prm")
    for goal, quoted in GOALS.items():
        results = runs(f"accuracy_{goal}", f"accuracy/{goal}_percent.prm", "Output/Mode shapes=none")
        counts, quantities = results.record["counts"], results.record["quantities"]
        errors = check_accuracy.compare(results, reference).query("converged == 1")
        found = [counts["dofs"], counts["dofs of the coarser mesh"],
                 100 * quantities["largest estimated error of a frequency by the mesh [-]"],
                 100 * quantities["largest estimated error of a divergence rate by the mesh [-]"],
                 *(errors[column].max() for column in check_accuracy.FOUND), counts["modes converged on the mesh"],
                 *(counts[f"modes {verdict} with the error of the mesh"] for verdict in ("unstable", "stable", "undecided"))]
        yield from several(f"Accuracy = {goal} %: ", ("dofs", "dofs of the coarser mesh", "estimated f [%]", "estimated xi [points]", "found f [%]",
                                                      "found xi [points]", "converged", "unstable", "stable", "undecided"), quoted, found)


# By row of complex_modes.csv: found frequency error and those estimated with elements 2 and 1.3 times as large [%]
BRAKE = {7: ("0.0011", "0.0002", "0.0099"), 8: ("0.356", "1.23", "0.320"), 10: ("0.540", "3.30", "0.647"), 12: ("1.09", "5.01", "1.09"),
         17: ("0.169", "0.963", "0.194")}
WHICH = ("found", "2 times", "1.3 times")
BRAKE_DIVERGENCE = ("0.0045", "0.028", "0.0028")  # of the last of them [points]


@entry("accuracy", "Disc brake: difference from coarser meshes and distance from a finer mesh")
def brake(runs):
    shapes, coarser = "Output/Mode shapes=none", "Discretization/Coarser mesh=disc_size = {}, pad_size = {}".format
    fine = runs("brake_fine", "brake.prm", shapes, "Geometry/disc_size=0.0063", "Geometry/pad_size=0.004").rows("complex_modes")
    twice, slightly = (runs(f"brake_{disc}", "brake.prm", shapes, coarser(disc, pad)).rows("complex_modes")
                       for disc, pad in ((0.019, 0.012), (0.0125, 0.0078)))
    estimated = "estimated frequency error by the mesh [%]"
    for row, quoted in BRAKE.items():
        found = 100 * abs(twice[row]["frequency [Hz]"] / fine[row]["frequency [Hz]"] - 1)
        yield from several(f"{fine[row]['label']} [%], ", WHICH, quoted, (found, twice[row][estimated], slightly[row][estimated]))
    found = abs(twice[17]["divergence rate [%]"] - fine[17]["divergence rate [%]"])
    estimated = "estimated divergence rate error by the mesh [%]"
    yield from several(f"{fine[17]['label']}, divergence rate [points], ", WHICH, BRAKE_DIVERGENCE, (found, twice[17][estimated], slightly[17][estimated]))


# Of full order by element and mesh factor: dofs, largest and rms frequency errors [%], largest divergence error [points]
DEFAULT_SCENE = {("trilinear", 1): ("8838", "9.17", "5.96", "0.134"),
                 ("trilinear", 1.5): ("21480", "4.25", "2.92", "0.0865"),
                 ("trilinear", 2): ("47040", "2.40", "1.68", "0.0414"),
                 ("incompatible modes", 1): ("8838", "7.03", "4.32", "0.0728"),
                 ("incompatible modes", 1.5): ("21480", "3.31", "2.04", "0.0811"),
                 ("incompatible modes", 2): ("47040", "1.95", "1.18", "0.0445"),
                 ("quadratic", 1): ("54600", "0.601", "0.324", "0.0406"),
                 ("quadratic", 1.5): ("141792", "0.237", "0.121", "0.0252"),
                 ("quadratic", 2): ("324108", "0.122", "0.0603", "0.0179")}
# Of full order by element and mesh factor: largest and rms frequency errors [%], modes without counterpart
ONE_PIN = {("trilinear", 0.5): ("16.4", "9.18", "2"),
           ("trilinear", 1): ("6.46", "3.49", "1"),
           ("trilinear", 1.5): ("2.35", "1.10", "1"),
           ("incompatible modes", 0.5): ("7.56", "3.97", "0"),
           ("incompatible modes", 1): ("2.02", "0.99", "0"),
           ("incompatible modes", 1.5): ("0.97", "0.20", "0")}
LARGEST, RMS = "frequency error [%]", "rms frequency error [%]"


def compared(results, quoted, columns):
    rows = {(row["element"], row["mesh factor [-]"]): row for row in results.rows("accuracy") if row["method"] == "full order"}
    for key, texts in quoted.items():
        yield from several(f"{key[0]}, mesh factor {key[1]}: ", columns, texts, map(rows[key].get, columns))


@entry("accuracy", "Errors of every element on three meshes of the default scene (20 min)")
def default_scene(runs):
    results = runs("accuracy", "studies/accuracy.prm")
    yield from compared(results, DEFAULT_SCENE, ("dofs [-]", LARGEST, RMS, "divergence error [percentage points]"))
    orders = [row["order of frequency [-]"] for row in results.rows("accuracy_orders") if row["family"].startswith("quadratic")]
    yield Number("modes whose frequency shows an order", "66", sum(isinstance(order, float) for order in orders))
    yield Number("their order in the middle", "2.4", statistics.median(orders))


@entry("accuracy", "Errors with one pin on each side")
def one_pin(runs):
    yield from compared(runs("accuracy_one_pin", "studies/accuracy_one_pin.prm"), ONE_PIN, (LARGEST, RMS, "modes without counterpart [-]"))
