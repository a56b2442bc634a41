# SPDX-License-Identifier: GPL-3.0-or-later

"""Onset of squeal and largest divergence rate versus each variable of a design study."""

import math

from squeal.plotting import style
from squeal.reporting.designs import LARGEST, ONSET, name_of, positions, variables_of

MOST_VARIABLES, MOST_LABELS = 8, 10


def figures(results):
    table = results.table("designs")
    variables = variables_of(table)[:MOST_VARIABLES]
    solved = [outcome == "solved" for outcome in table.texts("outcome")]
    if not variables or not any(solved):
        return {}
    end = results.number("Sweep/Last friction coefficient")
    panels = ((ONSET, "label at 0.01 %", "onset \u03bc (0.01 %) [-]"), (LARGEST, "label of largest", "largest divergence rate [%]"))
    labels = list(dict.fromkeys(label for _, column, _ in panels for label in table.texts(column) if label))
    marks = {label: style.mark_of(min(number, MOST_LABELS)) for number, label in enumerate(sorted(labels))}
    others = set(sorted(labels)[MOST_LABELS:])

    picture = style.Picture("Designs: onset of squeal and largest divergence rate", 2 * len(variables), len(variables), (3.6, 3.0))
    for row, (column, label_column, title) in enumerate(panels):
        values, names = table.numbers(column), table.texts(label_column)
        for number, variable in enumerate(variables):
            panel = picture.panels[row * len(variables) + number]
            style.prepare(panel, "", name_of(variable) if row else "", title if number == 0 else "")
            places, ticks = positions(table.texts(variable))
            for x, y, name, is_solved in zip(places, values, names, solved):
                if not is_solved:
                    continue
                if math.isnan(y):
                    # No mode reaches 0.01 %, or none grows, up to the last friction coefficient
                    panel.plot(x, end if row == 0 else 0, linestyle="", marker="o", markersize=6, color=style.BLACK, markerfacecolor="white",
                               label="quiet")
                else:
                    panel.plot(x, y, linestyle="", markersize=5, label="others" if name in others else name, **marks[name])
            if ticks:
                panel.set_xticks(range(len(ticks)), ticks, fontsize=style.SMALL)
            panel.set_ylim(bottom=0)
    return {"designs": picture.add_key()}
