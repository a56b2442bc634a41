#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Compares the errors estimated by a run with `set Accuracy` with its differences from a run on a much finer mesh.

    scripts/check_accuracy.py RUN REFERENCE

RUN and REFERENCE are result folders. Modes are paired by the smallest sum of distances of λ, with a penalty for
different kinds (the beginning of the label, such as A0), and not by shape as in the program. Prints the largest errors of frequencies
and divergence rates of all modes and of converged modes, and the number of converged modes with an error larger than
estimated. Lists converged modes with a frequency error above the accuracy, or a divergence rate error in percentage
points above a tenth of the accuracy; the exit status is 1 if the list is not empty.
"""

import pathlib
import sys

import numpy as np
from scipy.optimize import linear_sum_assignment

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
import squeal
from squeal.command_line import Parser, exit_on_error

OTHER_KIND = 0.002  # penalty as a fraction of the frequency; the label of a mixed mode may differ between meshes
ESTIMATED = ("estimated frequency error by the mesh", "estimated divergence rate error by the mesh")
FOUND = ("frequency error", "divergence error")  # columns of errors: relative [%], and in percentage points


def compare(run, reference):
    """The modes of `run` as a data frame, with their errors relative to the modes of `reference`."""
    modes, exact = run.modes, reference.modes
    frequency = abs(np.divide.outer(modes["frequency"].values, exact["frequency"].values) - 1)
    divergence = abs(np.subtract.outer(modes["divergence rate"].values, exact["divergence rate"].values))
    kinds, others = (frame["label"].str.extract("^([^- ]*)", expand=False).values for frame in (modes, exact))
    pairs = linear_sum_assignment(np.hypot(frequency, divergence / 100) + OTHER_KIND * np.not_equal.outer(kinds, others))
    return modes.iloc[pairs[0]].assign(**dict(zip(FOUND, (100 * frequency[pairs], divergence[pairs]))))


@exit_on_error()
def main():
    parser = Parser(__doc__)
    parser.add_argument("run")
    parser.add_argument("reference")
    arguments = parser.parse_args()
    run = squeal.Results(arguments.run)
    goal = run.parameters.get("Accuracy", "as given")
    if goal == "as given" or ESTIMATED[0] not in run.modes:
        raise squeal.Error("the run has no required accuracy or no estimated errors", arguments.run, "repeat the run with, e.g., `set Accuracy = 1 %`")
    goal = float(goal.replace("%", ""))
    modes = compare(run, squeal.Results(arguments.reference))
    converged = modes[modes["converged"] == 1]
    print(f"  {'':<44} modes   f [%]       xi [points]")
    outside = converged[converged["counterpart on the coarser mesh"] == "by shape"]
    for what, chosen in (("all", modes), ("converged", converged), ("converged, outside of clusters", outside)):
        if len(chosen):
            print(f"  {what:<44} {len(chosen):>4}   " + "   ".join(f"{chosen[column].max():>9.4f}" for column in FOUND))
    n_over = sum((~(converged[list(FOUND)].values <= converged[list(ESTIMATED)].values)).any(axis=1))
    print(f"  converged modes with errors larger than estimated: {n_over} of {len(converged)}")
    wrong = converged[(converged[FOUND[0]] > goal) | (converged[FOUND[1]] > goal / 10)]
    print(f"  reported as converged with errors above {goal:g} % or {goal / 10:g} points: {len(wrong)}")
    for _, mode in wrong.iterrows():
        print(f"    {mode['label']:<10} {mode['frequency']:9.2f} Hz: {mode[FOUND[0]]:.4f} % (estimated {mode[ESTIMATED[0]]:.4f}), "
              f"{mode[FOUND[1]]:.4f} points (estimated {mode[ESTIMATED[1]]:.4f})")
    return len(wrong) > 0


if __name__ == "__main__":
    sys.exit(main())
