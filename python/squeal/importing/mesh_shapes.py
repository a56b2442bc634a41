# SPDX-License-Identifier: GPL-3.0-or-later

"""Element shapes and their faces, shared by the mesh readers."""

import functools
import re

SOLIDS = {4: "tetra", 10: "tetra10", 6: "wedge", 15: "wedge15", 5: "pyramid", 13: "pyramid13", 8: "hexahedron", 20: "hexahedron20"}
SHELLS = {3: "triangle", 6: "triangle6", 4: "quad", 8: "quad8"}
# Corners of the faces S1, S2, ... of a shape; a shell has a single face
FACES = {
    "triangle": ((0, 1, 2),),
    "quad": ((0, 1, 2, 3),),
    "tetra": ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)),
    "wedge": ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)),
    "pyramid": ((0, 1, 2, 3), (0, 4, 1), (1, 4, 2), (2, 4, 3), (3, 4, 0)),
    "hexahedron": ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)),
}
# Edges in the order of their mid-side nodes
EDGES = {
    "tetra": ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)),
    "wedge": ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)),
    "pyramid": ((0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)),
    "hexahedron": ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)),
}


@functools.cache
def faces_of(shape):
    """Corners of the faces of an element of any order; empty for unsupported shapes."""
    return FACES.get(re.sub(r"\d+$", "", shape), ())


def middle_nodes(shape, nodes):
    """Edge (frozenset of its ends) -> mid-side node; empty for first-order elements."""
    edges = EDGES.get(re.sub(r"\d+$", "", shape), ())
    n_corners = len({corner for edge in edges for corner in edge})
    return {frozenset((nodes[a], nodes[b])): node for (a, b), node in zip(edges, nodes[n_corners:])}


def shape_of(element_type):
    """Shape and number of nodes of an Abaqus element type; 0 nodes for unsupported types. Variants such as C3D8R have
    the same nodes as the basic element, and continuum shells have the same nodes as solids."""
    if match := re.fullmatch(r"(?:C3D|SC)(\d+)[A-Z]*", element_type):
        shapes = SOLIDS
    elif match := re.fullmatch(r"(?:S|M3D|SFM3D|R3D)(\d)(?:R5?|RS|S|)", element_type):
        shapes = SHELLS
    if not match or int(match[1]) not in shapes:
        return element_type, 0
    return shapes[int(match[1])], int(match[1])


def read_text(path):
    try:
        return path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        return path.read_text(encoding="latin-1")
