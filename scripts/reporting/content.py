"""What a page says of a run: verdict, charts, tables, shapes, and how to repeat it. Everything is read from the results, nothing is computed anew."""

import base64
import math

from reporting import shapes

UNSTABLE, STABLE, PALE = "#b2182b", "#2166ac", "#b9c2cc"
WEAK = 0.01  # divergence rate [%] up to which growth is called weak
RATE, DAMPING, FREQUENCY = "divergence rate [%]", "effective damping ratio -2R/omega [%]", "frequency [Hz]"
TITLES = {"designs": "Designs", "design_thresholds": "Where modes of designs begin and cease to grow", "design_modes": "Modes of designs",
          "complex_modes": "Modes with friction", "real_modes": "Modes without friction", "component_modes": "Modes of disc and pins alone",
          "thresholds": "Where modes begin and cease to grow", "energy": "Where the energy of growing modes enters",
          "real_eigenvalues": "Eigenvalues that do not oscillate", "sliding_pins": "Pins in steady sliding", "table1": "Beside the paper's Table 1"}
LARGEST_TABLE = 2500  # rows


def number(text):
    return float(text) if text else math.nan


def short(text, n=6):
    """A number with so many digits, for a chart."""
    return float(f"{number(text):.{n}g}")


def digits(value, n=4):
    return f"{value:.{n}g}"


def end_of_band(results):
    return f"{float(results.parameter('Band/Maximum frequency')):g} Hz"


def verdict(results):
    """Level and sentence."""
    if results.has("branches"):
        return sweep_verdict(results)
    if results.has("complex_modes"):
        return modes_verdict(results)
    if results.has("designs"):
        return designs_verdict(results)
    return "none", f"Results of Study = {results.parameter('Study')}: see the tables."


def modes_verdict(results):
    rows = results.table("complex_modes").rows
    growing = [row for row in rows if row["unstable [-]"] == "1"]
    static = [row for row in results.table("real_eigenvalues").rows if number(row["growth rate [1/s]"]) > 0] if results.has("real_eigenvalues") else []
    undecided = [row for row in rows if row.get("verdict") == "undecided"]
    where = f"{len(rows)} modes up to {end_of_band(results)} at μ = {results.number('Operation/Friction coefficient'):g}"
    text = f"None of the {where} grows."
    if growing:
        worst = max(growing, key=lambda row: number(row[RATE]))
        text = (f"{len(growing)} of the {where} {'grow' if len(growing) > 1 else 'grows'}; {worst['label']} at {number(worst[FREQUENCY]):.0f} Hz "
                f"grows fastest, with a divergence rate of {digits(number(worst[RATE]), 3)} % (damping ratio {digits(number(worst[DAMPING]), 3)} %).")
    if static:
        text += f" {len(static)} {'eigenvalues grow' if len(static) > 1 else 'eigenvalue grows'} without oscillating: static divergence."
    if undecided:
        text += f" With the error of the mesh {len(undecided)} modes are undecided."
    return ("unstable" if growing or static else "undecided" if undecided else "stable"), text


def sweep_verdict(results):
    table = results.table("branches")
    rates, mus = table.numbers(RATE), table.numbers("mu [-]")
    strong = [(mu, row) for mu, rate, row in zip(mus, rates, table.rows) if rate > WEAK]
    span = f"from μ = {min(mus):g} to {max(mus):g}, up to {end_of_band(results)}"
    if not strong:
        weak = any(row["growing [-]"] not in ("", "0") for row in table.rows)
        return "stable", f"No mode grows {span}" + (f" by more than a divergence rate of {WEAK} %." if weak else ".")
    first = min(strong, key=lambda entry: entry[0])
    worst = max(strong, key=lambda entry: number(entry[1][RATE]))[1]
    return "unstable", (f"{len({row['branch [-]'] for _, row in strong})} modes grow by more than {WEAK} % {span}: {first[1]['label']} at "
                        f"{number(first[1][FREQUENCY]):.0f} Hz from μ = {first[0]:.3g} on; {worst['label']} at {number(worst[FREQUENCY]):.0f} Hz "
                        f"grows fastest, with a divergence rate of {digits(number(worst[RATE]), 3)} % at μ = {number(worst['mu [-]']):g}.")


ONSET, LARGEST = "mu of 0.01 % [-]", "largest divergence rate [%]"


def variables_of(table):
    return table.columns[1:table.columns.index("outcome")]


