# SPDX-License-Identifier: GPL-3.0-or-later

"""Change of the divergence rates of growing modes by a 1 % increase of each parameter."""

import math

from squeal.plotting import style

MOST_MODES = 4
CHANGE = "divergence rate per 1 % [percentage points]"


def figures(results):
    """Figures of a sensitivity study."""
    table = results.table("sensitivities")
    columns = [table.texts(name) for name in ("mode [-]", "label", "parameter", "body")]
    rows = [row for row in zip(*columns, table.numbers("frequency [Hz]"), table.numbers("divergence rate [%]"), table.numbers(CHANGE))
            if row[3] == "" and not math.isnan(row[6])]
    modes = list(dict.fromkeys(row[0] for row in rows))[:MOST_MODES]
    changes = {mode: {row[2]: row[6] for row in rows if row[0] == mode} for mode in modes}
    names = sorted(changes[modes[0]], key=lambda name: -abs(changes[modes[0]][name]))

    picture = style.Picture("Effect of a 1 % increase of each parameter", len(modes), len(modes), (3.9, style.BAR * len(names) + 1.3))
    for panel, mode in zip(picture.panels, modes):
        _, label, _, _, frequency, divergence, _ = next(row for row in rows if row[0] == mode)
        style.prepare(panel, f"{label}, {frequency:.0f} Hz, {divergence:.3g} %", "change of divergence rate [points]", "")
        for colour, text, sign in ((style.VERMILLION, "increase: grows faster", 1), (style.BLUE, "increase: grows more slowly", -1)):
            chosen = [place for place, name in enumerate(names) if sign * changes[mode][name] > 0]
            style.draw_bars(panel, chosen, [changes[mode][names[place]] for place in chosen], colour, text, sign < 0)
        panel.axvline(0, color=style.GREY, linewidth=1.1)
        style.name_rows(panel, names if panel is picture.panels[0] else [""] * len(names))
        panel.ticklabel_format(axis="x", style="plain", useOffset=False)
        panel.locator_params(axis="x", nbins=5)
    return {"sensitivity": picture.add_key()}
