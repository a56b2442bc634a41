# SPDX-License-Identifier: GPL-3.0-or-later

"""Differences between computed and measured frequencies before and after a fit."""

from squeal.plotting import style


def figures(results):
    rows = [row for row in results.table("fit").rows if row["quantity"] == "frequency"]
    names = [" ".join(filter(None, (row["state"], row["label"], row["member"]))) for row in rows]
    picture = style.Picture("Fit to measured modes", 1, 1, (6.5, 0.8 * style.BAR * len(rows) + 1.3))
    panel, = picture.panels
    style.prepare(panel, "", "computed minus measured frequency [%]", "")
    for name, colour, marker in (("difference of the start", style.GREY, "o"), ("difference after the fit", style.BLUE, "D")):
        panel.plot([float(row[f"{name} [%]"]) for row in rows], range(len(rows)), linestyle="", marker=marker, markersize=5, color=colour, label=name)
    panel.axvline(0, color=style.GREY, linewidth=1.1)
    style.name_rows(panel, names)
    return {"updating": picture.add_key()}
