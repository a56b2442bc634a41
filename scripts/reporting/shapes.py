"""Surfaces of disc and pins with the shapes of growing modes, small enough for a page."""

import base64
import re

import numpy as np

from vtu_file import VtuFile

LARGEST = 12  # modes
FACES = np.array([[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])  # of VTK's hexahedron
STEPS = 32767  # of a displacement from zero to the largest one


def text_of(array, kind):
    return base64.b64encode(np.ascontiguousarray(array, dtype=kind).tobytes()).decode()


def surface(cells):
    """Quadrilaterals that belong to one cell only."""
    faces = cells[:, FACES].reshape(-1, 4)
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return faces[first[count == 1]]


def of_growing_modes(results, modes):
    """Points, faces and displacements of the modes that grow fastest; None where there is none, or no file of shapes."""
    files = {int(match[1]): path for path in sorted((results.folder / "modes").glob("complex_*.vtu"))
             if (match := re.match(r"complex_(\d+)_", path.name)) and not path.stem.endswith("_contact")}
    growing = [i for i, row in enumerate(modes, start=1) if row["unstable [-]"] == "1" and i in files]
    growing = sorted(sorted(growing, key=lambda i: -float(modes[i - 1]["growth rate [1/s]"]))[:LARGEST])
    if not growing:
        return None
    mesh = VtuFile(files[growing[0]])
    points, cells, component = np.array(mesh.points), np.array(mesh.cells), np.array(mesh.cell_fields["component"])
    faces = surface(cells)
    used, numbers = np.unique(faces, return_inverse=True)
    is_disc = np.zeros(len(points), dtype=bool)
    is_disc[cells[component == 0]] = True
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
