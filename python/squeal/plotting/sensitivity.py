# SPDX-License-Identifier: GPL-3.0-or-later

"""Changes in the divergence rates of modes for a 1 % increase in each parameter."""

from squeal.plotting import style
from squeal.reporting.sensitivity import CHANGE, ranking

MOST_MODES = 4


def figures(results):
    modes = list(filter(None, map(ranking, results.table("sensitivities").groups("mode [-]"))))[:MOST_MODES]
    names = [row["parameter"] for row in modes[0]]
    picture = style.Picture("Effect of a 1 % increase in each parameter", len(modes), len(modes), (3.9, style.BAR * len(names) + 1.3))
    for panel, rows in zip(picture.panels, modes):
        label, frequency, rate = (rows[0][name] for name in ("label", "frequency [Hz]", "divergence rate [%]"))
        changes = {row["parameter"]: float(row[CHANGE]) for row in rows}
        title = f"{label}, {float(frequency):.0f} Hz, {float(rate):.3g} %"
        style.prepare(panel, title, "change in divergence rate [points]", "")
        for colour, text, sign in ((style.VERMILLION, "increase: grows faster", 1), (style.BLUE, "increase: grows more slowly", -1)):
            chosen = [place for place, name in enumerate(names) if sign * changes[name] > 0]
            style.draw_bars(panel, chosen, [changes[names[place]] for place in chosen], colour, text, sign < 0)
        panel.axvline(0, color=style.GREY, linewidth=1.1)
        style.name_rows(panel, names if panel is picture.panels[0] else [""] * len(names))
        panel.ticklabel_format(axis="x", style="plain", useOffset=False)
        panel.locator_params(axis="x", nbins=5)
    return {"sensitivity": picture.add_key()}