def design_text(row, variables):
    return "design " + row["design [-]"] + " (" + "; ".join(f"{name.split('/')[-1]} = {row[name]}" for name in variables) + ")"


def designs_verdict(results):
    table = results.table("designs")
    solved = [row for row in table.rows if row["outcome"] == "solved"]
    left = len(table) - len(solved)
    outcome = f"{len(solved)} of {len(table)} designs solved" + (f", {left} refused or failed" if left else "")
    if not solved:
        return "none", outcome + "."
    end = float(results.parameter("Sweep/Last friction coefficient"))
    quiet = [row for row in solved if not row[ONSET]]
    best = max(solved, key=lambda row: (number(row[ONSET] or "inf"), -number(row[LARGEST] or "0")))
    name = design_text(best, variables_of(table))
    if quiet:
        return "stable", f"{len(quiet)} of {len(solved)} designs stay below a divergence rate of {WEAK} % up to μ = {end:g}; the quietest is {name}."
    return "unstable", (f"All {len(solved)} designs exceed a divergence rate of {WEAK} % up to μ = {end:g}; the quietest is {name}, from "
                        f"μ = {digits(number(best[ONSET]), 3)} on ({best['label at 0.01 %']}), with {digits(number(best[LARGEST] or '0'), 3)} % at most."
                        + (f" {outcome}." if left else ""))


# ------------------------------------------------------------------------------------------------------------------------ charts


def designs_chart(results):
    """Onset over growth: what lies to the right and low is quiet."""
    table = results.table("designs")
    variables, end = variables_of(table), float(results.parameter("Sweep/Last friction coefficient"))
    rows = [row for row in table.rows if row["outcome"] == "solved"]
    traces = []
    for label in sorted({row["label of largest"] or "none" for row in rows}):
        own = [row for row in rows if (row["label of largest"] or "none") == label]
        traces.append({"type": "scatter", "mode": "markers", "name": label, "x": [short(row[ONSET] or end) for row in own],
                       "y": [short(row[LARGEST] or "0") for row in own], "marker": {"size": 10},
                       "customdata": ["<br>".join([f"<b>design {row['design [-]']}</b>", *(f"{name}: {row[name]}" for name in variables),
                                                   f"from μ = {digits(number(row[ONSET]))} on ({row['label at 0.01 %']})" if row[ONSET] else
                                                   f"quiet up to μ = {end:g}",
                                                   f"{digits(number(row[LARGEST] or '0'))} % at most ({row['label of largest']} at "
                                                   f"{digits(number(row['frequency of largest [Hz]']), 5)} Hz)" if row[LARGEST] else "no mode grows"])
                                      for row in own], "hovertemplate": "%{customdata}<extra></extra>"})
    return {"id": "designs_chart", "title": "Designs: where squeal begins, and how fast it grows",
            "caption": f"Each point is a design, named by the mode that grows fastest; what lies to the right and low is quiet. At μ = {end:g} the "
                       "study ends.", "data": traces, "layout": layout("μ from which on a divergence rate exceeds 0.01 %", "largest divergence rate [%]")}


def variables_chart(results):
    """Every design as a line through its values; ranges of an axis can be chosen with the mouse."""
    table = results.table("designs")
    rows = [row for row in table.rows if row["outcome"] == "solved"]
    end = float(results.parameter("Sweep/Last friction coefficient"))
    dimensions = []
    for name in variables_of(table):
        texts = [row[name] for row in rows]
        try:
            dimensions.append({"label": name.split("/")[-1], "values": [float(text) for text in texts]})
        except ValueError:
            names = list(dict.fromkeys(texts))
            dimensions.append({"label": name.split("/")[-1], "values": [names.index(text) for text in texts], "tickvals": list(range(len(names))),
                               "ticktext": names})
    onset = [number(row[ONSET] or end) for row in rows]
    dimensions += [{"label": "μ of 0.01 %", "values": onset},
                   {"label": "largest rate [%]", "values": [number(row[LARGEST] or "0") for row in rows]}]
    return {"id": "variables_chart", "title": "Which values make a design quiet",
            "caption": "Each line is a design; drag along an axis to choose a range. Colour is the μ from which on it squeals.",
            "data": [{"type": "parcoords", "dimensions": dimensions, "line": {"color": onset, "colorscale": "Viridis", "showscale": True}}],
            "layout": layout("", "", margin={"l": 70, "r": 60, "t": 50, "b": 30})}


