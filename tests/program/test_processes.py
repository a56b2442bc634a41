# SPDX-License-Identifier: GPL-3.0-or-later

"""Runs on several processes agree with runs on one: solvers, steady sliding, damping, and a sweep.

These tests are separate because they need free cores: MPI processes on shared cores wait for each other.
"""

import json

from program import COARSE, ProgramTest, eigenvalues, read_table, real_frequencies
from test_sliding import LOAD, SINGLE, STEADY, ContactFaces, SlidingTest, pins
from test_solvers import DISSIPATION, RESIDUAL_ITERATION
from test_sweep import DEFAULT_ACCURACY, MAP, SweepTest, by_mu, eigenvalue, grid_of, modes_by_mu, thresholds
from squeal.vtu_file import VtuFile

UNSTABLE_SHAPES = "Output/Mode shapes=unstable"
COMPONENT_SHAPES = "Output/Component mode shapes=true"


def cells_of(file):
    """Body and corners [um] of each cell, in sorted order."""
    return sorted((body, *(tuple(round(1e6 * x) for x in point) for point in (file.points[corner] for corner in file.cells[cell])))
                  for cell, body in enumerate(file.cell_fields["component"]))


class Solvers(ProgramTest):
    scene = COARSE

    def test_modes(self):
        for name, overrides in {"Krylov": [], "quadratic": ["Discretization/Element=quadratic"], "residual iteration": RESIDUAL_ITERATION,
                                "residual iteration, dissipation": [DISSIPATION, *RESIDUAL_ITERATION]}.items():
            one = self.run_scene("one", UNSTABLE_SHAPES, COMPONENT_SHAPES, *overrides)
            # Three processes execute the same code as two; four execute additional code
            for n_processes in {"Krylov": (2, 4), "residual iteration, dissipation": (3,)}.get(name, (2,)):
                with self.subTest(name, n_processes=n_processes):
                    several = self.run_scene("several", UNSTABLE_SHAPES, COMPONENT_SHAPES, *overrides, n_processes=n_processes)
                    self.assert_same_eigenvalues(eigenvalues(several), eigenvalues(one))
                    self.assert_same_eigenvalues(real_frequencies(several), real_frequencies(one))
                    fields, others = (sorted(path.name for path in (folder / "modes").iterdir()) for folder in (one, several))
                    self.assertEqual(others, fields)
                    # A process may own no cell of a component
                    for kind in ("component_disc_", "component_pins_sliding_", "complex_"):
                        file = next(file for file in fields if file.startswith(kind))
                        alone, pieces = (VtuFile(folder / "modes" / file) for folder in (one, several))
                        self.assertEqual(cells_of(pieces), cells_of(alone), file)
                        self.assertLessEqual(pieces.n_pieces, n_processes)
                    record = json.loads((several / "run.json").read_text(encoding="utf-8"))
                    self.assertEqual(record["machine"]["processes"], n_processes)


class Sliding(SlidingTest):
    def test_state(self):
        one, two = (self.run_scene(f"state_{n}", STEADY, DISSIPATION, UNSTABLE_SHAPES, n_processes=n) for n in (1, 2))
        self.assert_checked(two)
        actual = pins(two)
        for name, pin in pins(one).items():
            for column, value in pin.items():
                with self.subTest(name, column=column):
                    self.assertAlmostEqual(actual[name][column], value, delta=1e-8 * abs(value))
        self.assert_same_eigenvalues(eigenvalues(two), eigenvalues(one), 1e-8)
        for (_, fields), (_, other) in zip(ContactFaces(one / "sliding_state_contact.vtu").all(),
                                           ContactFaces(two / "sliding_state_contact.vtu").all(), strict=True):
            self.assertAlmostEqual(fields["normal_reaction"], other["normal_reaction"], delta=SINGLE * LOAD)


class Sweep(SweepTest):
    scene = COARSE

    def test_branches_and_thresholds(self):
        overrides = [DISSIPATION, "Sweep/Number of friction coefficients=4", "Sweep/Count modes at=0.2, 0.33",
                     "Sweep/Mode shapes at=0, 0.4", UNSTABLE_SHAPES, "Sweep/Complex plane at=0.33", "Sweep/Map parameter=load",
                     "Sweep/First map value=250", "Sweep/Last map value=4000", *MAP]
        one, two = (self.sweep(f"sweep_{n}", *overrides, n_processes=n) for n in (1, 2))
        for suffix in ("", "_without_dissipation"):
            self.assert_complete(two, suffix)
            modes, others = (modes_by_mu(folder, f"branches{suffix}.csv") for folder in (one, two))
            for mu in grid_of(one):
                self.assert_same_modes(others[mu], modes[mu], DEFAULT_ACCURACY)
            expected, actual = (thresholds(folder, f"thresholds{suffix}.csv") for folder in (one, two))
            self.assertGreater(len(expected), 0)
            self.assertEqual([row["event"] for row in actual], [row["event"] for row in expected])
            for a, b in zip(expected, actual):
                self.assertAlmostEqual(a["mu [-]"], b["mu [-]"], delta=a["uncertainty [-]"] + b["uncertainty [-]"] + 1e-6)
        planes = [[eigenvalue(row) for row in read_table(folder / "complex_plane.csv")] for folder in (one, two)]
        self.assert_same_modes(planes[1], planes[0], DEFAULT_ACCURACY)
        for a, b in zip(read_table(one / "argument_counts.csv"), read_table(two / "argument_counts.csv"), strict=True):
            self.assertEqual(a["modes counted [-]"], b["modes counted [-]"])
        self.assertEqual([len(by_mu(read_table(folder / "map.csv"))) for folder in (one, two)], [4, 4])
