"""doc/accuracy.md"""

import check_accuracy
from reproduction.numbers import Number, entry

# dofs, of the coarser mesh, estimated and found errors of f [%] and xi [points], converged, unstable, stable, undecided
GOALS = {"5": ("11952", "2520", "3.72", "0.747", "2.98", "0.171", "63", "5", "19", "42"),
         "1": ("52404", "21096", "0.791", "0.0936", "0.612", "0.0344", "66", "9", "47", "10"),
         "0.1": ("153012", "77292", "0.0518", "0.0187", "0.0432", "0.00211", "64", "9", "47", "10"),
         "0.01": ("265320", "153012", "0.0127", "0.000867", "0.0062", "0.0012", "62", "13", "53", "0")}


@entry("accuracy", "Errors that a run with an accuracy asked for estimates, and those that a finer mesh shows (40 min)")
def goals(runs):
    reference = check_accuracy.read(runs("accuracy_reference", "accuracy/reference.prm").folder)
    for goal, quoted in GOALS.items():
        results = runs(f"accuracy_{goal}", f"accuracy/{goal}_percent.prm", "Output/Mode shapes=none")
        counts, quantities = results.record["counts"], results.record["quantities"]
        converged = [pair for pair in check_accuracy.pairs(check_accuracy.read(results.folder), reference) if pair[0]["converged [-]"] == "1"]
        errors = [check_accuracy.error(pair) for pair in converged]
        found = [counts["dofs"], counts["dofs of the coarser mesh"],
                 100 * quantities["largest estimated error of a frequency by the mesh [-]"],
                 100 * quantities["largest estimated error of a divergence rate by the mesh [-]"],
                 max(error[0] for error in errors), max(error[1] for error in errors), counts["modes converged on the mesh"],
                 *(counts[f"modes {verdict} with the error of the mesh"] for verdict in ("unstable", "stable", "undecided"))]
        for what, text, value in zip(("dofs", "dofs of the coarser mesh", "estimated f [%]", "estimated xi [points]", "found f [%]",
                                      "found xi [points]", "converged", "unstable", "stable", "undecided"), quoted, found):
            yield Number(f"Accuracy = {goal} %: {what}", text, value)
