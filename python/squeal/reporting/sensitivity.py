# SPDX-License-Identifier: GPL-3.0-or-later

"""Page of a sensitivity study: effects of a 1 % increase on modes and thresholds, coalescing pairs, accuracy of derivatives."""

from squeal.reporting.charts import FREQUENCY, RATE, STABLE, UNSTABLE, digits, layout, name_of_mode, number, short

TABLES = ("sensitivities",)
TITLES = {"sensitivity_ranking": "Effect of a 1 % increase on the fastest growing mode",
          "sensitivities": "Effect of a 1 % increase on each mode",
          "sensitivities_thresholds": "Effect of a 1 % increase on thresholds"}
REPLACED = ("sensitivity",)
CHANGE, FREQUENCY_CHANGE, MU_CHANGE = "divergence rate per 1 % [percentage points]", "frequency per 1 % [Hz]", "mu per 1 % [-]"
MOST_BARS = 16
ROUNDING = 1e-8  # rounding level of R/ω, as in include/squeal/modes/verdict.h
LEAST_CHANGE = 1e-4  # smallest change that is shown [percentage points]
ROUGH = 0.01  # estimated error, relative to the largest derivative of a threshold, above which a note is shown
BAR, AXES = 30, 130  # heights of a bar and of the axes [pixels]


def verdict(results):
    rows = modes_of(results.table("sensitivities"))[0]
    error = results.record.get("quantities", {}).get("largest estimated error of lambda [-]", 0)
    grows = number(rows[0][RATE]) / 100 - 3 * error > ROUNDING
    text = f"At μ = {results.number('Operation/Friction coefficient'):g}, {rows[0]['label']} at {number(rows[0][FREQUENCY]):.0f} Hz "
    text += (f"grows fastest, with a divergence rate of {digits(number(rows[0][RATE]), 3)} %. " if grows else
             "is the least damped mode; no mode grows by more than the estimated errors. ")
    first, second = (*ranking(rows), None, None)[:2]
    if first is None or abs(number(first[CHANGE])) < LEAST_CHANGE:
        text += f"A 1 % increase in any single parameter changes its divergence rate by less than {LEAST_CHANGE:g} percentage points."
    else:
        text += f"{first['parameter']} has the largest effect, {signed(first[CHANGE])} percentage points for a 1 % increase"
        text += f", followed by {second['parameter']} with {signed(second[CHANGE])}." if second else "."
    return "unstable" if grows else "stable", text


def sections(results):
    found = [modes_section(modes_of(results.table("sensitivities")))]
    if results.has("sensitivities_thresholds"):
        found += thresholds_sections(thresholds_of(results.table("sensitivities_thresholds")))
    return found + notes_sections(results)


def checks(results):
    worst = max(relative_error(rows, "growth rate per unit [1/s]", "estimated error of the growth rate per unit [1/s]")
                for rows in modes_of(results.table("sensitivities")))
    found = [("largest estimated error of a mode's derivatives, relative to the largest", digits(worst, 2))]
    if results.has("sensitivities_thresholds"):
        thresholds = thresholds_of(results.table("sensitivities_thresholds"))
        known = [rows for rows in thresholds if rows[0]["derivative of"] != "none"]
        found.append(("thresholds with derivatives", f"{len(known)} of {len(thresholds)}"))
        if known:
            worst = max(relative_error(rows, "mu per unit [-]", "estimated error per unit [-]") for rows in known)
            found.append(("largest estimated error of a threshold's derivatives, relative to the largest", digits(worst, 2)))
    for step in results.record.get("steps", []):
        if step["name"].startswith("Derivatives of "):
            found.append((step["name"].lower(), step["result"]))
    return found


def modes_of(table):
    """Rows of the table for each mode; the fastest growing mode comes first."""
    return sorted(table.groups("mode [-]"), key=lambda rows: -number(rows[0][RATE]))


def thresholds_of(table):
    """Rows of the table for each threshold, in ascending order of the friction coefficient."""
    return table.groups("mu [-]", "event", "label", "partner label", FREQUENCY)


def ranking(rows, change=CHANGE):
    """Rows of parameters of the whole model with a change per 1 %, by descending magnitude of the change."""
    return sorted((row for row in rows if row[change] and not row["body"]), key=lambda row: -abs(number(row[change])))


def signed(text):
    return f"{number(text):+.4f}".replace("-", "−")


def relative_error(rows, derivative, error):
    """Largest estimated error of a change per 1 %, relative to the largest change."""
    values = [(abs(number(row["value"])), row) for row in rows if row[derivative] and row[error]]
    largest = max((value * abs(number(row[derivative])) for value, row in values), default=0)
    return max((value * number(row[error]) for value, row in values), default=0) / largest if largest else 0


def bars(rows, change, title, about, squeals):
    """Chart with a bar for each parameter; the largest change is at the top."""
    shown = ranking(rows, change)[:MOST_BARS]
    traces = []
    for sign in (1, -1):
        own = [row for row in shown if sign * number(row[change]) > 0 or sign == 1 and number(row[change]) == 0]
        traces.append({"type": "bar", "orientation": "h", "y": [in_two_lines(row["parameter"]) for row in own],
                       "x": [short(row[change]) for row in own], "marker": {"color": UNSTABLE if sign == squeals else STABLE},
                       "customdata": [about(row) for row in own], "hovertemplate": "%{customdata}<extra></extra>"})
    axes = layout(title, "", bargap=0.25, showlegend=False)
    axes["yaxis"].update(categoryorder="array", categoryarray=[in_two_lines(row["parameter"]) for row in reversed(shown)], tickfont={"size": 11},
                         ticks="", showgrid=False)
    axes["xaxis"].update(zeroline=True, zerolinecolor="#444", nticks=5, tickangle=0, exponentformat="power")
    axes["margin"].update(l=10, t=10)
    return traces, axes


