# SPDX-License-Identifier: GPL-3.0-or-later

"""Boundary faces of the bodies in a field file, and their edges, as indices of the points of the file."""

import numpy as np

from squeal.importing.mesh_shapes import faces_of
from squeal.vtu_file import SHAPES

# Faces of VTK cells; triangles repeat their last corner
FACES = {kind: [(*face, face[-1])[:4] for face in faces_of(shape)] for kind, shape in SHAPES.items() if shape != "vertex"}
SAME_PLACE = 1e-5  # distance within which points written by several processes coincide, relative to the size of the bodies


def outer_faces(mesh, bodies=None):
    """Faces that belong to one cell only (m x 4, triangles repeat their last corner), of all bodies or of the given components.

    Coincident points of the same body are merged; points of two bodies in contact are not.
    """
    points, of_cells = mesh.points, mesh.cell_fields.get("component", [0] * len(mesh.cells))
    chosen = [cell for cell, body in enumerate(of_cells) if bodies is None or body in bodies]
    body = np.zeros(len(points))
    for cell in chosen:
        body[mesh.cells[cell]] = of_cells[cell]
    places = np.round(points / (SAME_PLACE * np.ptp(points, axis=0).max()))
    _, first, number = np.unique(np.column_stack([body, places]), axis=0, return_index=True, return_inverse=True)
    cells = {kind: [mesh.cells[cell] for cell in chosen if mesh.cell_types[cell] == kind] for kind in FACES}
    none = np.zeros((0, 4), dtype=int)
    faces = first[number][np.concatenate([none, *(np.array(own)[:, FACES[kind]].reshape(-1, 4) for kind, own in cells.items() if own)])]
    keys = faces.copy()
    keys[faces[:, 2] == faces[:, 3], 3] = -1
    keys.sort(axis=1)
    _, first, count = np.unique(keys, axis=0, return_index=True, return_counts=True)
    return faces[first[count == 1]]


def sides_of(faces):
    """Ends (n x 2, ascending) of the sides of faces, and the index of the face to which each side belongs."""
    ends = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    is_side = ends[:, 0] < ends[:, 1]  # a repeated corner forms no side
    return ends[is_side], np.repeat(np.arange(len(faces)), 4)[is_side]


def edges_of(faces):
    """Ends (n x 2) of the edges of faces, and the number of faces that share each edge."""
    return np.unique(sides_of(faces)[0], axis=0, return_counts=True)


def sharp_edges(points, faces, angle=50):
    """Ends (n x 2) of the edges of a closed surface at which the normal turns by more than `angle` [degree]."""
    corners = points[faces]
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    ends, owners = sides_of(faces)
    order = np.lexsort(ends.T)  # makes the two faces of an edge adjacent in the list
    one, other = owners[order].reshape(-1, 2).T
    return ends[order][::2][abs(np.sum(normals[one] * normals[other], axis=1)) < np.cos(np.radians(angle))]
