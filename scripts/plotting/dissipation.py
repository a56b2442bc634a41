"""Divergence rates with every reading of the radial dissipation, side by side."""

import math

from matplotlib.ticker import FuncFormatter

from plotting import style

LINEAR_TO = 0.01  # divergence rates up to this [%] are on a linear scale, larger ones on a logarithmic one
NAME_WIDTH = 0.17  # of the column of a mode [inches]


def draw(panel, table, names_column, title):
    """A column of marks for each row of a table, one mark for each reading; returns the names of the rows."""
    style.prepare(panel, title, "", style.DIVERGENCE)
    names = table.texts(names_column)
    readings = [column for column in table.columns if column.endswith(" [%]")]
    for number, column in enumerate(readings):
        offset = 0.6 * (number / (len(readings) - 1) - 0.5) if len(readings) > 1 else 0.0
        places = [(place + offset, rate) for place, rate in enumerate(table.numbers(column)) if not math.isnan(rate)]
        if places:
            panel.plot(*zip(*places), linestyle="none", label=column.removesuffix(" [%]"), markersize=4.5, **style.mark_of(number))
    style.zero_line(panel)
    panel.set_xlim(-0.6, len(names) - 0.4)
    return names


def figures(results):
    """Of a study of the readings of the radial dissipation."""
    if not results.has("dissipation"):
        return {}
    modes, ranges = results.table("dissipation"), results.table("dissipation_ranges")
    width = max(6.0, NAME_WIDTH * len(modes) + 1)
    picture = style.Picture("Readings of the radial dissipation", 2, 1, (width, 4.2))
    picture.panels[0].set_yscale("symlog", linthresh=LINEAR_TO)
    names = draw(picture.panels[0], modes, "label", "All modes of the band")
    picture.panels[0].set_xticks(range(len(names)), names, rotation=90, fontsize=style.SMALL)
    picture.panels[0].yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    names = draw(picture.panels[1], ranges, "damped pin modes", "Pin modes that the paper lists as damped")
    picture.panels[1].set_xticks(range(len(names)), names)
    return {"dissipation": picture.add_key()}
