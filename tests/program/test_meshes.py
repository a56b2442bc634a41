# SPDX-License-Identifier: GPL-3.0-or-later

"""Meshes written by other programs: names, tags, handedness, and messages for unsuitable meshes."""

import math
import pathlib
import re

from blocks import BLOCKS, HEXAHEDRA, SURFACES, VOLUMES
from hex_mesh import PARAMETERS, disc_with_pads
from program import ProgramTest, eigenvalues, read_table
from tet_mesh import BRAKE, brake, clutch


def renamed(mesh, old, *new, where=lambda nodes: True):
    """Replaces the name `old` of faces by `new`, if `where` is true for their nodes."""
    mesh.faces = [(tuple(n for name in names for n in (new if name == old and where(nodes) else [name])), nodes) for names, nodes in mesh.faces]
    return mesh


def left_handed(mesh, where):
    """Makes the cells for which `where` is true left-handed by swapping bottom and top; returns their number."""
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
        """Writes a mesh and its parameter file; returns the name of the parameter file."""
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
        # The mesh file that the run writes has all names
        (self.folder / "left.prm").write_text(PARAMETERS.format(file=results / "mesh.msh", mount="hub"), encoding="utf-8")
        self.assert_baseline(self.run_scene("out_left", file="left.prm"))

    def test_names_that_exclude_each_other(self):
        mesh = renamed(disc_with_pads()[0], "pin_contact", "pin_contact", "pin_clamp")
        self.dry_run_refused(["contact node", "pin_clamp"], file=self.write_mesh(mesh, "clamped_contact"))
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
        # The mount acts only on the bore, although the rim has the same elementary tag
        mesh, faces = disc_with_pads()
        mesh.name(faces["disc"]["+a"].values(), "disc_rim")
        self.assert_baseline(self.run_mesh(mesh, "tag_rim", version=2, elementary=1))

    def edited_refused(self, mentions, change, **options):
        """Checks that a mesh file is rejected after `change` has edited its text."""
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
                self.assertIn(f"left-handed cells: {n} of {len(mesh.cells)}", self.call(f"left_{kind}.prm", "--dry-run").stdout)
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
                # Without the mount, the pins are unconstrained
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


def turned(angle):
    c, s = math.cos(angle), math.sin(angle)
    return lambda x, y, z: (c * x - s * y, s * x + c * y, z)


def part_pad(mesh, pad, of_nodes=slice(0, 10)):
    """Gives the backplate its own nodes on the interface with the lining."""
    lining, own = {node for volume, nodes in mesh.cells if volume == f"{pad}_lining" for node in nodes[of_nodes]}, {}
    for index, (volume, nodes) in enumerate(mesh.cells):
        if volume == f"{pad}_backplate":
            for node in lining.intersection(nodes) - own.keys():
                own[node] = len(mesh.points)
                mesh.points.append(mesh.points[node])
            mesh.cells[index] = volume, [own.get(node, node) for node in nodes]
    mesh.faces = [(name, [own.get(node, node) for node in nodes] if name == f"{pad}_front" else nodes) for name, nodes in mesh.faces]


def bonded_brake(pad_parts=None):
    """Brake with separately meshed backplates and named faces for ties. `pad_parts`: divisions of nonmatching backplates."""
    mesh = brake(backplate_parts=pad_parts, has_bond=True)
    if pad_parts is None:
        for pad in ("pad_outer", "pad_inner"):
            part_pad(mesh, pad)
    return mesh


TIED = "Contact/Tied=pad_outer_lining_back / pad_outer_front; pad_inner_lining_back / pad_inner_front"


