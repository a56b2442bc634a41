"""Meshes as other programs write them: names, tags, handedness, and what is said of those that cannot be read."""

import math
import os
import pathlib

from blocks import BLOCKS, HEXAHEDRA, SURFACES, VOLUMES
from hex_mesh import PARAMETERS, disc_with_pads
from program import ProgramTest, eigenvalues, read_table

MATRICES = "Output/Write matrices=true"


def renamed(mesh, old, *new, where=lambda nodes: True):
    """Gives the faces of one name, or some of them, other ones."""
    mesh.faces = [(tuple(n for name in names for n in (new if name == old and where(nodes) else [name])), nodes) for names, nodes in mesh.faces]
    return mesh


def left_handed(mesh, where):
    """Exchanges bottom and top of some cells; returns their number."""
    chosen = [where(body, nodes) for body, nodes in mesh.cells]
    mesh.cells = [(body, nodes[4:] + nodes[:4] if left else nodes) for left, (body, nodes) in zip(chosen, mesh.cells)]
    return sum(chosen)


class Meshes(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.baseline = eigenvalues(cls.run_mesh(disc_with_pads()[0], "baseline"))

    @classmethod
    def write(cls, mesh, name, version=4, mount="disc_bore", **options):
        """Writes a mesh and its parameters; returns the name of these."""
        (mesh.write_4 if version == 4 else mesh.write_2)(cls.folder / f"{name}.msh", **options)
        (cls.folder / f"{name}.prm").write_text(PARAMETERS.format(file=f"{name}.msh", mount=mount), encoding="utf-8")
        return f"{name}.prm"

    @classmethod
    def run_mesh(cls, mesh, name, *overrides, **options):
        return cls.run_scene(f"out_{name}", *overrides, file=cls.write(mesh, name, **options))

    def assert_baseline(self, results):
        self.assert_same_eigenvalues(eigenvalues(results), self.baseline)

    def refused(self, mentions, file, *overrides):
        process = self.call(file, "--dry-run", *(word for override in overrides for word in ("--set", override)))
        self.assertEqual(process.returncode, 1, process.stdout)
        self.assertEqual(process.stderr.count("error: "), 1, process.stderr)
        for word in mentions:
            self.assertIn(word, process.stderr)

    # ------------------------------------------------------------------- names

    def test_a_face_bears_several_names(self):
        for version in (2, 4):
            for names in (("disc_bore", "hub"), ("hub", "disc_bore")):
                with self.subTest(version=version, names=names):
                    mesh = renamed(disc_with_pads()[0], "disc_bore", *names)
                    results = self.run_mesh(mesh, f"two_{version}_{names[0]}", version=version, mount="hub")
                    self.assert_baseline(results)
        # What the run leaves has all names
        (self.folder / "left.prm").write_text(PARAMETERS.format(file=results / "mesh.msh", mount="hub"), encoding="utf-8")
        self.assert_baseline(self.run_scene("out_left", file="left.prm"))
        # A second name on a part of a contact, of a clamp, of a cylinder that quadratic elements follow
        quadratic = "Discretization/Element=quadratic"
        expected = self.run_mesh(disc_with_pads()[0], "quadratic", quadratic)
        mesh = disc_with_pads()[0]
        some = lambda nodes: mesh.points[nodes[0]][1] > 0.01
        for name, other in (("disc_contact", "ground"), ("pin_contact", "pin_side"), ("pin_clamp", "pin_side"), ("disc_bore", "hub")):
            renamed(mesh, name, name, other, where=some)
        actual = self.run_mesh(mesh, "parts", quadratic, "Mounts/Elastic mounts=disc_bore: 0, 7.8e10, 1.88e10; hub: 0, 0, 0; ground: 0, 0, 0")
        self.assert_same_eigenvalues(eigenvalues(actual), eigenvalues(expected))

    def test_several_groups_have_one_name(self):
        for name in ("disc_contact", "pin_contact", "pin_clamp", "disc_bore", "pin_top"):
            with self.subTest(name):
                self.assert_baseline(self.run_mesh(disc_with_pads()[0], f"same_{name}", same_name=name))

    def test_names_that_exclude_each_other(self):
        mesh = renamed(disc_with_pads()[0], "pin_contact", "pin_contact", "pin_clamp")
        self.refused(["pin_contact", "pin_clamp"], self.write(mesh, "clamped_contact"))
        mesh = renamed(disc_with_pads()[0], "pin_clamp", "pin_clamp", "back")
        self.refused(["'pin_clamp'", "'back'"], self.write(mesh, "mounted_clamp"), "Mounts/Elastic mounts=back: 1e9, 1e9, 1e9")

    def test_a_curve_of_a_plan_bears_two_names(self):
        plan = (pathlib.Path(__file__).resolve().parents[2] / "geometry" / "disc_pad.geo").read_text(encoding="utf-8")
        bore = plan[plan.index('Physical Curve("disc_bore")'):].split("\n")[0]
        (self.folder / "plan.geo").write_text(plan + "\n" + bore.replace("disc_bore", "hub") + "\n", encoding="utf-8")
        for mount in ("disc_bore", "hub"):
            (self.folder / f"plan_{mount}.prm").write_text(PARAMETERS.format(file="plan.geo", mount=mount), encoding="utf-8")
        coarse = ("Geometry/Element size=0.06", "Geometry/Disc layers=1", "Geometry/Pin layers=1")
        results = [self.run_scene(f"out_plan_{mount}", *coarse, file=f"plan_{mount}.prm") for mount in ("disc_bore", "hub")]
        self.assert_same_eigenvalues(*map(eigenvalues, results))

    def test_tables_quote_names(self):
        pin = "pin_\"a\", 'b'\n"
        script = BLOCKS + HEXAHEDRA + VOLUMES + SURFACES
        names = "name = StrCat(\"pin_\", '\"a\", ', \"'b'\n\");\n"
        (self.folder / "names.geo").write_text(names + script.replace('"pin_1"', "Str(name)"), encoding="utf-8")
        (self.folder / "names.prm").write_text(PARAMETERS.format(file="names.geo", mount="disc_contact"), encoding="utf-8")
        results = self.run_scene("out_names", "Mounts/Elastic mounts=", MATRICES, file="names.prm")
        for table, column in (("nodes", "component"), ("contact_nodes", "pin")):
            rows = read_table(results / "matrices" / f"{table}.csv")
            self.assertIn(pin, {row[column] for row in rows})
            self.assertTrue(all(None not in row and None not in row.values() for row in rows))

    # -------------------------------------------------------------------- tags

    def test_elements_share_an_elementary_tag(self):
        for elementary in (0, 1):
            with self.subTest(elementary):
                self.assert_baseline(self.run_mesh(disc_with_pads()[0], f"tag_{elementary}", version=2, elementary=elementary))
        # A mount on the bore alone, although the rim has its entity
        mesh, faces = disc_with_pads()
        mesh.name(faces["disc"]["+a"].values(), "disc_rim")
        self.assert_baseline(self.run_mesh(mesh, "tag_rim", version=2, elementary=1))

    def test_a_volume_has_one_name(self):
        prm = self.write(disc_with_pads()[0], "two_bodies")
        path = self.folder / "two_bodies.msh"
        lines = path.read_text(encoding="utf-8").splitlines()
        tags = {line.split()[2].strip('"'): line.split()[1] for line in lines if line.startswith("3 ") and line.endswith('"')}
        volume = f" 1 {tags['pin_top']} 0"
        path.write_text("\n".join(line.replace(volume, f" 2 {tags['pin_top']} {tags['disc']} 0") if line.endswith(volume) else line
                                  for line in lines) + "\n", encoding="utf-8")
        self.refused(["'disc'", "'pin_top'", "elementary tag"], prm)

    def test_groups_without_names(self):
        prm = self.write(disc_with_pads()[0], "unnamed", version=2)
        path = self.folder / "unnamed.msh"
        text = path.read_text(encoding="utf-8")
        first, last = text.index("$PhysicalNames"), text.index("$Nodes")
        path.write_text(text[:first] + text[last:], encoding="utf-8")
        self.refused(["Physical surface 1 has no name"], prm)

    def test_meshes_without_groups(self):
        prm = self.write(disc_with_pads()[0], "no_entities")
        path = self.folder / "no_entities.msh"
        text = path.read_text(encoding="utf-8")
        path.write_text(text[:text.index("$Entities")] + text[text.index("$Nodes"):], encoding="utf-8")
        self.refused(["$Entities", "physical groups"], prm)

        # One hexahedron in I-DEAS' universal format
        nodes = "".join(f"{i:10}{1:10}{1:10}{11:10}\n{x:25.16E}{y:25.16E}{z:25.16E}\n" for i, (x, y, z) in enumerate(
            ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)), 1))
        element = "".join(f"{number:10}" for number in (1, 115, 1, 1, 7, 8)) + "\n" + "".join(f"{node:10}" for node in range(1, 9)) + "\n"
        (self.folder / "other.unv").write_text(f"    -1\n  2411\n{nodes}    -1\n    -1\n  2412\n{element}    -1\n", encoding="utf-8")
        (self.folder / "other.geo").write_text('Merge "other.unv";\n', encoding="utf-8")
        self.refused(["Physical volume 1 has no name", ".unv", ".geo"], "scene.prm", "Geometry/File=other.geo")

    # ------------------------------------------------------------- handedness

    def test_left_handed_hexahedra_are_reordered(self):
        for kind, where in {"all": lambda mesh, body, nodes: True, "body": lambda mesh, body, nodes: body == "pin_bottom",
                            "half": lambda mesh, body, nodes: sum(mesh.points[node][1] for node in nodes) < 0}.items():
            with self.subTest(kind):
                mesh = disc_with_pads()[0]
                n = left_handed(mesh, lambda body, nodes: where(mesh, body, nodes))
                results = self.run_mesh(mesh, f"left_{kind}")
                self.assert_baseline(results)
                self.assertIn(f"{n} of {len(mesh.cells)} hexahedra are left-handed", self.call(f"left_{kind}.prm", "--dry-run").stdout)
        self.assertNotIn("left-handed", self.call("baseline.prm", "--dry-run").stdout)

    def test_inverted_hexahedra_are_refused(self):
        # A node through the opposite face
        mesh, faces = disc_with_pads()
        node = next(iter(faces["pin_top"]["+c"].values()))[0]
        mesh.points[node] = (*mesh.points[node][:2], -0.05)
        self.refused(["inverted", "'pin_top'"], self.write(mesh, "through"))
        # A layer of nodes beyond the next one: the elements between are left-handed where they are
        mesh, _ = disc_with_pads()
        mesh.points = [(x, y, 0.07 if math.isclose(z, 0.035) else z) for x, y, z in mesh.points]
        self.refused(["inverted", "'pin_top'"], self.write(mesh, "folded"))

    # ------------------------------------------------------------------ clamps

    def test_pins_are_held_by_mounts_alone(self):
        mounts = "Mounts/Elastic mounts=disc_bore: 0, 7.8e10, 1.88e10; back: {0}, {0}, {0}"
        some = {"none": lambda nodes: True, "one": lambda nodes: mesh.points[nodes[0]][2] < 0}
        for kind, where in some.items():
            with self.subTest(kind):
                mesh = disc_with_pads()[0]
                renamed(mesh, "pin_clamp", "back", where=where)
                soft = eigenvalues(self.run_mesh(mesh, f"clamps_{kind}", mounts.format("1e10")))
                hard = eigenvalues(self.run_scene(f"out_hard_{kind}", mounts.format("1e18"), file=f"clamps_{kind}.prm"))
                self.assert_same_eigenvalues(hard, self.baseline, 1e-4)
                self.assertGreater(len(soft), len(self.baseline))
                # Without the mount nothing holds them
                mesh.faces = [face for face in mesh.faces if "back" not in face[0]]
                self.refused(["'pin_bottom'" if kind == "one" else "'pin_", "'pin_clamp'"], self.write(mesh, f"loose_{kind}"))

    # -------------------------------------------------------------------- Gmsh

    def test_any_folder_and_name(self):
        script = 'Include "part.geo";\nheight = part_height;\n' + BLOCKS + HEXAHEDRA + VOLUMES + SURFACES
        for name in ('a"b', "c'd", "e#f", "g$HOME", "h~i", "j k", "l%m", "n\no", "'\"", "b\\c"):
            with self.subTest(name):
                folder = self.folder / name
                folder.mkdir()
                (folder / "part.geo").write_text("part_height = 0.02;\n", encoding="utf-8")
                file = folder / ("plan.geo" if "\\" in name else f"{name}.geo")
                file.write_text(script, encoding="utf-8")
                process = self.call("scene.prm", "--dry-run", "--set", f"Geometry/File={file}", "--set", "Mounts/Elastic mounts=")
                self.assertEqual((process.returncode, process.stderr), (0, ""))

    def test_gmsh_leaves_nothing_behind(self):
        home = pathlib.Path("/nonexistent")
        self.assertFalse(home.exists() and os.geteuid() != 0)
        before = home.exists()
        for allowed in ("true", "false"):
            self.assertEqual(self.call("scene.prm", "--dry-run", "--set", f"Geometry/Allow shell commands={allowed}").returncode, 0)
        self.assertEqual(home.exists(), before)
