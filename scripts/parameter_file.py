"""Reads the parameters of a run."""

import pathlib
import re


def read_parameters(path):
    """Values of a parameter file as a dictionary "Section/Name" -> text."""
    values, sections = {}, []
    for line in pathlib.Path(path).read_text(encoding="utf-8").splitlines():
        line = line.split("#", 1)[0].strip()
        if match := re.fullmatch(r"subsection\s+(.+)", line):
            sections.append(match[1])
        elif line == "end":
            sections.pop()
        elif match := re.fullmatch(r"set\s+(.+?)\s*=\s*(.*)", line):
            values["/".join([*sections, match[1]])] = match[2]
    return values