def in_two_lines(parameter):
    """The parameter in two lines: name and direction for a mount, section and name for other parameters."""
    return parameter.split("/", 1)[1].replace(": ", "<br>") if ": " in parameter else parameter.replace("/", "<br>", 1)


def height_of(groups_of_rows, change):
    return AXES + BAR * max((min(MOST_BARS, len(ranking(rows, change))) for rows in groups_of_rows), default=1)


def modes_section(modes):
    choices = []
    for rows in modes:
        data, axes = bars(rows, CHANGE, "change [% points]", about_mode, squeals=1)
        choices.append({"key": rows[0]["mode [-]"], "data": data, "layout": axes, "name": name_of_mode(rows[0])})
    return {"id": "sensitivity", "title": "Effect of a 1 % increase in each parameter on growth", "choices": choices,
            "chosen": choices[0]["key"], "height": height_of(modes, CHANGE),
            "caption": "Change in the divergence rate for a 1 % increase in each parameter (red: higher, blue: lower). Mode:"}


def about_mode(row):
    parts = [f"<b>{row['parameter']}</b> = {value_text(row)}", f"1 % increase: {signed(row[CHANGE])} percentage points of divergence rate",
             f"{digits(number(row[FREQUENCY_CHANGE]))} Hz, {digits(number(row['growth rate per 1 % [1/s]']))} 1/s"]
    if row["derivative of"] != "lambda":
        parts.append("of the " + row["derivative of"])
    return "<br>".join(parts)


def value_text(row):
    return f"{digits(number(row['value']))} {row['unit']}".rstrip(" -")


def thresholds_sections(thresholds):
    known = [rows for rows in thresholds if rows[0]["derivative of"] != "none"]
    if not known:
        return []
    choices = []
    for i, rows in enumerate(known):
        data, axes = bars(rows, MU_CHANGE, "change in μ", about_threshold, squeals=-1)
        choices.append({"key": str(i), "name": threshold_text(rows[0]), "data": data, "layout": axes})
    moves = [max((abs(number(row[MU_CHANGE])) for row in ranking(rows, MU_CHANGE)), default=0) for rows in known]
    most = max(range(len(known)), key=lambda i: (known[i][0]["event"] == "onset", moves[i]))
    return [{"id": "sensitivity_thresholds", "title": "Effect of a 1 % increase on a threshold", "choices": choices, "chosen": str(most),
             "height": height_of(known, MU_CHANGE),
             "caption": "Change in the friction coefficient of a threshold for a 1 % increase in each parameter (red: lower, blue: higher). "
                        "The onset with the largest change is shown first. Threshold:"}]


def threshold_text(row):
    partner = f" with {row['partner label']}" if row["partner label"] else ""
    return f"μ = {digits(number(row['mu [-]']))}: {row['event']} of {row['label'] or 'unnamed'}{partner}, {number(row[FREQUENCY]):.0f} Hz"


def about_threshold(row):
    share = number(row[MU_CHANGE]) / number(row["mu [-]"])
    return "<br>".join([f"<b>{row['parameter']}</b> = {value_text(row)}",
                        f"1 % increase: μ changes by {digits(number(row[MU_CHANGE]))} ({100 * share:.3g} %)",
                        "from the " + row["derivative of"]])


def notes_sections(results):
    """Section on pairs near exceptional points, where two modes coalesce, and on thresholds without derivatives."""
    notes = []
    modes = modes_of(results.table("sensitivities"))
    for rows in modes:
        if rows[0]["derivative of"] != "lambda":
            notes.append(f"{rows[0]['label']} at {number(rows[0][FREQUENCY]):.1f} Hz: derivatives of the {rows[0]['derivative of']}.")
    if results.has("sensitivities_thresholds"):
        thresholds = thresholds_of(results.table("sensitivities_thresholds"))
        pairs = sum(rows[0]["derivative of"] == "squared difference of the pair" for rows in thresholds)
        if pairs:
            notes.append(f"Exceptional points: {pairs} of {len(thresholds)} thresholds. There, two modes coalesce and λ has no derivative. "
                         "The squared difference of the pair, (λ₁ − λ₂)², is smooth and is differentiated instead.")
        for rows in thresholds:
            error = relative_error(rows, "mu per unit [-]", "estimated error per unit [-]")
            if rows[0]["derivative of"] == "none":
                notes.append(f"{threshold_text(rows[0])} has no derivative: {rows[0]['remark']}.")
            elif error > ROUGH:
                notes.append(f"{threshold_text(rows[0])}: estimated errors reach {100 * error:.2g} % of the largest derivative.")
    if all(rows[0]["derivative of"] == "lambda" for rows in modes):
        notes.insert(0, "No mode in the table is close to coalescence: all derivatives are derivatives of simple eigenvalues.")
    return [{"id": "sensitivity_notes", "title": "Pairs near exceptional points, and limits", "notes": notes,
             "caption": "Derivatives are valid for changes that are small compared with the distance to the next mode."}]
