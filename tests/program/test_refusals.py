"""Every refusal: one message that says what, where and what to change, a non-zero exit status, nothing written."""

import os
import pathlib
import shutil
import time

from mesh_file import MeshFile
from program import ProgramTest, contents

# Two blocks one upon the other; tests add names.
BLOCKS = """
SetFactory("OpenCASCADE");
Box(1) = {0.1, 0, -0.05, 0.1, 0.1, 0.05};
Box(2) = {0.1, 0, 0, 0.1, 0.1, 0.02};
"""
HEXAHEDRA = "Transfinite Curve{:} = 3; Transfinite Surface{:}; Recombine Surface{:}; Transfinite Volume{:};\n"
VOLUMES = 'Physical Volume("disc") = {1}; Physical Volume("pin_1") = {2};\n'
SURFACES = 'Physical Surface("disc_contact") = {6}; Physical Surface("pin_contact") = {11}; Physical Surface("pin_clamp") = {12};\n'


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

    def scene_refused(self, mentions, *overrides, n_processes=1):
        settings = [word for override in overrides for word in ("--set", override)]
        self.refused(mentions, "scene.prm", "--output", "results", *settings, n_processes=n_processes)

    def geometry_refused(self, mentions, text, *overrides):
        self.scene_refused(mentions, f"Geometry/File={self.write('other.geo', text)}", "Mounts/Elastic mounts=", *overrides)

    def changed_mesh(self):
        mesh = MeshFile(self.results / "mesh.msh")
        self.addCleanup((self.folder / "changed.msh").unlink)
        return mesh

    def mesh_refused(self, mentions, mesh):
        mesh.write(self.folder / "changed.msh")
        self.scene_refused(mentions, "Geometry/File=changed.msh")

    # ------------------------------------------------------------ command line

    def test_command_line(self):
        self.refused(["no parameter file"])
        self.refused(["unknown option", "--friction"], "scene.prm", "--friction")
        self.refused(["lacks its value", "--output"], "scene.prm", "--output")
        self.refused(["more than one", "other.prm"], "scene.prm", "other.prm")
        self.refused(["cannot be read", "missing.prm"], "missing.prm")

    def test_override(self):
        self.scene_refused(["no `=`"], "Operation/Friction coefficient")
        self.scene_refused(["not match", "abc"], "Operation/Friction coefficient=abc")

    # -------------------------------------------------------------- parameters

    def test_unknown_names(self):
        for written, nearest in {"Operation/Frction": "Operation/Friction coefficient",
                                 "Operation/Friction coeficient": "Operation/Friction coefficient",
                                 "Geometry/Friction coefficient": "Operation/Friction coefficient",
                                 "Operation/Rotaton": "Operation/Rotation",
                                 "Geometry/Pin dia": "Geometry/Pin diameter",
                                 "Geometry/Nodes per face": "Geometry/Nodes per pin face",
                                 "Complex/Solver": "Complex modes/Solver",
                                 "Output/Matrices": "Output/Write matrices"}.items():
            with self.subTest(written):
                self.scene_refused([f"unknown parameter `{written}`", f"nearest known name is `{nearest}`", "--set"], f"{written}=1")

    def test_unknown_names_in_a_file(self):
        self.write("wrong.prm", "subsection Operation\n\n  set Friction coeff = 0.3\nend\n")
        self.refused(["`Operation/Friction coeff`", "`Operation/Friction coefficient`", "wrong.prm, line 3"], "wrong.prm")
        self.write("section.prm", "subsection Opration\n  set Friction coefficient = 0.3\nend\n")
        self.refused(["unknown section `Opration/`", "`Operation/`", "section.prm, line 1"], "section.prm")

    def test_values(self):
        self.scene_refused(["-0.1"], "Operation/Friction coefficient=-0.1")
        self.scene_refused(["3"], "Discretization/Degree=3")
        self.scene_refused(["sideways"], "Operation/Rotation=sideways")
        self.scene_refused(["Band/Maximum frequency"], "Band/Maximum frequency=0")
        self.scene_refused(["Poisson"], "Disc material/Poisson ratio=0.5")
        self.write("value.prm", "subsection Operation\n  set Friction coefficient = much\nend\n")
        self.refused(["much", "value.prm"], "value.prm")
        self.write("open.prm", "subsection Operation\n  set Friction coefficient = 0.3\n")
        self.refused(["open.prm"], "open.prm")

    def test_operation(self):
        self.scene_refused(["sliding speed", "Operation/Rotation speed"],
                           "Operation/Radial dissipation=consistent", "Operation/Rotation speed=0")
        self.scene_refused(["load", "Operation/Load per side"], "Operation/Radial dissipation=published", "Operation/Load per side=0")

    def test_mounts(self):
        self.scene_refused(["is not an elastic mount", "radial, tangential, axial"], "Mounts/Elastic mounts=disc_bore: 1e10, 1e10")
        self.scene_refused(["`stiff` is not a number"], "Mounts/Elastic mounts=disc_bore: 0, stiff, 0")
        self.scene_refused(["twice"], "Mounts/Elastic mounts=disc_bore: 0, 1e10, 0; disc_bore: 0, 0, 1e10")
        self.scene_refused(["'disc_ear'", "disc_bore", "disc_rim"], "Mounts/Elastic mounts=disc_ear: 0, 1e10, 1e10")

    def test_linear_algebra(self):
        self.scene_refused(["CHOLMOD", "sparse LU"], "Linear algebra/Factorization=CHOLMOD", "Complex modes/Shift inverse=sparse LU")
        start = time.monotonic()
        self.scene_refused(["CHOLMOD", "on 2 processes", "MUMPS"], "Linear algebra/Factorization=CHOLMOD", n_processes=2)
        self.assertLess(time.monotonic() - start, 60)

    # ---------------------------------------------------------------- geometry

    def test_layout(self):
        self.scene_refused(["Top pin angles: pins 1 and 2", "overlap"], "Geometry/Top pin angles=0, 10")
        self.scene_refused(["Bottom pin radii: pin 2", "beyond the outer radius"], "Geometry/Bottom pin radii=0.2275, 0.3")
        self.scene_refused(["Top pin radii: pin 1", "beyond the inner radius"], "Geometry/Top pin radii=0.17, 0.2275")
        self.scene_refused(["Disc inner radius is 0.32", "outer radius"], "Geometry/Disc inner radius=0.32")
        self.scene_refused(["Top pin radii has 2 values", "Top pin angles has 1"], "Geometry/Top pin angles=0")
        self.scene_refused(["Nodes per pin face is 8", "nearest allowed value is 7"], "Geometry/Nodes per pin face=8")
        self.scene_refused(["no contact"], *(f"Geometry/{side} pin {what}=" for side in ("Top", "Bottom") for what in ("radii", "angles")))
        self.scene_refused(["Element size", "at most"], "Geometry/Element size=0.1")

    def test_files(self):
        self.scene_refused(["missing.geo", "Geometry/File"], "Geometry/File=missing.geo")
        self.geometry_refused(["other.geo", "line 2", "syntax error"], "Point(1) = {0, 0, 0};\nthis is not Gmsh\n")
        self.geometry_refused(["neither physical volumes nor physical surfaces"], "Point(1) = {0, 0, 0};\n")

    def test_names(self):
        self.geometry_refused(["'pin_contact'", "disc_contact"],
                              BLOCKS + HEXAHEDRA + VOLUMES + 'Physical Surface("disc_contact") = {6};')
        self.geometry_refused(["'disc_boer'", "disc_bore"],
                              BLOCKS + HEXAHEDRA + VOLUMES + SURFACES + 'Physical Surface("disc_boer") = {1};')
        self.geometry_refused(["'disk'", "disc, pin_"],
                              BLOCKS + HEXAHEDRA + VOLUMES.replace("disc", "disk") + SURFACES)

    def test_tetrahedra(self):
        self.geometry_refused(["'Tetrahedron 4'", "'Hexahedron 8'"], BLOCKS + "Mesh.MeshSizeMin = 0.1;\n" + VOLUMES + SURFACES)

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
        mesh.set_element_nodes(dimension, entity, element, nodes[4:] + nodes[:4])
        self.mesh_refused(["inverted", "scaled Jacobian -", "'pin_top_1'"], mesh)

    # ----------------------------------------------------------- result folder

    def test_foreign_files(self):
        foreign = self.folder / "foreign"
        foreign.mkdir()
        self.addCleanup(shutil.rmtree, foreign)
        (foreign / "thesis.tex").write_text("years of work", encoding="utf-8")
        self.refused(["foreign", "not the results of a run"], "scene.prm", "--output", "foreign")

    def test_no_folder(self):
        self.write("file", "")
        self.refused(["`file` is a file"], "scene.prm", "--output", "file")
        self.refused(["file/results"], "scene.prm", "--output", "file/results")
        self.refused(["empty"], "scene.prm", "--output", "")

    def test_folder_without_permission(self):
        if os.geteuid() == 0:
            self.skipTest("root may write everywhere")
        locked = self.folder / "locked"
        locked.mkdir(mode=0o500)
        self.addCleanup(locked.rmdir)
        self.refused(["Permission denied", "locked/results"], "scene.prm", "--output", "locked/results")

    # ----------------------------------------------------------------- success

    def test_earlier_results_are_replaced_by_success_only(self):
        copy = self.folder / "copy"
        shutil.copytree(self.results, copy)
        self.addCleanup(shutil.rmtree, copy)
        (copy / "matrices").mkdir()
        self.run_scene("copy")
        self.assertEqual(sorted(path.name for path in copy.iterdir()), sorted(path.name for path in self.results.iterdir()))
        self.assertEqual([path for path in self.folder.iterdir() if pathlib.Path(path).suffix], [self.folder / "scene.prm"])
