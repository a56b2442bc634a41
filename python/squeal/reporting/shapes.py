"""Surfaces of disc and pins with the shapes of growing modes, small enough for a page."""

import base64

import numpy as np

from squeal.results import shape_files
from squeal.vtu_file import VtuFile

LARGEST = 12  # modes
# Of VTK's cells; triangles repeat their last corner
FACES = {5: ((0, 1, 2, 2),), 9: ((0, 1, 2, 3),),
         10: ((0, 1, 2, 2), (0, 1, 3, 3), (1, 2, 3, 3), (2, 0, 3, 3)),
         12: ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
         13: ((0, 1, 2, 2), (3, 4, 5, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
         14: ((0, 1, 2, 3), (0, 1, 4, 4), (1, 2, 4, 4), (2, 3, 4, 4), (3, 0, 4, 4))}
STEPS = 32767  # of a displacement from zero to the largest one


def text_of(array, kind):
    return base64.b64encode(np.ascontiguousarray(array, dtype=kind).tobytes()).decode()


def surface(cells, types):
    """Faces that belong to one cell only, four corners each; a triangle repeats its last one."""
    faces = np.concatenate([np.array([cell for cell, of_cell in zip(cells, types) if of_cell == kind])[:, FACES[kind]].reshape(-1, 4)
                            for kind in sorted(set(types))])
    keys = faces.copy()
    keys[faces[:, 2] == faces[:, 3], 3] = -1
    keys.sort(axis=1)
    _, first, count = np.unique(keys, axis=0, return_index=True, return_counts=True)
    return faces[first[count == 1]]


def of_growing_modes(results, modes):
    """Points, faces and displacements of the modes that grow fastest; None where there is none, or no file of shapes."""
    files = shape_files(results.folder)
    growing = [i for i, row in enumerate(modes, start=1) if row["unstable [-]"] == "1" and i in files]
    growing = sorted(sorted(growing, key=lambda i: -float(modes[i - 1]["growth rate [1/s]"]))[:LARGEST])
    if not growing:
        return None
    mesh = VtuFile(files[growing[0]])
    points, faces = np.array(mesh.points), surface(mesh.cells, mesh.cell_types)
    used, numbers = np.unique(faces, return_inverse=True)
    is_disc = np.zeros(len(points), dtype=bool)
    is_disc[[corner for cell, component in zip(mesh.cells, mesh.cell_fields["component"]) if component == 0 for corner in cell]] = True
    found = {"points": text_of(points[used], "<f4"), "faces": text_of(numbers.reshape(-1), "<u4"), "disc": text_of(is_disc[used], "u1"),
             "size": float(np.ptp(points, axis=0).max()), "modes": []}
    for i in growing:
        row = modes[i - 1]
        fields = VtuFile(files[i]).fields
        parts = {part: np.round(STEPS * np.array(fields[f"displacement_{part}"])[used]) for part in ("real", "imag")}
        found["modes"].append({"number": i, "label": row["label"], "frequency": float(row["frequency [Hz]"]),
                               "rate": float(row["divergence rate [%]"]), **{part: text_of(values, "<i2") for part, values in parts.items()}})
    found["leading"] = max(range(len(growing)), key=lambda k: found["modes"][k]["rate"])
    return found
