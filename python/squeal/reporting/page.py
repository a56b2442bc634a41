# SPDX-License-Identifier: GPL-3.0-or-later

"""A self-contained HTML file with data, drawing libraries and styles."""

import base64
import html
import json
import pathlib
import re

from squeal.errors import Error

HERE = pathlib.Path(__file__).resolve().parent
JAVASCRIPT = pathlib.Path("/usr/share/javascript")
# Debian packages, and the file of each package that is embedded
LIBRARIES = {"python3-plotly": pathlib.Path("/usr/share/python3-plotly/plotly.js"),
             "libjs-three": JAVASCRIPT / "three" / "three.min.js",
             "libjs-jquery": JAVASCRIPT / "jquery" / "jquery.min.js",
             "libjs-jquery-datatables": JAVASCRIPT / "jquery-datatables" / "jquery.dataTables.min.js"}
CONTROLS = JAVASCRIPT / "three" / "examples" / "js" / "controls" / "OrbitControls.js"
TABLE_STYLE = JAVASCRIPT / "jquery-datatables" / "css" / "jquery.dataTables.min.css"


def missing_packages():
    return [package for package, path in LIBRARIES.items() if not path.is_file()]


def style_of(path):
    """A style sheet with embedded pictures."""
    def picture(match):
        file = (path.parent / match[1].strip("\"'")).resolve()
        return f"url(data:image/png;base64,{base64.b64encode(file.read_bytes()).decode()})" if file.is_file() else "none"

    return re.sub(r"url\(([^)]*)\)", picture, path.read_text(encoding="utf-8"))


def script(text):
    """A script element with escaped text, which cannot end the element."""
    return "<script>" + text.replace("</script", "<\\/script").replace("<!--", "<\\!--") + "</script>\n"


VIEWER = ('<div class="viewer"><div class="buttons" id="modes"></div><div id="canvas"></div><div class="buttons"><button id="play">pause</button>'
          '<label>size <input type="range" id="size" min="0" max="0.2" step="0.005" value="0.06"></label>'
          '<label><input type="checkbox" id="disc" checked> disc</label><button data-view="above">above</button>'
          '<button data-view="below">below</button><button data-view="side">side</button></div><p>Colour: amplitude, dark where large. '
          "Drag to rotate. Hide the disc to see the contact faces of the pins.</p></div>")


def section(title, body, name):
    return f'<section id="{html.escape(name)}"><h2>{html.escape(title)}</h2>{body}</section>\n'


def entry_section(entry):
    """A section with the available parts of its entry: caption, selection list, animated shapes, chart, picture, facts,
    notes, command."""
    parts, name = [], html.escape(entry["id"])
    if "caption" in entry:
        parts.append(f'<p>{html.escape(entry["caption"])} {choices(entry)}</p>')
    if "shapes" in entry:
        parts.append(VIEWER)
    if is_chart(entry):
        size = "".join(f"{style}: {entry[part]}px; " for part, style in (("height", "height"), ("least width", "min-width")) if part in entry)
        parts.append(f'<div class="wide"><div class="chart" id="chart-{name}" style="{size}"></div></div>')
    if "picture" in entry:
        parts.append(f'<img src="{entry["picture"]}" alt="{html.escape(entry["title"])}">')
    if "facts" in entry:
        parts.append('<div class="wide"><table class="facts">' + rows_of(entry["facts"]["columns"], entry["facts"]["rows"], str) + "</table></div>")
    if "notes" in entry:
        parts.append("<ul>" + "".join(f"<li>{html.escape(note)}</li>" for note in entry["notes"]) + "</ul>")
    if "command" in entry:
        parts.append(f'<pre>{html.escape(entry["command"])}</pre>')
    return section(entry["title"], "".join(parts), entry["id"])


def choices(entry):
    """A selection list for the data of a chart."""
    if "choices" not in entry:
        return ""
    options = "".join(f'<option value="{html.escape(choice["key"])}">{html.escape(choice["name"])}</option>' for choice in entry["choices"])
    return f'<select id="choice-{html.escape(entry["id"])}" aria-label="{html.escape(entry["title"])}">{options}</select>'


def is_chart(entry):
    return "data" in entry or "choices" in entry


def rows_of(columns, rows, text_of):
    """Head and body of a table; text_of(cell) returns the displayed text."""
    head = "".join(f"<th>{html.escape(column)}</th>" for column in columns)
    lines = "".join("<tr>" + "".join(f"<td>{html.escape(text_of(cell))}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<thead><tr>{head}</tr></thead><tbody>{lines}</tbody>"


def table(entry):
    name = html.escape(entry["id"])
    return (f'<details open><summary>{html.escape(entry["title"])} <span class="file">{name}.csv</span></summary>'
            f'<div class="wide"><table class="sortable" id="table-{name}">{rows_of(entry["columns"], entry["rows"], shown)}</table></div></details>')


def shown(cell):
    """A number with six digits; the files have twelve."""
    try:
        value = float(cell)
    except ValueError:
        return cell
    return cell if len(cell) < 8 else f"{value:.6g}"


def not_shown(names):
    return f"<p>Tables in the folder only: {html.escape(', '.join(name + '.csv' for name in names))}.</p>" if names else ""


def body(content):
    parts = [f'<header class="{content["level"]}"><p class="study">{html.escape(content["title"])} · Study = {html.escape(content["study"])}</p>'
             f'<h1 id="verdict">{html.escape(content["verdict"])}</h1></header>\n']
    parts += map(entry_section, content["sections"])
    parts.append(section("Tables", "".join(table(entry) for entry in content["tables"]) +
                         "<p>Numbers are rounded to six digits; the files have twelve.</p>" + not_shown(content["too long"]), "tables"))
    parts.append(section("Checks and accuracy",
                         "<dl>" + "".join(f"<dt>{html.escape(what)}</dt><dd>{html.escape(value)}</dd>" for what, value in content["checks"]) +
                         "</dl>" + "".join(f'<p class="warning">{html.escape(text)}</p>' for text in content["repeat"]["warnings"]), "checks"))
    again = content["repeat"]
    parts.append(section("How to repeat the run", f'<pre>{html.escape(again["command"])}</pre><p>{html.escape(again["finished"])}, '
                         f'{again["time"]}; {html.escape(again["versions"])}</p><details><summary>parameters.prm</summary><pre>'
                         f'{html.escape(again["parameters"])}</pre></details>', "repeat"))
    return "".join(parts)


def page(content):
    """The complete page. Raises Error if libraries are missing."""
    if missing := missing_packages():
        raise Error("JavaScript libraries are missing", "Results.report()", f"apt-get install {' '.join(missing)} (or scripts/setup.sh)")
    charts = [{part: entry[part] for part in ("id", "data", "layout", "choices", "chosen") if part in entry}
              for entry in content["sections"] if is_chart(entry)]
    data = {"charts": charts, "shapes": next((entry["shapes"] for entry in content["sections"] if "shapes" in entry), None)}
    scripts = [path.read_text(encoding="utf-8") for path in (*LIBRARIES.values(), CONTROLS)]
    return ("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
            f"<title>{html.escape(content['title'])}</title><link rel=\"icon\" href=\"data:,\">\n"
            f"<style>{style_of(TABLE_STYLE)}\n{(HERE / 'report.css').read_text(encoding='utf-8')}</style></head><body>\n<main>{body(content)}</main>\n"
            + "".join(map(script, scripts))
            + f'<script type="application/json" id="data">{json.dumps(data, allow_nan=False).replace("</", "<" + chr(92) + "/")}</script>\n'
            + script((HERE / "report.js").read_text(encoding="utf-8")) + "</body></html>\n")
