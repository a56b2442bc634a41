# SPDX-License-Identifier: GPL-3.0-or-later

"""The table of doc/extremes.md."""

import pathlib

PAGE = pathlib.Path(__file__).resolve().parents[2] / "doc" / "extremes.md"
BEGIN, END = "<!-- cases -->", "<!-- end of cases -->"
COLUMNS = ("case", "value", "outcome", "modes", "residual", "count", "oracle", "deviation", "digits", "remark")
HEAD = "| " + " | ".join(COLUMNS) + " |\n" + "|---" * len(COLUMNS) + "|"


def line(row):
    cells = (row.group, row.value, row.outcome, row.modes, row.residual, row.count, row.oracle, row.deviation, row.digits, row.remark)
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def write(rows, order):
    """Rows that were measured replace those of their cases; the other rows stay. Cases that `order` does not name are left out."""
    text = PAGE.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    table, after = rest.split(END)
    lines = {name_of(text): text for text in table.strip().splitlines()[2:]}
    lines.update({(row.group, row.value): line(row) for row in rows})
    table = "\n".join([HEAD, *(lines[name] for name in order if name in lines)])
    PAGE.write_text(f"{before}{BEGIN}\n{table}\n{END}{after}", encoding="utf-8")


def cases_of_page():
    """Cells of each row of the table as a list."""
    table = PAGE.read_text(encoding="utf-8").split(BEGIN)[1].split(END)[0]
    return [cells_of(text) for text in table.strip().splitlines()[2:]]


def names():
    """Group and value of the cases in the table."""
    return {tuple(cells[:2]) for cells in cases_of_page()}


def cells_of(text):
    return [cell.strip() for cell in text.strip("| ").split(" | ")]


def name_of(text):
    return tuple(cells_of(text)[:2])
