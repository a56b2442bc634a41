# SPDX-License-Identifier: GPL-3.0-or-later

"""Errors and costs of reduced bases, as in figures 10 to 18 of the paper."""

from squeal.plotting import style

CRITERIA = {"res [-]": "\u03b5_res", "mac [-]": "\u03b5_mac", "frq [-]": "\u03b5_frq", "div [-]": "\u03b5_div"}
FLOOR = 1e-16  # replaces zero and rounding errors on the logarithmic axis
MOST_COLUMNS = 3
AT_FLOOR = "on this line: 1e-16 or less"


class Candidate:
    """A basis and its truncation: errors by group of modes and column, and CPU times [s]."""

    def __init__(self, name, truncation, build_seconds, solve_seconds):
        self.name, self.truncation = name, truncation
        self.build_seconds, self.solve_seconds = build_seconds, solve_seconds
        self.errors = {}  # error by group and column

    @property
    def title(self):
        return self.name + (f" {self.truncation}" if self.truncation else "")

    def largest(self, column):
        return max(errors[column] for errors in self.errors.values())


def read_candidates(results):
    bases, errors = results.table("reduction_bases"), results.table("reduction_errors")
    columns = (bases.texts("basis"), bases.texts("component modes"), bases.numbers("build time [s]"), bases.numbers("solve time [s]"))
    candidates = {row[:2]: Candidate(*row) for row in zip(*columns)}
    values = {column: errors.numbers(column) for column in CRITERIA}
    for i, (name, truncation, group) in enumerate(zip(errors.texts("basis"), errors.texts("component modes"), errors.texts("group"))):
        candidates[name, truncation].errors[group] = {column: values[column][i] for column in CRITERIA}
    return list(candidates.values())


def draw_floor(panel, values):
    """Draws a line at FLOOR if a value is drawn there."""
    if any(value <= FLOOR for value in values):
        panel.axhline(FLOOR, color=style.GREY, linestyle=(0, (2, 2)), linewidth=1.2, zorder=1, label=AT_FLOOR)


def draw_errors(panel, candidates, names, group, criteria):
    """Draws one mark for each basis and criterion."""
    shown = []
    for candidate in candidates:
        number = names.index(candidate.name)
        # Offset marks to keep equal values visible
        offset = 0.75 * (number / (len(names) - 1) - 0.5) if len(names) > 1 else 0.0
        values = [candidate.errors[group][column] for column in criteria]
        shown += values
        panel.plot([place + offset for place in range(len(values))], [max(value, FLOOR) for value in values], linestyle="none",
                   label=candidate.name, markersize=6, **style.mark_of(number))
    draw_floor(panel, shown)
    panel.set_yscale("log")
    panel.set_xticks(range(len(criteria)), [CRITERIA[column] for column in criteria])
    panel.set_xlim(-0.5, len(criteria) - 0.5)
    panel.grid(False, axis="x")
    for place in range(1, len(criteria)):
        panel.axvline(place - 0.5, color="#dddddd", linewidth=0.8, zorder=0)


def error_figure(candidates):
    """A panel for each group of modes and each truncation of the component modes."""
    truncations = list(dict.fromkeys(candidate.truncation for candidate in candidates if candidate.truncation)) or [""]
    groups = list(dict.fromkeys(group for candidate in candidates for group in candidate.errors))
    names = list(dict.fromkeys(candidate.name for candidate in candidates))
    # Omit criteria without errors, such as the divergence rate if no mode grows
    criteria = [column for column in CRITERIA if any(candidate.largest(column) > 0 for candidate in candidates)]
    title = "Largest errors of reduced bases by group of modes"
    # One row for each truncation; if there is only one, its groups are wrapped
    n_columns = len(groups) if len(truncations) > 1 else min(len(groups), MOST_COLUMNS)
    picture = style.Picture(title, len(truncations) * len(groups), n_columns, (4.9, 3.6))
    panels = iter(picture.panels)
    for truncation in truncations:
        for group in groups:
            panel = next(panels)
            title = group + (f", component modes {truncation}" if len(truncations) > 1 else "")
            style.prepare(panel, title, "criterion", "largest error of the group [-]")
            draw_errors(panel, [candidate for candidate in candidates if candidate.truncation in ("", truncation)], names, group, criteria)
    return picture.add_key()


def pareto_front(points):
    """The Pareto-optimal points (cost, error), in ascending order of cost."""
    front = []
    for cost, error in sorted(points):
        if not front or error < front[-1][1]:
            front.append((cost, error))
    return front


def draw_costs(panel, candidates, column, costs):
    """Draws the largest error of each basis versus its cost, and the Pareto front."""
    errors = [max(candidate.largest(column), FLOOR) for candidate in candidates]
    front = pareto_front(zip(costs, errors))
    panel.plot(*zip(*front), color=style.GREY, linewidth=1.6, label="Pareto front", zorder=1)
    for number, (candidate, cost, error) in enumerate(zip(candidates, costs, errors)):
        panel.plot([cost], [error], linestyle="none", label=candidate.title, markersize=7, **style.mark_of(number))
    draw_floor(panel, errors)
    style.cost_axes(panel, costs)


def cost_figure(candidates, with_friction):
    column = "div [-]" if with_friction else "frq [-]"
    label = f"largest {CRITERIA[column]} [-]"
    picture = style.Picture("Cost and accuracy of reduced bases", 2, 2, (5.4, 4.2))
    times = ("CPU time per friction coefficient" if with_friction else "CPU time of the solution", "CPU time of the basis")
    seconds = ([candidate.solve_seconds for candidate in candidates], [candidate.build_seconds for candidate in candidates])
    for panel, time, costs in zip(picture.panels, times, seconds):
        style.prepare(panel, f"Error versus {time}", f"{time} [s]", label)
        draw_costs(panel, candidates, column, costs)
    return picture.add_key()


def figures(results):
    candidates = read_candidates(results)
    return {"reduction_errors": error_figure(candidates),
            "reduction_cost": cost_figure(candidates, results.parameter("Reduction/Problem") == "friction")}
