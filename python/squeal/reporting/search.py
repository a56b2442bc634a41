# SPDX-License-Identifier: GPL-3.0-or-later

"""Page of a search: its history, the best design with its check at full order, and all designs versus their variables."""

import re
import shlex
import textwrap

from squeal.reporting.charts import FREQUENCY, RATE, STABLE, UNSTABLE, WEAK, best_so_far, digits, layout, number, plain, points, short
from squeal.reporting.designs import LARGEST, ONSET, about, design_text, end_of_sweep, name_of

TABLES = ("search", "designs")
TITLES = {"search": "Designs in the order of evaluation", "full_order": "The best design at full order"}
GOALS = {LARGEST: "largest divergence rate [%]", ONSET: "onset μ (0.01 %)"}


class Search:
    """Evaluated designs with their goal, and the best design."""

    def __init__(self, results):
        self.table = results.table("search")
        self.goal = self.table.columns[-2]
        self.variables = self.table.columns[2:-2]
        self.designs = {row["design [-]"]: row for row in results.table("designs").rows}
        self.solved = [row for row in self.table.rows if row[self.goal]]
        self.end = end_of_sweep(results)
        better = max if self.goal == ONSET else min
        self.best = better(self.solved, key=self.value) if self.solved else None
        samples = [row for row in self.solved if row["phase"] == "sample"]
        self.best_sample = better(samples, key=self.value) if samples else None

    def value(self, row):
        return number(row[self.goal])

    def text(self, row):
        """Text with the goal of a design."""
        return f"{digits(self.value(row))} %" if self.goal == LARGEST else f"μ = {digits(self.value(row))}"


def verdict(results):
    search = Search(results)
    if search.best is None:
        return "none", f"None of {len(search.table)} designs could be solved."
    row = search.designs[search.best["design [-]"]]
    grows = number(row[LARGEST] or "0") > WEAK
    text = f"Of {len(search.table)} designs, the best is {design_text(row, search.variables)}: "
    if grows:
        text += (f"a divergence rate of at most {digits(number(row[LARGEST]), 3)} % ({row['label of largest']}), "
                 f"above 0.01 % from μ = {digits(number(row[ONSET]), 3)}.")
    else:
        text += f"it stays below a divergence rate of {WEAK} % up to μ = {search.end:g}."
    if search.best_sample is not None and search.best_sample is not search.best:
        text += f" The best sample reaches {search.text(search.best_sample)}, this design {search.text(search.best)}."
    elif len(search.table) > sum(row["phase"] == "sample" for row in search.table.rows):
        text += " It is one of the samples: the searches from the best two samples found no better design."
    return "unstable" if grows else "stable", text


def sections(results):
    search = Search(results)
    found = [history_section(search)]
    if search.best is not None:
        found += [best_section(results, search), variables_section(results, search)]
    return found


def checks(results):
    if not results.has("full_order"):
        return []
    rows = results.table("full_order")
    return [("largest residual of the best design's modes at full order", digits(max(rows.numbers(rows.columns[-1]), default=0), 2))]


def history_section(search):
    """Chart of the goal versus the number of the evaluation, with the best value so far."""
    first = search.table.rows.index(search.solved[0]) if search.solved else len(search.table)
    best = best_so_far(search.table.rows[first:], search.goal, hovertemplate="best of %{x} designs: %{y:.4g}<extra></extra>")
    traces = [best, *designs_traces(search, lambda row: int(row["design [-]"]))]
    left = [row for row in search.table.rows if not row[search.goal]]
    if left:
        worst = (min if search.goal == ONSET else max)(map(search.value, search.solved), default=0)
        reasons = [search.designs[row["design [-]"]]["reason"] for row in left]
        traces.append(points("rejected or failed", [int(row["design [-]"]) for row in left], [worst] * len(left),
                             [f"<b>design {row['design [-]']}</b><br>{'<br>'.join(textwrap.wrap(reason, 44))}" for row, reason in zip(left, reasons)],
                             marker={"symbol": "x", "color": "#8a939c", "size": 9}))
    caption = ("Each mark is a design; the line shows the best value so far. Searches from the best two samples follow the samples of the ranges."
               + (" Crosses are designs without a value." if left else ""))
    return {"id": "history", "title": "History of the search", "caption": caption, "data": traces, "layout": layout("evaluation", GOALS[search.goal])}


