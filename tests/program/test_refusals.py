"""Every refusal: one message that says what, where and what to change, a non-zero exit status, nothing written."""

import os
import pathlib
import resource
import shutil
import subprocess

from blocks import BLOCKS, HEXAHEDRA, SURFACES, VOLUMES
from mesh_file import MeshFile
from program import EXECUTABLE, ProgramTest, contents


class Refusals(ProgramTest):
    """In a folder with an earlier result, which every refusal must leave alone."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.results = cls.run_scene("results")

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        self.addCleanup(path.unlink, missing_ok=True)
        return name

    def refused(self, mentions, *arguments, n_processes=1):
        """Calls the program and looks for the words in its message."""
        before = contents(self.folder)
        process = self.call(*arguments, n_processes=n_processes)
        self.assertEqual(contents(self.folder), before)
        self.assertNotEqual(process.returncode, 0)
        message = process.stderr.strip()
        if n_processes == 1:
            self.assertEqual(process.returncode, 1)
            self.assertTrue(message.startswith("error: "), message)
        lines = message.splitlines()
        for start in ("error: ", "  where:  ", "  change: "):
            self.assertEqual(sum(line.startswith(start) and len(line) > len(start) for line in lines), 1, message)
        for word in mentions:
            self.assertIn(word, message)
        return process

    def scene_refused(self, mentions, *overrides, n_processes=1, output="results"):
        settings = [word for override in overrides for word in ("--set", override)]
        return self.refused(mentions, "scene.prm", "--output", output, *settings, n_processes=n_processes)

    def sliding_refused(self, mentions, *overrides, n_processes=1):
        """Refused before anything is assembled or factorised, and no folder is made for results."""
        process = self.scene_refused(mentions, "Steady sliding/Contact state=steady sliding", *overrides, n_processes=n_processes,
                                     output="new")
        for step in ("Assembly", "Steady sliding", "Component modes"):
            self.assertNotIn(step, process.stdout)

    def geometry_refused(self, mentions, text, *overrides):
        self.scene_refused(mentions, f"Geometry/File={self.write('other.geo', text)}", "Mounts/Elastic mounts=", *overrides)

    def changed_mesh(self):
        mesh = MeshFile(self.results / "mesh.msh")
        self.addCleanup((self.folder / "changed.msh").unlink)
        return mesh

    def mesh_refused(self, mentions, mesh):
        mesh.write(self.folder / "changed.msh")
        self.scene_refused(mentions, "Geometry/File=changed.msh")

    def test_override(self):
        self.scene_refused(["no `=`"], "Operation/Friction coefficient")

    def test_limit_of_threads(self):
        """With a stack larger than the address space no thread can be started: one does the work."""
        stack, (_, most) = 1 << 47, resource.getrlimit(resource.RLIMIT_STACK)
        if most != resource.RLIM_INFINITY:
            self.skipTest("the size of stacks is limited")
        process = subprocess.run([EXECUTABLE, "scene.prm", "--output", "limited", "--set", "Linear algebra/Threads=2"], cwd=self.folder,
                                 env={**os.environ, "OPENBLAS_NUM_THREADS": "1"}, capture_output=True, text=True,
                                 preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_STACK, (stack, most)), timeout=60)
        self.addCleanup(shutil.rmtree, self.folder / "limited", ignore_errors=True)
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertNotIn("defect", process.stderr)

    # -------------------------------------------------------------- parameters

    def test_unknown_names(self):
        for written, nearest in {"Operation/Friction coeficient": "Operation/Friction coefficient",
                                 "Geometry/Friction coefficient": "Operation/Friction coefficient",
                                 "Complex/Solver": "Complex modes/Solver"}.items():
            with self.subTest(written):
                self.scene_refused([f"`{written}`", f"`{nearest}`", "--set"], f"{written}=1")

    def test_unknown_names_in_a_file(self):
        self.write("wrong.prm", "subsection Operation\n\n  set Friction coeff = 0.3\nend\n")
        self.refused(["`Operation/Friction coeff`", "`Operation/Friction coefficient`", "wrong.prm, line 3"], "wrong.prm")
        self.write("section.prm", "subsection Opration\n  set Friction coefficient = 0.3\nend\n")
        self.refused(["unknown section `Opration/`", "`Operation/`", "section.prm, line 1"], "section.prm")

    def test_values(self):
        """tests/parameters has every kind."""
        self.scene_refused(["trilinear, incompatible modes, quadratic"], "Discretization/Element=cubic")
        self.write("value.prm", "subsection Operation\n  set Friction coefficient = much\nend\n")
        self.refused(["`much`", "value.prm, line 2"], "value.prm")
        self.write("open.prm", "subsection Operation\n  set Friction coefficient = 0.3\n")
        self.refused(["`Operation`", "open.prm, line 1"], "open.prm")

    def test_operation(self):
        for dissipation in ("consistent", "published"):
            self.scene_refused(["sliding speed", "Operation/Rotation speed"],
                               f"Operation/Radial dissipation={dissipation}", "Operation/Rotation speed=0")
        self.scene_refused(["load", "Operation/Load per side"], "Operation/Radial dissipation=published", "Operation/Load per side=0")

    def test_steady_sliding(self):
        self.sliding_refused(["does not turn", "Operation/Rotation speed"], "Operation/Rotation speed=0")
        self.sliding_refused(["-1000", "Operation/Load per side"], "Operation/Load per side=-1000")
        self.sliding_refused(["load is zero", "Operation/Load per side"], "Operation/Load per side=0")
        self.sliding_refused(["ahead", "one of equal load, steady sliding"], "Steady sliding/Contact state=ahead")
        self.sliding_refused(["by hand", "one of load per side, displacement, load per pin"], "Steady sliding/Control=by hand")

    def test_gaps(self):
        gaps = "Steady sliding/Gaps"
        self.sliding_refused(["no pin `pin_top_3`", gaps, "pin_top_1, pin_top_2, pin_bottom_1, pin_bottom_2"], f"{gaps}=pin_top_3: 1e-6")
        self.sliding_refused(["0.032 m", "height of the pin", gaps, "pin_top_2", "metres"], f"{gaps}=pin_top_1: 1e-6; pin_top_2: 0.032")
        self.sliding_refused(["-10 m", "height of the pin", "pin_bottom_1"], f"{gaps}=pin_bottom_1: -10")
        self.sliding_refused(["height of the pin", "pin_top_1"], f"{gaps}=pin_top_1: 0, 2, 0")
        self.sliding_refused(["`pin_top_1 1e-6` is not an entry", "pin: gap, sliding taper, radial taper"], f"{gaps}=pin_top_1 1e-6")
        self.sliding_refused(["`pin_top_1: 1e-6, 1e-4` is not an entry", gaps], f"{gaps}=pin_top_1: 1e-6, 1e-4")
        self.sliding_refused(["`: 1e-6` is not an entry", gaps], f"{gaps}=: 1e-6")
        self.sliding_refused(["`wide` is not a finite number", gaps, "pin pin_top_1"], f"{gaps}=pin_top_1: wide")
        self.sliding_refused(["`nan` is not a finite number", gaps], f"{gaps}=pin_top_1: nan")
        self.sliding_refused(["`1e-6 m` is not a finite number", gaps], f"{gaps}=pin_top_1: 1e-6 m")
        self.sliding_refused(["`pin_top_1` is given twice", gaps], f"{gaps}=pin_top_1: 1e-6; pin_top_1: 0")
        self.sliding_refused(["no pin `pin_top_3`", gaps], f"{gaps}=pin_top_3: 1e-6", n_processes=2)

    def test_material_of_a_pin(self):
        pins = "Pin material/Single pins"
        self.scene_refused(["no pin `pin_top_3`", pins, "pin_top_1, pin_top_2, pin_bottom_1"], f"{pins}=pin_top_3: 2e9, 0.25, 3000")
        self.scene_refused(["`pin_top_1: 2e9` is not the material", pins, "pin: Young modulus"], f"{pins}=pin_top_1: 2e9")

    def test_contact_damping_needs_a_sliding_speed(self):
        self.scene_refused(["Operation/Rotation speed", "does not turn"], "Operation/Friction slope=0.1", "Operation/Rotation speed=0")

    def test_loads_of_pins(self):
        per_pin, loads = "Steady sliding/Control=load per pin", "Steady sliding/Loads"
        self.sliding_refused(["no pin `pin_left`", loads, "pin_bottom_2"], per_pin, f"{loads}=pin_left: 500")
        self.sliding_refused(["`pin_top_1: 1, 2` is not an entry", "pin: load"], per_pin, f"{loads}=pin_top_1: 1, 2")
        self.sliding_refused(["`heavy` is not a finite number", "pin pin_top_1"], per_pin, f"{loads}=pin_top_1: heavy")
        self.sliding_refused(["load is -5 N", loads, "pin pin_top_1"], per_pin, f"{loads}=pin_top_1: -5")
        self.sliding_refused(["load is 0 N", loads, "pin pin_top_1"], per_pin, f"{loads}=pin_top_1: 0")
        self.sliding_refused(["does not list has no load", "Operation/Load per side"], per_pin, f"{loads}=pin_top_1: 5",
                             "Operation/Load per side=0")
        for control, displacement in {"load per side": 0, "displacement": 1e-5}.items():
            self.sliding_refused([f"`{control}` is prescribed", loads, "Control = load per pin"], f"Steady sliding/Control={control}",
                                 f"Steady sliding/Displacement={displacement}", f"{loads}=pin_top_1: 500")

    def test_displacement(self):
        control, displacement = "Steady sliding/Control=displacement", "Steady sliding/Displacement"
        self.sliding_refused(["do not move", displacement, "positive"], control)
        self.sliding_refused(["-1e-6", displacement], control, f"{displacement}=-1e-6")
        self.sliding_refused(["1e-06 m closes no gap", "2e-06 m", displacement, "Gaps"], control, f"{displacement}=1e-6",
                             "Steady sliding/Gaps=pin_top_1: 1e-5; pin_top_2: 2e-6")
        for other in ("load per side", "load per pin"):
            self.sliding_refused([f"`{other}` is prescribed", displacement, "Control = displacement"], f"Steady sliding/Control={other}",
                                 f"{displacement}=1e-6")

    def test_disc_that_nothing_holds(self):
        # Friction pushes the disc in its plane; this is known after a factorisation only.
        self.scene_refused(["nothing holds the disc in its plane", "Mounts/Elastic mounts"], "Steady sliding/Contact state=steady sliding",
                           "Mounts/Elastic mounts=", output="new")

    def test_damping(self):
        self.scene_refused(["parameter Damping/Modal damping ratio", "1000 Hz"], "Damping/Modal damping ratio=1000: 1", output="new")
        self.scene_refused(["steep", "Operation/Friction slope"], "Operation/Friction slope=steep", output="new")
        self.scene_refused(["load is zero", "Friction slope"], "Operation/Friction slope=-0.01", "Operation/Load per side=0", output="new")

    def test_mounts(self):
        """tests/parameters has what is no mount."""
        self.scene_refused(["'disc_ear'", "disc_bore", "disc_rim"], "Mounts/Elastic mounts=disc_ear: 0, 1e10, 1e10")

    def test_linear_algebra(self):
        self.scene_refused(["CHOLMOD", "on 2 processes", "MUMPS"], "Linear algebra/Factorization=CHOLMOD", n_processes=2)

    # ---------------------------------------------------------------- geometry

    def test_geometry(self):
        """tests/geometry has the rest."""
        self.scene_refused(["Top pin angles", "overlap"], "Geometry/Top pin angles=0, 10")
        self.scene_refused(["Top pin radii", "Top pin angles"], "Geometry/Top pin angles=0")
        self.scene_refused(["Disc inner radius is 0.32", "outer radius"], "Geometry/Disc inner radius=0.32")
        self.scene_refused(["Nodes per pin face is 8", "7"], "Geometry/Nodes per pin face=8")
        self.scene_refused(["no contact"], *(f"Geometry/{side} pin {what}=" for side in ("Top", "Bottom") for what in ("radii", "angles")))
        self.scene_refused(["missing.geo", "Geometry/File"], "Geometry/File=missing.geo")
        self.geometry_refused(["other.geo", "line 2"], "Point(1) = {0, 0, 0};\nthis is not Gmsh\n")
        self.geometry_refused(["'disk'", "disc, pin_"], BLOCKS + HEXAHEDRA + VOLUMES.replace("disc", "disk") + SURFACES)

    def test_unpaired_nodes(self):
        mesh = self.changed_mesh()
        for node in mesh.nodes_of("pin_top_1"):
            _, (x, y, z) = mesh.nodes[node]
            mesh.move(node, [x, y + 1e-4, z])
        self.mesh_refused(["7 of 28 nodes of pin_contact have no partner"], mesh)

    def test_inverted_element(self):
        mesh = self.changed_mesh()
        dimension, entity = mesh.entity("pin_top_1")
        element = next(iter(mesh.elements[dimension, entity]))
        nodes = mesh.element_nodes(dimension, entity, element)
        _, (x, y, z) = mesh.nodes[nodes[4]]
        mesh.move(nodes[4], [x, y, z - 0.1])
        self.mesh_refused(["inverted", "scaled Jacobian -", "'pin_top_1'"], mesh)
