# SPDX-License-Identifier: GPL-3.0-or-later

"""Numbers as printed in the documentation, compared with computed numbers."""

import dataclasses
import itertools
import re

from squeal.program import SOURCE

ENTRIES = {}


@dataclasses.dataclass
class Number:
    """A number as printed in a page, such as "0.680", "6.2e-7" or "24", and the computed number; with `bound`, the
    printed number is an upper bound."""

    what: str
    quoted: str
    found: float
    bound: bool = False

    def printed(self):
        """The computed number, with the number of digits in the page."""
        mantissa, _, exponent = self.quoted.lower().partition("e")
        digits = len(mantissa.partition(".")[2])
        return f"{self.found:.{digits}e}" if exponent else f"{self.found:.{digits}f}"

    def agrees(self):
        """True if the printed digits agree or, for a bound, if it is met."""
        if self.bound:
            return self.found <= float(self.quoted)
        return float(self.printed()) == float(self.quoted)

    def __str__(self):
        relation = "at most " if self.bound else ""
        return f"    {self.what:<64} {relation + self.quoted:>16}   found {self.printed():>12}{'' if self.agrees() else '   <- differs'}"


def entry(page, sentence):
    """Decorator that registers a function, which yields the numbers of a statement of a page."""
    def register(function):
        ENTRIES.setdefault(page, []).append((sentence, function))
        return function
    return register


def of_mode(name, mode, frequency=None, rate=None):
    """Numbers for frequency and divergence rate of a mode, except values that the page does not quote (None)."""
    for unit, quoted, column in (("Hz", frequency, "frequency [Hz]"), ("%", rate, "divergence rate [%]")):
        if quoted is not None:
            yield Number(f"{name} [{unit}]", quoted, mode[column])


def several(prefix, names, quoted, found):
    """A Number for each name."""
    return map(Number, (f"{prefix}{name}" for name in names), quoted, found)


def table(page, head):
    """Rows of cells of the table in doc/PAGE.md whose header contains `head`, without bold type, code and plus signs.
    """
    text = re.sub(r"[*`]|\+(?=\d)", "", (SOURCE / "doc" / f"{page}.md").read_text(encoding="utf-8")).replace("−", "-")
    lines = itertools.dropwhile(lambda line: not (line.startswith("|") and head in line), text.splitlines())
    rows = itertools.takewhile(lambda line: line.startswith("|"), itertools.islice(lines, 2, None))
    return [[cell.strip() for cell in re.split(r"(?<!\\)\|", row)[1:-1]] for row in rows]


def numbers_in(*cells):
    """The numbers in cells of a table, as printed."""
    return [number for cell in cells for number in re.findall(r"-?\d+(?:\.\d+)?(?:e-\d+)?", cell)]
