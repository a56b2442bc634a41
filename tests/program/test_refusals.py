# SPDX-License-Identifier: GPL-3.0-or-later

"""Rejected runs: one message that says what happened, where, and what to change; a nonzero exit status; no files."""

import os
import resource
import shutil
import subprocess

from mesh_file import MeshFile
from program import EXECUTABLE, ProgramTest, contents, settings


class Refusals(ProgramTest):
    """Runs in a folder with earlier results, which must not change."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.results = cls.run_scene("results")

    def refused(self, mentions, *arguments, n_processes=1):
        """Checks that a call writes nothing and fails with a message that contains `mentions`."""
        before = contents(self.folder)
        process = self.call(*arguments, n_processes=n_processes)
        self.assertEqual(contents(self.folder), before)
        if n_processes == 1:
            self.assertEqual(process.returncode, 1)
            self.assertTrue(process.stderr.strip().startswith("error: "), process.stderr)
        self.assert_message(process, mentions)
        return process

    def scene_refused(self, mentions, *overrides, n_processes=1, output="results"):
        return self.refused(mentions, "scene.prm", "--output", output, *settings(overrides), n_processes=n_processes)

    def sliding_refused(self, mentions, *overrides, n_processes=1):
        """Checks that the run is rejected before assembly and factorisation and creates no result folder."""
        process = self.scene_refused(mentions, "Steady sliding/Contact state=steady sliding", *overrides, n_processes=n_processes,
                                     output="new")
        for step in ("Assembly", "Steady sliding", "Component modes"):
            self.assertNotIn(step, process.stdout)

    def test_limit_of_threads(self):
        """If the stack size exceeds the address space, no thread can be started, and the run uses one thread."""
        stack, (_, most) = 1 << 47, resource.getrlimit(resource.RLIMIT_STACK)
        if most != resource.RLIM_INFINITY:
            self.skipTest("the hard limit of the stack size is finite")
        process = subprocess.run([EXECUTABLE, "scene.prm", "--output", "limited", "--set", "Linear algebra/Threads=2"], cwd=self.folder,
                                 env={**os.environ, "OPENBLAS_NUM_THREADS": "1"}, capture_output=True, text=True,
                                 preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_STACK, (stack, most)), timeout=60)
        self.addCleanup(shutil.rmtree, self.folder / "limited", ignore_errors=True)
        if "PMIX ERROR" in process.stderr:
            self.skipTest("this version of MPI requires a thread")
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertNotIn("defect", process.stderr)

    # -------------------------------------------------------------- parameters

    def test_unknown_names(self):
        self.scene_refused(["`Complex/Solver`", "`Complex modes/Solver`", "--set"], "Complex/Solver=1")
        self.write("wrong.prm", "subsection Operation\n\n  set Friction coeff = 0.3\nend\n")
        self.refused(["`Operation/Friction coeff`", "`Operation/Friction coefficient`", "wrong.prm, line 3"], "wrong.prm")

    def test_operation(self):
        self.scene_refused(["no `=`"], "Operation/Friction coefficient")
        self.scene_refused(["sliding speed", "Operation/Rotation speed"], "Operation/Radial dissipation=consistent",
                           "Operation/Rotation speed=0")
        self.scene_refused(["load", "Operation/Load per side"], "Operation/Radial dissipation=published", "Operation/Load per side=0")
        self.scene_refused(["Operation/Rotation speed", "does not turn"], "Operation/Friction slope=0.1", "Operation/Rotation speed=0")
        self.scene_refused(["load is zero", "Friction slope"], "Operation/Friction slope=-0.01", "Operation/Load per side=0")
        self.sliding_refused(["does not turn", "Operation/Rotation speed"], "Operation/Rotation speed=0")
        self.sliding_refused(["load is zero", "Operation/Load per side"], "Operation/Load per side=0")

    def test_gaps(self):
        gaps = "Steady sliding/Gaps"
        for entry, mentions in (("pin_top_1: 1e-6; pin_top_2: 0.032", ["0.032 m", "height of the pin", "pin_top_2", "metres"]),
                                ("pin_top_1 1e-6", ["`pin_top_1 1e-6` is not the gap of a pin", "pin: gap, sliding taper, radial taper"]),
                                ("pin_top_1: nan", ["`nan` is not a finite number", "pin pin_top_1"]),
                                ("pin_top_1: 1e-6; pin_top_1: 0", ["`pin_top_1` is given twice"])):
            with self.subTest(entry):
                self.sliding_refused([gaps, *mentions], f"{gaps}={entry}")
        self.sliding_refused(["no pin `pin_top_3`", gaps, "pin_top_1, pin_top_2, pin_bottom_1, pin_bottom_2"], f"{gaps}=pin_top_3: 1e-6",
                             n_processes=2)

    def test_material_of_a_pin(self):
        pins = "Materials/Volumes"
        self.scene_refused(["no volume `pin_top_3`", pins, "pin_top_1, pin_top_2, pin_bottom_1"], f"{pins}=pin_top_3: 2e9, 0.25, 3000")
        self.scene_refused(["`pin_top_1: 2e9` is not the material", pins, "volume: Young modulus"], f"{pins}=pin_top_1: 2e9")

    def test_orthotropic_volume(self):
        self.scene_refused(["no volume `pin_top_3`", "Materials/Orthotropic", "pin_top_1, pin_top_2, pin_bottom_1"],
                           "Materials/Orthotropic=pin_top_3: 2e9, 2e9, 5e8, 0.2, 0.1, 0.1, 8e8, 3e8, 3e8, 2600")

    def test_loads_of_pins(self):
        per_pin, loads = "Steady sliding/Control=load per pin", "Steady sliding/Loads"
        self.sliding_refused(["no pin `pin_left`", loads, "pin_bottom_2"], per_pin, f"{loads}=pin_left: 500")
        self.sliding_refused(["load is 0 N", loads, "pin pin_top_1"], per_pin, f"{loads}=pin_top_1: 0")
        self.sliding_refused(["is not listed in Steady sliding/Loads has no load", "Operation/Load per side"], per_pin, f"{loads}=pin_top_1: 5",
                             "Operation/Load per side=0")
        self.sliding_refused(["`load per side` is prescribed", loads, "Control = load per pin"], f"{loads}=pin_top_1: 500")

    def test_displacement(self):
        control, displacement = "Steady sliding/Control=displacement", "Steady sliding/Displacement"
        self.sliding_refused(["displacement of the backplates is zero", displacement, "positive"], control)
        self.sliding_refused(["1e-06 m", "2e-06 m", displacement, "Gaps"], control, f"{displacement}=1e-6",
                             "Steady sliding/Gaps=pin_top_1: 1e-5; pin_top_2: 2e-6")

    def test_disc_that_nothing_holds(self):
        # Friction pushes the disc in its plane; this is detected only after a factorisation
        self.scene_refused(["nothing holds the disc against the friction forces", "Mounts/Elastic mounts"], "Steady sliding/Contact state=steady sliding",
                           "Mounts/Elastic mounts=", output="new")

    def test_damping(self):
        self.scene_refused(["parameter Damping/Modal damping ratio", "1000 Hz"], "Damping/Modal damping ratio=1000: 1", output="new")

    def test_linear_algebra(self):
        self.scene_refused(["CHOLMOD", "on 2 processes", "MUMPS"], "Linear algebra/Factorization=CHOLMOD", n_processes=2)

    def test_pin_off_the_disc(self):
        """tests/geometry covers other invalid geometries and meshes."""
        mesh = MeshFile(self.results / "mesh.msh")
        for node in mesh.nodes_of("pin_top_1"):
            _, (x, y, z) = mesh.nodes[node]
            mesh.move(node, [x, y, z + 0.1])
        mesh.write(self.folder / "changed.msh")
        self.scene_refused(["only 0 % of the contact face of pin_top_1", "surfaces disc_contact and pin_contact"], "Geometry/File=changed.msh",
                           "Steady sliding/Contact state=equal load")
