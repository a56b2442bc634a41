"""A mode and a state of contact as squeal writes them, made without squeal: an annulus with pins on both sides.

Vertices are not shared between cells, as in deal.II's files.
"""

import itertools
import math

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray

INNER, OUTER, THICKNESS, PIN_RADIUS, PIN_HEIGHT = 0.1505, 0.3155, 0.0463, 0.0260, 0.0318
PINS = list(itertools.product((0.1970, 0.2585), np.radians([-18.4, 0.0, 18.4])))


def hexahedra(shape, position):
    """Corners (cells x 8 x 3) of a structured block: position maps [0, 1]^3 (three arrays) to space."""
    grid = np.stack(np.meshgrid(*(np.linspace(0, 1, n + 1) for n in shape), indexing="ij"))
    points = np.stack(position(*grid), axis=-1)
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    blocks = [points[i:i + shape[0], j:j + shape[1], k:k + shape[2]].reshape(-1, 3) for i, j, k in corners]
    return np.stack(blocks, axis=1)


def disc(cells):
    def position(r, theta, z):
        radius = INNER + (OUTER - INNER) * r
        return radius * np.cos(2 * math.pi * theta), radius * np.sin(2 * math.pi * theta), THICKNESS * (z - 0.5)
    return hexahedra(cells, position)


def pin(radius, angle, side, cells):
    def position(x, y, z):
        x, y = 2 * x - 1, 2 * y - 1
        return (radius * math.cos(angle) + PIN_RADIUS * x * np.sqrt(1 - y**2 / 2),
                radius * math.sin(angle) + PIN_RADIUS * y * np.sqrt(1 - x**2 / 2),
                side * (THICKNESS / 2 + PIN_HEIGHT * z))
    corners = hexahedra(cells, position)
    return corners if side > 0 else corners[:, [4, 5, 6, 7, 0, 1, 2, 3]]


def bending(points, n_diameters, turn):
    """Displacement of a disc mode A0-n turned by an angle; above and below the disc it fades out to the clamped pin ends."""
    r, theta = np.hypot(points[:, 0], points[:, 1]), np.arctan2(points[:, 1], points[:, 0]) - turn
    z = np.clip(points[:, 2], -THICKNESS / 2, THICKNESS / 2)
    profile, slope = (r - 0.6 * INNER) ** 2, 2 * (r - 0.6 * INNER)
    radial = -z * slope * np.cos(n_diameters * theta)
    around = z * profile * n_diameters / r * np.sin(n_diameters * theta)
    axial = profile * np.cos(n_diameters * theta)
    fade = 1 - np.clip((abs(points[:, 2]) - THICKNESS / 2) / PIN_HEIGHT, 0, 1)
    azimuth = np.arctan2(points[:, 1], points[:, 0])
    cosine, sine = np.cos(azimuth), np.sin(azimuth)
    return fade[:, None] * np.stack([radial * cosine - around * sine, radial * sine + around * cosine, axial], axis=1)


def write(path, n_diameters=4, disc_cells=(16, 150, 3), pin_cells=(6, 6, 4)):
    bodies = [disc(disc_cells)] + [pin(*place, side, pin_cells) for side in (1, -1) for place in PINS]
    points = np.concatenate(bodies).reshape(-1, 3)
    component = np.repeat(np.arange(len(bodies)), [len(body) for body in bodies])
    mode = bending(points, n_diameters, 0.0) + 0.3j * bending(points, n_diameters, math.pi / (2 * n_diameters))
    largest = np.abs(mode[np.arange(len(mode)), np.abs(mode).argmax(axis=1)])
    dominant = mode[np.arange(len(mode)), np.abs(mode).argmax(axis=1)]
    arrays = {"displacement_real": mode.real, "displacement_imag": mode.imag,
              "amplitude": np.where(largest > 0, np.linalg.norm(mode, axis=1), 0), "phase": np.angle(dominant)}
    write_grid(path, points, 8, vtk.VTK_HEXAHEDRON, arrays, {"component": component})


def write_real(path, n_diameters=4, disc_cells=(4, 40, 1), pin_cells=(2, 2, 2)):
    """A real mode of the disc; the pins are at rest."""
    bodies = [disc(disc_cells)] + [pin(*place, side, pin_cells) for side in (1, -1) for place in PINS]
    points = np.concatenate(bodies).reshape(-1, 3)
    component = np.repeat(np.arange(len(bodies)), [len(body) for body in bodies])
    mode = bending(points, n_diameters, 0.0)
    mode[len(bodies[0]) * 8:] = 0
    write_grid(path, points, 8, vtk.VTK_HEXAHEDRON, {"displacement": mode, "amplitude": abs(mode)}, {"component": component})


def write_contact(path, pin_cells=(6, 6, 4)):
    """Contact faces of the pins: pressure falls along the sliding in the positive sense, and the last nodes are open."""
    faces, ahead = [], []
    for side in (1, -1):
        for radius, angle in PINS:
            quadrilaterals = pin(radius, angle, side, pin_cells).reshape(-1, 4, 3)
            face = quadrilaterals[np.all(abs(abs(quadrilaterals[:, :, 2]) - THICKNESS / 2) < 1e-9, axis=1)].reshape(-1, 3)
            faces.append(face)
            ahead.append((face[:, 1] * math.cos(angle) - face[:, 0] * math.sin(angle)) / PIN_RADIUS)
    points, ahead = np.concatenate(faces), np.concatenate(ahead)
    pressure = 1e5 * np.maximum(0.9 - ahead, 0)
    gap = 1e-6 * np.minimum(0.9 - ahead, 0)
    write_grid(path, points, 4, vtk.VTK_QUAD, {"pressure": pressure, "closed": pressure > 0, "gap": gap}, {})


def write_grid(path, points, n_corners, cell_type, point_fields, cell_fields):
    """Cells that follow each other in the points."""
    n_cells = len(points) // n_corners
    grid = vtk.vtkUnstructuredGrid()
    vertices = vtk.vtkPoints()
    vertices.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    grid.SetPoints(vertices)
    cells = vtk.vtkCellArray()
    cells.SetData(numpy_to_vtkIdTypeArray(np.arange(0, n_corners * n_cells + 1, n_corners), deep=True),
                  numpy_to_vtkIdTypeArray(np.arange(n_corners * n_cells), deep=True))
    grid.SetCells(cell_type, cells)
    for data, fields in ((grid.GetPointData(), point_fields), (grid.GetCellData(), cell_fields)):
        for name, values in fields.items():
            array = numpy_to_vtk(np.ascontiguousarray(values, dtype=float), deep=True)
            array.SetName(name)
            data.AddArray(array)

    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(grid)
    writer.SetDataModeToBinary()
    writer.SetCompressorTypeToZLib()
    writer.Write()
