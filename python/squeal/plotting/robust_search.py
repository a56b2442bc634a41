# SPDX-License-Identifier: GPL-3.0-or-later

"""History of a search with uncertain parameters, and the goal of the search versus the variables."""

from squeal.plotting import style

MOST_VARIABLES = 5


def figures(results):
    table = results.table("search")
    goal = table.columns[-2]
    variables = table.columns[2:table.columns.index("probability of squeal [%]")][:MOST_VARIABLES]
    picture = style.Picture("Search with uncertain parameters", 1 + len(variables), 3)
    for panel, name in zip(picture.panels, ["design [-]", *variables]):
        style.prepare(panel, "", name, goal)
        for phase, colour in (("sample", style.SKY), ("search", style.BLUE)):
            rows = [row for row in table.rows if row["phase"] == phase]
            panel.plot([float(row[name]) for row in rows], [float(row[goal]) for row in rows], linestyle="", marker=".", color=colour, label=phase)
    picture.panels[0].step(table.numbers("design [-]"), table.numbers("best " + goal), where="post", color=style.GREY, label="best so far")
    return {"search": picture.add_key()}
