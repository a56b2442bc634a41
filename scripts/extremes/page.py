"""The table of doc/extremes.md."""

import pathlib

PAGE = pathlib.Path(__file__).resolve().parents[2] / "doc" / "extremes.md"
BEGIN, END = "<!-- cases -->", "<!-- end of cases -->"
COLUMNS = ("case", "value", "outcome", "modes", "residual", "count", "oracle", "deviation", "digits", "remark")
HEAD = "| " + " | ".join(COLUMNS) + " |\n" + "|---" * len(COLUMNS) + "|"


def line(row):
    cells = (row.group, row.value, row.outcome, row.modes, row.residual, row.count, row.oracle, row.deviation, row.digits, row.remark)
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def write(rows):
    """Replaces the table between the marks."""
    text = PAGE.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    _, after = rest.split(END)
    table = "\n".join([HEAD, *map(line, rows)])
    PAGE.write_text(f"{before}{BEGIN}\n{table}\n{END}{after}", encoding="utf-8")


def cases_of_page():
    """Cells of each row of the table as a list."""
    table = PAGE.read_text(encoding="utf-8").split(BEGIN)[1].split(END)[0]
    return [[cell.strip() for cell in text.strip("| ").split(" | ")] for text in table.strip().splitlines()[2:]]
