# SPDX-License-Identifier: GPL-3.0-or-later

"""Renders the Unicode formulas of the pages in the site: K_c as K with a subscript, e^(λt) with a superscript.

MkDocs calls on_page_content() with the HTML of each page; code, commands and file names are unchanged.
"""

import re

PARTS = re.compile(r"(<pre.*?</pre>|<code.*?</code>|<[^>]+>)", re.DOTALL)
SUBSCRIPT = re.compile(r"((?<![A-Za-z0-9_])[A-Za-zÀ-žα-ωΑ-Ω][\u0300-\u036f]*|\))_([A-Za-z0-9]{1,4})(?![A-Za-z0-9_])")
SUPERSCRIPT = re.compile(r"\^(?:\(([^()]+)\)|\{([^{}]+)\}|([A-Z]\b))")
IS_FORMULA = re.compile(r"[αβγδελμξπρσφψωΦΨΩΣ∫√‖ᵀᴴ½⁻·−×≤]")
IS_COMMAND = re.compile(r"scripts/|build/|--set|^\s*set |squeal", re.MULTILINE)


def rendered(text):
    """The text with its subscripts and superscripts as HTML."""
    text = SUPERSCRIPT.sub(lambda match: f"<sup>{next(group for group in match.groups() if group)}</sup>", text)
    return SUBSCRIPT.sub(r"\1<sub>\2</sub>", text)


def rendered_part(part):
    if part.startswith("<pre"):
        if not IS_FORMULA.search(part) or IS_COMMAND.search(part):
            return part
        return "".join(piece if piece.startswith("<") else rendered(piece) for piece in re.split(r"(<[^>]+>)", part))
    return part if part.startswith("<") else rendered(part)


def on_page_content(html, **_):
    return "".join(map(rendered_part, PARTS.split(html)))
