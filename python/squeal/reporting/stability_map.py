# SPDX-License-Identifier: GPL-3.0-or-later

"""Page of the map of a sweep: stability versus two parameters."""

import math

import numpy as np

from squeal.plotting import stability_cells as cells
from squeal.reporting.charts import FREQUENCY, RATE, digits, layout, number, points
from squeal.results import axis_title, symbol

TABLES = ("map",)
TITLES = {"map": "Stability map"}
REPLACED = ("map",)
STABLE, UNDECIDED = "#dce9f2", "#b4b4b4"


def verdict(results):
    table = results.table("map")
    stability = cells.StabilityMap(table)
    growing = [row for row in table.rows if number(row["unstable modes [-]"] or "0") > 0]
    where = f"of {len(table)} points of the map over {symbol(stability.abscissa)} and {ordinate(stability)} ({spanned(stability)})"
    if not growing:
        return "stable", f"None {where} is unstable."
    worst = max(growing, key=lambda row: number(row[RATE]))
    return "unstable", (f"Unstable: {len(growing)} {where}; the largest divergence rate is {digits(number(worst[RATE]), 3)} % "
                        f"({worst['label'] or 'unnamed'}), at {symbol(stability.abscissa)} = {number(worst[stability.abscissa]):g} and {text_of(number(worst[stability.ordinate]), stability)}.")


def sections(results):
    table = results.table("map")
    stability = cells.StabilityMap(table)
    texts = texts_of(stability, table)
    masks = [("stable", stability.is_known & ~stability.is_unstable & ~stability.is_undecided, STABLE),
             ("undecided", stability.is_undecided, UNDECIDED)]
    scale = [[i / (len(cells.COLOURS) - 1), code] for i, code in enumerate(cells.COLOURS)]
    traces = [heatmap(stability, texts, stability.is_unstable, colorscale=scale, zmin=0,
                      colorbar={"title": {"text": "divergence rate [%]", "side": "right"}, "thickness": 12, "tickfont": {"size": 11}})]
    traces += [heatmap(stability, texts, mask, colorscale=[[0, colour], [1, colour]], showscale=False) for _, mask, colour in masks if mask.any()]
    traces += [limit(stability), names(stability)]
    meanings = [f"{'pale blue' if colour == STABLE else 'grey'}: {name}" for name, mask, colour in masks if mask.any()]
    if not stability.is_known.all():
        meanings.append("empty: not computed")
    axes = layout(axis_title(stability.abscissa), stability.ordinate, margin={"l": 60, "r": 8, "t": 30, "b": 50})
    axes["xaxis"].update(range=stability.x_edges[[0, -1]].tolist(), showgrid=False)
    ends = stability.y_edges[[0, -1]].tolist()
    axes["yaxis"].update(range=ends, showgrid=False)
    if stability.is_logarithmic:
        ticks = cells.logarithmic_ticks(*ends)
        axes["yaxis"].update(type="log", range=[math.log10(edge) for edge in ends], tickvals=ticks,
                             ticktext=[f"{tick:g}" for tick in ticks])
    caption = ("Colour: divergence rate of the fastest growing mode, which labels its region; " + "; ".join(meanings) +
               ". The black line is the stability boundary.")
    return [{"id": "map", "title": f"Stability versus {axis_title(stability.abscissa).split(' [')[0]} and {ordinate(stability)}", "caption": caption, "data": traces,
             "layout": axes}]


def checks(results):
    table = results.table("map")
    known = [row for row in table.rows if row["unstable modes [-]"]]
    found = [("points of the map that were computed", f"{len(known)} of {len(table)}")]
    errors = [number(row["estimated error of lambda [-]"]) for row in known if row["estimated error of lambda [-]"]]
    return found + [("largest estimated error of λ on the map", digits(max(errors), 2))] if errors else found


def ordinate(stability):
    return stability.ordinate.split(" [")[0]


def text_of(value, stability):
    return f"{value:.6g} {stability.ordinate.split('[')[1].rstrip(']')}"


def spanned(stability):
    first, last = stability.values[0], text_of(stability.values[-1], stability)
    return f"up to {symbol(stability.abscissa)} = {stability.mus[-1]:g}, " + (f"from {first:.6g} to {last}" if len(stability.values) > 1 else last)


def heatmap(stability, texts, mask, **look):
    """Cells for which a mask is true, coloured by rate; the rate is zero if there is no mode in the band."""
    shown = [[float(f"{rate:.6g}") if is_shown else None for rate, is_shown in zip(rates, are_shown)]
             for rates, are_shown in zip(np.nan_to_num(stability.rate), mask)]
    return {"type": "heatmap", "x": stability.x_edges.tolist(), "y": stability.y_edges.tolist(), "z": shown,
            "text": texts, "hovertemplate": "%{text}<extra></extra>", "hoverongaps": False, **look}


def texts_of(stability, table):
    """Hover texts of the cells, row by row."""
    found = [[""] * len(stability.mus) for _ in stability.values]
    for row in table.rows:
        mu, value = number(row[stability.abscissa]), number(row[stability.ordinate])
        found[stability.values.index(value)][stability.mus.index(mu)] = about(row, f"{symbol(stability.abscissa)} = {mu:.4g}, {text_of(value, stability)}")
    return found


def about(row, place):
    if not row["unstable modes [-]"]:
        return f"{place}<br>not computed"
    grows, undecided = row["unstable modes [-]"] != "0", row["undecided modes [-]"] != "0"
    parts = [f"<b>{row['label'] or 'unnamed'}</b>, {number(row[FREQUENCY]):.0f} Hz"] if grows else []
    parts += [place, f"divergence rate {digits(number(row[RATE]))} %, {row['unstable modes [-]']} unstable" if grows else
              "undecided" if undecided else "stable"]
    if undecided:
        parts[-1] += f", {row['undecided modes [-]']} undecided"
    if row["open contact nodes [-]"] != "0":
        parts.append(f"{row['open contact nodes [-]']} contact nodes open")
    return "<br>".join(parts)


def limit(stability):
    """The line between stable and unstable cells."""
    is_unstable = stability.is_unstable
    edges = cells.limits(stability, lambda a, b: is_unstable[a] != is_unstable[b])
    line = [tuple(None if math.isnan(value) else float(value) for value in edge) for edge in edges]
    return points("stability boundary", [x for x, _ in line], [y for _, y in line], mode="lines", showlegend=False, hoverinfo="skip",
                  connectgaps=False, line={"color": "#000", "width": 2.6})


def names(stability):
    """The label of the most unstable mode in each region that has space for it."""
    found = [(stability.leader[region[0]], cells.place_of_name(region, stability.rate.shape, 2 * len(stability.leader[region[0]])))
             for region in cells.regions(stability)]
    found = [(name, cell) for name, cell in found if cell]
    return {"type": "scatter", "mode": "text", "showlegend": False, "hoverinfo": "skip", "text": [name for name, _ in found],
            "x": [stability.mus[column] for _, (_, column) in found], "y": [stability.values[row] for _, (row, _) in found]}
