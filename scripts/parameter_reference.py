#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Writes doc/parameters.md from the parameters that the program prints.

    scripts/parameter_reference.py            # writes the page
    scripts/parameter_reference.py --check    # exit status 1 if the page is not up to date

The environment variable SQUEAL is the path of the program (default: build/release/squeal).
"""

import dataclasses
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
HEAD = """# Parameters

Every parameter of a `.prm` file with its default, as `squeal --print-parameters` prints them; after `PRM --print-parameters` the values are those of
a run. `--set "Section/Name=value"` overrides one. This page is written by `scripts/parameter_reference.py`.
"""


@dataclasses.dataclass
class Parameter:
    section: str
    name: str
    default: str
    meaning: str
    unit: str
    accepts: str


def parameter(section, name, default, words):
    """Splits the words of a comment into meaning, units and accepted values."""
    text, _, accepts = " ".join(words).partition(ACCEPTS)
    meaning, _, unit = text.partition(UNITS)
    unit = unit.rstrip(".")
    return Parameter(section, name, default, meaning, "" if unit == "none" else unit, accepts.rstrip("."))


def parameters(listing):
    """The parameters printed by the program, in its order."""
    section, words, found = "", [], []
    for line in map(str.strip, listing.splitlines()):
        if line.startswith("subsection "):
            section, words = line.removeprefix("subsection "), []
        elif line in TITLE:
            words = []
        elif line.startswith("#"):
            words.append(line.lstrip("# "))
        elif match := re.match(r"set (.*?)\s*=\s*(.*)$", line):
            found.append(parameter(section, match[1], match[2], words))
            words = []
        elif not line:
            words = []
    return found


def cell(text):
    return text.replace("|", "\\|")


def page(listing):
    text, section = HEAD, None
    for one in parameters(listing):
        if one.section != section:
            section = one.section
            text += f"\n## {section or 'Without a section'}\n\n| parameter | default | unit | meaning | accepts |\n|---|---|---|---|---|\n"
        default = f"`{one.default}`" if one.default else ""
        text += f"| {cell(one.name)} | {cell(default)} | {cell(one.unit)} | {cell(one.meaning)} | {cell(one.accepts)} |\n"
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
