"""Meshes as other programs write them: names, tags, handedness, and what is said of those that cannot be read."""

import pathlib
import re

from blocks import BLOCKS, HEXAHEDRA, SURFACES, VOLUMES
from hex_mesh import PARAMETERS, disc_with_pads
from program import ProgramTest, eigenvalues


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
    def write_mesh(cls, mesh, name, version=4, mount="disc_bore", **options):
        """Writes a mesh and its parameters; returns the name of these."""
        (mesh.write_4 if version == 4 else mesh.write_2)(cls.folder / f"{name}.msh", **options)
        (cls.folder / f"{name}.prm").write_text(PARAMETERS.format(file=f"{name}.msh", mount=mount), encoding="utf-8")
        return f"{name}.prm"

    @classmethod
    def run_mesh(cls, mesh, name, *overrides, **options):
        return cls.run_scene(f"out_{name}", *overrides, file=cls.write_mesh(mesh, name, **options))

    def assert_baseline(self, results):
        self.assert_same_eigenvalues(eigenvalues(results), self.baseline)

    # ------------------------------------------------------------------- names

    def test_a_face_bears_several_names(self):
        for version, names in ((2, ("disc_bore", "hub")), (4, ("hub", "disc_bore"))):
            with self.subTest(version=version):
                results = self.run_mesh(renamed(disc_with_pads()[0], "disc_bore", *names), f"two_{version}", version=version, mount="hub")
                self.assert_baseline(results)
        # What the run leaves has all names
        (self.folder / "left.prm").write_text(PARAMETERS.format(file=results / "mesh.msh", mount="hub"), encoding="utf-8")
        self.assert_baseline(self.run_scene("out_left", file="left.prm"))

    def test_names_that_exclude_each_other(self):
        mesh = renamed(disc_with_pads()[0], "pin_contact", "pin_contact", "pin_clamp")
        self.dry_run_refused(["pin_contact", "pin_clamp"], file=self.write_mesh(mesh, "clamped_contact"))
        mesh = renamed(disc_with_pads()[0], "pin_clamp", "pin_clamp", "back")
        file = self.write_mesh(mesh, "mounted_clamp")
        self.dry_run_refused(["'pin_clamp'", "'back'"], "Mounts/Elastic mounts=back: 1e9, 1e9, 1e9", file=file)

    def test_a_curve_of_a_plan_bears_two_names(self):
        plan = (pathlib.Path(__file__).resolve().parents[2] / "geometry" / "disc_pad.geo").read_text(encoding="utf-8")
        bore = plan[plan.index('Physical Curve("disc_bore")'):].split("\n")[0]
        (self.folder / "plan.geo").write_text(plan + "\n" + bore.replace("disc_bore", "hub") + "\n", encoding="utf-8")
        for mount in ("disc_bore", "hub"):
            (self.folder / f"plan_{mount}.prm").write_text(PARAMETERS.format(file="plan.geo", mount=mount), encoding="utf-8")
        coarse = ("Geometry/Element size=0.06", "Geometry/Disc layers=1", "Geometry/Pin layers=1")
        results = [self.run_scene(f"out_plan_{mount}", *coarse, file=f"plan_{mount}.prm") for mount in ("disc_bore", "hub")]
        self.assert_same_eigenvalues(*map(eigenvalues, results))

    # -------------------------------------------------------------------- tags

    def test_elements_share_an_elementary_tag(self):
        for elementary in (0, 1):
            with self.subTest(elementary):
                self.assert_baseline(self.run_mesh(disc_with_pads()[0], f"tag_{elementary}", version=2, elementary=elementary))
        # A mount on the bore alone, although the rim has its entity
        mesh, faces = disc_with_pads()
        mesh.name(faces["disc"]["+a"].values(), "disc_rim")
        self.assert_baseline(self.run_mesh(mesh, "tag_rim", version=2, elementary=1))

    def edited_refused(self, mentions, change, **options):
        """The text of a mesh is changed."""
        prm = self.write_mesh(disc_with_pads()[0], "edited", **options)
        path = self.folder / "edited.msh"
        path.write_text(change(path.read_text(encoding="utf-8")), encoding="utf-8")
        self.dry_run_refused(mentions, file=prm)

    def test_a_volume_has_one_name(self):
        def change(text):
            tags = {name: tag for tag, name in re.findall(r'^3 (\d+) "(\w+)"$', text, re.MULTILINE)}
            return re.sub(rf" 1 {tags['pin_top']} 0$", f" 2 {tags['pin_top']} {tags['disc']} 0", text, flags=re.MULTILINE)

        self.edited_refused(["'disc'", "'pin_top'", "elementary tag"], change)

    def test_meshes_without_groups(self):
        def without(first):
            return lambda text: text[:text.index(first)] + text[text.index("$Nodes"):]

        self.edited_refused(["Physical surface 1 has no name"], without("$PhysicalNames"), version=2)
        self.edited_refused(["$Entities", "physical groups"], without("$Entities"))

    # ------------------------------------------------------------- handedness

    def test_left_handed_hexahedra_are_reordered(self):
        for kind, where in {"body": lambda mesh, body, nodes: body == "pin_bottom",
                            "half": lambda mesh, body, nodes: sum(mesh.points[node][1] for node in nodes) < 0}.items():
            with self.subTest(kind):
                mesh = disc_with_pads()[0]
                n = left_handed(mesh, lambda body, nodes: where(mesh, body, nodes))
                results = self.run_mesh(mesh, f"left_{kind}")
                self.assert_baseline(results)
                self.assertIn(f"{n} of {len(mesh.cells)} hexahedra are left-handed", self.call(f"left_{kind}.prm", "--dry-run").stdout)
        self.assertNotIn("left-handed", self.call("baseline.prm", "--dry-run").stdout)

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
                loose = self.write_mesh(mesh, f"loose_{kind}")
                self.dry_run_refused(["'pin_bottom'" if kind == "one" else "'pin_", "'pin_clamp'"], file=loose)

    # -------------------------------------------------------------------- Gmsh

    def test_any_folder_and_name(self):
        script = 'Include "part.geo";\nheight = part_height;\n' + BLOCKS + HEXAHEDRA + VOLUMES + SURFACES
        for name in ("a\"'b#c", "d$HOME e~f%g", "n\no", "b\\c"):
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
        before = home.exists()
        self.assertEqual(self.dry_run("Geometry/Allow shell commands=true").returncode, 0)
        self.assertEqual(home.exists(), before)
