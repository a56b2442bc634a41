# SPDX-License-Identifier: GPL-3.0-or-later

"""scripts/import_mesh.py: the same mesh from several pre-processors gives the same modes; omitted parts are reported."""

import itertools
import json
import pathlib
import re
import subprocess
import sys
import unittest

try:
    import meshio
except ImportError:
    meshio = None

from hex_mesh import PARAMETERS, disc_with_pads
from program import EXECUTABLE, SOURCE, ProgramTest, eigenvalues
from tet_mesh import BRAKE, brake

# Corners of the sides S1 to S6 of C3D8, counted from 0
SIDES = ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 4, 5), (1, 2, 5, 6), (2, 3, 6, 7), (0, 3, 4, 7))
SURFACES = {"disc_contact": "ROTOR_SURF", "pin_contact": "PAD_SURF", "disc_bore": "HUB"}
NAMES = {"disc": "ROTOR", "pin_top": "PAD_T", "pin_bottom": "PAD_B"}
MATERIALS = {"ROTOR": ("210000.", "0.3", "7.85e-9"), "PAD_T": ("2000.", "0.1", "2.5e-9"), "PAD_B": ("2000.", "0.1", "2.5e-9")}


def rows(numbers, per_row=10):
    numbers = list(numbers)
    return [", ".join(map(str, numbers[i:i + per_row])) for i in range(0, len(numbers), per_row)]


def abaqus(mesh):
    """Abaqus input in millimetres with contact and bore as surfaces of element faces, the backs of the pads as a node
    set, and renamed bodies."""
    lines = ["** a comment", "*NODE"] + [f"{i}, " + ", ".join(repr(1e3 * x) for x in point) for i, point in enumerate(mesh.points, 1)]
    for body, name in NAMES.items():
        lines.append(f"*Element, type=C3D8R, elset={name.lower()}")
        lines += [f"{i}, " + ", ".join(str(n + 1) for n in nodes) for i, (b, nodes) in enumerate(mesh.cells, 1) if b == body]
    sides = {}
    for (_, nodes), (number, side) in itertools.product(mesh.cells, enumerate(SIDES, 1)):
        sides.setdefault(frozenset(nodes[i] for i in side), []).append((nodes, number))
    element = {id(nodes): i for i, (_, nodes) in enumerate(mesh.cells, 1)}
    for surface, name in SURFACES.items():
        lines.append(f"*SURFACE, NAME={name}, TYPE=ELEMENT")
        for names, nodes in mesh.faces:
            if surface in names:
                (cell, number), = sides[frozenset(nodes)]
                lines.append(f"{element[id(cell)]}, S{number}")
    lines += ["*NSET, NSET=BACKS", *rows(sorted({n + 1 for names, nodes in mesh.faces if "pin_clamp" in names for n in nodes}))]
    lines += ["*ELEMENT, TYPE=SPRINGA, ELSET=SPRINGS", "9001, 1, 2"]
    for name, (modulus, ratio, density) in MATERIALS.items():
        lines += [f"*SOLID SECTION, ELSET={name}, MATERIAL=M_{name}", f"*MATERIAL, NAME=M_{name}"]
        lines += ["*ELASTIC", f"{modulus}, {ratio}", "*DENSITY", f"{density},"]
    return "\n".join(lines) + "\n"


def bulk(mesh, elements, groups):
    """Nastran cards in free format, in millimetres. `elements`: (card, name of the group, nodes). Property ids are
    numbers of groups."""
    numbers = {name: i for i, name in enumerate(groups, 1)}
    lines = ["BEGIN BULK"] + [f"GRID,{i},," + ",".join(repr(1e3 * x) for x in point) for i, point in enumerate(mesh.points, 1)]
    for i, (card, name, nodes) in enumerate(elements, 1):
        words = [card, str(i), str(numbers[name]), *(str(n + 1) for n in nodes)]
        lines += [",".join(words[:9])] + ([",".join(["+", *words[9:]])] if len(words) > 9 else [])
    return "\n".join([*lines, "ENDDATA", ""]), numbers


def nastran(mesh):
    """Nastran input with the bodies, and surfaces as shells."""
    cells = [("CHEXA", body, nodes) for body, nodes in mesh.cells]
    return bulk(mesh, cells + [("CQUAD4", name, nodes) for names, nodes in mesh.faces for name in names], [*mesh.bodies(), *mesh.surfaces()])


