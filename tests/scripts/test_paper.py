# SPDX-License-Identifier: GPL-3.0-or-later

"""scripts/paper.py on small tables; tests/program/test_paper.py runs the script."""

import csv
import json
import math
import pathlib
import sys
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
sys.path.insert(0, str(SCRIPTS))

import paper
from reproduction.runs import Results


class PaperTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def write(self, folder, name, columns, rows):
        (self.folder / folder).mkdir(exist_ok=True)
        with open(self.folder / folder / f"{name}.csv", "w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([columns, *rows])

    def results(self, folder, complex_modes, real_modes=(), component_modes=()):
        """Writes results of a run with one pin. Complex modes: (label, frequency [Hz], divergence rate [%], fraction of the
        wave that travels with the rotation [-] or None)."""
        self.write(folder, "complex_modes", ("label", "frequency [Hz]", "divergence rate [%]", "unstable [-]", "wave with rotation [-]",
                                             "wave against rotation [-]"),
                   [(label, frequency, rate, int(rate > 0), wave, wave and 1 - wave) for label, frequency, rate, wave in complex_modes])
        self.write(folder, "real_modes", ("label", "frequency [Hz]"), real_modes)
        self.write(folder, "component_modes", ("component", "contact", "label", "frequency [Hz]"), component_modes)
        self.write(folder, "sliding_pins", ("pin",), [("pin_top_1",)])
        (self.folder / folder / "run.json").write_text(json.dumps({}), encoding="utf-8")
        (self.folder / folder / "parameters.prm").write_text(
            "subsection Operation\n  set Friction coefficient = 0.4\n  set Radial dissipation = none\nend\n"
            "subsection Band\n  set Maximum frequency = 5000\nend\n", encoding="utf-8")
        return Results(self.folder / folder)


class TableOne(PaperTest):
    def row(self, label, without, damped):
        return next(row for row in paper.table_one(without, damped) if row["label"] == label)

    def test_growing_modes_are_compared_with_growing_ones(self):
        pair = [("A0-4 -", 2300, -0.6, None), ("A0-4 +", 2301, 0.7, None)]
        without, damped = self.results("without", pair), self.results("with", pair)
        row = self.row("A0-4 -", without, damped)
        self.assertEqual((row["mode without C_b"], row["divergence without C_b paper [%]"], row["divergence without C_b [%]"]), ("A0-4 -", -0.64, -0.6))
        self.assertEqual((row["mode with C_b"], row["divergence with C_b paper [%]"], row["divergence with C_b [%]"]), ("A0-4 +", 0.65, 0.7))
        self.assertEqual((row["coupled paper [Hz]"], row["coupled [Hz]"]), (2284, None))

    def test_measured_modes_are_those_of_the_file(self):
        with open(SCRIPTS.parent / "prm" / "table1_modes.csv", newline="", encoding="utf-8") as file:
            self.assertEqual([tuple(row) for row in csv.reader(file)], list(paper.measured_modes()))

    def test_modes_without_a_name_are_found_by_frequency(self):
        near, far = [("A0-0", 1100, 0, None)], [("A0-0", 1200, 0, None)]
        row = self.row("unnamed", self.results("without", near), self.results("with", far))
        self.assertEqual((row["mode without C_b"], row["without C_b [Hz]"]), ("A0-0", 1100))
        self.assertAlmostEqual(row["without C_b difference [%]"], 100 * (1100 / 1061 - 1))
        self.assertIsNone(row["with C_b [Hz]"])

    def test_groups_of_pin_modes(self):
        """24 F1 modes with divergence rates -12, -11, ... 11 %, sorted by magnitude."""
        modes = [("F1", 3600 + rate, rate, None) for rate in sorted(range(-12, 12), key=abs)]
        run = self.results("run", modes)
        for label, column, rate in (("F1 damped lowest", "with C_b", -12), ("F1 damped highest", "with C_b", -1),
                                    ("F1 pair 1 +", "with C_b", 11), ("F1 neutral highest", "with C_b", 10),
                                    ("F1 pair 2 -", "without C_b", -11), ("F1 highest", "without C_b", 9)):
            self.assertEqual(self.row(label, run, run)[f"divergence {column} [%]"], rate, label)
            self.assertEqual(self.row(label, run, run)[f"{column} [Hz]"], 3600 + rate, label)

    def test_all_that_the_paper_prints_is_read(self):
        cells = [cell for _, cells in paper.printed_rows() for cell in cells]
        self.assertEqual(len(cells), 4 * len(paper.TABLE_1.splitlines()))
        self.assertEqual(sum(cell is not None for cell in cells), sum(cell != "" for line in paper.TABLE_1.splitlines() for cell in line.split(",")[1:]))


class Statements(PaperTest):
    UNDAMPED = [("A0-4 -", 2300, -0.6, 0.1), ("A0-4 +", 2300, 0.6, 0.9), ("F1", 3503, -0.1, None), ("F1", 3503, 0.1, None)]
    DAMPED = [("A0-4 -", 2300, -0.62, 0.1), ("A0-4 +", 2300, 0.59, 0.9), ("F1", 3502, -1, None), ("F1", 3503, -0.02, None)]
    COUPLED = [("A0-4 -", 2290), ("A0-4 +", 2310), ("F1", 3500), ("F1", 3507)]

    def statements(self, expected, undamped=None, damped=None):
        """Checks number and verdict of statements, identified by their first words; None: no such statement."""
        without = self.results("without", undamped or self.UNDAMPED, self.COUPLED)
        rows = paper.statements(without, self.results("with", damped or self.DAMPED, self.COUPLED))
        for words, what in expected.items():
            found = next(((round(row["here"], 6), row["verdict"]) for row in rows if row["statement"].startswith(words)), None)
            self.assertEqual(found, what, words)

    def test_that_hold(self):
        self.statements({"unstable disc modes": (1, "does not hold"), "unstable modes have a stable partner": (0, "holds"),
                         "A0-4 + looks like a rotating wave": (0.9, "holds"), "its partner A0-4 -": (0.9, "holds"),
                         "further unstable modes": None, "C_b breaks the symmetry": (-0.03, "holds"),
                         "C_b reduces the divergence rate of the growing A0-4": (-0.01, "holds"),
                         "unstable modes with C_b": (1, "does not hold"), "coupling spreads the bending modes": (0.2, "holds"),
                         "complex modes have nearly the frequencies of the real coupled ones, without C_b": (0.436681, "holds"),
                         "friction hardly shifts": None})

    def test_that_hold_less_or_not(self):
        self.statements({"unstable modes have a stable partner": (round(math.hypot(0.05, 2260 / 2300 - 1), 6), "holds in part"),
                         "its partner A0-4 -": (0.55, "does not hold"),
                         "unstable disc modes": (1, "does not hold"), "further unstable modes": (1, "holds in part"),
                         "complex modes have nearly the frequencies of the real coupled ones, without C_b": (1.310044, "holds in part"),
                         "C_b reduces the divergence rate of the growing A0-4": (0.03, "does not hold")},
                        [("A0-4 -", 2260, -0.57, 0.45), *self.UNDAMPED[1:], ("R0-1 -", 690, -0.003, None), ("R0-1 +", 690, 0.003, None)],
                        [self.DAMPED[0], ("A0-4 +", 2300, 0.63, 0.9), *self.DAMPED[2:]])


class Readings(PaperTest):
    def test_modes_side_by_side(self):
        one = self.results("one", [("A0-4 -", 2300, -0.6, None), ("A0-4 +", 2300, 0.6, None), *(("T1", 3900, rate, None) for rate in (0, -2, -1))])
        other = self.results("other", [("A0-4 -", 2301, -0.7, None), *(("T1", 3900, rate, None) for rate in (-4, -5, -3))])
        rows = [tuple(row.values()) for row in paper.readings({"one": one, "other": other})]
        self.assertEqual(rows, [("A0-4 -", "A0-4 +", -0.67, -0.6, -0.7), ("A0-4 +", "A0-4 -", 0.65, 0.6, None), ("T1", "T1 lowest", -2.34, -2, -5),
                                ("T1", None, None, -1, -4), ("T1", "T1 highest", -1.41, 0, -3)])


if __name__ == "__main__":
    unittest.main()