def designs_traces(search, place):
    """Series of points for the samples and for the designs of searches."""
    for phase, title, colour, symbol in (("sample", "samples", STABLE, "circle"), ("search", "search", UNSTABLE, "diamond")):
        rows = [row for row in search.solved if row["phase"] == phase]
        yield points(title, list(map(place, rows)), [short(row[search.goal]) for row in rows],
                     [about(search.designs[row["design [-]"]], search.variables, search.end) for row in rows],
                     marker={"color": colour, "size": 8, "symbol": symbol})


def best_section(results, search):
    """Values of the best design and of the baseline, and the check at full order."""
    ranges = dict(re.findall(r"\s*([^;=]+?)\s*=\s*([^;]+?)\s*(?:;|$)", results.parameter("Designs/Variables")))
    facts, notes = [], []
    for name in search.variables:
        value = number(search.best[name])
        facts.append([name, plain(baseline_value(results, name)), ranges.get(name, "").replace(" to ", " … "), plain(search.best[name], 4)])
        ends = [float(end) for end in re.findall(r"[-+.\deE]+", ranges.get(name, "").replace(" to ", " "))[:2]]
        if value in ends:
            end = "lower" if value == ends[0] else "upper"
            notes.append(f"{name} is at the {end} limit of its range; a wider range may contain a better design.")
    row = search.designs[search.best["design [-]"]]
    for full in results.table("full_order").rows if results.has("full_order") else []:
        text = (f"At full order, μ = {number(full['mu [-]']):.4g}: {full['unstable modes [-]']} of {full['modes [-]']} modes grow, "
                f"with at most {digits(number(full[RATE]))} % ({full['label']} at {number(full[FREQUENCY]):.1f} Hz)")
        if row[LARGEST] and abs(number(full["mu [-]"]) - number(row["mu of largest [-]"])) < 1e-9:
            text += f"; the sweep of the search gives {digits(number(row[LARGEST]))} % there"
        notes.append(text + ".")
    # Take the first word of the command, which may contain quoted blanks
    program = re.match(r"(?:[^\s'\\]|\\.|'[^']*')*", results.record.get("command", ""))[0] or "squeal"
    return {"id": "best", "title": f"The best design, number {search.best['design [-]']}",
            "facts": {"columns": ["parameter", "baseline", "range", "best"], "rows": facts}, "notes": notes,
            "caption": "The parameter file of this design is best.prm next to this page. To repeat its sweep:",
            "command": f"{program} {shlex.quote(str(results.folder / 'best.prm'))}"}


def baseline_value(results, name):
    """The value of a variable in the parameter file of the search."""
    match = re.fullmatch(r"([^+\[]+?)(?:\[(\d+)\])?(?:\s*\+.*)?", name)
    text = results.parameters.get(match[1], "") if match else ""
    if match and match[2]:
        numbers = re.findall(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", text)
        text = numbers[int(match[2]) - 1] if int(match[2]) <= len(numbers) else ""
    return text


def variables_section(results, search):
    """Chart of the goal versus each variable."""
    choices = []
    for name in search.variables:
        ring = points("the best", [number(search.best[name])], [short(search.best[search.goal])], hoverinfo="skip",
                      marker={"symbol": "circle-open", "size": 17, "color": "#222", "line": {"width": 2}})
        traces = [*designs_traces(search, lambda row: number(row[name])), ring]
        choices.append({"key": name, "name": name_of(name), "data": traces, "layout": layout(name, GOALS[search.goal])})
    return {"id": "over_variables", "title": "Designs versus their variables", "choices": choices, "chosen": search.variables[0],
            "caption": "Each mark is a solved design; a ring marks the best design. Variable:"}
