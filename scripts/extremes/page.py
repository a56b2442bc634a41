# SPDX-License-Identifier: GPL-3.0-or-later

"""The table of doc/extremes.md."""

import dataclasses
import pathlib
import re

PAGE = pathlib.Path(__file__).resolve().parents[2] / "doc" / "extremes.md"
BEGIN, END = "<!-- cases -->", "<!-- end of cases -->"
COLUMNS = ("case", "value", "outcome", "modes", "residual", "count", "oracle", "deviation", "digits", "remark")  # of judge.Row
HEAD = "| " + " | ".join(COLUMNS) + " |\n" + "|---" * len(COLUMNS) + "|"


def line(row):
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in dataclasses.astuple(row)) + " |"


def known_lines():
    """Lines of the table by group and value of their cases."""
    table = PAGE.read_text(encoding="utf-8").split(BEGIN)[1].split(END)[0]
    return {tuple(cell.strip() for cell in text.strip("| ").split(" | ")[:2]): text for text in table.strip().splitlines()[2:]}


def write(rows, order):
    """Replaces the rows of the measured cases, keeps the others, and drops cases that are not in `order`."""
    lines = {**known_lines(), **{(row.group, row.value): line(row) for row in rows}}
    before, after = re.split(f"{BEGIN}.*{END}", PAGE.read_text(encoding="utf-8"), flags=re.DOTALL)
    table = "\n".join([HEAD, *(lines[name] for name in order if name in lines)])
    PAGE.write_text(f"{before}{BEGIN}\n{table}\n{END}{after}", encoding="utf-8")