def layout(x, y, **more):
    axis = {"zeroline": False, "gridcolor": "#e8ebee", "linecolor": "#8a939c", "ticks": "outside", "automargin": True}
    return {"xaxis": {**axis, "title": x}, "yaxis": {**axis, "title": y}, "hovermode": "closest", "plot_bgcolor": "white", "paper_bgcolor": "white",
            "margin": {"l": 60, "r": 16, "t": 30, "b": 50}, "legend": {"orientation": "h", "y": -0.32, "yanchor": "top", "x": 0},
            "font": {"family": "inherit", "size": 13}, **more}


def damping_chart(results):
    """Damping ratio over frequency, as NVH engineers look for it; below zero a mode grows."""
    rows = results.table("complex_modes").rows
    traces = []
    for title, colour, flag in (("does not grow", STABLE, "0"), ("grows", UNSTABLE, "1")):
        own = [row for row in rows if row["unstable [-]"] == flag]
        names = most_negative(own) if flag == "1" else set()
        traces.append({
            "type": "scatter", "mode": "markers+text" if flag == "1" else "markers", "name": title, "x": [number(row[FREQUENCY]) for row in own],
            "y": [number(row[DAMPING]) for row in own], "textposition": "bottom center",
            "text": [row["label"] if i in names else "" for i, row in enumerate(own)], "customdata": [about(row) for row in own],
            "hovertemplate": "%{customdata}<extra></extra>",
            "marker": {"color": colour, "size": 9 if flag == "1" else 7, "symbol": "diamond" if flag == "1" else "circle"}})
    line = {"type": "line", "xref": "paper", "x0": 0, "x1": 1, "y0": 0, "y1": 0, "line": {"color": "#444", "width": 1}}
    return {"id": "damping", "title": "Damping ratio over frequency",
            "caption": "Damping ratio −2R/ω of every mode; below zero it grows.",
            "data": traces, "layout": layout("frequency [Hz]", "damping ratio [%]", shapes=[line])}


def most_negative(rows, most=6):
    """Those with names: the leading one of each label, a few."""
    order = sorted(range(len(rows)), key=lambda i: number(rows[i][DAMPING]))
    return set(order[:most])


def about(row):
    parts = [f"<b>{row['label']}</b>", f"{number(row[FREQUENCY]):.2f} Hz", f"damping ratio {digits(number(row[DAMPING]))} %",
             f"growth rate {digits(number(row['growth rate [1/s]']))} 1/s", f"residual {digits(number(row['residual [-]']), 2)}"]
    for column, text in (("estimated error of lambda [-]", "estimated error of λ"),
                         ("estimated frequency error by the mesh [%]", "error of the mesh, frequency [%]")):
        if row.get(column):
            parts.append(f"{text} {digits(number(row[column]), 2)}")
    return "<br>".join(parts)


def branch_chart(results, name, title):
    """Divergence rate of every branch over the friction coefficient."""
    table, branches = results.table(name), {}
    for row in table.rows:
        branches.setdefault(row["branch [-]"], []).append(row)
    peaks = {branch: max(number(row[RATE]) for row in rows) for branch, rows in branches.items()}
    named = {branch for branch in sorted(peaks, key=peaks.get)[-8:] if peaks[branch] > WEAK}
    traces = []
    for branch, rows in branches.items():
        is_named = branch in named
        peak = max(range(len(rows)), key=lambda i: number(rows[i][RATE]))
        traces.append({
            "type": "scatter", "mode": "lines+text" if is_named else "lines", "showlegend": False, "name": f"{rows[0]['label']} ({branch})",
            "x": [short(row["mu [-]"]) for row in rows], "y": [short(row[RATE]) for row in rows],
            "text": [rows[0]["label"] if is_named and i == peak else "" for i in range(len(rows))], "textposition": "top left",
            "customdata": [[short(row[FREQUENCY]), row["verdict"], short(row["estimated error of lambda [-]"], 2)] for row in rows],
            "hovertemplate": f"<b>{rows[0]['label']}</b>" + "<br>μ = %{x:.4g}<br>%{customdata[0]:.2f} Hz<br>divergence rate %{y:.4g} %<br>"
                             "%{customdata[1]}, estimated error of λ %{customdata[2]}<extra></extra>",
            "line": {"color": UNSTABLE if peaks[branch] > WEAK else PALE, "width": 1.8 if peaks[branch] > WEAK else 1}})
    events = results.table(name.replace("branches", "thresholds")).rows if results.has(name.replace("branches", "thresholds")) else []
    for event, symbol in (("onset", "triangle-up"), ("restabilisation", "triangle-down")):
        own = [row for row in events if row["event"] == event]
        traces.append({"type": "scatter", "mode": "markers", "name": event, "x": [number(row["mu [-]"]) for row in own], "y": [0] * len(own),
                       "customdata": [[row["label"], row["mechanism"], number(row[FREQUENCY]), row["uncertainty [-]"]] for row in own],
                       "hovertemplate": "<b>%{customdata[0]}</b> " + event + "<br>μ = %{x:.6g} ± %{customdata[3]}<br>%{customdata[2]:.2f} Hz"
                                        "<br>%{customdata[1]}<extra></extra>",
                       "marker": {"symbol": symbol, "size": 9, "color": "white", "line": {"color": "#222", "width": 1.3}}})
    return {"id": name, "title": title, "caption": f"Every mode is a curve; red ones reach more than {WEAK} %. Triangles are thresholds.", "data": traces,
            "layout": layout("friction coefficient μ", "divergence rate [%]")}


