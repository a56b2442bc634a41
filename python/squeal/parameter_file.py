# SPDX-License-Identifier: GPL-3.0-or-later

"""Reads the parameters of a run."""

import pathlib
import re

BLANKS = " \t\r\n\v\f"


def read_value(text):
    """The value after `=`: the text in double quotes, or the text before the comment."""
    text = text.strip(BLANKS)
    if quoted := re.match(r'"((?:[^"\\]|\\.)*)"', text):
        return re.sub(r"\\(.)", lambda escaped: "\n" if escaped[1] == "n" else escaped[1], quoted[1])
    return text.split("#", 1)[0].strip(BLANKS)


def read_parameters(path):
    """Values of a parameter file as a dictionary "Section/Name" -> text. Bytes that are not UTF-8 are
    preserved, because file names may contain them."""
    values, sections = {}, []
    for line in pathlib.Path(path).read_text(encoding="utf-8", errors="surrogateescape").split("\n"):
        line = line.strip(BLANKS)
        statement = line.split("#", 1)[0].strip(BLANKS)
        if match := re.fullmatch(r"subsection\s+(.+)", statement):
            sections.append(match[1])
        elif statement == "end":
            sections.pop()
        elif match := re.fullmatch(r"set\s+([^#]+?)\s*=(.*)", line):
            values["/".join([*sections, match[1]])] = read_value(match[2])
    return values
