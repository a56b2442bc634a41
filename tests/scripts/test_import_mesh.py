# SPDX-License-Identifier: GPL-3.0-or-later

"""scripts/import_mesh.py: volumes and surfaces in Exodus, MED and VTK files; unsupported formats are rejected."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

SCRIPTS = pathlib.Path(__file__).parents[2] / "scripts"
sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "program"))

from hex_mesh import disc_with_pads  # noqa: E402
from tet_mesh import brake  # noqa: E402

try:
    import h5py  # noqa: F401
    import meshio
    import netCDF4
except ImportError:
    meshio = None

BODIES = {"disc": "ROTOR", "pin_top": "PAD_T", "pin_bottom": "PAD_B"}
SURFACES = {"disc_contact": "ROTOR_SURF", "pin_contact": "PAD_SURF", "disc_bore": "HUB", "pin_clamp": "BACKS"}
# Corners of the sides of a hexahedron in Exodus, starting with side 1
EXODUS_SIDES = ((0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (0, 4, 7, 3), (0, 3, 2, 1), (4, 5, 6, 7))


def places(points, elements):
    """Names and corner positions of elements, which do not depend on numbering."""
    return {(name, frozenset(map(tuple, np.round(points[nodes], 9) + 0.0))) for name, nodes in elements}


@unittest.skipIf(meshio is None, "needs python3-meshio, python3-h5py, python3-netcdf4")
class ImportMesh(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder, cls.mesh = pathlib.Path(folder.name), disc_with_pads(8, (0, 1))[0]
        cls.points, cls.cells = np.array(cls.mesh.points), {body: np.array([nodes for b, nodes in cls.mesh.cells if b == body]) for body in BODIES}
        cls.faces = {name: np.array([nodes for names, nodes in cls.mesh.faces if name in names]) for name in SURFACES}
        cls.expected = places(cls.points, [(name, nodes) for sets in (cls.cells, cls.faces) for name, some in sets.items() for nodes in some])

    def imports(self, *arguments):
        return subprocess.run([sys.executable, "-B", SCRIPTS / "import_mesh.py", *arguments], cwd=self.folder, text=True, capture_output=True, timeout=60)

    def imported(self, file, volumes, surfaces=None):
        """The imported mesh, and (name, nodes) of its elements."""
        words = [word for option, names in (("--volume", volumes), ("--surface", surfaces or {})) for name, given in names.items()
                 for word in (option, f"{name}={given}")]
        process = self.imports(file, "imported.msh", "--unit", "m", *words)
        self.assertEqual((process.returncode, process.stderr), (0, ""), file)
        mesh = meshio.read(self.folder / "imported.msh", "gmsh")
        names = {tag: name for name, (tag, _) in mesh.field_data.items()}
        return mesh, [(names[tag], nodes) for block, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"]) for nodes, tag in zip(block.data, tags)]

    def assert_is_mesh(self, file, volumes, surfaces=SURFACES):
        mesh, elements = self.imported(file, volumes, surfaces)
        self.assertEqual((len(mesh.points), places(mesh.points, elements)), (len(self.points), self.expected), file)

    def test_exodus(self):
        """Exodus: blocks by number and by name; surfaces as node sets and side sets."""
        path = self.folder / "brake.exo"
        meshio.write(path, meshio.Mesh(self.points, [("hexahedron", nodes) for nodes in self.cells.values()],
                                       point_sets={given: np.unique(self.faces[name]) for name, given in SURFACES.items()}))
        self.assert_is_mesh(path, {body: f"block_{i}" for i, body in enumerate(self.cells)})
        sides = {frozenset(int(nodes[i]) for i in side): (element, number) for element, nodes in enumerate(np.vstack([*self.cells.values()]), 1)
                 for number, side in enumerate(EXODUS_SIDES, 1)}
        with netCDF4.Dataset(path, "a") as file:
            file.createDimension("num_side_sets", len(SURFACES))
            for kind, count, names in (("eb", "num_el_blk", BODIES.values()), ("ss", "num_side_sets", (f"S_{name}" for name in SURFACES.values()))):
                variable = file.createVariable(f"{kind}_names", "S1", (count, "len_string"))
                for i, name in enumerate(names):
                    variable[i, :len(name)] = list(name)
            file.createVariable("ss_prop1", "i4", "num_side_sets")[:] = range(1, len(SURFACES) + 1)
            for i, name in enumerate(SURFACES, 1):
                file.createDimension(f"num_side_ss{i}", len(self.faces[name]))
                members = np.array([sides[frozenset(map(int, nodes))] for nodes in self.faces[name]])
                for column, variable in enumerate(("elem", "side")):
                    file.createVariable(f"{variable}_ss{i}", "i4", f"num_side_ss{i}")[:] = members[:, column]
        self.assert_is_mesh(path, BODIES, {name: f"S_{given}" for name, given in SURFACES.items()})

    def test_med(self):
        """MED: a group may consist of several families, because a family is a combination of groups."""
        tags, families, faces = {}, {}, [(names, nodes) for names, nodes in self.mesh.faces]
        for names, given in [((body,), BODIES) for body in BODIES] + [(names, SURFACES) for names, _ in faces]:
            families[tags.setdefault(names, -1 - len(tags))] = [given[name] for name in names]
        families[-1 - len(tags)] = [BODIES["disc"], "SPOT"]
        bodies = [tags[body,] for body, _ in self.mesh.cells]
        bodies[0] = -1 - len(tags)
        backs = np.zeros(len(self.points), dtype=int)
        backs[np.unique(self.faces["pin_clamp"])] = 1
        backs[self.faces["pin_clamp"][0][0]] = 2
        mesh = meshio.Mesh(self.points, [("hexahedron", np.array([nodes for _, nodes in self.mesh.cells])), ("quad", np.array([nodes for _, nodes in faces]))],
                           point_data={"point_tags": backs}, cell_data={"cell_tags": [np.array(bodies), np.array([tags[names] for names, _ in faces])]})
        mesh.cell_tags, mesh.point_tags = families, {1: ["NODES"], 2: ["NODES", "CORNER"]}
        meshio.write(self.folder / "brake.med", mesh)
        self.assert_is_mesh("brake.med", BODIES)
        self.assert_is_mesh("brake.med", BODIES, {**SURFACES, "pin_clamp": "NODES"})

    def test_vtk(self):
        """VTK: each value of integer cell data defines a set."""
        numbers = {name: i for i, name in enumerate([*BODIES, *SURFACES], 1)}
        blocks = [("hexahedron", name, nodes) for name, nodes in self.cells.items()] + [("quad", name, nodes) for name, nodes in self.faces.items()]
        mesh = meshio.Mesh(self.points, [(shape, nodes) for shape, _, nodes in blocks],
                           cell_data={"part": [np.full(len(nodes), numbers[name]) for _, name, nodes in blocks]})
        for file in ("brake.vtk", "brake.vtu"):
            meshio.write(self.folder / file, mesh)
            self.assert_is_mesh(file, *({name: f"part:{numbers[name]}" for name in names} for names in (BODIES, SURFACES)))

    def test_quadratic_tetrahedra(self):
        """Mid-side nodes remain on their edges, also in left-handed elements."""
        source = brake(4, 1, 1)
        volumes, points = source.volumes(), np.array(source.points)
        straight = {volume: np.array([(*nodes[:8], nodes[9], nodes[8]) for v, nodes in source.cells if v == volume]) for volume in volumes}
        mirrored = np.vstack([*straight.values()])[:, [0, 2, 1, 3, 6, 5, 4, 7, 9, 8]]
        parts = [np.full(len(nodes), i) for i, nodes in enumerate(straight.values())]
        meshio.write(self.folder / "tet.exo", meshio.Mesh(points, [("tetra10", nodes) for nodes in straight.values()]))
        meshio.write(self.folder / "tet.vtk", meshio.Mesh(points, [("tetra10", nodes) for nodes in straight.values()], cell_data={"part": parts}))
        mesh = meshio.Mesh(points, [("tetra10", mirrored)], cell_data={"cell_tags": [np.concatenate(parts)]})
        mesh.cell_tags = {i: [volume] for i, volume in enumerate(volumes)}
        meshio.write(self.folder / "tet.med", mesh)
        for file, name in (("tet.exo", "block_{}"), ("tet.vtk", "part:{}"), ("tet.med", None)):
            result, elements = self.imported(file, {volume: name.format(i) if name else volume for i, volume in enumerate(volumes)})
            self.assertEqual(len(elements), len(source.cells))
            for name, nodes in elements:
                x = result.points[nodes]
                for middle, (a, b) in enumerate(((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)), 4):
                    self.assertLess(np.linalg.norm(x[middle] - (x[a] + x[b]) / 2), 0.3 * np.linalg.norm(x[a] - x[b]), file)

    def test_formats_that_are_not_read(self):
        for file, text, what in (("brake.cdb", "/COM,ANSYS RELEASE 22\n/PREP7\n", "Ansys"), ("brake.dat", "! Ansys\nnblock,3,,8\n(1i9,3e20.9e3)\n", "Ansys"),
                                 ("brake.msh", '(0 "Fluent")\n(2 3)\n', "Fluent"), ("brake.dato", "$ENTER COMPONENT NAME=DFLT_COMP\n$STRUCTURE\n$COOR\n", "Permas")):
            (self.folder / file).write_text(text, encoding="utf-8")
            process = self.imports(file)
            self.assertEqual(process.stderr, f"error: {what} meshes are not supported\n  where:  {file}\n"
                             "  change: export .inp (Abaqus) or .bdf (Nastran) in the pre-processor\n")
        for file in ("broken.exo", "broken.med", "broken.vtk"):
            (self.folder / file).write_text("no mesh", encoding="utf-8")
            self.assertIn("  change: export ", self.imports(file).stderr)


if __name__ == "__main__":
    unittest.main()
