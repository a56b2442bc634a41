#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Writes doc/parameters.md from the parameters that the program prints.

    scripts/parameter_reference.py            # writes the page
    scripts/parameter_reference.py --check    # exit status 1 if the page is not up to date

The environment variable SQUEAL is the path of the program (default: build/release/squeal).
"""

import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from squeal.command_line import Parser, exit_on_error
from squeal.program import SOURCE, find_program

PAGE = SOURCE / "doc" / "parameters.md"
TITLE = ("# Listing of Parameters", "# ---------------------")  # deal.II's
ACCEPTS, UNITS = " Accepts ", " Units: "
TABLE_HEAD = "| parameter | default | unit | meaning | accepts |\n|---|---|---|---|---|\n"
HEAD = """# Parameters

Every parameter of a `.prm` file with its default, as `squeal --print-parameters` prints them; after `PRM --print-parameters` the values are those of
a run. `--set "Section/Name=value"` overrides one. This page is written by `scripts/parameter_reference.py`.
"""


def cells_of(name, default, comment):
    """Cells of a parameter, whose comment has its meaning, unit and accepted values."""
    text, _, accepts = comment.partition(ACCEPTS)
    meaning, _, unit = text.partition(UNITS)
    unit = unit.rstrip(".")
    return name, f"`{default}`" if default else "", "" if unit == "none" else unit, meaning, accepts.rstrip(".")


def page(listing):
    """The page for the parameters that the program prints."""
    text, words, in_section = HEAD, [], False
    for line in map(str.strip, listing.splitlines()):
        if line.startswith("#") and line not in TITLE:
            words.append(line.lstrip("# "))
            continue
        section, parameter = re.match(r"subsection (.*)", line), re.match(r"set (.*?)\s*=\s*(.*)$", line)
        if section or parameter and not in_section:
            in_section = True
            text += f"\n## {section[1] if section else 'Without a section'}\n\n{TABLE_HEAD}"
        if parameter:
            cells = cells_of(parameter[1], parameter[2], " ".join(words))
            text += "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |\n"
        words = []
    return text


@exit_on_error()
def main():
    parser = Parser(__doc__)
    parser.add_argument("--check", action="store_true", help="writes nothing")
    arguments = parser.parse_args()
    written = page(subprocess.run([find_program(), "--print-parameters"], capture_output=True, text=True, check=True).stdout)
    if not arguments.check:
        PAGE.write_text(written, encoding="utf-8")
    elif not PAGE.exists() or PAGE.read_text(encoding="utf-8") != written:
        sys.exit(f"{PAGE.relative_to(SOURCE)} is not up to date: run scripts/parameter_reference.py")


if __name__ == "__main__":
    main()