COLOURS = ("#b2182b", "#2166ac", "#1b7837", "#762a83", "#bf812d", "#01665e", "#c51b7d", "#4d4d4d")


def bifurcation_chart(results):
    """Frequencies of two modes about that at which they meet and begin to flutter; the pairs that then grow most."""
    name = "branches_without_dissipation" if results.has("branches_without_dissipation") else "branches"
    branches = {}
    for row in results.table(name).rows:
        branches.setdefault(row["branch [-]"], []).append(row)
    peaks = {branch: max(number(row[RATE]) for row in rows) for branch, rows in branches.items()}
    events = [row for row in results.table(name.replace("branches", "thresholds")).rows if row["event"] == "onset" and row["partner [-]"] in branches]
    events = sorted((row for row in events if peaks[row["branch [-]"]] > WEAK), key=lambda row: -peaks[row["branch [-]"]])[:len(COLOURS)]
    if not events:
        return None
    traces = []
    for event, colour in zip(events, COLOURS):
        meeting = number(event[FREQUENCY])
        title = f"{event['label']} and {event['label of partner']}, {meeting:.0f} Hz"
        for branch in (event["branch [-]"], event["partner [-]"]):
            rows, is_first = branches[branch], branch == event["branch [-]"]
            traces.append({"type": "scatter", "mode": "lines", "name": title, "legendgroup": title, "showlegend": is_first,
                           "x": [short(row["mu [-]"]) for row in rows], "y": [short(number(row[FREQUENCY]) - meeting) for row in rows],
                           "customdata": [[short(row[FREQUENCY]), short(row[RATE], 4)] for row in rows], "line": {"color": colour, "width": 1.6},
                           "hovertemplate": f"<b>{rows[0]['label']}</b>" + "<br>μ = %{x:.4g}<br>%{customdata[0]:.2f} Hz"
                                            "<br>divergence rate %{customdata[1]:.4g} %<extra></extra>"})
    caption = ("Frequencies of two modes less that at which they meet; from there on both have one frequency, and one of them grows. "
               f"The {len(events)} pairs that grow most" + (", without radial dissipation." if "without" in name else "."))
    return {"id": "bifurcations", "title": "Which modes meet", "caption": caption, "data": traces,
            "layout": layout("friction coefficient μ", "frequency less that of meeting [Hz]")}


def energy_charts(results):
    """What each body adds to the divergence rate, by modes."""
    charts = {}
    for row in results.table("energy").rows if results.has("energy") else []:
        charts.setdefault(row["mode [-]"], []).append(row)
    parts = (("friction into the disc [%]", "friction on the disc", "#b2182b"), ("friction into the pin [%]", "friction on the pin", "#f4a582"),
             ("slope of friction [%]", "slope of friction", "#7b3294"), ("radial dissipation [%]", "radial dissipation", "#4393c3"),
             ("damping [%]", "damping", "#2166ac"))
    result = []
    for mode, rows in charts.items():
        data = [{"type": "bar", "name": title, "x": [row["body"] for row in rows], "y": [number(row[column] or "0") for row in rows],
                 "marker": {"color": colour}, "hovertemplate": "%{x}<br>" + title + " %{y:.4g} %<extra></extra>"}
                for column, title, colour in parts if any(number(row[column] or "0") != 0 for row in rows)]
        result.append({"mode": int(mode), "data": data, "layout": layout("", "adds to the divergence rate [%]", barmode="relative")})
    return result


