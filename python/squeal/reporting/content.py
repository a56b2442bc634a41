# SPDX-License-Identifier: GPL-3.0-or-later

"""Content of a report: verdict, sections, tables, checks, and how to repeat the run. Everything is read from the results.

Each kind of results has a module in PAGES. It defines the tables that it requires (`TABLES`), titles of tables
(`TITLES`), `verdict`, and optionally `sections` with charts, `checks`, and the plots that its charts replace
(`REPLACED`).
"""

import base64
import math

from squeal.reporting import designs, robust_search, robustness, search, sensitivity, stability, stability_map, sweep, updating
from squeal.reporting.charts import digits

PAGES = (sweep, stability_map, stability, search, robust_search, designs, sensitivity, robustness, updating)
LARGEST_TABLE = 2500  # maximum number of rows of a table


def parts(pages, name, results):
    """Sections or checks of all pages."""
    return [part for page in pages if hasattr(page, name) for part in getattr(page, name)(results)]


def verdict(results, pages):
    """Verdict of the run as (level, sentence)."""
    found = [said for page in pages if (said := page.verdict(results))]
    if not found:
        return "none", f"Results of Study = {results.parameter('Study')}: see the tables."
    return found[0][0], " ".join(sentence for _, sentence in found)


def tables(results, pages):
    """Tables, most important first, and the names of omitted tables: tables of branches, and tables with too many rows."""
    titles = {name: title for page in pages for name, title in page.TITLES.items()}
    order = {name: place for place, name in enumerate(titles)}
    found, too_long = [], []
    for name in sorted(results.names(), key=lambda name: (order.get(name, len(order)), name)):
        table = results.table(name)
        if len(table) > LARGEST_TABLE or name.startswith("branches"):
            too_long.append(name)
        elif len(table):
            found.append({"id": name, "title": titles.get(name, name.replace("_", " ").capitalize()), "columns": table.columns,
                          "rows": [[row[column] for column in table.columns] for row in table.rows]})
    return found, too_long


def pictures(results, pages):
    """Plots of the run that no chart replaces, as data URLs."""
    replaced = tuple(name for page in pages for name in getattr(page, "REPLACED", ()))
    return [{"id": "plot-" + path.stem, "title": path.stem.replace("_", " ").capitalize(),
             "picture": "data:image/svg+xml;base64," + base64.b64encode(path.read_bytes()).decode()}
            for path in sorted((results.folder / "plots").glob("*.svg")) if not path.stem.startswith(replaced)]


def checks(results, pages):
    """Checks of the results as pairs (check, result)."""
    record = results.record
    counts, quantities = record.get("counts", {}), record.get("quantities", {})
    found = parts(pages, "checks", results)
    for step in record.get("steps", []):
        if step["name"] in ("Mode count", "Real modes"):
            found.append((step["name"].lower(), step["result"]))
    for name in ("digits of the eigenvalues [-]", "largest condition number of an eigenvalue [-]", "largest estimated error of lambda [-]",
                 "largest estimated error of a frequency by the mesh [-]", "largest estimated error of a divergence rate by the mesh [-]",
                 "largest difference of a divergence rate from the sum of its contributions [-]"):
        if name in quantities:
            found.append((name.removesuffix(" [-]"), digits(quantities[name], 3)))
    for name in ("dofs", "contact nodes", "modes converged on the mesh"):
        if name in counts:
            found.append((name, str(counts[name])))
    if "largest estimated error of a frequency by the mesh [-]" not in quantities:
        found.append(("error of the mesh", "not estimated; set Accuracy = 1 % or Discretization/Coarser mesh"))
    return found


def repeat(results):
    record = results.record
    return {"command": record.get("command", ""), "finished": record.get("finished", ""), "time": f"{record.get('wall time [s]', math.nan):.1f} s",
            "versions": ", ".join(f"{name} {version}" for name, version in record.get("versions", {}).items()),
            "warnings": record.get("warnings", []), "parameters": (results.folder / "parameters.prm").read_text(encoding="utf-8", errors="replace")}


def content(results):
    pages = [page for page in PAGES if all(map(results.has, page.TABLES))]
    level, sentence = verdict(results, pages)
    shown, too_long = tables(results, pages)
    return {"title": results.folder.resolve().name, "study": results.parameter("Study"), "level": level, "verdict": sentence,
            "sections": parts(pages, "sections", results) + pictures(results, pages), "tables": shown,
            "too long": too_long, "checks": checks(results, pages), "repeat": repeat(results)}
