"""One mesh in the formats of Gmsh: text and binary of 4.1, text of 2.2. Element types are Gmsh's: 3 quadrilaterals, 5 hexahedra."""

import pathlib
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "program"))
from mesh_file import MeshFile  # noqa: E402 (found by the line before)

TYPE = {2: 3, 3: 5}


def text_2(mesh):
    """A mesh of the program in format 2.2."""
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(mesh.names))]
    lines += [f'{dimension} {tag} "{name}"' for (dimension, tag), name in mesh.names.items()]
    lines += ["$EndPhysicalNames", "$Nodes", str(len(mesh.nodes))]
    lines += [" ".join([str(tag), *map(repr, position)]) for tag, (_, position) in mesh.nodes.items()]
    lines += ["$EndNodes", "$Elements", str(sum(len(block) for block in mesh.elements.values()))]
    for (dimension, entity), block in mesh.elements.items():
        lines += [" ".join(map(str, [element, TYPE[dimension], 2, entity, entity, *mesh.element_nodes(dimension, entity, element)]))
                  for element in block]
    return ("\n".join([*lines, "$EndElements"]) + "\n").encode()


def binary_4(mesh):
    """A mesh of the program in binary format 4.1: counts and tags of nodes and elements have eight bytes, other integers four."""
    sizes, integers, numbers = (lambda *v: struct.pack(f"={len(v)}Q", *v)), (lambda *v: struct.pack(f"={len(v)}i", *v)), (
        lambda *v: struct.pack(f"={len(v)}d", *v))
    names = "".join(f'{dimension} {tag} "{name}"\n' for (dimension, tag), name in mesh.names.items())
    data = b"$MeshFormat\n4.1 1 8\n" + integers(1) + b"\n$EndMeshFormat\n"
    data += f"$PhysicalNames\n{len(mesh.names)}\n{names}$EndPhysicalNames\n".encode()
    of_dimension = {d: [tag for dimension, tag in mesh.names if dimension == d] for d in (2, 3)}
    data += b"$Entities\n" + sizes(0, 0, len(of_dimension[2]), len(of_dimension[3]))
    for tag in of_dimension[2] + of_dimension[3]:
        data += integers(tag) + numbers(*[-1.0] * 3, *[1.0] * 3) + sizes(1) + integers(tag) + sizes(0)
    data += b"\n$EndEntities\n$Nodes\n" + sizes(1, len(mesh.nodes), 1, len(mesh.nodes)) + integers(3, of_dimension[3][0], 0)
    data += sizes(len(mesh.nodes), *mesh.nodes) + b"".join(numbers(*position) for _, position in mesh.nodes.values())
    n_elements = sum(len(block) for block in mesh.elements.values())
    data += b"\n$EndNodes\n$Elements\n" + sizes(len(mesh.elements), n_elements, 1, n_elements)
    for (dimension, entity), block in mesh.elements.items():
        data += integers(dimension, entity, TYPE[dimension]) + sizes(len(block))
        for element in block:
            data += sizes(element, *mesh.element_nodes(dimension, entity, element))
    return data + b"\n$EndElements\n"


def in_all_formats(path):
    """A mesh that the program has written, by the name of its format."""
    mesh = MeshFile(path)
    return {"text 4.1": path.read_bytes(), "text 2.2": text_2(mesh), "binary 4.1": binary_4(mesh)}
