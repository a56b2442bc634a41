# SPDX-License-Identifier: GPL-3.0-or-later

"""Accuracy versus cost: errors of meshes, elements and bases versus CPU time."""

from squeal.plotting import style
from squeal.plotting.reduction import pareto_front

FULL_ORDER = "full order"
KINDS = ("discretisation", "reduction", "algebraic")
FLOOR = 1e-12  # replaces zero and rounding errors on the logarithmic axis [%]
TIME = "CPU time [s]"
FREQUENCY, DIVERGENCE = "frequency error [%]", "divergence error [percentage points]"
TITLES = {FREQUENCY: "largest frequency error [%]", DIVERGENCE: "largest divergence error [points]"}


class Solution:
    """Cost and errors of one mesh, element type and solution method."""

    def __init__(self, row):
        self.family = row["element"] + ("" if row["outlines"] == "curved" else f", {row['outlines']}")
        self.method, self.seconds = row["method"], float(row[TIME])
        self.is_complete = row["modes without counterpart [-]"] == "0"
        self.errors = {column: max(float(row[column]), FLOOR) for column in row if column.endswith((FREQUENCY, DIVERGENCE))}


def cost_figure(solutions):
    """One panel for frequencies and one for divergence rates; lines connect the meshes of a family at full order."""
    picture = style.Picture("Accuracy versus cost", 2, 2, (5.6, 4.4))
    families = dict.fromkeys(solution.family for solution in solutions)
    for panel, column in zip(picture.panels, (FREQUENCY, DIVERGENCE)):
        style.prepare(panel, "", TIME, TITLES[column])
        if all(solution.errors[column] <= FLOOR for solution in solutions):
            panel.text(0.5, 0.5, "only rounding errors outside clusters", transform=panel.transAxes, ha="center", color=style.GREY)
            panel.set_xticks([])
            panel.set_yticks([])
            continue
        front = pareto_front((solution.seconds, solution.errors[column]) for solution in solutions if solution.is_complete)
        style.draw_points(panel, front, linestyle="-", color=style.GREY, linewidth=1.6, label="Pareto front (all modes found)", zorder=1)
        for number, family in enumerate(families):
            look = style.mark_of(number)
            own = sorted((s for s in solutions if s.family == family), key=lambda solution: solution.seconds)
            full, reduced = ([(s.seconds, s.errors[column]) for s in own if (s.method == FULL_ORDER) == is_full] for is_full in (True, False))
            style.draw_points(panel, full, linestyle=":", linewidth=1, label=f"{family}, {FULL_ORDER}", markersize=6, **look)
            style.draw_points(panel, reduced, label=f"{family}, reduced", markersize=6, **{**look, "markerfacecolor": "white"})
        style.cost_axes(panel, [solution.seconds for solution in solutions])
    return picture.add_key()


def kind_figure(solutions):
    """A panel for each method and quantity, with marks for the kinds of error on each mesh; rounding errors are omitted."""
    methods = list(dict.fromkeys(solution.method for solution in solutions))
    picture = style.Picture("Errors by kind", 2 * len(methods), len(methods), (4.4, 3.6))
    panels = iter(picture.panels)
    for column in (FREQUENCY, DIVERGENCE):
        for method in methods:
            panel = next(panels)
            style.prepare(panel, method, TIME, TITLES[column])
            own = [solution for solution in solutions if solution.method == method]
            for number, kind in enumerate(KINDS):
                points = [(solution.seconds, solution.errors[f"{kind} {column}"]) for solution in own]
                style.draw_points(panel, [point for point in points if point[1] > FLOOR], label=kind, markersize=6, **style.mark_of(number))
            style.cost_axes(panel, [solution.seconds for solution in own])
    return picture.add_key()


def figures(results):
    solutions = [Solution(row) for row in results.table("accuracy").rows]
    return {"accuracy": cost_figure(solutions), "accuracy_kinds": kind_figure(solutions)}
