#!/usr/bin/python3
"""Draws a mode: the deformed bodies, coloured, over the outline of the undeformed ones.

    scripts/render_mode.py MODE.vtu [-o PICTURE.png] [--field FIELD] [--view VIEW]

MODE.vtu is one of the mode files of a run. The bodies are displaced by the real part of the mode. Needs no screen:
without one the script starts itself again under xvfb-run. Needs Debian's python3-vtk9, xvfb and xauth
(scripts/setup.sh pictures).
"""

import argparse
import math
import pathlib
import sys

import numpy as np

from pictures import (INK, RED_BLUE, SIZE, TWILIGHT, YELLOW_BLUE, add_array, colour_bar, colour_table, ensure_display, line_actor,
                      new_window, nice_range, read, save, sharp_edges, surface_of, text_actor, values_of)

import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

LARGEST_DISPLACEMENT = 0.08  # of the size of the bodies
SHORTEST_EDGE, LARGEST_SHEAR = 0.35, 1.0  # of the length of an element edge at rest
VIEW_ANGLE = 24  # degree
MARGIN = 1.03  # around the bodies

VIEWS = {  # direction from the bodies to the eye, and what is up
    "iso": ((0.62, -0.52, 0.62), (0, 0, 1)),
    "top": ((0, 0, 1), (0, 1, 0)),
    "side": ((1, -0.08, 0.10), (0, 0, 1)),
}


def automatic_scale(grid, displacement):
    """Displaces by 8 % of the size of the bodies at most, and by less where elements would be drawn inside out."""
    points = vtk_to_numpy(grid.GetPoints().GetData())
    largest = np.linalg.norm(displacement, axis=1).max()
    if largest == 0:
        return 1.0
    scale = LARGEST_DISPLACEMENT * np.ptp(points, axis=0).max() / largest
    edges = vtk.vtkExtractEdges()
    edges.SetInputData(grid)
    edges.UseAllPointsOn()
    edges.Update()
    pairs = vtk_to_numpy(edges.GetOutput().GetLines().GetConnectivityArray()).reshape(-1, 2)
    sides = points[pairs[:, 1]] - points[pairs[:, 0]]
    changes = displacement[pairs[:, 1]] - displacement[pairs[:, 0]]
    squares = np.sum(sides**2, axis=1)
    shortening = (-np.sum(changes * sides, axis=1) / squares).max()
    change = (np.linalg.norm(changes, axis=1) / np.sqrt(squares)).max()
    for allowed, value in ((1 - SHORTEST_EDGE, shortening), (LARGEST_SHEAR, change)):
        if value * scale > allowed:
            scale = allowed / value
    return scale


def colour_field(grid, field):
    """Values to draw, their caption, their range and the anchors of their colour map.

    The size of a mode is arbitrary, so displacements are drawn as shares of the largest amplitude.
    """
    mode = values_of(grid, "displacement_real") + 1j * values_of(grid, "displacement_imag")
    amplitude = np.linalg.norm(mode, axis=1)
    largest = amplitude.max() or 1.0
    if field == "amplitude":
        return amplitude / largest, "amplitude, share of the largest", (0, 1), YELLOW_BLUE
    if field not in ("displacement_real", "displacement_imag", "phase"):
        values = values_of(grid, field)
        values = values if values.ndim == 1 else np.linalg.norm(values, axis=1)
        return values, field.replace("_", " "), nice_range(values), YELLOW_BLUE if values.min() >= 0 else RED_BLUE
    # The component that moves most, with its sign or phase, tells the shape.
    points = vtk_to_numpy(grid.GetPoints().GetData())
    azimuth = np.arctan2(points[:, 1], points[:, 0])
    components = {"axial": mode[:, 2],
                  "radial": mode[:, 0] * np.cos(azimuth) + mode[:, 1] * np.sin(azimuth),
                  "circumferential": mode[:, 1] * np.cos(azimuth) - mode[:, 0] * np.sin(azimuth)}
    name = max(components, key=lambda key: np.sum(abs(components[key]) ** 2))
    if field == "phase":
        return np.degrees(np.angle(components[name])), f"phase of the {name} displacement [degree]", (-180, 180), TWILIGHT
    values, part = (components[name].real, "real") if field == "displacement_real" else (components[name].imag, "imaginary")
    values = values / largest
    return values, f"{name} displacement, {part} part, share of the largest", nice_range(np.append(values, -values)), RED_BLUE


