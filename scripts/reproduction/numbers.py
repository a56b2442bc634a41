# SPDX-License-Identifier: GPL-3.0-or-later

"""Numbers as the pages print them, beside what is found."""

import dataclasses

ENTRIES = {}


@dataclasses.dataclass
class Number:
    """A number as the page prints it, such as "0.680", "6.2e-7" or "24", and what was found.

    With `bound` the page says that it is at most so much.
    """

    what: str
    quoted: str
    found: float
    bound: bool = False

    def printed(self):
        """What was found with as many digits as the page prints."""
        mantissa, _, exponent = self.quoted.lower().partition("e")
        digits = len(mantissa.partition(".")[2])
        return f"{self.found:.{digits}e}" if exponent else f"{self.found:.{digits}f}"

    def agrees(self):
        """Whether the page is right to the digits that it prints."""
        if self.bound:
            return self.found <= float(self.quoted)
        return float(self.printed()) == float(self.quoted)

    def __str__(self):
        relation = "at most " if self.bound else ""
        return f"    {self.what:<64} {relation + self.quoted:>16}   found {self.printed():>12}{'' if self.agrees() else '   <- differs'}"


def entry(page, sentence):
    """Registers a function that yields the numbers of a sentence of a page."""
    def register(function):
        ENTRIES.setdefault(page, []).append((sentence, function))
        return function
    return register


def of_mode(name, mode, frequency=None, rate=None):
    """Frequency and divergence rate of a mode, of which the page may say one only."""
    for unit, quoted, column in (("Hz", frequency, "frequency [Hz]"), ("%", rate, "divergence rate [%]")):
        if quoted is not None:
            yield Number(f"{name} [{unit}]", quoted, mode[column])


def several(prefix, names, quoted, found):
    """A number for each name."""
    return map(Number, (f"{prefix}{name}" for name in names), quoted, found)
