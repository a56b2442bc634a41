# SPDX-License-Identifier: GPL-3.0-or-later

"""Surfaces of disc and pins with the shapes of growing modes, compressed for a page."""

import base64

import numpy as np

from squeal.results import shape_files
from squeal.surface import outer_faces
from squeal.vtu_file import VtuFile

LARGEST = 12  # maximum number of modes
STEPS = 32767  # largest integer of the quantised displacements


def text_of(array, kind):
    return base64.b64encode(np.ascontiguousarray(array, dtype=kind).tobytes()).decode()


def of_growing_modes(results, modes):
    """Points, faces and displacements of the fastest growing modes; None if there are no growing modes, files or
    surfaces."""
    files = shape_files(results.folder)
    growing = [i for i, row in enumerate(modes, start=1) if row["unstable [-]"] == "1" and i in files]
    growing = sorted(sorted(growing, key=lambda i: -float(modes[i - 1]["growth rate [1/s]"]))[:LARGEST])
    if not growing:
        return None
    mesh = VtuFile(files[growing[0]])
    points, faces = mesh.points, outer_faces(mesh)
    if len(faces) == 0:
        return None
    used, numbers = np.unique(faces, return_inverse=True)
    is_disc = np.zeros(len(points), dtype=bool)
    is_disc[[corner for cell, component in zip(mesh.cells, mesh.cell_fields["component"]) if component == 0 for corner in cell]] = True
    found = {"points": text_of(points[used], "<f4"), "faces": text_of(numbers.reshape(-1), "<u4"), "disc": text_of(is_disc[used], "u1"),
             "size": float(np.ptp(points, axis=0).max()), "modes": []}
    for i in growing:
        row = modes[i - 1]
        fields = VtuFile(files[i]).fields
        parts = {part: np.round(STEPS * fields[f"displacement_{part}"][used]) for part in ("real", "imag")}
        found["modes"].append({"number": i, "label": row["label"], "frequency": float(row["frequency [Hz]"]),
                               "rate": float(row["divergence rate [%]"]), **{part: text_of(values, "<i2") for part, values in parts.items()}})
    found["leading"] = max(range(len(growing)), key=lambda k: found["modes"][k]["rate"])
    return found
