#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Compares the default model with D. Brizard, O. Chiello, J.-J. Sinou, X. Lorang, J. Sound Vib. 330 (2011) 703.

    scripts/paper.py [--results DIR] [--set "Section/Name=value"]...
    scripts/paper.py --measured-modes FILE

Runs squeal without radial dissipation (C_b) and with each form of it, unless DIR (results/paper) contains up-to-date results, prints the
comparison, and writes to DIR:

    table1.csv       Table 1: component, coupled and complex modes without and with C_b, of the paper and of squeal
    statements.csv   section 4: the numbers of the paper and of squeal, and whether the statement holds by the rule in the row
    dissipation.csv  divergence rates of all modes with each form of C_b
    figure6.svg      divergence rate versus frequency without and with C_b; requires python3-matplotlib

"With C_b" means consistent dissipation about steady sliding, the form closest to the paper. The second command only
writes the labelled component and coupled modes of Table 1 as measured modes for Study = updating.
"""

import csv
import dataclasses
import math
import pathlib
import re
import sys

from reproduction.runs import SOURCE, Runs
from squeal.command_line import Parser, exit_on_error

NEGLIGIBLE = 0.01  # divergence rate [%] below which a mode counts as neutral
FIXED = "Study", "Band/", "Operation/Radial dissipation", "Steady sliding/Contact state", "Output/"
NO_SHAPES, PUBLISHED = "Output/Mode shapes=none", "Operation/Radial dissipation=published"
WITHOUT, WITH = "no C_b", "steady sliding consistent"
READINGS = {  # form of C_b -> arguments of the run
    WITHOUT: ("default", "disc_pins.prm", NO_SHAPES), "equal load consistent": ("dissipation", "dissipation.prm", NO_SHAPES),
    "equal load published": ("dissipation_published", "dissipation.prm", NO_SHAPES, PUBLISHED), WITH: ("sliding", "sliding.prm", NO_SHAPES),
    "steady sliding published": ("sliding_published", "sliding.prm", NO_SHAPES, PUBLISHED)}

# The paper's Table 1: label, component, coupled, complex without and with C_b. A cell is [HOW] FREQUENCY [DIVERGENCE RATE], in Hz and %.
# HOW selects the computed mode. Default: the mode with the label of the row. + and -: the growing mode and the other mode of this shape
# (in the paper, A0-4 - grows with C_b). ~: the mode with the nearest frequency, if its label is unclear. A slice selects pin modes of this
# shape ordered by divergence rate; a row `highest` compares their largest frequency and rate, other rows the smallest. The 12 of 24 F1
# modes that bend radially have the most damping. The component frequency of F1, printed as 3353 Hz, is read as 3553 Hz.
TABLE_1 = """\
A0-1 -,251,295,295,296
A0-1 +,251,~ 312,~ 312,~ 313
A0-0,352,,,
A0-2 -,569,489,489,489
A0-2 +,569,697,700,700
C0-0,644,644,645,644
R0-1 -,649,643,644,644
R0-1 +,649,647,648,648 -0.093
unnamed,,~ 1057,~ 1061,~ 1061
A0-3 -,1267,1374,1379,1379
A0-3 +,1267,1567,1576,1576
A1-0,1404,1449,1450,1450
R0-2 -,1822,1823,1823,1823
R0-2 +,1822,1825,1826,1826
A1-1 -,2082,2087,2087,2087
A1-1 +,2082,2150,2153,2153
A0-4 -,2220,2284,- 2297 -0.64,+ 2297 0.65
A0-4 +,2220,2305,+ 2297 0.64,- 2297 -0.67
A0-5 -,3345,3380,- 3376 -0.98,- 3376 -1.02
A0-5 +,3345,3392,+ 3376 0.98,+ 3377 0.95
A1-2 -,3365,3350,3352,3352
A1-2 +,3365,3371,3386,3387 -0.078
F1 lowest,: 3553,: 3551,2:-2 3516,
F1 highest,: 3553,: 3562,2:-2 3564,
F1 pair 1 -,,,:1 3542 -0.89,12:13 3535 -0.51
F1 pair 1 +,,,-1: 3542 0.89,-1: 3537 0.88
F1 pair 2 -,,,1:2 3550 -0.10,
F1 pair 2 +,,,-2:-1 3550 0.10,
F1 next damped,,,,13:14 3521 -0.12
F1 neutral lowest,,,,14:-1 3525
F1 neutral highest,,,,14:-1 3528
F1 damped lowest,,,,:12 3552 -1.76
F1 damped highest,,,,:12 3563 -1.07
R0-0,3704,3704,3704,3704
T1 lowest,: 3934,: 3934,: 3934,: 3933 -2.34
T1 highest,: 3934,: 3934,: 3934,: 3933 -1.41
R0-3 -,3990,3989,3989,3989
R0-3 +,3990,3991,3989,3990
C0-1 -,4500,4499,4499,4499
C0-1 +,4500,4500,4500,4500
A0-6 -,4659,4641,4641,4641
A0-6 +,4659,4653,4652,4652
A1-3 -,4794,4800,4799,4800
A1-3 +,4794,4815,4814,4815
"""
COLUMNS = ("component", "coupled", "without C_b", "with C_b")


@dataclasses.dataclass
class Mode:
    label: str
    frequency: float  # frequency [Hz]
    rate: float = 0.0  # divergence rate [%]
    unstable: bool = False
    wave: tuple = (None, None)  # shares of the waves with and against the rotation

    @property
    def shape(self):
        return re.sub(" [-+]$", "", self.label)

    @property
    def grows(self):
        return self.unstable and self.rate >= NEGLIGIBLE

    def __str__(self):
        return f"{self.label} {self.frequency:.4g} Hz"


def modes_of(results, table):
    """Modes in a table of a run by frequency; component modes only of the free disc and of sliding pins."""
    return [Mode(row["label"], row["frequency [Hz]"], row.get("divergence rate [%]", 0.0), row.get("unstable [-]") == 1,
                 (row.get("wave with rotation [-]"), row.get("wave against rotation [-]"))) for row in results.rows(table)
            if (row.get("component"), row.get("contact")) in ((None, None), ("disc", "free"), ("pins", "sliding"))]


def modes_to_compare(without, damped):
    """Lists of modes to compare, one for each of COLUMNS."""
    return *(modes_of(without, f"{kind}_modes") for kind in ("component", "real", "complex")), modes_of(damped, "complex_modes")


@dataclasses.dataclass
class Printed:
    """A cell of Table 1 of the paper."""
    how: str
    frequency: float
    rate: float

    def places(self, n):
        """Indices of the modes that the cell selects among n modes of a shape ordered by divergence rate."""
        return range(n)[slice(*(int(end) if end else None for end in self.how.split(":")))]

    def find(self, label, modes):
        """The corresponding mode of a run, or None."""
        if ":" in self.how:
            family = sorted((mode for mode in modes if mode.shape == label.split()[0]), key=lambda mode: mode.rate)
            group = [family[place] for place in self.places(len(family))]
            end = max if label.endswith("highest") else min
            return Mode(label.split()[0], end(mode.frequency for mode in group), end(mode.rate for mode in group)) if group else None
        if self.how == "~":
            nearest = min(modes, key=lambda mode: abs(mode.frequency / self.frequency - 1), default=None)
            return nearest if nearest and abs(nearest.frequency / self.frequency - 1) < 0.1 else None
        name = f"{label.split()[0]} {self.how}" if self.how else label
        return next((mode for mode in modes if mode.label == name), None)


def printed_rows():
    """Labels with the printed cells of COLUMNS; None for empty cells."""
    pattern = re.compile(r"(?:([~+-]|-?\d*:-?\d*) )?(\d+)(?: (-?[\d.]+))?")
    for line in TABLE_1.splitlines():
        label, *cells = line.split(",")
        matches = [pattern.fullmatch(cell) for cell in cells]
        yield label, [match and Printed(match[1] or "", float(match[2]), match[3] and float(match[3])) for match in matches]


def measured_modes():
    """Rows of a file for Study = updating: the labelled component and coupled modes of Table 1."""
    yield "state", "label", "member", "frequency [Hz]"
    for state, column in (("component", 0), ("coupled", 1)):
        for label, cells in printed_rows():
            if (printed := cells[column]) and printed.how != "~":
                family, _, member = label.partition(" ") if ":" in printed.how else (label, "", "")
                yield state, family, member, f"{printed.frequency:g}"


def table_one(without, damped):
    """Rows of Table 1 with the modes of runs without and with C_b; None if the paper prints no number or the run has no
    such mode."""
    found = modes_to_compare(without, damped)
    for label, cells in printed_rows():
        row = {"label": label}
        for name, printed, modes in zip(COLUMNS, cells, found):
            here = printed and printed.find(label, modes)
            if name.endswith("C_b"):
                row[f"mode {name}"] = here and here.label
            row[f"{name} paper [Hz]"] = printed and printed.frequency
            row[f"{name} [Hz]"] = here and here.frequency
            row[f"{name} difference [%]"] = here and 100 * (here.frequency / printed.frequency - 1)
            if name.endswith("C_b"):
                row[f"divergence {name} paper [%]"] = printed and printed.rate
                row[f"divergence {name} [%]"] = here and here.rate
        yield row


def agreement(rows, name):
    """Root mean square of the differences of a column of Table 1 [%], their number, the largest difference [%] and its
    row."""
    differences = {row["label"]: row[f"{name} difference [%]"] for row in rows if row[f"{name} difference [%]"] is not None}
    rms = math.sqrt(sum(value**2 for value in differences.values()) / len(differences))
    largest = max(differences, key=lambda label: abs(differences[label]))
    return rms, len(differences), differences[largest], largest


def ruling(rule, holds, less=False):
    return ("holds" if holds else "holds in part" if less else "does not hold"), rule


def at_most(value, bound, weaker):
    return ruling(f"holds up to {bound:.4g}, in part up to {weaker:g}", value <= bound, value <= weaker)


def alike(value, paper):
    return ruling("holds from half to twice the number in the paper, in part if the signs agree", 0.5 <= value / paper <= 2, value / paper > 0)


def as_many(modes, paper):
    return ruling("holds if equal, in part if there are more", modes == paper, modes > paper)


def change(before, after):
    return 100 * (after / before - 1)


def by_shape(modes):
    return {shape: [mode for mode in modes if mode.shape == shape] for shape in dict.fromkeys(mode.shape for mode in modes)}


def largest_shift(before, after, pattern):
    """Largest change in a frequency [%] and its mode, for shapes that match a pattern in both lists, as a list
    with at most one pair."""
    former = by_shape(before)
    shifts = [(abs(change(one.frequency, other.frequency)), one) for shape, modes in by_shape(after).items()
              if re.match(pattern, shape) and len(former.get(shape, [])) == len(modes) for one, other in zip(former[shape], modes)]
    return sorted(shifts, key=lambda shift: -shift[0])[:1]


def of_frequencies(component, coupled, undamped, damped, n_pins):
    """Statements on frequencies as tuples: section, words, number in the paper, computed number, unit, (verdict, rule),
    modes."""
    for name, paper in (("bending modes F1", 2), ("torsional modes T1", 1)):
        n = sum(mode.label == name.split()[-1] for mode in component) / n_pins
        yield "4.1", f"{name} per pin below 5 kHz", paper, n, "-", as_many(n, paper)
    spreads = {shape: change(modes[0].frequency, modes[-1].frequency) for shape, modes in by_shape(coupled).items()
               if len(modes) == 2 or shape == "F1"}
    for words, paper, pattern, rule in (
            ("splits double disc modes, axial ones most", change(489, 697), r"A\d-([2-9]|\d\d)", alike),
            ("spreads the bending modes of the pins", change(3551, 3562), "F1", alike),
            ("hardly splits in-plane disc modes", change(643, 647), r"[RC]\d", lambda value, paper: at_most(value, paper, 1))):
        for shape in sorted((shape for shape in spreads if re.match(pattern, shape)), key=lambda shape: -spreads[shape])[:1]:
            yield "4.2", f"coupling {words}", paper, spreads[shape], "%", rule(spreads[shape], paper), shape
    near, hardly = "complex modes have nearly the frequencies of the real coupled ones,", "hardly shifts in-plane disc modes and torsion of pins"
    for section, words, paper, bounds, before, after, pattern in (
            ("4.2", f"coupling {hardly}", -change(649, 643), (-change(649, 643), 2), component, coupled, r"[RCT]\d"),
            ("4.3", f"{near} without C_b", -change(3551, 3516), (1, 2), coupled, undamped, "[^u]"),
            ("4.3", f"{near} with C_b", -change(3551, 3521), (1, 2), coupled, damped, "[^u]"),
            ("Table 1", f"friction {hardly}", change(644, 645), (change(644, 645), 0.5), coupled, undamped, r"[RCT]\d")):
        for shift, mode in largest_shift(before, after, pattern):
            yield section, words, paper, shift, "%", at_most(shift, *bounds), mode


def of_growth(undamped):
    unstable, others = [mode for mode in undamped if mode.unstable], [mode for mode in undamped if not mode.unstable]
    for words, paper, modes in (
            ("unstable disc modes without C_b", 2, [mode for mode in unstable if mode.grows and mode.label[0] not in "FTL"]),
            ("unstable pin modes without C_b", 2, [mode for mode in unstable if mode.grows and mode.label[0] in "FTL"]),
            ("further unstable modes without C_b, below 0.01 %", 0, [mode for mode in unstable if not mode.grows])):
        if modes or paper:
            yield "4.3", words, paper, len(modes), "-", as_many(len(modes), paper), *modes
    rests = [(min((math.hypot(other.rate / mode.rate + 1, other.frequency / mode.frequency - 1) for other in others), default=1.0), mode)
             for mode in unstable]
    for rest, mode in sorted(rests, key=lambda pair: -pair[0])[:1]:
        yield ("4.3", "unstable modes have a stable partner with the opposite divergence rate: largest relative deviation", 0, rest, "-",
               at_most(rest, 1e-3, 0.1), mode)
    for mode in unstable:
        if mode.grows and None not in mode.wave:
            direction = int(mode.wave[0] <= mode.wave[1])
            partner = next((other for other in others if other.label == f"{mode.shape} -"), None)
            words = f"{mode.label} looks like a rotating wave: share that travels {('with', 'against')[direction]} the rotation"
            waves = [(mode, mode.wave[direction], words)]
            if partner:
                waves.append((partner, partner.wave[1 - direction], f"its partner {partner.label} rotates in the opposite sense: share"))
            for one, share, words in waves:
                yield "4.3", words, None, share, "-", ruling("holds from 0.75, in part from 0.6", share >= 0.75, share >= 0.6), one


def of_dissipation(undamped, damped):
    before, after = ({mode.label: mode for mode in modes} for modes in (undamped, damped))
    for shape, paper_sum, paper_change in (("A0-4", -0.02, 0.01), ("A0-5", -0.07, -0.03)):
        if all(f"{shape} {sign}" in modes for sign in "-+" for modes in (before, after)):
            minus, plus = after[f"{shape} -"], after[f"{shape} +"]
            for words, paper, here, modes in (
                    (f"breaks the symmetry of the chart: sum of the divergence rates of {shape}", paper_sum, minus.rate + plus.rate, (minus, plus)),
                    (f"reduces the divergence rate of the growing {shape}", paper_change, plus.rate - before[plus.label].rate, (plus,))):
                yield "4.3", f"C_b {words}", paper, here, "%", ruling("holds below zero", here < 0), *modes
    former, bending, torsion = (sorted(mode.rate for mode in modes if mode.shape == shape)
                                for modes, shape in ((undamped, "F1"), (damped, "F1"), (damped, "T1")))
    if former and bending:
        gain = bending[-1] - former[-1]
        yield "4.3", "C_b reduces the divergence rate of the leading F1", -0.01, gain, "%", ruling("holds below zero", gain < 0)
    if len(bending) > 3 and len(former) == len(bending):
        yield ("4.3", "C_b stabilises the second unstable pin mode: second largest divergence rate of the F1 modes", 0, bending[-2], "%",
               ruling("holds below 0.01 %, in part if the rate decreases", bending[-2] < NEGLIGIBLE, bending[-2] < former[-2]),
               f"without C_b {former[-2]:.3g} %")
    for words, rates, place, paper in (
            ("F1, most damped", bending, 0, -1.76), ("F1, least damped of the lower half", bending, (len(bending) - 1) // 2, -1.07),
            ("T1, most damped", torsion, 0, -2.34), ("T1, least damped", torsion, -1, -1.41)):
        if rates:
            here = rates[place]
            yield "4.3", f"many pin modes turn to highly negative divergence rates: {words}", paper, here, "%", alike(here, paper)
    growing = [mode for mode in damped if mode.grows]
    yield "4.3", "unstable modes with C_b", 3, len(growing), "-", as_many(len(growing), 3), *growing


def statements(without, damped):
    """Statements in section 4 of the paper, except statements on modes that are missing in the runs."""
    modes = modes_to_compare(without, damped)
    found = (*of_frequencies(*modes, len(damped.rows("sliding_pins"))), *of_growth(modes[2]), *of_dissipation(*modes[2:]))
    return [{"section": section, "statement": words, "paper": paper, "here": here, "unit": unit, "verdict": verdict, "rule": rule,
             "modes": "; ".join(map(str, modes))} for section, words, paper, here, unit, (verdict, rule), *modes in found]


def printed_rate(label, shape, place, n):
    """Label and divergence rate [%] printed in the paper with C_b for the mode at position `place` among n modes of its
    shape."""
    for row, cells in printed_rows():
        printed = cells[-1]
        if printed and printed.rate is not None and row.split()[0] == shape:
            places = printed.places(n) if ":" in printed.how else ()
            if place in places[-1:] if row.endswith("highest") else place in places[:1]:
                return row, printed.rate
            if not places and label == (f"{shape} {printed.how}" if printed.how else row):
                return row, printed.rate
    return None, None


def readings(solutions):
    """Divergence rates of all modes with each form of C_b; members of doublets are matched by sign, pin modes by order
    of the divergence rate."""
    families = {reading: by_shape(modes_of(results, "complex_modes")) for reading, results in solutions.items()}
    for shape in dict.fromkeys(shape for family in families.values() for shape in family):
        n = max(len(family.get(shape, [])) for family in families.values())
        for place in range(n):
            label = shape if n != 2 else f"{shape} {'-+'[place]}"
            paper_label, paper = printed_rate(label, shape, place, n)
            row = {"label": label, "label in the paper": paper_label, "paper with C_b [%]": paper}
            for reading, family in families.items():
                modes = sorted(family.get(shape, []), key=lambda mode: mode.label.endswith("+") if n <= 2 else mode.rate)
                row[f"{reading} [%]"] = modes[place].rate if place < len(modes) else None
            yield row


def write(folder, name, rows):
    with open(folder / f"{name}.csv", "w", newline="", encoding="utf-8") as file:
        cells = ([f"{cell:.12g}" if isinstance(cell, float) else cell for cell in row.values()] for row in rows)
        csv.writer(file).writerows([rows[0], *cells])


def show(title, rows, columns):
    """Prints columns of rows. A column is (heading, name, digits); digits is None for text."""
    texts = [[heading for heading, _, _ in columns]]
    for row in rows:
        texts.append(["" if row[name] is None else str(row[name]) if digits is None else f"{row[name]:.{digits}f}" for _, name, digits in columns])
    widths = [max(map(len, column)) for column in zip(*texts)]
    print(f"\n{title}\n")
    for text in texts:
        cells = zip(text, widths, columns)
        print("  ".join(cell.ljust(width) if digits is None else cell.rjust(width) for cell, width, (_, _, digits) in cells).rstrip())


def draw(folder, without, damped):
    """Draws figure 6 of the paper if matplotlib is installed."""
    try:
        from squeal.plotting import complex_plane
        from squeal.plotting.draw import render
        figure = complex_plane.paper_figure(without, damped)
        (folder / "figure6.svg").write_bytes(render(figure, "svg"))
    except ModuleNotFoundError as missing:
        print(f"No figure6.svg: {missing.name} is missing; install python3-matplotlib.", file=sys.stderr)


def compare(folder, settings):
    solutions = {reading: Runs(folder)(*how, *settings) for reading, how in READINGS.items()}
    without, damped = solutions[WITHOUT], solutions[WITH]
    table, section, rates = list(table_one(without, damped)), statements(without, damped), list(readings(solutions))
    write(folder, "table1", table)
    write(folder, "statements", section)
    write(folder, "dissipation", rates)
    draw(folder, without, damped)
    columns = [("label", "label", None)]
    for name in COLUMNS:
        columns += [("paper", f"{name} paper [Hz]", 0), (name, f"{name} [Hz]", 1)]
        if name.endswith("C_b"):
            columns += [("paper", f"divergence {name} paper [%]", 3), ("xi", f"divergence {name} [%]", 3)]
    show("Table 1: frequencies [Hz] and divergence rates xi [%]", table, columns)
    print()
    for name in COLUMNS:
        rms, n, largest, label = agreement(table, name)
        print(f"{name}: difference of {n} frequencies {rms:.3f} % rms, largest {largest:+.2f} % ({label})")
    show("Section 4", section, [("section", "section", None), ("statement", "statement", None), ("paper", "paper", 2), ("here", "here", 3),
                                ("unit", "unit", None), ("verdict", "verdict", None)])
    show("Divergence rates [%] with each form of C_b, for modes whose rate the paper prints",
         [row for row in rates if row["paper with C_b [%]"] is not None],
         [("label", "label", None), ("in the paper", "label in the paper", None), ("paper", "paper with C_b [%]", 3),
           *((reading, f"{reading} [%]", 3) for reading in READINGS)])
    print(f"\nresults in {folder}")


@exit_on_error()
def main():
    parser = Parser(__doc__)
    parser.add_argument("--results", metavar="DIR", type=pathlib.Path, default=SOURCE / "results" / "paper")
    parser.add_argument("--set", action="append", default=[], dest="settings", metavar="Section/Name=value",
                        help="override for every run, such as another mesh")
    parser.add_argument("--measured-modes", metavar="FILE", type=pathlib.Path, help="only write this file for Study = updating")
    arguments = parser.parse_args()
    if arguments.measured_modes:
        with open(arguments.measured_modes, "w", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerows(measured_modes())
        return
    if fixed := [setting for setting in arguments.settings if setting.startswith(FIXED)]:
        parser.error(f"--set {fixed[0]}: the comparison sets {', '.join(FIXED)}; omit it")
    compare(arguments.results, arguments.settings)


if __name__ == "__main__":
    main()
