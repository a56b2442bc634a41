# SPDX-License-Identifier: GPL-3.0-or-later

"""Page of a sweep: growth versus the swept parameter, and coalescing modes."""

from squeal.reporting.charts import FREQUENCY, PALE, RATE, UNSTABLE, WEAK, digits, end_of_band, layout, names_apart, number, points, short
from squeal.results import MU, axis_title, symbol

TABLES = ("branches",)
TITLES = {"onsets": "Onset of squeal", "thresholds": "Thresholds of modes"}
REPLACED = ("complex_plane", "overview")
COLOURS = ("#b2182b", "#2166ac", "#1b7837", "#762a83", "#bf812d", "#01665e", "#c51b7d", "#4d4d4d")


def verdict(results):
    table = results.table("branches")
    parameter, name = table.parameter, symbol(table.parameter)
    rates, mus = table.numbers(RATE), table.numbers(parameter)
    strong = [row for rate, row in zip(rates, table.rows) if rate > WEAK]
    first = [row for row in results.table("onsets").rows if number(row["divergence rate beyond [%]"]) == WEAK] if results.has("onsets") else []
    span = f"from {name} = {min(mus):g} to {max(mus):g}, up to {end_of_band(results)}"
    if not first:
        weak = any(row["growing [-]"] not in ("", "0") for row in table.rows)
        return "stable", f"No mode grows {span}" + (f" by more than a divergence rate of {WEAK} %." if weak else ".")
    worst = max(strong, key=lambda row: number(row[RATE]))
    return "unstable", (f"Modes above a divergence rate of {WEAK} % {span}: {len({row['branch [-]'] for row in strong})}. The first is {first[0]['label']} at "
                        f"{number(first[0][FREQUENCY]):.0f} Hz, from {name} = {number(first[0][parameter]):.3g}; {worst['label']} at "
                        f"{number(worst[FREQUENCY]):.0f} Hz "
                        f"grows fastest, with a divergence rate of {digits(number(worst[RATE]), 3)} % at {name} = {number(worst[parameter]):g}.")


def sections(results):
    parameter = results.table("branches").parameter
    growth_over = "the friction coefficient" if parameter == MU else symbol(parameter)
    found = [branch_section(results, "branches", "Growth versus " + growth_over)]
    if results.has("branches_without_dissipation"):
        found.append(branch_section(results, "branches_without_dissipation", "Growth without radial dissipation"))
    return found + bifurcation_sections(results)


def checks(results):
    if not results.has("argument_counts"):
        return []
    table = results.table("argument_counts")
    return [(f"modes at {symbol(table.parameter)} = {number(row[table.parameter]):g} by the argument principle, and modes found",
             f"{row['modes counted [-]']}, {row['modes of the sweep [-]']}") for row in table.rows]


def branches_of(results, name):
    """Rows of each branch, and its largest divergence rate [%]."""
    branches = {rows[0]["branch [-]"]: rows for rows in results.table(name).groups("branch [-]")}
    return branches, {branch: max(number(row[RATE]) for row in rows) for branch, rows in branches.items()}


def events_of(results, name):
    """Rows of the thresholds of branches."""
    name = name.replace("branches", "thresholds")
    return results.table(name).rows if results.has(name) else []


def branch_section(results, name, title):
    """Chart of the divergence rate of every branch versus the swept parameter."""
    (branches, peaks), parameter = branches_of(results, name), results.table(name).parameter
    lowest = min(number(row[RATE]) for rows in branches.values() for row in rows)
    named = names_apart({branch: peak for branch, peak in peaks.items() if peak > WEAK}, max(peaks.values()) - lowest)
    traces = []
    for branch, rows in branches.items():
        is_named = branch in named
        peak = max(range(len(rows)), key=lambda i: number(rows[i][RATE]))
        color, width = (UNSTABLE, 1.8) if peaks[branch] > WEAK else (PALE, 1)
        traces.append(points(
            f"{rows[0]['label']} ({branch})", [short(row[parameter]) for row in rows], [short(row[RATE]) for row in rows],
            [[short(row[FREQUENCY]), row["verdict"], short(row["estimated error of lambda [-]"], 2)] for row in rows],
            mode="lines+text" if is_named else "lines", showlegend=False, line={"color": color, "width": width}, textposition="top left",
            text=[rows[0]["label"] if is_named and i == peak else "" for i in range(len(rows))],
            hovertemplate=f"<b>{rows[0]['label']}</b><br>{symbol(parameter)} = %{{x:.4g}}<br>%{{customdata[0]:.2f}} Hz<br>divergence rate %{{y:.4g}} %"
                          "<br>%{customdata[1]}, estimated error of λ %{customdata[2]}<extra></extra>"))
    for event, marker in (("onset", "triangle-up"), ("restabilisation", "triangle-down")):
        own = [row for row in events_of(results, name) if row["event"] == event]
        traces.append(points(event, [number(row[parameter]) for row in own], [0] * len(own),
                             [[row["label"], row["mechanism"], number(row[FREQUENCY]), row["uncertainty [-]"]] for row in own],
                             hovertemplate=f"<b>%{{customdata[0]}}</b> {event}<br>{symbol(parameter)} = %{{x:.6g}} ± %{{customdata[3]}}<br>"
                                           "%{customdata[2]:.2f} Hz<br>%{customdata[1]}<extra></extra>",
                             marker={"symbol": marker, "size": 9, "color": "white", "line": {"color": "#222", "width": 1.3}}))
    return {"id": name, "title": title, "caption": f"Each curve is a mode; red curves exceed {WEAK} %. Triangles are thresholds.",
            "data": traces, "layout": layout(axis_title(parameter), "divergence rate [%]")}


def bifurcation_sections(results):
    """Chart of the frequencies of the most strongly growing pairs of modes, relative to the frequency of coalescence."""
    name = "branches_without_dissipation" if results.has("branches_without_dissipation") else "branches"
    (branches, peaks), parameter = branches_of(results, name), results.table(name).parameter
    events = [row for row in events_of(results, name) if row["event"] == "onset" and row["partner [-]"] in branches]
    events = sorted((row for row in events if peaks[row["branch [-]"]] > WEAK), key=lambda row: -peaks[row["branch [-]"]])[:len(COLOURS)]
    if not events:
        return []
    traces = []
    for group, (event, colour) in enumerate(zip(events, COLOURS)):
        meeting = number(event[FREQUENCY])
        title = f"{event['label']} and {event['partner label']}, {meeting:.1f} Hz"
        for branch in (event["branch [-]"], event["partner [-]"]):
            rows, is_first = branches[branch], branch == event["branch [-]"]
            traces.append(points(title, [short(row[parameter]) for row in rows], [short(number(row[FREQUENCY]) - meeting) for row in rows],
                                 [[short(row[FREQUENCY]), short(row[RATE], 4)] for row in rows], mode="lines", legendgroup=group,
                                 showlegend=is_first, line={"color": colour, "width": 1.6},
                                 hovertemplate=f"<b>{rows[0]['label']}</b><br>{symbol(parameter)} = %{{x:.4g}}<br>%{{customdata[0]:.2f}} Hz"
                                               "<br>divergence rate %{customdata[1]:.4g} %<extra></extra>"))
    caption = ("Frequencies of two modes minus the frequency at which they coalesce. After coalescence, their frequencies are nearly equal "
               f"and one mode grows. Number of pairs shown: {len(events)}" + (", without radial dissipation." if "without" in name else "."))
    return [{"id": "bifurcations", "title": "Coalescing modes", "caption": caption, "data": traces,
             "height": 500, "layout": layout(axis_title(parameter), "frequency difference [Hz]")}]
