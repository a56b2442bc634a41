# SPDX-License-Identifier: GPL-3.0-or-later

"""Page of a run at one friction coefficient: effective damping ratios, growing modes, and their energy sources."""

from squeal.reporting import shapes
from squeal.reporting.charts import DAMPING, FREQUENCY, RATE, STABLE, UNSTABLE, digits, end_of_band, layout, name_of_mode, names_apart, number, points

TABLES = ("complex_modes",)
TITLES = {"complex_modes": "Modes with friction", "real_modes": "Modes without friction", "component_modes": "Modes of disc and pins alone",
          "energy": "Energy sources of growing modes", "real_eigenvalues": "Real eigenvalues",
          "sliding_pins": "Pins in steady sliding"}
REPLACED = ("complex_plane",)


def verdict(results):
    rows = results.table("complex_modes").rows
    growing = [row for row in rows if row["unstable [-]"] == "1"]
    static = [row for row in results.table("real_eigenvalues").rows if number(row["growth rate [1/s]"]) > 0] if results.has("real_eigenvalues") else []
    undecided = [row for row in rows if row.get("verdict") == "undecided"]
    where = f"{len(rows)} modes up to {end_of_band(results)} at μ = {results.number('Operation/Friction coefficient'):g}"
    text = f"None of the {where} is unstable."
    if growing:
        worst = max(growing, key=lambda row: number(row[RATE]))
        text = (f"{len(growing)} of the {where} {'grow' if len(growing) > 1 else 'grows'}; {worst['label']} at {number(worst[FREQUENCY]):.0f} Hz "
                f"grows fastest, with a divergence rate of {digits(number(worst[RATE]), 3)} % (effective damping ratio {digits(number(worst[DAMPING]), 3)} %).")
    if static:
        text += f" {len(static)} {'eigenvalues are' if len(static) > 1 else 'eigenvalue is'} real and positive (static divergence)."
    if undecided:
        text += f" {len(undecided)} {'modes are' if len(undecided) > 1 else 'mode is'} undecided within the estimated errors."
    return ("unstable" if growing or static else "undecided" if undecided else "stable"), text


def sections(results):
    modes = results.table("complex_modes").rows
    return [damping_section(modes), *shape_sections(results, modes), *energy_sections(results)]


def checks(results):
    residuals = results.table("complex_modes").numbers("residual [-]")
    return [("largest residual of a mode", digits(max(residuals, default=0), 2))]


def damping_section(rows):
    """Chart of the effective damping ratio -2R/omega versus frequency; the ratio is negative for growing modes."""
    traces, ratios = [], [number(row[DAMPING]) for row in rows] or [0]
    for title, colour, flag in (("does not grow", STABLE, "0"), ("grows", UNSTABLE, "1")):
        own = [row for row in rows if row["unstable [-]"] == flag]
        names = names_apart({i: -number(row[DAMPING]) for i, row in enumerate(own)}, max(ratios) - min(ratios)) if flag == "1" else []
        traces.append(points(title, [number(row[FREQUENCY]) for row in own], [number(row[DAMPING]) for row in own], list(map(about, own)),
                             mode="markers+text" if flag == "1" else "markers", textposition="bottom center",
                             text=[row["label"] if i in names else "" for i, row in enumerate(own)],
                             marker={"color": colour, "size": 9 if flag == "1" else 7, "symbol": "diamond" if flag == "1" else "circle"}))
    line = {"type": "line", "xref": "paper", "x0": 0, "x1": 1, "y0": 0, "y1": 0, "line": {"color": "#444", "width": 1}}
    return {"id": "damping", "title": "Effective damping ratio versus frequency",
            "caption": "Effective damping ratio −2R/ω of every mode; modes below zero grow.",
            "data": traces, "layout": layout("frequency [Hz]", "effective damping ratio [%]", shapes=[line])}


def about(row):
    parts = [f"<b>{row['label']}</b>", f"{number(row[FREQUENCY]):.2f} Hz", f"effective damping ratio {digits(number(row[DAMPING]))} %",
             f"growth rate {digits(number(row['growth rate [1/s]']))} 1/s", f"residual {digits(number(row['residual [-]']), 2)}"]
    for column, text in (("estimated error of lambda [-]", "estimated error of λ"),
                         ("estimated frequency error by the mesh [%]", "error of the mesh, frequency [%]")):
        if row.get(column):
            parts.append(f"{text} {digits(number(row[column]), 2)}")
    return "<br>".join(parts)


def shape_sections(results, modes):
    found = shapes.of_growing_modes(results, modes)
    return [{"id": "shapes", "title": "Growing modes", "shapes": found}] if found else []


def energy_sections(results):
    """Charts of the contribution of each body to the divergence rate of each growing mode."""
    bodies = {rows[0]["mode [-]"]: rows for rows in results.table("energy").groups("mode [-]")} if results.has("energy") else {}
    if not bodies:
        return []
    parts = (("friction into the disc [%]", "friction on the disc", "#b2182b"), ("friction into the pin [%]", "friction on the pin", "#f4a582"),
             ("friction slope [%]", "friction slope", "#7b3294"), ("radial dissipation [%]", "radial dissipation", "#4393c3"),
             ("damping [%]", "damping", "#2166ac"))
    choices = []
    for mode, rows in bodies.items():
        data = [{"type": "bar", "name": title, "x": [row["body"] for row in rows], "y": [number(row[column] or "0") for row in rows],
                 "marker": {"color": colour}, "hovertemplate": "%{x}<br>" + title + " %{y:.4g} %<extra></extra>"}
                for column, title, colour in parts if any(number(row[column] or "0") != 0 for row in rows)]
        choices.append({"key": mode, "name": name_of_mode(rows[0]), "data": data, "layout": layout("", "part of the divergence rate [%]", barmode="relative")})
    return [{"id": "energy", "title": "Energy sources of growing modes", "choices": choices,
             "chosen": max(bodies, key=lambda mode: number(bodies[mode][0][RATE])),
             "caption": "Contributions of friction and damping of each body, which add up to the divergence rate. Mode:"}]