class Tetrahedra(ProgramTest):
    """Brake of quadratic tetrahedra; the meshes of pads and disc do not match."""

    def write_brake(self, mesh, name="brake"):
        mesh.write_msh(self.folder / f"{name}.msh")
        (self.folder / f"{name}.prm").write_text(BRAKE.format(file=f"{name}.msh"), encoding="utf-8")
        return f"{name}.prm"

    def test_symmetries(self):
        expected = eigenvalues(self.shared(file=self.write_brake(brake())))
        self.assertGreaterEqual(sum(value.real > 1 for value in expected), 2)
        negative = "Operation/Rotation=negative"
        for name, mesh, *overrides in (("turned", brake().moved(turned(0.7))), ("renumbered", brake().renumbered(1)),
                                       ("mirrored", brake().moved(lambda x, y, z: (x, -y, z)), negative)):
            with self.subTest(name):
                self.assert_same_eigenvalues(eigenvalues(self.run_scene(f"out_{name}", *overrides, file=self.write_brake(mesh))), expected)
        several = self.run_scene("out_3", file=self.write_brake(brake()), n_processes=3)
        self.assert_same_eigenvalues(eigenvalues(several), expected)

    def test_tied_backplates(self):
        expected = eigenvalues(self.shared(file=self.write_brake(brake())))
        file = self.write_brake(bonded_brake(), "bonded")
        for n_processes in (1, 2):
            with self.subTest(n_processes=n_processes):
                tied = self.run_scene(f"out_tied_{n_processes}", TIED, "Output/Mode shapes=unstable", file=file, n_processes=n_processes)
                self.assert_same_eigenvalues(eigenvalues(tied), expected)
        # Pads guided in the plane of their backs and pressed along the axis
        pressed = ("Steady sliding/Contact state=steady sliding", "Steady sliding/Control=pressure", "Operation/Radial dissipation=consistent",
                   "Steady sliding/Pressed faces=pad_outer_back, pad_inner_back",
                   "Mounts/Elastic mounts=disc_hub: 1e12, 1e12, 1e12; pad_outer_back: 2e10, 2e10, 0; pad_inner_back: 2e10, 2e10, 0")
        self.assert_same_eigenvalues(*(eigenvalues(self.run_scene(f"out_pressed_{name}", *pressed, *tied, file=f"{name}.prm"))
                                       for name, tied in (("brake", ()), ("bonded", (TIED,)))))
        # Nonmatching faces give only similar eigenvalues, because both meshes are coarse
        other = eigenvalues(self.run_scene("out_other", TIED, file=self.write_brake(bonded_brake(5), "bonded_5")))
        self.assertEqual(len(other), len(expected))
        self.assert_same_eigenvalues(other, expected, 0.02)

    def test_two_discs(self):
        pairs = "Contact/Pairs=rear_face / pad_rear; front_face / pad_front"
        held = "Mounts/Elastic mounts=disc_rear_hub: 1e12, 1e12, 1e12; disc_front_hub: {0}, {0}, {0}; pad_back: 2e10, 2e10, 2e10".format
        volumes = "Materials/Volumes="
        file = self.write_brake(clutch(), "clutch")
        values = eigenvalues(self.run_scene("out_clutch", pairs, held("1e12"), volumes, file=file))
        # Mirroring the model in the plane between the discs does not change the eigenvalues
        mirrored = self.write_brake(clutch().moved(lambda x, y, z: (x, y, -z)), "mirrored")
        self.assert_same_eigenvalues(eigenvalues(self.run_scene("out_mirrored", pairs, held("1e12"), volumes, file=mirrored)), values)
        other = eigenvalues(self.run_scene("out_soft", pairs, held("1e11"), volumes, file=file))
        self.assertGreater(max(abs(a - b) for a, b in zip(values, other)), 1)
        loose = clutch()
        loose.faces = [face for face in loose.faces if face[0] != "disc_front_hub"]
        self.dry_run_refused(["'disc' consists of 2 disconnected pieces", "if they are discs"], pairs, held("1e12").replace("disc_front_hub: 1e12, 1e12, 1e12; ", ""),
                             volumes, file=self.write_brake(loose, "loose"))

    def test_ties_that_are_refused(self):
        file = self.write_brake(bonded_brake(), "bonded")
        for mentions, *overrides in (
                (["'pad_outer_lining_back' is not used", "Contact/Tied"],),
                (["`pad_outer_face`", "Contact/Pairs"], "Contact/Tied=pad_outer_face / pad_outer_front"),
                (["'pad_inner_fronts'", "Contact/Tied"], TIED + "s"),
                (["`pad_outer_front` is not a pair"], "Contact/Tied=pad_outer_front")):
            with self.subTest(mentions):
                self.dry_run_refused(mentions, *overrides, file=file)
        apart = bonded_brake(5).moved(lambda x, y, z: (x, y, z + 0.05), lambda volume: volume == "pad_outer_backplate")
        self.dry_run_refused(["overlap by 0 m", "surfaces pad_outer_lining_back and pad_outer_front"], TIED, file=self.write_brake(apart, "apart"))

    def test_refusals(self):
        def spoiled(change):
            mesh = brake()
            change(mesh)
            return mesh

        def middle_at(part, beside=0.0):
            """Moves the mid-side node of the last element's first edge to the fraction `part`, shifted by `beside` in x, y and z."""
            def change(mesh):
                nodes = mesh.cells[-1][1]
                first, last = mesh.points[nodes[0]], mesh.points[nodes[1]]
                mesh.points[nodes[4]] = tuple(a + part * (b - a) + beside for a, b in zip(first, last))
            return change

        def pad(place):
            return lambda mesh: mesh.moved(place, lambda volume: volume.startswith("pad_outer"))

        def without(*names):
            def change(mesh):
                mesh.faces = [face for face in mesh.faces if face[0] not in names]
            return change

        def parted(of_nodes):
            return lambda mesh: part_pad(mesh, "pad_outer", of_nodes)

        def with_corner(value):
            def change(mesh):
                mesh.points[mesh.cells[0][1][0]] = (value, 0.0, 0.0)
            return change

        def nothing(mesh):
            pass

        outer, inner, hub = "disc_top / pad_outer_face", "disc_bottom / pad_inner_face", "disc_hub: 1e12, 1e12, 1e12"
        pairs = "Contact/Pairs={}; {}".format
        held = "Mounts/Elastic mounts={}; {}: 0, 0, 2e10; {}: 0, 0, 2e10".format
        between = "surfaces disc_top and pad_outer_face"
        for change, mentions, *overrides in (
                (middle_at(0.5, 0.05), ["1 second-order node", "than half its length", "'pad_inner_backplate'"]),
                (middle_at(0.1), ["folded by second-order nodes"]),
                (parted(slice(4, 10)), ["second-order nodes differ from", "merge"]),
                (parted(slice(0, 10)), ["'pad_outer_lining' is not held", "merge"]),
                (with_corner(math.nan), ["not a finite number"]),
                (with_corner(math.inf), ["not a finite number"]),
                (pad(lambda x, y, z: (x, y, z + 0.05)), ["overlap by 0 m", between, "gap below"]),
                (pad(lambda x, y, z: (1.5 * x, 1.5 * y, z)), ["only 5 %", "pad_outer", between, "20 %"]),
                (pad(lambda x, y, z: (x, y, z - 0.005)), ["'pad_outer' and 'disc' overlap"]),
                (pad(lambda x, y, z: (x, y, 0.012 + 0.4 * (z - 0.012))), ["do not face each other", "surfaces disc_top and pad_outer_back", "opposite"],
                 pairs("disc_top / pad_outer_back", inner), held(hub, "pad_outer_face", "pad_inner_back")),
                (nothing, ["overlap by 0 m", "surfaces disc_bottom and pad_outer_face"], pairs(f"{outer}; {inner}", "disc_bottom / pad_outer_face")),
                (nothing, ["no physical surface 'disc_topp', which is named in Contact/Pairs", "disc_top"], pairs("disc_topp / pad_outer_face", inner)),
                (nothing, ["'pad_outer_face' has a face on 'pad_outer'", "Contact/Pairs", "surface of the disc first"], pairs("pad_outer_face / disc_top", inner)),
                (nothing, ["'disc_hub' has a face on 'disc'", "Contact/Pairs"], pairs(f"{outer}; {inner}", "disc_top / disc_hub")),
                (nothing, ["'pad_outer_face' is not used", "Contact/Pairs"], pairs("disc_top / disc_bottom", inner)),
                (nothing, ["no physical surface 'disc_bub', which is named in Mounts/"], held("disc_bub: 0, 0, 1e10", "pad_outer_back", "pad_inner_back")),
                (nothing, ["no volume `pad_outer_plate`", "pad_outer_backplate"], "Materials/Volumes=pad_outer_plate: 210e9, 0.3, 7850"),
                (without("disc_top", "pad_outer_face"), ["'pad_outer' has no contact face", "Contact/Pairs"], f"Contact/Pairs={inner}"),
                (without("pad_outer_back"), ["'pad_outer' is not held", "Mounts/Elastic mounts"],
                 f"Mounts/Elastic mounts={hub}; pad_inner_back: 0, 0, 2e10"),
                (lambda mesh: mesh.cells.extend(mesh.cells[-10:]), ["Duplicates: 10 of 298 elements", "'pad_inner_backplate'"]),
                (nothing, ["second order", "quadratic"], "Discretization/Element=trilinear")):
            with self.subTest(mentions):
                self.dry_run_refused(mentions, *overrides, file=self.write_brake(spoiled(change), "spoiled"))

    def test_energy_of_contact_springs(self):
        """The relative sensitivity of a frequency to the stiffness is half the energy share of the springs."""
        def rows(stiffness):
            pairs = "Contact/Pairs={0}: 1, {2!r}; {1}: 1, {2!r}".format("disc_top / pad_outer_face", "disc_bottom / pad_inner_face", stiffness)
            results = self.run_scene(f"out_{stiffness}", pairs, "Operation/Friction coefficient=0", file=self.write_brake(brake()))
            return read_table(results / "complex_modes.csv")

        change = 1e-3
        modes, stiffer = rows(1e10), rows((1 + change) * 1e10)
        self.assertEqual(len(modes), len(stiffer))
        shares = [float(row["strain energy in contact springs [%]"]) / 100 for row in modes]
        self.assertGreater(max(shares), 0.05)
        for row, other, share in zip(modes, stiffer, shares):
            self.assertAlmostEqual(sum(float(value) for name, value in row.items() if name.startswith("strain energy")), 100, places=6)
            self.assertAlmostEqual(float(other["frequency [Hz]"]) / float(row["frequency [Hz]"]) - 1, share * change / 2, delta=1e-3 * change)

    def test_difference_from_a_coarser_mesh(self):
        """If a counterpart is found by shape, the estimated error is the difference between two runs."""
        coarse, fine = (self.write_brake(brake(n_parts), f"brake_{n_parts}") for n_parts in (12, 16))
        found, expected = (read_table(self.run_scene(f"out_{file}", *overrides, file=file) / "complex_modes.csv")
                           for file, overrides in ((fine, ["Discretization/Coarser mesh=brake_12.msh"]), (coarse, ["Band/Maximum frequency=5250"])))
        frequencies = [float(row["frequency [Hz]"]) for row in expected]
        n_alone = 0
        for row in found:
            frequency, error = (row[name] for name in ("frequency [Hz]", "estimated frequency error by the mesh [%]"))
            self.assertEqual(row["counterpart on the coarser mesh"] == "none", error == "")
            if row["counterpart on the coarser mesh"] == "by shape":
                n_alone += 1
                differences = [100 * abs(other / float(frequency) - 1) for other in frequencies]
                self.assertLess(min(abs(difference - float(error)) for difference in differences), 1e-6)
        self.assertGreater(n_alone, len(found) / 2)
        self.assertNotIn("converged [-]", found[0])
        self.run_scene("again", file=self.folder / f"out_{fine}" / "parameters.prm")

    def test_notes(self):
        fine = brake(n_parts=60, n_rings=8, pad_parts=2)
        for mesh, note in ((brake().moved(lambda x, y, z: (x, y, z + 0.002), lambda volume: volume.startswith("pad_outer")), "up to 0.002 m"),
                           (fine, "pad_outer_face are up to")):
            with self.subTest(note):
                process = self.dry_run(file=self.write_brake(mesh, "noted"))
                self.assertEqual((process.returncode, process.stderr), (0, ""))
                self.assertIn(note, process.stdout)
                self.assertNotIn("warning", process.stdout)  # in particular none about the roundness of triangulated faces
        script = BLOCKS + VOLUMES + SURFACES + "Mesh.Algorithm3D = 10;\n"
        self.write("blocks.geo", script)
        process = self.dry_run("Geometry/File=blocks.geo", "Mounts/Elastic mounts=")
        self.assertIn("of first order are too stiff in bending", process.stdout)
        self.assertIn("set Discretization/Element = quadratic", process.stdout)