def assignments(numbers, mesh):
    volumes = [word for name in mesh.bodies() for word in ("--volume", f"{name}={numbers[name]}")]
    return volumes + [word for name in mesh.surfaces() for word in ("--surface", f"{name}={numbers[name]}")]


def abaqus_tetrahedra(mesh):
    """Abaqus input in millimetres with C3D10 (Gmsh swaps the last two mid-side nodes), element sets, surfaces and
    materials."""
    lines = ["*NODE"] + [f"{i}, " + ", ".join(repr(1e3 * x) for x in point) for i, point in enumerate(mesh.points, 1)]
    for volume in mesh.volumes():
        lines.append(f"*ELEMENT, TYPE=C3D10, ELSET={volume.upper()}")
        lines += [f"{i}, " + ", ".join(str(n + 1) for n in (*c[:8], c[9], c[8])) for i, (v, c) in enumerate(mesh.cells, 1) if v == volume]
    sides = {frozenset(c[i] for i in side): (i_cell, number) for i_cell, (_, c) in enumerate(mesh.cells, 1)
             for number, side in enumerate(((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)), 1)}
    for surface in mesh.surfaces():
        lines.append(f"*SURFACE, NAME={surface.upper()}")
        lines += ["{}, S{}".format(*sides[frozenset(nodes[:3])]) for name, nodes in mesh.faces if name == surface]
    for volume, (modulus, ratio, density) in TETRAHEDRA.items():
        lines += [f"*SOLID SECTION, ELSET={volume.upper()}, MATERIAL=M_{volume.upper()}", f"*MATERIAL, NAME=M_{volume.upper()}"]
        lines += ["*ELASTIC", f"{modulus}, {ratio}", "*DENSITY", f"{density},"]
    return "\n".join(lines) + "\n"


def nastran_tetrahedra(mesh):
    """Nastran input with ten-node CTETRA in the node order of Abaqus, and surfaces as CTRIA6."""
    cells = [("CTETRA", volume, (*c[:8], c[9], c[8])) for volume, c in mesh.cells]
    return bulk(mesh, cells + [("CTRIA6", *face) for face in mesh.faces], [*mesh.volumes(), *mesh.surfaces()])


# Materials of BRAKE in units of N, mm, t and s
TETRAHEDRA = {"disc": ("110000.", "0.28", "7.2e-9"), **{f"pad_{side}_{part}": material for side in ("outer", "inner") for part, material in (
    ("lining", ("5000.", "0.25", "2.6e-9")), ("backplate", ("210000.", "0.3", "7.85e-9")))}}
PAIRS = ("disc_top / pad_outer_face", "disc_bottom / pad_inner_face")
MOUNTS = ("disc_hub: 1e12, 1e12, 1e12", "pad_outer_back: 2e10, 2e10, 2e10", "pad_inner_back: 2e10, 2e10, 2e10")


