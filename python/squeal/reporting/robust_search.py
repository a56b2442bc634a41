# SPDX-License-Identifier: GPL-3.0-or-later

"""Page of a search with uncertain parameters: the best design, evaluated with the samples of the search and with other samples."""

from squeal.reporting.charts import STABLE, UNSTABLE, best_so_far, confidence, digits, layout, number, plain, points, short

TABLES = ("best_design",)
TITLES = {"best_design": "The best design with the samples of the search and with other samples", "search": "Designs in the order of evaluation",
          "full_order": "The worst of the other samples at full order"}


def goal_of(results):
    """The column of the goal, which precedes the column of the best value so far."""
    return results.table("search").columns[-2]


def verdict(results):
    goal, rows = goal_of(results), results.table("search").rows
    best = min(rows, key=lambda row: number(row[goal]))
    other = results.table("best_design").rows[1]
    columns = results.table("search").columns
    variables = columns[2:columns.index("probability of squeal [%]")]
    values = ", ".join(f"{name} = {plain(best[name], 4)}" for name in variables)
    name = goal.removesuffix(" [%]")
    level = "unstable" if number(other["probability of squeal [%]"]) > 0. else "stable"
    return level, (f"Of {len(rows)} designs, number {best['design [-]']} is the best ({values}): {name} {digits(number(best[goal]), 3)} %, or "
                   f"{digits(number(other[goal]), 3)} % with other samples; {digits(number(other['probability of squeal [%]']), 3)} % of the other "
                   f"samples squeal ({confidence(other)}).")


def sections(results):
    goal, rows = goal_of(results), results.table("search").rows
    traces = [best_so_far(rows, goal)]
    for phase, colour, symbol in (("sample", STABLE, "circle"), ("search", UNSTABLE, "diamond")):
        chosen = [row for row in rows if row["phase"] == phase]
        traces.append(points(phase, [int(row["design [-]"]) for row in chosen], [short(row[goal]) for row in chosen],
                             marker={"color": colour, "size": 8, "symbol": symbol}))
    return [{"id": "history", "title": "History of the search", "data": traces, "layout": layout("evaluation", goal),
             "caption": "Each mark is a design; the line shows the best value so far."}]


def checks(results):
    counts = results.record["counts"]
    return [("samples of a design", str(counts["samples of a design"])), ("basis vectors", str(counts["basis vectors"]))]