def displaced(polygons, scale):
    """The polygons displaced by the real part of the mode."""
    result = vtk.vtkPolyData()
    result.DeepCopy(polygons)
    displacement = vtk_to_numpy(polygons.GetPointData().GetArray("displacement_real"))
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(vtk_to_numpy(polygons.GetPoints().GetData()) + scale * displacement, deep=True))
    result.SetPoints(points)
    return result


def actors_of(grid, scale, table, cyclic):
    """Deformed surface, its elements, its sharp edges, and the sharp edges of the undeformed bodies."""
    rest = surface_of(grid)
    rest_edges = sharp_edges(rest)
    deformed = displaced(rest, scale)

    normals = vtk.vtkPolyDataNormals()
    normals.SetInputData(deformed)
    normals.SetFeatureAngle(50)
    normals.SplittingOn()
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(normals.GetOutputPort())
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("colour")
    mapper.SetLookupTable(table)
    mapper.UseLookupTableScalarRangeOn()
    # A phase jumps from 180 to -180 degrees, between which its colours do not jump.
    mapper.SetInterpolateScalarsBeforeMapping(not cyclic)
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    surface = vtk.vtkActor()
    surface.SetMapper(mapper)
    surface.GetProperty().SetAmbient(0.42)
    surface.GetProperty().SetDiffuse(0.62)
    surface.GetProperty().SetSpecular(0.08)
    surface.GetProperty().SetSpecularPower(20)

    elements = vtk.vtkExtractEdges()
    elements.SetInputData(deformed)
    elements.Update()
    return [surface,
            line_actor(elements.GetOutput(), INK, 0.6, 0.16),
            line_actor(displaced(rest_edges, scale), INK, 1.3, 0.9),
            line_actor(rest_edges, (0.45, 0.45, 0.48), 1.0, 0.55)]


def add_renderer(window, viewport, actors, direction, up):
    """One picture in the window: the bodies, the first of the actors, seen from a direction, fill the viewport."""
    renderer = vtk.vtkRenderer()
    renderer.SetViewport(*viewport)
    renderer.SetBackground(1, 1, 1)
    for actor in actors:
        renderer.AddActor(actor)
    window.AddRenderer(renderer)

    actors[0].GetMapper().Update()
    points = vtk_to_numpy(actors[0].GetMapper().GetInput().GetPoints().GetData()).astype(float)
    backward = np.array(direction, dtype=float) / np.linalg.norm(direction)
    right = np.cross(up, backward)
    right /= np.linalg.norm(right)
    upward = np.cross(backward, right)
    aspect = (viewport[2] - viewport[0]) * SIZE[0] / ((viewport[3] - viewport[1]) * SIZE[1])
    tangent = math.tan(math.radians(VIEW_ANGLE) / 2)

    # The eye is as far away as makes the picture of every point fit; then that picture is centred, which
    # changes the distance, so a few times over.
    centre = (points.min(axis=0) + points.max(axis=0)) / 2
    for _ in range(4):
        x, y, z = ((points - centre) @ axis for axis in (right, upward, backward))
        distance = MARGIN * max((z + abs(y) / tangent).max(), (z + abs(x) / (tangent * aspect)).max())
        for coordinate, axis in ((x, right), (y, upward)):
            picture = coordinate / (distance - z)
            centre = centre + (picture.max() + picture.min()) / 2 * distance * axis
    camera = renderer.GetActiveCamera()
    camera.SetViewAngle(VIEW_ANGLE)
    camera.SetFocalPoint(*centre)
    camera.SetPosition(*(centre + distance * backward))
    camera.SetViewUp(*up)
    renderer.ResetCameraClippingRange()

    lights = vtk.vtkLightKit()
    lights.SetKeyLightIntensity(0.68)
    lights.SetKeyLightAngle(25, 15)  # elevation, azimuth from the eye
    lights.SetKeyToHeadRatio(1.6)
    lights.SetKeyToFillRatio(2.5)
    for set_warmth in (lights.SetKeyLightWarmth, lights.SetFillLightWarmth, lights.SetHeadLightWarmth, lights.SetBackLightWarmth):
        set_warmth(0.5)  # neutral: colours are to be read
    lights.AddLightsToRenderer(renderer)


