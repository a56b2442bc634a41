# SPDX-License-Identifier: GPL-3.0-or-later

"""Page of a design study: onset of squeal, largest growth, and the values of quiet designs."""

from squeal.reporting.charts import WEAK, digits, layout, number, plain, points, short

TABLES = ("designs",)
TITLES = {"designs": "Designs", "design_thresholds": "Thresholds of modes of designs", "design_modes": "Modes of designs"}
REPLACED = ("designs",)
ONSET, LARGEST = "mu of 0.01 % [-]", "largest divergence rate [%]"


def variables_of(table):
    return table.columns[1:table.columns.index("outcome")]


def name_of(variable):
    """The axis title of a variable; if several parameters share its value, the name of the first."""
    first, *others = variable.split(" + ")
    return first.split("/")[-1] + (" …" if others else "")


def positions(texts):
    """Positions of values on an axis, and names of the ticks if the values are not numbers."""
    try:
        return [float(text) for text in texts], []
    except ValueError:
        names = list(dict.fromkeys(texts))
        return [names.index(text) for text in texts], names


def solved(table):
    return [row for row in table.rows if row["outcome"] == "solved"]


def design_text(row, variables):
    return "design " + row["design [-]"] + " (" + "; ".join(f"{name_of(name)} = {plain(row[name])}" for name in variables) + ")"


def end_of_sweep(results):
    return results.number("Sweep/Last friction coefficient")


def verdict(results):
    """Verdict of a design study; None for a search, which has its own verdict."""
    if results.has("search"):
        return None
    table = results.table("designs")
    rows = solved(table)
    left = len(table) - len(rows)
    outcome = f"{len(rows)} of {len(table)} designs solved" + (f", {left} rejected or failed" if left else "")
    if not rows:
        return "none", outcome + "."
    end = end_of_sweep(results)
    quiet = [row for row in rows if not row[ONSET]]
    best = max(rows, key=lambda row: (number(row[ONSET] or "inf"), -number(row[LARGEST] or "0")))
    name = design_text(best, variables_of(table))
    if quiet:
        return "stable", f"Designs below a divergence rate of {WEAK} % up to μ = {end:g}: {len(quiet)} of {len(rows)}; the quietest is {name}."
    onset, largest = digits(number(best[ONSET]), 3), digits(number(best[LARGEST] or "0"), 3)
    return "unstable", (f"Designs below a divergence rate of {WEAK} % up to μ = {end:g}: none of {len(rows)}; the quietest is {name}, "
                        f"with onset μ = {onset} ({best['label at 0.01 %']}) and at most {largest} %." + (f" {outcome}." if left else ""))


def sections(results):
    return [onset_section(results), lines_section(results)] if solved(results.table("designs")) else []


def checks(results):
    rows = solved(results.table("designs"))
    found = [("designs in which all counted modes were found", f"{sum(row['complete [-]'] == '1' for row in rows)} of {len(rows)}")]
    for column, text in (("estimated error of lambda [-]", "largest estimated error of λ"), ("eps_res [-]", "largest residual of a mode, eq. (16)")):
        found.append((text, digits(max((number(row[column]) for row in rows), default=0), 2)))
    return found


def about(row, variables, end):
    return "<br>".join([f"<b>design {row['design [-]']}</b>", *(f"{name}: {plain(row[name])}" for name in variables),
                        f"onset at μ = {digits(number(row[ONSET]))} ({row['label at 0.01 %']})" if row[ONSET] else
                        f"quiet up to μ = {end:g}",
                        f"at most {digits(number(row[LARGEST] or '0'))} % ({row['label of largest']} at "
                        f"{digits(number(row['frequency of largest [Hz]']), 5)} Hz)" if row[LARGEST] else "no mode grows"])


def onset_section(results):
    """Chart of the largest divergence rate versus the onset of squeal, one point per design."""
    table = results.table("designs")
    variables, end, rows = variables_of(table), end_of_sweep(results), solved(table)
    traces = []
    for label in sorted({row["label of largest"] or "none" for row in rows}):
        own = [row for row in rows if (row["label of largest"] or "none") == label]
        traces.append(points(label, [short(row[ONSET] or end) for row in own], [short(row[LARGEST] or "0") for row in own],
                             [about(row, variables, end) for row in own], marker={"size": 10}))
    return {"id": "designs_chart", "title": "Designs: onset of squeal and largest growth",
            "caption": "Each point is a design, with the label of its fastest growing mode. At the onset μ, a divergence rate exceeds "
                       f"0.01 %. Designs at the lower right are quiet. The study ends at μ = {end:g}.",
            "data": traces, "layout": layout("onset μ (0.01 %)", "largest divergence rate [%]", showlegend=True)}


def lines_section(results):
    """Chart with each design as a line through its values; ranges can be selected on an axis."""
    table = results.table("designs")
    rows, end = solved(table), end_of_sweep(results)
    dimensions = []
    for name in variables_of(table):
        values, names = positions([row[name] for row in rows])
        ticks = {"tickvals": list(range(len(names))), "ticktext": names} if names else {"tickformat": ".4~g"}
        dimensions.append({"label": name_of(name), "values": values, **ticks})
    onset, largest = [number(row[ONSET] or end) for row in rows], [number(row[LARGEST] or "0") for row in rows]
    dimensions += [{"label": "onset μ (0.01 %)", "values": onset, "tickformat": ".4~g"},
                   {"label": "largest rate [%]", "values": largest, "tickformat": ".4~g"}]
    by_rate = results.has("search") and results.parameter("Search/Goal") == "divergence rate"
    return {"id": "variables_chart", "title": "Which values make a design quiet",
            "caption": "Each line is a design. Drag along an axis to choose a range. The colour shows the "
                       + ("largest divergence rate [%]." if by_rate else "onset μ at which a divergence rate exceeds 0.01 %."),
            "data": [{"type": "parcoords", "dimensions": dimensions, "line": {"color": largest if by_rate else onset, "colorscale": "Viridis",
                                                                              "reversescale": by_rate, "showscale": True}}],
            "least width": 110 * len(dimensions) + 100,
            "layout": layout("", "", margin={"l": 70, "r": 60, "t": 50, "b": 30})}