@unittest.skipIf(meshio is None, "needs python3-meshio")
class Import(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.mesh = disc_with_pads()[0]
        cls.mesh.write_4(cls.folder / "original.msh")
        (cls.folder / "brake.inp").write_text(abaqus(cls.mesh), encoding="utf-8")
        cls.baseline = eigenvalues(cls.run_mesh("original"))

    @classmethod
    def run_mesh(cls, name, *overrides):
        (cls.folder / f"run_{name}.prm").write_text(PARAMETERS.format(file=f"{name}.msh", mount="disc_bore"), encoding="utf-8")
        return cls.run_scene(f"out_{name}", *overrides, file=f"run_{name}.prm")

    def imports(self, *arguments):
        return subprocess.run([sys.executable, "-B", SOURCE / "scripts" / "import_mesh.py", *arguments],
                              cwd=self.folder, text=True, capture_output=True, timeout=60)

    def imported(self, *arguments):
        process = self.imports(*arguments)
        self.assertEqual((process.returncode, process.stderr), (0, ""))
        return process.stdout

    ABAQUS = ("--volume", "disc=ROTOR", "--volume", "pin_top=PAD_T", "--volume", "pin_bottom=pad_b", "--surface", "pin_clamp=BACKS",
              *(word for name, given in SURFACES.items() for word in ("--surface", f"{name}={given}")))

    def test_abaqus(self):
        text = self.imported("brake.inp", "abaqus.msh", "--unit", "mm", *self.ABAQUS)
        for line in ("volume disc: 72 hexahedron of ROTOR", "surface disc_contact: ROTOR_SURF (faces: 6)", "left out: elements of type SPRINGA: 1"):
            self.assertIn(line, text)
        self.assert_same_eigenvalues(eigenvalues(self.run_mesh("abaqus")), self.baseline)
        stub = (self.folder / "abaqus.prm").read_text(encoding="utf-8")
        for line in ("File = abaqus.msh", "Young modulus = 2.1e+11", "Density = 7850", "pin_top: 2000000000, 0.1, 2500; pin_bottom"):
            self.assertIn(line, stub)
        self.assertIn("kg", self.call("abaqus.prm", "--dry-run", "--set", "Mounts/Elastic mounts=disc_bore: 0, 7.8e10, 1.88e10").stdout)

    def test_what_pre_processors_write(self):
        text = abaqus(self.mesh)
        part = ("*PART, NAME=P\n" + text + "*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=P-1, PART=P\n*END INSTANCE\n"
                "*ELSET, ELSET=ALL\nP-1.ROTOR\n*END ASSEMBLY\n")
        layout = text.replace(", elset=rotor", ",\n elset=rotor").lower().replace(", ", ",\t").replace("\n", "\r\n")
        ranges = text + "*ELSET, ELSET=ALL, GENERATE\n1, 999999999\n"
        for variant, left in ((layout, None), (part, None), (ranges, None), (text.replace("0.3\n", "0.3, 20.\n1., 0.3, 90.\n"), "material of disc")):
            self.write("variant.inp", variant)
            (self.folder / "variant.prm").unlink(missing_ok=True)
            self.assertIn(left or "with the materials of disc, pin_top", self.imported("variant.inp", "variant.msh", "--unit", "mm", *self.ABAQUS))
            self.assertEqual(len(meshio.read(self.folder / "variant.msh").cells[0].data), len(self.mesh.faces))

    def test_engineering_constants(self):
        """Constants refer to cylindrical axes about z or, without orientation, to x, y and z; materials with other axes are omitted."""
        constants = "*ELASTIC, TYPE=ENGINEERING CONSTANTS\n2000., 1500., 500., 0.2, 0.1, 0.15, 800., 300.\n250."
        text = abaqus(self.mesh).replace("*ELASTIC\n2000., 0.1", constants)
        for orientation, is_about_z in (("\n0., 0., 0., 0., 0., 1.\n3, 0.", True), ("\n0., 0., 0., 1., 0., 0.", False)):
            self.write("variant.inp", text.replace("ELSET=PAD_T,", "ELSET=PAD_T, ORIENTATION=O,") + f"*ORIENTATION, NAME=O, SYSTEM=CYLINDRICAL{orientation}\n")
            (self.folder / "variant.prm").unlink(missing_ok=True)
            said = self.imported("variant.inp", "variant.msh", "--unit", "mm", *self.ABAQUS)
            self.assertEqual("material of pin_top" in said, not is_about_z)
            stub = (self.folder / "variant.prm").read_text(encoding="utf-8")
            values = "2000000000, 1500000000, 500000000, 0.2, 0.1, 0.15, 800000000, 300000000, 250000000, 2500"
            self.assertIn("pin_bottom: " + values, stub)
            self.assertEqual("pin_top: " + values in stub, is_about_z)
            self.assertIn("set Axes = pin_bottom: 1, 0, 0, 0, 1, 0\n", stub)
            self.assertIn("kg", self.call("variant.prm", "--dry-run", "--set", "Mounts/Elastic mounts=disc_bore: 0, 7.8e10, 1.88e10").stdout)

    def test_names_from_a_file(self):
        names = {"unit": "mm", "volumes": {"disc": "ROTOR", "pin_top": ["PAD_T"], "pin_bottom": ["PAD_B"]}, "surfaces": {**SURFACES, "pin_clamp": ["BACKS"]}}
        yaml = "\n".join(f"{key}: {json.dumps(value)}" for key, value in names.items())
        for name, text in (("names.json", json.dumps(names)), ("names.yaml", yaml)):
            self.write(name, text)
            self.imported("brake.inp", f"{name}.msh", "--names", name)
            self.assertEqual(meshio.read(self.folder / f"{name}.msh").cells[0].data.shape, (len(self.mesh.faces), 4))

    def test_commands_of_the_page(self):
        """The commands in doc/own_geometry.md run, from an Abaqus mesh to the chart."""
        (self.folder / "build").mkdir()
        for link, target in (("scripts", SOURCE / "scripts"), ("build/release", pathlib.Path(EXECUTABLE).parent)):
            (self.folder / link).symlink_to(target)
        page = (SOURCE / "doc" / "own_geometry.md").read_text(encoding="utf-8")
        commands = re.search(r"## Meshes of other pre-processors.*?```sh\n(.*?)```", page, re.DOTALL)[1]
        process = subprocess.run(["bash", "-e", "-c", commands], cwd=self.folder, text=True, capture_output=True, timeout=300)
        self.assertEqual(process.returncode, 0, process.stdout + process.stderr)
        self.assertIn("unstable", process.stdout)
        self.assertTrue(list((self.folder / "results" / "chart" / "plots").glob("*.svg")))

    def test_formats_of_meshio(self):
        text, numbers = nastran(self.mesh)
        self.write("brake.bdf", text)
        self.mesh.write_2(self.folder / "brake_2.msh")
        for source, unit, names in (("brake.bdf", "mm", assignments(numbers, self.mesh)), ("brake_2.msh", "m", []), ("original.msh", "m", [])):
            with self.subTest(source=source):
                name = source.replace(".", "_")
                self.imported(source, f"{name}.msh", "--unit", unit, *names)
                self.assert_same_eigenvalues(eigenvalues(self.run_mesh(name)), self.baseline)

    def test_brake_of_quadratic_tetrahedra(self):
        """Two nonmatching pads with two volumes each: mesh and parameter file of the import reproduce the modes."""
        mesh = brake()
        mesh.write_msh(self.folder / "tet.msh")
        mesh.write_msh(self.folder / "tet_4.msh", "4.1")
        self.write("tet.prm", BRAKE.format(file="tet.msh"))
        baseline = eigenvalues(self.run_scene("out_tet", file="tet.prm"))
        self.assertTrue(any(value.real > 1 for value in baseline))
        self.write("tet.inp", abaqus_tetrahedra(mesh))
        text, numbers = nastran_tetrahedra(mesh)
        self.write("tet.bdf", text)
        rubs = [word for option, entries in (("--contact", PAIRS), ("--mount", MOUNTS)) for entry in entries for word in (option, entry)]
        known = [f"Disc material/{name}={value}" for name, value in (("Young modulus", 110e9), ("Poisson ratio", 0.28), ("Density", 7200))]
        known += ["Materials/Volumes=" + "; ".join(f"{name}: {values}" for name, values in (
            ("pad_outer_lining", "5e9, 0.25, 2600"), ("pad_inner_lining", "5e9, 0.25, 2600"),
            ("pad_outer_backplate", "210e9, 0.3, 7850"), ("pad_inner_backplate", "210e9, 0.3, 7850")))]
        for source, unit, names, materials in (("tet.inp", "mm", {name: name for name in numbers}, []), ("tet.bdf", "mm", numbers, known),
                                               ("tet.msh", "m", {name: name for name in numbers}, known),
                                               ("tet_4.msh", "m", {name: name for name in numbers}, known)):
            with self.subTest(source):
                name = "from_" + source.replace(".", "_")
                words = [word for volume in mesh.volumes() for word in ("--volume", f"{volume}={names[volume]}")]
                words += [word for surface in mesh.surfaces() for word in ("--surface", f"{surface}={names[surface]}")]
                self.imported(source, f"{name}.msh", "--unit", unit, *words, *rubs)
                overrides = ["Operation/Friction coefficient=0.5", "Output/Mode shapes=none", *materials]
                self.assert_same_eigenvalues(eigenvalues(self.run_scene(f"out_{name}", *overrides, file=f"{name}.prm")), baseline)
        # Without --contact and --mount, the parameter file has commented lines to be completed
        self.imported("tet.inp", "blank.msh", "--unit", "mm", *words)
        stub = (self.folder / "blank.prm").read_text(encoding="utf-8")
        for line in ("# Surfaces of the disc: disc_bottom, disc_hub, disc_top; of other bodies: pad_outer_face, ", "# set Pairs", "# set Elastic mounts",
                     "set Element = quadratic", "pad_outer_lining: 5000000000, 0.25, 2600; pad_outer_backplate: 2.1e+11, 0.3, 7850"):
            self.assertIn(line, stub)
        for option, entry in (("--contact", "disc_top / pad_face"), ("--contact", "disc_top"), ("--mount", "hub: 0, 0, 1"), ("--mount", "disc_hub: 1")):
            self.refused([f"`{entry}`", "disc_top"], "tet.inp", "refused.msh", "--unit", "mm", *words, option, entry)

    def test_lists_what_is_in_a_file(self):
        text = self.imported("brake.inp")
        for line in (f"{len(self.mesh.cells)} hexahedron", "set of elements ROTOR: 72", "set of faces ROTOR_SURF: 6", "--unit mm (0.6 m)"):
            self.assertIn(line, text)

    def refused(self, mentions, *arguments):
        self.assert_message(self.imports(*arguments), mentions)
        self.assertFalse((self.folder / "refused.msh").exists())

    def test_refusals(self):
        given = ("brake.inp", "refused.msh", "--unit", "mm")
        self.refused(["no unit of length", "--unit mm (0.6 m)"], "brake.inp", "refused.msh", *self.ABAQUS)
        self.refused(["`furlong`"], "brake.inp", "refused.msh", "--unit", "furlong", *self.ABAQUS)
        self.refused(["assigned to the disc", "PAD_B, PAD_T, ROTOR"], *given)
        self.refused(["no set of solids `ROTER`", "ROTOR"], *given, "--volume", "disc=ROTER")
        self.refused(["in volumes disc and pin_top"], *given, "--volume", "disc=ROTOR", "--volume", "pin_top=ROTOR")
        self.refused(["`disc`"], *given, "--volume", "disc")
        self.refused(["is missing"], "brakes.inp", "refused.msh")
        self.refused(["`disc` is given twice"], *given, *self.ABAQUS, "--volume", "disc=PAD_T")
        self.refused(["cannot be written"], "brake.inp", "nowhere/refused.msh", "--unit", "mm", *self.ABAQUS)
        self.refused(["cannot be written"], "original.msh", "original.msh", "--unit", "m")
        for names in ("volumes: [disc]", "volums: {disc: ROTOR}", "unit: [mm", "unit: [mm]", "volumes: {disc: ROTOR, disc: PAD_T}"):
            self.refused([], *given[:2], "--names", self.write("refused.yaml", names))
        nodes = nastran(self.mesh)[0]
        for name, content in (("broken.msh", "no mesh"), ("broken.bdf", nodes.replace("GRID,1,,", "GRID,1,5,")),
                              ("broken.bdf", nodes.replace("ENDDATA", ""))):
            self.refused([], self.write(name, content), "refused.msh", "--unit", "m", "--volume", "disc=1")
        text = abaqus(self.mesh)
        for broken, mentions in ((text.replace("*NSET", "*NODE\n1, 0., 0., 0.\n*NSET"), ["node 1 is defined twice", "parts"]),
                                 (text.replace("type=C3D8R", "type=C3D20", 1), ["*ELEMENT cannot be read", "C3D20"]),
                                 (text.replace("*NODE\n", "*NODE, SYSTEM=C\n"), ["*NODE generates or transforms"]),
                                 (text.replace("\n1, ", "\n777, ", 1), ["has node 1, which is not in the file"]),
                                 ("*INCLUDE, INPUT=nodes.inp\n" + text, ["nodes.inp", "is missing"]),
                                 (text.replace("S2", "SPOS", 1), ["side SPOS", "use one of: S1, S2"]),
                                 (text + "*SURFACE, NAME=HUB\n1, S1\n", ["surface HUB is defined twice"]),
                                 (text + "*ELSET, ELSET=MORE\nROTOR, STATOR\n", ["set MORE refers to `STATOR`"]),
                                 (text + "*NSET, NSET=HUB\nBACKS\n", ["several sets are called `HUB`"]),
                                 (text.replace("TYPE=SPRINGA, ELSET=SPRINGS", "TYPE=GK3D8, ELSET=PAD_T"), ["type GK3D8", "not supported"]),
                                 ("*PART, NAME=P\n" + text + "*END PART\n*INSTANCE, NAME=P-1, PART=P\n0., 0., 1.\n*END INSTANCE\n", ["moved"]),
                                 ("*NODE\n1, 0., 0., 0.\n", ["no supported solid elements"])):
            self.refused(mentions, self.write("broken.inp", broken), "refused.msh", "--unit", "mm", *self.ABAQUS)
