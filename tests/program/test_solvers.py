# SPDX-License-Identifier: GPL-3.0-or-later

"""All solvers give the same eigenvalues, with and without friction, dissipation and rotation."""

import json
import math

from mesh_file import MeshFile
from program import COARSE, ProgramTest, distance, eigenvalues, numbers, read_table, real_frequencies

# The default tolerance of the residual iteration, 1e-7, is too large for this comparison
RESIDUAL_ITERATION = ["Complex modes/Solver=residual iteration", "Complex modes/Iteration tolerance=1e-10"]
DISSIPATION = "Operation/Radial dissipation=consistent"


class Solvers(ProgramTest):
    scene = COARSE

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.reference = cls.run_scene("reference")
        cls.values = eigenvalues(cls.reference)

    def test_linear_algebra(self):
        for overrides in (["Linear algebra/Factorization=CHOLMOD"],
                          ["Linear algebra/Factorization=MUMPS"],
                          ["Complex modes/Shift inverse=sparse LU"],
                          ["Complex modes/Shift inverse=sparse LU", "Linear algebra/Factorization=MUMPS"],
                          ["Real modes/Solver=Anasazi"],
                          ["Real modes/Solver=ARPACK"]):
            with self.subTest(overrides):
                results = self.run_scene("results", *overrides)
                self.assert_same_eigenvalues(eigenvalues(results), self.values)
                self.assert_same_eigenvalues(real_frequencies(results), real_frequencies(self.reference))
                self.assert_same_eigenvalues(real_frequencies(results, "component_modes.csv"),
                                             real_frequencies(self.reference, "component_modes.csv"))

    def test_residual_iteration(self):
        self.assert_same_eigenvalues(eigenvalues(self.run_scene("results", *RESIDUAL_ITERATION)), self.values)

        # Errors are below the default tolerance
        results = self.run_scene("results", RESIDUAL_ITERATION[0])
        estimates = [float(row["estimated error of lambda [-]"]) for row in read_table(results / "complex_modes.csv")]
        self.assertLessEqual(max(estimates), 1e-7)
        self.assert_same_eigenvalues(eigenvalues(results), self.values, 1e-7)

    def test_dissipation(self):
        krylov = eigenvalues(self.run_scene("results", DISSIPATION))
        self.assertGreater(distance(krylov, self.values), 1e-5)
        for overrides in (["Complex modes/Shift inverse=sparse LU"], RESIDUAL_ITERATION):
            with self.subTest(overrides):
                self.assert_same_eigenvalues(eigenvalues(self.run_scene("results", DISSIPATION, *overrides)), krylov)

    def test_no_friction(self):
        for overrides in ([], RESIDUAL_ITERATION):
            with self.subTest(overrides):
                values = eigenvalues(self.run_scene("results", "Operation/Friction coefficient=0", *overrides))
                expected = [2j * math.pi * frequency for frequency in real_frequencies(self.folder / "results")]
                self.assert_same_eigenvalues(values, expected)


class Rotation(ProgramTest):
    """Reversed rotation is equivalent to rotation with a mirrored mesh."""

    scene = COARSE

    def values(self, rotation, geometry, *overrides):
        return eigenvalues(self.run_scene("results", f"Operation/Rotation={rotation}", f"Geometry/File={geometry}", *overrides))

    def test_mirrored_mesh(self):
        skewed = "Geometry/Bottom pin angles=-4, 20"
        values = self.values("positive", "disc_pins.geo", skewed)
        mesh = MeshFile(self.folder / "results" / "mesh.msh")
        mesh.mirror()
        mesh.write(self.folder / "mirrored.msh")
        self.assert_same_eigenvalues(self.values("negative", "mirrored.msh"), values)
        self.assertGreater(distance(self.values("negative", "disc_pins.geo", skewed), values), 1e-3)


class GyroscopicForces(ProgramTest):
    scene = COARSE
    ON = "Operation/Gyroscopic forces=true"

    def test_both_solvers_and_sweep(self):
        values = eigenvalues(self.run_scene("single", self.ON))
        self.assert_same_eigenvalues(eigenvalues(self.run_scene("results", self.ON, *RESIDUAL_ITERATION)), values)
        self.assertGreater(distance(eigenvalues(self.run_scene("results")), values), 1e-5)
        self.run_scene("sweep", self.ON, "Study=sweep", "Sweep/First friction coefficient=0", "Sweep/Last friction coefficient=0.4",
                       "Sweep/Number of friction coefficients=3", "Sweep/Tolerance=1e-9")
        rows = [row for row in read_table(self.folder / "sweep" / "branches.csv") if float(row["mu [-]"]) == 0.4]
        found = [complex(float(row["growth rate [1/s]"]), 2 * math.pi * float(row["frequency [Hz]"])) for row in rows]
        for value in values:
            self.assertLess(min(abs(other - value) for other in found), 1e-7 * abs(value))

    def test_free_disc(self):
        process = self.call("scene.prm", "--output", "refused", "--set", "Operation/Gyroscopic forces=true", "--set", "Mounts/Elastic mounts=")
        self.assertEqual(process.returncode, 1)
        self.assertIn("rigid-body", process.stderr)


class Mounts(ProgramTest):
    scene = COARSE

    def test_free_disc(self):
        # The pins support the disc only axially, so that three rigid-body modes in its plane remain
        for overrides in (["Mounts/Elastic mounts=", DISSIPATION], ["Mounts/Elastic mounts=disc_bore: 0, 0, 1.88e10"]):
            values = []
            for solver in ([], RESIDUAL_ITERATION):
                with self.subTest(overrides, solver=solver):
                    results = self.run_scene("results", *overrides, *solver)
                    counts = json.loads((results / "run.json").read_text(encoding="utf-8"))["counts"]
                    self.assertEqual(counts["rigid-body modes"], 3)
                    rows = read_table(results / "real_modes.csv")
                    self.assertEqual([(row["label"], float(row["frequency [Hz]"])) for row in rows[:3]], 3 * [("RB", 0.0)])
                    self.assertGreater(float(rows[3]["frequency [Hz]"]), 1)
                    self.assertEqual(counts["complex modes"], counts["real modes"] - 3)
                    for table in ("real_modes.csv", "complex_modes.csv", "component_modes.csv"):
                        self.assertTrue(all(abs(number) < 1e9 for number in numbers(results / table)), table)
                    values.append(eigenvalues(results))
            # Rounding errors of K reduce the accuracy of modes with very low frequencies
            self.assert_same_eigenvalues(*values, 1e-7)
