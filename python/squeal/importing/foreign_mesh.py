# SPDX-License-Identifier: GPL-3.0-or-later

"""A mesh of another pre-processor, read from its input file or by meshio."""

import contextlib
import io
import re

import numpy as np

from squeal.errors import Error
from squeal.importing.abaqus_input import AbaqusInput
from squeal.importing.exodus_file import ExodusFile
from squeal.importing.mesh_shapes import faces_of
from squeal.importing.nastran_input import NastranInput

UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "in": 0.0254}
READERS = {".inp": AbaqusInput, **dict.fromkeys((".bdf", ".nas", ".fem", ".dat"), NastranInput), **dict.fromkeys((".e", ".exo", ".ex2"), ExodusFile)}
# Lines that identify Ansys, Fluent and Permas files, which have no fixed suffix
NOT_READ = rb"(?im)^\s*(?P<Ansys>/prep7|/com\b|nblock,)|\A\s*(?P<Fluent>\()|^\s*(?P<Permas>\$enter component|\$coor\b)"
# meshio keeps Gmsh's node order for these types; mid-face nodes are omitted, because squeal adds them
GMSH_ORDER = {"wedge18": ("wedge15", (0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11)),
              "pyramid14": ("pyramid13", (0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12))}


class ForeignMesh:
    """A mesh of another pre-processor.

    points (n x 3); elements: [(shape, nodes)], including shells and unsupported types; element_sets, node_sets: name ->
    indices; faces: name -> tuples of nodes; materials: element index -> material as in AbaqusInput; dropped:
    descriptions of omitted content."""

    def __init__(self):
        self.points, self.elements, self.dropped = np.empty((0, 3)), [], []
        self.element_sets, self.faces, self.node_sets, self.materials = {}, {}, {}, {}

    def is_solid(self, number):
        return len(faces_of(self.elements[number][0])) > 1

    def shells(self, name):
        """Corner nodes of the shells in a set of elements."""
        elements = (self.elements[number] for number in self.element_sets.get(name, []))
        return [tuple(nodes[i] for i in faces_of(shape)[0]) for shape, nodes in elements if len(faces_of(shape)) == 1]


def from_input_file(source, path):
    for what, label, nodes in [*(("element", label, nodes) for label, (_, nodes) in source.elements.items()),
                               *(("node set", name, nodes) for name, nodes in source.node_sets.items())]:
        if unknown := next((node for node in nodes if node not in source.points), None):
            raise Error(f"{what} {label} has node {unknown}, which is not in the file", path, "write all nodes to one file")
    mesh = ForeignMesh()
    mesh.points = np.array(list(source.points.values()))
    node = {label: number for number, label in enumerate(source.points)}
    element = {label: number for number, label in enumerate(source.elements)}
    mesh.elements = [(shape, [node[label] for label in nodes]) for shape, nodes in source.elements.values()]
    mesh.element_sets = {name: [element[label] for label in labels] for name, labels in source.element_sets.items()}
    mesh.node_sets = {name: [node[label] for label in labels] for name, labels in source.node_sets.items()}
    for name, sides in source.surfaces.items():
        corners = [(mesh.elements[element[label]], number) for label, number in sides]
        mesh.faces[name] = [tuple(nodes[i] for i in faces_of(shape)[number]) for (shape, nodes), number in corners]
    mesh.materials = {element[label]: material for label, material in source.materials.items()}
    mesh.dropped = source.dropped
    return mesh


def with_meshio(action, path):
    """Return value and printed output of a call to meshio."""
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said), np.errstate(all="ignore"):
            import meshio
            return action(meshio), said.getvalue().strip()
    except ImportError as error:
        raise Error(f"the Python module {error.name} is missing", path, "apt-get install python3-meshio, or install this module") from error
    except (Exception, SystemExit) as error:  # meshio's readers raise various exceptions for invalid files
        what = " ".join(f"{said.getvalue()} {error!r}".split())
        raise Error(f"meshio fails: {what}", path, "export the mesh again or in another format; check the free space") from error


def from_meshio(path):
    source, said = with_meshio(lambda meshio: meshio.read(path), path)
    mesh = ForeignMesh()
    mesh.points = np.asarray(source.points, dtype=float)
    mesh.dropped = [" ".join(said.split())] if said else []
    # Gmsh's field_data: name -> (tag, dimension)
    names = {(int(value[1]), int(value[0])): [name] for name, value in source.field_data.items() if np.size(value) == 2}
    for index, block in enumerate(source.cells):
        first = len(mesh.elements)
        shape, data = block.type, block.data
        if shape in GMSH_ORDER:
            shape, order = GMSH_ORDER[shape]
            data = data[:, order if path.suffix == ".msh" else range(len(order))]
        mesh.elements += [(shape, [int(node) for node in nodes] if faces_of(shape) else []) for nodes in data]
        members = {name: sets[index] for name, sets in source.cell_sets.items() if not name.startswith("gmsh:") and sets[index] is not None}
        for key, values in source.cell_data.items():
            values = np.asarray(values[index])
            if key != "gmsh:geometrical" and values.ndim == 1 and values.dtype.kind in "iu":
                is_set = key.endswith((":ref", ":physical")) or key in ("material", "cell_tags")
                for value in np.unique(values):
                    alone = [str(value) if is_set else f"{key}:{value}"]
                    for name in names.get((block.dim, value)) or getattr(source, "cell_tags", {}).get(value) or alone:
                        # A MED group may have several tags
                        members[name] = np.union1d(members.get(name, []), np.flatnonzero(values == value))
        for name, numbers in members.items():
            mesh.element_sets.setdefault(name, []).extend(first + int(number) for number in numbers)
    if any(not 0 <= node < len(mesh.points) for _, nodes in mesh.elements for node in nodes):
        raise Error("elements have nodes that are not in the file", path, "export all nodes")
    mesh.node_sets = {name: [int(node) for node in nodes] for name, nodes in source.point_sets.items()}
    for value, names in getattr(source, "point_tags", {}).items():
        for name in names:
            mesh.node_sets.setdefault(name, []).extend(np.flatnonzero(source.point_data["point_tags"] == value).tolist())
    return mesh


def read(path):
    with path.open("rb") as file:
        if begin := re.search(NOT_READ, file.read(100_000)):
            raise Error(f"{begin.lastgroup} meshes are not supported", path, "export .inp (Abaqus) or .bdf (Nastran) in the pre-processor")
    reader = READERS.get(path.suffix.lower())
    return from_input_file(reader(path), path) if reader else from_meshio(path)
