# SPDX-License-Identifier: GPL-3.0-or-later

"""Largest changes caused by each part of the model, compared with the required accuracy, and the cost of each variant.
"""

import math

from squeal.plotting import style

LEAST = 1e-6  # smaller changes are rounding errors [%]

PANELS = (("change of frequency [%]", "change of frequency [%]", "Ingredients/Frequency tolerance"),
          ("change of divergence rate [percentage points]", "change of divergence rate [points]", "Ingredients/Divergence tolerance"))
COST = "cost relative to reference [-]"


def draw_bars(panel, values, changed):
    """Draws a bar for each available value, coloured by whether the verdict changes."""
    for colour, label, wanted in ((style.BLUE, "verdict unchanged", False), (style.VERMILLION, "verdict changed", True)):
        chosen = [place for place, flag in enumerate(changed) if flag is wanted and not math.isnan(values[place])]
        style.draw_bars(panel, chosen, [values[place] for place in chosen], colour, label, wanted)


def figures(results):
    table = results.table("ingredients")
    names = [f"{ingredient}: {tried}" if reason == "" else f"{ingredient}: not tried"
             for ingredient, tried, reason in zip(table.texts("ingredient"), table.texts("variant"), table.texts("reason not tried"))]
    names = [name if len(name) < 42 else name[:39] + "..." for name in names]
    changed = [number == 1 for number in table.numbers("verdict changed [-]")]

    picture = style.Picture("Effect of each part of the model", 3, 3, (3.9, style.BAR * len(table) + 1.1))
    for panel, (column, label, parameter) in zip(picture.panels, PANELS):
        style.prepare(panel, "", label, "")
        panel.set_xscale("log")
        values = [value if math.isnan(value) or value > LEAST else math.nan for value in table.numbers(column)]
        draw_bars(panel, values, changed)
        panel.axvline(results.number(parameter), color=style.BLACK, linestyle="--", linewidth=1.1, label="required accuracy")
        panel.set_xlim(left=LEAST)
    style.prepare(picture.panels[2], "", "CPU time relative to reference [-]", "")
    draw_bars(picture.panels[2], table.numbers(COST), changed)
    picture.panels[2].axvline(1, color=style.GREY, linewidth=1.1, label="reference model")
    for panel in picture.panels:
        style.name_rows(panel, names if panel is picture.panels[0] else [""] * len(table))
    return {"ingredients": picture.add_key()}
