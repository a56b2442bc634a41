# SPDX-License-Identifier: GPL-3.0-or-later

"""Modes of all samples, the distribution of the largest divergence rate, and the most influential parameters."""

import math

from squeal.plotting import style

RATE = "divergence rate [%]"
COLOURS = {"stable": style.GREY, "neutral": style.GREY, "undecided": style.ORANGE, "unstable": style.VERMILLION}
N_BINS, MOST_SCATTERS = 30, 4


def figures(results):
    modes, samples = results.table("sample_modes"), results.table("samples")
    indices = results.table("sobol_indices").rows if results.has("sobol_indices") else []
    indices = [row for row in indices if row["quantity"] == "largest divergence rate"]
    parameters = samples.columns[1:samples.columns.index("unstable modes [-]")]
    if indices:
        parameters = [row["uncertain parameter"] for row in sorted(indices, key=lambda row: -float(row["total index [-]"]))]
    parameters = parameters[:MOST_SCATTERS]

    has_onsets = results.has("sample_onsets")
    picture = style.Picture("Modes and divergence rates with uncertain parameters", 2 + bool(indices) + has_onsets + len(parameters), 3)
    panels = iter(picture.panels)
    cloud(next(panels), modes)
    rates = [0. if math.isnan(rate) else rate for rate in samples.numbers(RATE)]
    panel = next(panels)
    style.prepare(panel, "", "largest divergence rate of a sample [%]", "samples")
    panel.hist(rates, bins=N_BINS, color=style.BLUE)
    if indices:
        bars(next(panels), indices)
    if has_onsets:
        cumulative(next(panels), results.table("sample_onsets"))
    for name in parameters:
        panel = next(panels)
        style.prepare(panel, "", name, "largest divergence rate [%]")
        panel.plot(samples.numbers(name), rates, linestyle="", marker=".", markersize=3, color=style.BLUE)
    return {"robustness": picture.add_key()}


def cloud(panel, modes):
    style.prepare(panel, "", style.FREQUENCY, style.DIVERGENCE)
    style.zero_line(panel)
    points = list(zip(modes.numbers("frequency [Hz]"), modes.numbers(RATE), modes.texts("verdict")))
    for verdict, colour in COLOURS.items():
        chosen = [point for *point, of_point in points if of_point == verdict]
        style.draw_points(panel, chosen, marker=".", markersize=3, color=colour, label=verdict, rasterized=True)


def cumulative(panel, onsets):
    """Draws the percentage of samples with an onset up to each value of the swept parameter; samples that miss the
    tolerance are omitted."""
    known = [missed == 0. for missed in onsets.numbers("values that miss the tolerance [-]")]
    columns = [column for column in onsets.columns if " of " in column and column.endswith("[-]") and not column.startswith("uncertainty")]
    style.prepare(panel, "", f"first onset: {columns[0].split(' of ')[0]} [-]", "samples with an onset up to this value [%]")
    for column, colour in zip(columns, (style.SKY, style.BLUE)):
        values = sorted(value for value, is_known in zip(onsets.numbers(column), known) if is_known and not math.isnan(value))
        name = column.split(" of ")[1].removesuffix(" [-]")
        panel.step(values, [100. * (number + 1) / sum(known) for number in range(len(values))], where="post", color=colour,
                   label=name if name == "growth" else f"divergence rate beyond {name}")
    panel.set_ylim(0., 100.)


def bars(panel, indices):
    """Draws first-order and total indices with their confidence intervals."""
    style.prepare(panel, "", "Sobol' index of the largest divergence rate [-]", "")
    for offset, kind, colour in ((-0.2, "first-order index", style.SKY), (0.2, "total index", style.BLUE)):
        values = [float(row[f"{kind} [-]"]) for row in indices]
        lower = [max(0., value - float(row[f"lower limit of the {kind} [-]"])) for value, row in zip(values, indices)]
        upper = [max(0., float(row[f"upper limit of the {kind} [-]"]) - value) for value, row in zip(values, indices)]
        panel.barh([number + offset for number in range(len(indices))], values, height=0.36, xerr=(lower, upper), color=colour, label=kind)
    panel.set_yticks(range(len(indices)), [row["uncertain parameter"].replace("/", "\n", 1) for row in indices], fontsize=style.SMALL)
    panel.invert_yaxis()
