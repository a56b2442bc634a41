"""The same eigenvalues by every solver and on several processes, and what friction and its absence do to them."""

import json
import math
import pathlib
import unittest

from mesh_file import MeshFile
from program import ProgramTest, distance, eigenvalues, numbers, read_table, real_frequencies

# With its default tolerance of 1e-7 the residual iteration stops earlier than the comparison asks.
RESIDUAL_ITERATION = ["Complex modes/Solver=residual iteration", "Complex modes/Iteration tolerance=1e-10"]
HERE = pathlib.Path(__file__).resolve().parent
DISSIPATION = "Operation/Radial dissipation=consistent"


class Solvers(ProgramTest):
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

        # With the default tolerance, errors are no larger than that.
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
    """Turning the other way is the mirror image."""

    def values(self, rotation, geometry, *overrides):
        return eigenvalues(self.run_scene("results", f"Operation/Rotation={rotation}", f"Geometry/File={geometry}", *overrides))

    def sectors(self, rings, sectors):
        """A plan with pads in some places of a mesh that is its own mirror image."""
        (self.folder / "plan.geo").write_text(f"ring() = {{{rings}}}; sector() = {{{sectors}}}; Include \"{HERE / 'sectors.geo'}\";\n",
                                              encoding="utf-8")
        return "plan.geo"

    def test_mirrored_mesh(self):
        values = self.values("positive", "disc_pins.geo", "Geometry/Bottom pin angles=-4, 20")
        mesh = MeshFile(self.folder / "results" / "mesh.msh")
        mesh.mirror()
        mesh.write(self.folder / "mirrored.msh")
        self.assert_same_eigenvalues(self.values("negative", "mirrored.msh"), values)

    def test_symmetric_layout(self):
        # Gmsh's mesh of the pins' plan is not symmetric, so that frequencies would only agree to some 0.1 %; this mesh is.
        plan = self.sectors("1, 1", "1, 22")
        self.assert_same_eigenvalues(self.values("negative", plan), self.values("positive", plan))

    def test_skewed_layout(self):
        plan = self.sectors("0, 2", "1, 22")
        self.assertGreater(distance(self.values("negative", plan), self.values("positive", plan)), 1e-3)


class GyroscopicForces(ProgramTest):
    def test_both_solvers_and_lu(self):
        values = [eigenvalues(self.run_scene("results", "Operation/Gyroscopic forces=true", *overrides))
                  for overrides in ((), RESIDUAL_ITERATION,
                                    ("Complex modes/Shift inverse=sparse LU",))]
        for others in values[1:]:
            self.assert_same_eigenvalues(others, values[0])
        self.assertGreater(distance(eigenvalues(self.run_scene("results")), values[0]), 1e-5)

    def test_sweep(self):
        # Modes of a sweep are those of a single run
        self.run_scene("sweep", "Operation/Gyroscopic forces=true", "Study=sweep", "Sweep/First friction coefficient=0",
                       "Sweep/Last friction coefficient=0.4", "Sweep/Number of friction coefficients=3", "Sweep/Tolerance=1e-9")
        rows = [row for row in read_table(self.folder / "sweep" / "branches.csv") if float(row["mu [-]"]) == 0.4]
        found = [complex(float(row["growth rate [1/s]"]), 2 * math.pi * float(row["frequency [Hz]"])) for row in rows]
        for value in eigenvalues(self.run_scene("single", "Operation/Gyroscopic forces=true")):
            self.assertLess(min(abs(other - value) for other in found), 1e-7 * abs(value))

    def test_free_disc(self):
        process = self.call("scene.prm", "--output", "refused", "--set", "Operation/Gyroscopic forces=true", "--set", "Mounts/Elastic mounts=")
        self.assertEqual(process.returncode, 1)
        self.assertIn("rigid body", process.stderr)


class Mounts(ProgramTest):
    def test_free_disc(self):
        # Pins hold the disc only along its axis: it may move in its plane and turn.
        for mount, dissipations in {"": ("none", "consistent"), "disc_bore: 0, 0, 1.88e10": ("none",)}.items():
            values = {}
            for solver in ("Krylov", "residual iteration"):
                for dissipation in dissipations:
                    with self.subTest(mount=mount, solver=solver, dissipation=dissipation):
                        results = self.run_scene("results", f"Mounts/Elastic mounts={mount}", f"Complex modes/Solver={solver}",
                                                 f"Operation/Radial dissipation={dissipation}", "Complex modes/Iteration tolerance=1e-10")
                        counts = json.loads((results / "run.json").read_text(encoding="utf-8"))["counts"]
                        self.assertEqual(counts["rigid-body modes"], 3)
                        rows = read_table(results / "real_modes.csv")
                        self.assertEqual([(row["label"], float(row["frequency [Hz]"])) for row in rows[:3]], 3 * [("RB", 0.0)])
                        self.assertGreater(float(rows[3]["frequency [Hz]"]), 1)
                        self.assertEqual(counts["complex modes"], counts["real modes"] - 3)
                        for table in ("real_modes.csv", "complex_modes.csv", "component_modes.csv"):
                            self.assertTrue(all(abs(number) < 1e9 for number in numbers(results / table)), table)
                        values[solver, dissipation] = eigenvalues(results)
            for dissipation in dissipations:
                # Modes far below the others are known less well: rounding errors of K.
                self.assert_same_eigenvalues(values["residual iteration", dissipation], values["Krylov", dissipation], 1e-7)
