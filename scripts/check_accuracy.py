#!/usr/bin/python3
"""Holds the errors that a run with `set Accuracy` estimates against a run on a much finer mesh.

    scripts/check_accuracy.py RUN REFERENCE

RUN and REFERENCE are result folders. Modes are paired by their λ among those of one kind, the letters of their labels, where these
have not changed, so that the sum of the distances is smallest: not by shape, as the program does. Prints the largest errors of frequencies
and divergence rates of all modes and of those that RUN calls converged, how many errors are larger than estimated, and every mode that is
called converged and is off by more than the accuracy, or by a tenth of that in percentage points of the divergence rate. The exit status
is 1 if there is one.
"""

import pathlib
import sys

import numpy as np
from scipy.optimize import linear_sum_assignment

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from squeal.command_line import Parser, exit_on_error
from squeal.errors import Error
from squeal.parameter_file import read_parameters
from squeal.results import read_table

FREQUENCY, DIVERGENCE = "frequency [Hz]", "divergence rate [%]"
ESTIMATED_FREQUENCY, ESTIMATED_DIVERGENCE = ("estimated frequency error by the mesh [%]", "estimated divergence rate error by the mesh [%]")
OTHER_KIND = 0.002  # of the frequency: where disc and pins take part alike, a mode's name may change from mesh to mesh


def read(folder):
    return read_table(pathlib.Path(folder) / "complex_modes.csv")


def accuracy(folder):
    """What RUN was asked for [%]."""
    goal = read_parameters(pathlib.Path(folder) / "parameters.prm").get("Accuracy", "as given")
    if goal == "as given":
        raise Error("the run has no `set Accuracy`", folder, "run with `set Accuracy = ...`")
    return float(goal.replace("%", ""))


def kind(mode):
    return mode["label"].split("-")[0].split(" ")[0]


def pairs(modes, reference):
    """Each mode with its counterpart."""
    def distance(a, b):
        frequency = float(a[FREQUENCY]) / float(b[FREQUENCY]) - 1
        divergence = (float(a[DIVERGENCE]) - float(b[DIVERGENCE])) / 100
        return np.hypot(frequency, divergence) + OTHER_KIND * (kind(a) != kind(b))

    rows, columns = linear_sum_assignment([[distance(a, b) for b in reference] for a in modes])
    return [(modes[row], reference[column]) for row, column in zip(rows, columns)]


def error(pair):
    """Relative, of the frequency, and of the divergence rate in percentage points [%]."""
    mode, exact = pair
    return (100 * abs(float(mode[FREQUENCY]) / float(exact[FREQUENCY]) - 1), abs(float(mode[DIVERGENCE]) - float(exact[DIVERGENCE])))


def print_largest(what, chosen):
    if chosen:
        errors = [error(pair) for pair in chosen]
        print(f"  {what:<44} {len(chosen):>4}   {max(e[0] for e in errors):>9.4f}   {max(e[1] for e in errors):>9.4f}")


@exit_on_error()
def main():
    parser = Parser(__doc__)
    parser.add_argument("run")
    parser.add_argument("reference")
    arguments = parser.parse_args()
    modes, reference = read(arguments.run), read(arguments.reference)
    if ESTIMATED_FREQUENCY not in modes[0]:
        raise Error("the run has no estimated errors", arguments.run, "run with `set Accuracy = ...`")
    found = pairs(modes, reference)
    converged = [pair for pair in found if pair[0]["converged [-]"] == "1"]
    print(f"  {'':<44} modes   f [%]       xi [points]")
    print_largest("all", found)
    print_largest("converged", converged)
    print_largest("converged, outside of clusters", [pair for pair in converged if pair[0]["counterpart on the coarser mesh"] == "by shape"])
    n_over = sum(error(pair)[0] > float(pair[0][ESTIMATED_FREQUENCY]) or error(pair)[1] > float(pair[0][ESTIMATED_DIVERGENCE])
                 for pair in converged)
    print(f"  errors larger than estimated: {n_over} of {len(converged)}")
    goal = accuracy(arguments.run)
    wrong = [pair for pair in converged if error(pair)[0] > goal or error(pair)[1] > goal / 10]
    print(f"  called converged, and off by more than {goal:g} % or {goal / 10:g} points: {len(wrong)}")
    for mode, exact in wrong:
        frequency, divergence = error((mode, exact))
        print(f"    {mode['label']:<10} {float(mode[FREQUENCY]):9.2f} Hz: {frequency:.4f} % (estimated {float(mode[ESTIMATED_FREQUENCY]):.4f}), "
              f"{divergence:.4f} points (estimated {float(mode[ESTIMATED_DIVERGENCE]):.4f})")
    return len(wrong) > 0


if __name__ == "__main__":
    sys.exit(main())