def charts(results):
    found = []
    if results.has("complex_modes"):
        found.append(damping_chart(results))
    if results.has("branches"):
        found.append(branch_chart(results, "branches", "Growth over the friction coefficient"))
        if results.has("branches_without_dissipation"):
            found.append(branch_chart(results, "branches_without_dissipation", "The same without radial dissipation"))
        found += filter(None, [bifurcation_chart(results)])
    if results.has("designs") and any(row["outcome"] == "solved" for row in results.table("designs").rows):
        found += [designs_chart(results), variables_chart(results)]
    return found


# ------------------------------------------------------------------------------------------------------------------------ the rest


def tables(results):
    """All tables but those with a row for every point of a chart; the most important ones first."""
    order = {name: place for place, name in enumerate(TITLES)}
    found = []
    for name in sorted(results.names(), key=lambda name: (order.get(name, len(order)), name)):
        table = results.table(name)
        if len(table) and len(table) <= LARGEST_TABLE and not name.startswith("branches"):
            found.append({"id": name, "title": TITLES.get(name, name.replace("_", " ").capitalize()), "columns": table.columns,
                          "rows": [[row[column] for column in table.columns] for row in table.rows]})
    return found


def pictures(results):
    """Plots of the run that no chart replaces, as data."""
    skipped = ("complex_plane", "overview", "designs")
    return [{"name": path.stem.replace("_", " "), "source": "data:image/svg+xml;base64," + base64.b64encode(path.read_bytes()).decode()}
            for path in sorted((results.folder / "plots").glob("*.svg")) if not path.stem.startswith(skipped)]


def checks(results):
    """What was checked, and how accurate it is: pairs of what and how much."""
    record, found = results.record, []
    counts, quantities = record.get("counts", {}), record.get("quantities", {})
    if results.has("complex_modes"):
        residuals = results.table("complex_modes").numbers("residual [-]")
        found.append(("largest residual of a mode", digits(max(residuals, default=0), 2)))
    for step in record.get("steps", []):
        if step["name"] in ("Mode count", "Real modes"):
            found.append((step["name"].lower(), step["result"]))
    if results.has("argument_counts"):
        for row in results.table("argument_counts").rows:
            found.append((f"modes at μ = {number(row['mu [-]']):g} by the argument principle, and found",
                          f"{row['modes counted [-]']}, {row['modes of the sweep [-]']}"))
    for name in ("digits of the eigenvalues [-]", "largest condition number of an eigenvalue [-]", "largest estimated error of lambda [-]",
                 "largest estimated error of a frequency by the mesh [-]", "largest estimated error of a divergence rate by the mesh [-]",
                 "largest difference of a divergence rate from what its powers add up to [-]"):
        if name in quantities:
            found.append((name.removesuffix(" [-]"), digits(quantities[name], 3)))
    if results.has("designs"):
        rows = [row for row in results.table("designs").rows if row["outcome"] == "solved"]
        found.append(("designs of which all modes were found that were counted", f"{sum(row['complete [-]'] == '1' for row in rows)} of {len(rows)}"))
        for column, text in (("estimated error of lambda [-]", "largest estimated error of λ"), ("eps_res [-]", "largest residual of a mode, eq. (16)")):
            found.append((text, digits(max((number(row[column]) for row in rows), default=0), 2)))
    for name in ("dofs", "contact nodes", "modes converged on the mesh"):
        if name in counts:
            found.append((name, str(counts[name])))
    if "largest estimated error of a frequency by the mesh [-]" not in quantities:
        found.append(("error of the mesh", "not estimated; set Accuracy = 1 % does"))
    return found


def repeat(results):
    record = results.record
    return {"command": record.get("command", ""), "finished": record.get("finished", ""), "time": f"{record.get('wall time [s]', math.nan):.1f} s",
            "versions": ", ".join(f"{name} {version}" for name, version in record.get("versions", {}).items()),
            "warnings": record.get("warnings", []), "parameters": (results.folder / "parameters.prm").read_text(encoding="utf-8")}


def content(results):
    level, sentence = verdict(results)
    modes = results.table("complex_modes").rows if results.has("complex_modes") else []
    return {"title": results.folder.resolve().name, "study": results.parameter("Study"), "level": level, "verdict": sentence, "charts": charts(results),
            "energy": energy_charts(results), "shapes": shapes.of_growing_modes(results, modes), "tables": tables(results),
            "pictures": pictures(results), "checks": checks(results), "repeat": repeat(results)}
