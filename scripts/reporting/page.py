"""One HTML file with everything in it: data, drawing libraries, styles."""

import base64
import html
import json
import pathlib
import re

HERE = pathlib.Path(__file__).resolve().parent
JAVASCRIPT = pathlib.Path("/usr/share/javascript")
# Debian's packages, and what of them goes into the page
LIBRARIES = {"python3-plotly": pathlib.Path("/usr/share/python3-plotly/plotly.js"),
             "libjs-three": JAVASCRIPT / "three" / "three.min.js",
             "libjs-jquery": JAVASCRIPT / "jquery" / "jquery.min.js",
             "libjs-jquery-datatables": JAVASCRIPT / "jquery-datatables" / "jquery.dataTables.min.js"}
CONTROLS = JAVASCRIPT / "three" / "examples" / "js" / "controls" / "OrbitControls.js"
TABLE_STYLE = JAVASCRIPT / "jquery-datatables" / "css" / "jquery.dataTables.min.css"


class MissingLibraries(Exception):
    """Names of Debian's packages."""


def missing_packages():
    return [package for package, path in LIBRARIES.items() if not path.is_file()]


def style_of(path):
    """A style sheet with its pictures in it."""
    def picture(match):
        file = (path.parent / match[1].strip("\"'")).resolve()
        return f"url(data:image/png;base64,{base64.b64encode(file.read_bytes()).decode()})" if file.is_file() else "none"

    return re.sub(r"url\(([^)]*)\)", picture, path.read_text(encoding="utf-8"))


def script(text):
    """A script that the page's parser does not end early."""
    return "<script>" + text.replace("</script", "<\\/script").replace("<!--", "<\\!--") + "</script>\n"


def section(title, body, name):
    return f'<section id="{name}"><h2>{html.escape(title)}</h2>{body}</section>\n'


def table(entry):
    head = "".join(f"<th>{html.escape(column)}</th>" for column in entry["columns"])
    rows = "".join("<tr>" + "".join(f"<td>{html.escape(shown(cell))}</td>" for cell in row) + "</tr>" for row in entry["rows"])
    return (f'<details open><summary>{html.escape(entry["title"])} <span class="file">{html.escape(entry["id"])}.csv</span></summary>'
            f'<div class="wide"><table class="sortable" id="table-{html.escape(entry["id"])}"><thead><tr>{head}</tr></thead>'
            f"<tbody>{rows}</tbody></table></div></details>")


def shown(cell):
    """Numbers with six digits; the files have twelve."""
    try:
        value = float(cell)
    except ValueError:
        return cell
    return cell if len(cell) < 8 else f"{value:.6g}"


def body(content):
    parts = [f'<header class="{content["level"]}"><p class="study">{html.escape(content["title"])} · Study = {html.escape(content["study"])}</p>'
             f'<h1 id="verdict">{html.escape(content["verdict"])}</h1></header>\n']
    for chart in content["charts"]:
        parts.append(section(chart["title"], f'<p>{html.escape(chart["caption"])}</p><div class="chart" id="chart-{chart["id"]}"></div>', chart["id"]))
    if content["shapes"]:
        parts.append(section("Modes that grow", '<div class="viewer"><div class="buttons" id="modes"></div><div id="canvas"></div>'
                             '<div class="buttons"><button id="play">pause</button><label>size <input type="range" id="size" min="0" max="0.2" '
                             'step="0.005" value="0.06"></label><label><input type="checkbox" id="disc" checked> disc</label>'
                             '<button data-view="above">above</button><button data-view="below">below</button>'
                             '<button data-view="side">side</button></div><p>Colours: amplitude, dark where it is large. Turn with the mouse or a '
                             "finger. Without the disc the contact faces of the pins are seen.</p></div>", "shapes"))
    if content["energy"]:
        parts.append(section("Where their energy enters", '<p>What friction and damping of each body add to the divergence rate of '
                             '<select id="energy-mode"></select>; together they are the divergence rate.</p>'
                             '<div class="chart" id="chart-energy"></div>', "energy"))
    for picture in content["pictures"]:
        parts.append(section(picture["name"].capitalize(), f'<img src="{picture["source"]}" alt="{html.escape(picture["name"])}">', "plot-" + picture["name"].replace(" ", "-")))
    parts.append(section("Tables", "".join(table(entry) for entry in content["tables"]) +
                         "<p>Here with six digits; the files have twelve.</p>", "tables"))
    parts.append(section("What was checked, and how accurate it is",
                         "<dl>" + "".join(f"<dt>{html.escape(what)}</dt><dd>{html.escape(value)}</dd>" for what, value in content["checks"]) +
                         "</dl>" + "".join(f'<p class="warning">{html.escape(text)}</p>' for text in content["repeat"]["warnings"]), "checks"))
    again = content["repeat"]
    parts.append(section("How to repeat it", f'<pre>{html.escape(again["command"])}</pre><p>{html.escape(again["finished"])}, {again["time"]}; '
                         f'{html.escape(again["versions"])}</p><details><summary>parameters.prm</summary><pre>{html.escape(again["parameters"])}</pre></details>',
                         "repeat"))
    return "".join(parts)


def page(content):
    """The whole file. Throws MissingLibraries."""
    missing = missing_packages()
    if missing:
        raise MissingLibraries(missing)
    data = {name: content[name] for name in ("charts", "energy", "shapes")}
    scripts = [path.read_text(encoding="utf-8") for path in (*LIBRARIES.values(), CONTROLS)]
    return ("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
            f"<title>{html.escape(content['title'])}</title><link rel=\"icon\" href=\"data:,\">\n"
            f"<style>{style_of(TABLE_STYLE)}\n{(HERE / 'report.css').read_text(encoding='utf-8')}</style></head><body>\n<main>{body(content)}</main>\n"
            + "".join(map(script, scripts))
            + f'<script type="application/json" id="data">{json.dumps(data, allow_nan=False).replace("</", "<" + chr(92) + "/")}</script>\n'
            + script((HERE / "report.js").read_text(encoding="utf-8")) + "</body></html>\n")