def title_of(path, grid):
    """What the file says of itself: texts and single numbers of its field data, else its name."""
    parts, fields = [], grid.GetFieldData()
    for i in range(fields.GetNumberOfArrays()):
        array, name = fields.GetAbstractArray(i), fields.GetArrayName(i)
        if array is None or array.GetNumberOfTuples() != 1 or name in ("TIME", "TimeValue", "CYCLE", "MeshName"):
            continue
        if isinstance(array, vtk.vtkStringArray):
            parts.append(array.GetValue(0))
        elif array.GetNumberOfComponents() == 1:
            parts.append(f"{name.replace('_', ' ')} {fields.GetArray(i).GetTuple1(0):.6g}")
    return ",  ".join(parts) or path.stem.replace("_", " ")


def draw(path, picture, field, scale, view, title):
    """Draws the mode in `path` into the file `picture`; scale and title may be None."""
    grid = read(path)
    title = title or title_of(path, grid)
    displacement = values_of(grid, "displacement_real")
    if scale is None:
        scale = automatic_scale(grid, displacement)
    values, caption, limits, anchors = colour_field(grid, field)
    add_array(grid, "colour", values)
    table = colour_table(anchors, limits)
    actors = actors_of(grid, scale, table, field == "phase")

    window, overlay = new_window()

    if view == "iso":
        direction, up = VIEWS["iso"]
        add_renderer(window, (0.02, 0.13, 0.69, 0.93), actors, direction, up)
        add_renderer(window, (0.71, 0.50, 0.99, 0.86), actors, (direction[0], direction[1], -direction[2]), up)
        add_renderer(window, (0.71, 0.13, 0.99, 0.36), actors, *VIEWS["side"])
        overlay.AddActor2D(text_actor("from below", 0.72, 0.875, 20, grey=0.35))
        overlay.AddActor2D(text_actor("from the side", 0.72, 0.375, 20, grey=0.35))
    else:
        add_renderer(window, (0.01, 0.14, 0.99, 0.93), actors, *VIEWS[view])

    drawn = 1000 * scale * np.linalg.norm(displacement, axis=1).max()
    overlay.AddActor2D(text_actor(title, 0.03, 0.945, 30, bold=True))
    overlay.AddActor2D(text_actor(f"largest displacement drawn as {drawn:.3g} mm; grey lines: the bodies at rest", 0.50, 0.05, 20, grey=0.35))
    colour_bar(table, caption, limits, overlay)

    save(window, overlay, picture)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mode", metavar="MODE.vtu", type=pathlib.Path)
    parser.add_argument("-o", "--output", metavar="PICTURE.png", type=pathlib.Path, help="(default: MODE.png beside MODE.vtu)")
    parser.add_argument("--field", default="displacement_real",
                        help="displacement_real, displacement_imag, amplitude, phase or another point field (default: %(default)s)")
    parser.add_argument("--scale", default="auto", help="factor of the displacement, or auto (default)")
    parser.add_argument("--view", choices=tuple(VIEWS), default="iso", help="(default: %(default)s)")
    parser.add_argument("--title", help="(default: the file's field data, or its name)")
    arguments = parser.parse_args()
    if not arguments.mode.is_file():
        sys.exit(f"There is no file {arguments.mode}.")
    try:
        scale = None if arguments.scale == "auto" else float(arguments.scale)
    except ValueError:
        parser.error(f"--scale takes a number or auto, not {arguments.scale}")
    ensure_display()
    picture = arguments.output or arguments.mode.with_suffix(".png")
    draw(arguments.mode, picture, arguments.field, scale, arguments.view, arguments.title)
    print(picture)


if __name__ == "__main__":
    main()
