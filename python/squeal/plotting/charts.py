# SPDX-License-Identifier: GPL-3.0-or-later

"""Branches and thresholds of a sweep, by default over the friction coefficient. `mu` is the swept parameter."""

import dataclasses
import re

NO_LABEL = "unnamed"  # label of modes that do not resemble a component mode
WITHOUT, WITH = "without radial dissipation", "with radial dissipation"


@dataclasses.dataclass
class Mode:
    """A mode with frequency [Hz] and divergence rate [%], which are None if the branch has no mode at this point."""

    label: str
    frequency: float
    divergence: float
    grows: bool
    is_undecided: bool
    mu: float = None

    @property
    def is_shown(self):
        return self.frequency is not None


@dataclasses.dataclass
class Threshold:
    """A point at which a branch begins or ceases to grow; its divergence rate there is zero."""

    mu: float
    event: str
    branch: int
    partner: int  # None: no other branch is involved
    frequency: float


class Chart:
    """Modes of the band at all values of the swept parameter, with one contact set.

    `mus`: all values in ascending order; `modes[branch][mu]`: a mode; `labels[branch]`: the label of a branch.
    """

    def __init__(self, title, branches, thresholds, counts, band_end):
        self.title = title
        self.parameter = counts.parameter
        self.mus = counts.numbers(self.parameter)
        self.labels, self.modes = {}, {}
        columns = (branches.numbers("branch [-]"), branches.numbers(self.parameter), branches.texts("label"), branches.numbers("frequency [Hz]"),
                   branches.numbers("divergence rate [%]"), branches.flags("growing [-]"), branches.texts("verdict"))
        for branch, mu, label, frequency, divergence, grows, verdict in zip(*columns):
            self.labels[int(branch)] = label
            mode = Mode(label, frequency, divergence, grows, verdict == "undecided", mu)
            self.modes.setdefault(int(branch), {})[mu] = mode
        columns = (thresholds.numbers(self.parameter), thresholds.texts("event"), thresholds.numbers("branch [-]"),
                   thresholds.texts("partner [-]"), thresholds.numbers("frequency [Hz]"))
        self.thresholds = [Threshold(mu, event, int(branch), int(partner) if partner else None, frequency)
                           for mu, event, branch, partner, frequency in zip(*columns) if frequency <= band_end]

    def curve(self, branch):
        """Modes of a branch at all values of the chart and at the thresholds of the branch."""
        points = [Mode("", event.frequency, 0.0, False, False, event.mu) for event in self.thresholds
                  if branch in (event.branch, event.partner) and event.mu <= self.mus[-1]]
        points += [self.modes[branch].get(mu, Mode("", None, None, False, False, mu)) for mu in self.mus]
        return sorted(points, key=lambda point: point.mu)

    def grows_somewhere(self, branch):
        return any(mode.grows for mode in self.modes[branch].values())

    def modes_at(self, mu):
        return [modes[mu] for modes in self.modes.values() if mu in modes]


def family(label):
    """Label of a branch without the doublet sign: `A0-4` for `A0-4 -`."""
    return label[:-2] if len(label) > 2 and label[-2:] in (" -", " +") else label


def read_charts(results):
    """Charts of a sweep, first those without radial dissipation; one chart for each interval with a constant contact
    set."""
    band_end = results.number("Band/Maximum frequency")
    is_damped = results.parameter("Operation/Radial dissipation") != "none"
    charts = []
    for name in results.names():
        if match := re.fullmatch(r"branches((_without_dissipation)?(?:_(\d+))?)", name):
            suffix, is_bare, stretch = match[1], bool(match[2]) or not is_damped, int(match[3] or 1)
            tables = [results.table(table + suffix) for table in ("branches", "thresholds", "counts")]
            charts.append(((not is_bare, stretch), Chart(WITHOUT if is_bare else WITH, *tables, band_end)))
    return [chart for _, chart in sorted(charts, key=lambda entry: entry[0])]
