#!/usr/bin/python3
"""Draws modes: the deformed bodies, coloured, over the outline of the undeformed ones.

    scripts/render_mode.py MODE... [-o PICTURE.png] [--field FIELD] [--view VIEW] [--bodies all|moving]

MODE are files of modes of a run, `modes/NAME.vtu`: complex, real or component modes. Several of them come side by side in one picture with one scale of colours. The bodies are displaced by the real part of the mode. Needs no screen: without one the script starts
itself again under xvfb-run. Needs Debian's python3-vtk9, xvfb and xauth (scripts/setup.sh pictures).
"""

import argparse
import dataclasses
import math
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from pictures import (INK, RED_BLUE, TWILIGHT, YELLOW_BLUE, add_array, colour_bar, colour_table, line_actor, new_window, nice_range,
                      read, save, sharp_edges, surface_of, text_actor, values_of)

from squeal.command_line import ensure_display, exit_on_error
from squeal.errors import Error

import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

LARGEST_DISPLACEMENT = 0.08  # of the size of the bodies
SHORTEST_EDGE, LARGEST_SHEAR = 0.35, 1.0  # of the length of an element edge at rest
VIEW_ANGLE = 24  # degree
MANY_EDGES, FAINT, CLEAR = 2000, 0.16, 0.5  # edges of elements and their opacity, which grows where they are few
MARGIN = 1.03  # around the bodies
LEAST_MOTION = 0.01  # of the largest amplitude, below which a body is at rest
PANEL, HEAD, FOOT = (800, 500), 84, 130  # one of several modes, its title, and what stands below all of them [pixels]

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


def shape_of(grid):
    """The mode, complex; of a real mode its displacement."""
    if grid.GetPointData().HasArray("displacement_real"):
        return values_of(grid, "displacement_real") + 1j * values_of(grid, "displacement_imag")
    return values_of(grid, "displacement").astype(complex)


@dataclasses.dataclass
class Colours:
    """Values to draw with their caption and the anchors of their colour map; limits where they do not follow from the values."""

    values: np.ndarray
    caption: str
    anchors: tuple
    limits: tuple = None


def colours_of(grid, field):
    """What a field looks like. The size of a mode is arbitrary, so displacements are drawn as shares of the largest amplitude."""
    if field not in ("displacement", "displacement_real", "displacement_imag", "amplitude", "phase"):
        values = values_of(grid, field)
        values = values if values.ndim == 1 else np.linalg.norm(values, axis=1)
        return Colours(values, field.replace("_", " "), YELLOW_BLUE if values.min() >= 0 else RED_BLUE)
    mode = shape_of(grid)
    amplitude = np.linalg.norm(mode, axis=1)
    largest = amplitude.max() or 1.0
    if field == "amplitude":
        return Colours(amplitude / largest, "amplitude, share of the largest", YELLOW_BLUE, (0, 1))
    # The component that moves most, with its sign or phase, tells the shape.
    points = vtk_to_numpy(grid.GetPoints().GetData())
    azimuth = np.arctan2(points[:, 1], points[:, 0])
    components = {"axial": mode[:, 2],
                  "radial": mode[:, 0] * np.cos(azimuth) + mode[:, 1] * np.sin(azimuth),
                  "circumferential": mode[:, 1] * np.cos(azimuth) - mode[:, 0] * np.sin(azimuth)}
    name = max(components, key=lambda key: np.sum(abs(components[key]) ** 2))
    if field == "phase":
        return Colours(np.degrees(np.angle(components[name])), f"phase of the {name} displacement [degree]", TWILIGHT, (-180, 180))
    part = ", imaginary part" if field == "displacement_imag" else ", real part" if np.any(mode.imag) else ""
    values = components[name].imag if field == "displacement_imag" else components[name].real
    return Colours(values / largest, f"{name} displacement{part}, share of the largest", RED_BLUE)


def common_limits(colours):
    """Limits of the colours of several modes: symmetric where one has two signs."""
    if colours[0].limits:
        return colours[0].limits
    values = np.concatenate([one.values for one in colours])
    return nice_range(np.append(values, -values) if any(one.anchors is RED_BLUE for one in colours) else values)


def moving_bodies(grid):
    """The bodies that take part in the mode."""
    amplitude = np.linalg.norm(shape_of(grid), axis=1)
    body = values_of(grid, "component")
    moving = [number for number in np.unique(body) if amplitude[body == number].max() > LEAST_MOTION * amplitude.max()]
    first_points = vtk_to_numpy(grid.GetCells().GetConnectivityArray())[vtk_to_numpy(grid.GetCells().GetOffsetsArray())[:-1]]
    extract = vtk.vtkExtractCells()
    extract.SetInputData(grid)
    for cell in np.flatnonzero(np.isin(body[first_points], moving)):
        extract.AddCellRange(int(cell), int(cell))
    extract.Update()
    result = extract.GetOutput()
    result.SetFieldData(grid.GetFieldData())
    return result


def displaced(polygons, scale):
    """The polygons displaced by the real part of the mode."""
    result = vtk.vtkPolyData()
    result.DeepCopy(polygons)
    displacement = vtk_to_numpy(polygons.GetPointData().GetArray("shape"))
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
            line_actor(elements.GetOutput(), INK, 0.6, FAINT if elements.GetOutput().GetNumberOfCells() > MANY_EDGES else CLEAR),
            line_actor(displaced(rest_edges, scale), INK, 1.3, 0.9),
            line_actor(rest_edges, (0.45, 0.45, 0.48), 1.0, 0.55)]


def add_renderer(window, viewport, actors, view):
    """One picture in the window: the actors, seen from a direction, fill the viewport."""
    direction, up = view
    renderer = vtk.vtkRenderer()
    renderer.SetViewport(*viewport)
    renderer.SetBackground(1, 1, 1)
    for actor in actors:
        renderer.AddActor(actor)
    window.AddRenderer(renderer)

    points = []
    for actor in actors:  # deformed and at rest
        actor.GetMapper().Update()
        points.append(vtk_to_numpy(actor.GetMapper().GetInput().GetPoints().GetData()).astype(float))
    points = np.concatenate(points)
    backward = np.array(direction, dtype=float) / np.linalg.norm(direction)
    right = np.cross(up, backward)
    right /= np.linalg.norm(right)
    upward = np.cross(backward, right)
    width, height = window.GetSize()
    aspect = (viewport[2] - viewport[0]) * width / ((viewport[3] - viewport[1]) * height)
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


class Mode:
    """A mode to be drawn: its bodies with the real part of its shape, how much that is magnified, and its colours."""

    def __init__(self, path, field, scale, bodies):
        grid = read(path)
        self.grid = moving_bodies(grid) if bodies == "moving" else grid
        self.title = title_of(path, grid)
        self.displacement = shape_of(self.grid).real
        self.scale = automatic_scale(self.grid, self.displacement) if scale is None else scale
        self.colours = colours_of(self.grid, field)
        add_array(self.grid, "shape", self.displacement)
        add_array(self.grid, "colour", self.colours.values)

    def actors(self, table):
        return actors_of(self.grid, self.scale, table, self.colours.anchors is TWILIGHT)

    def drawn(self):
        """What the largest displacement is drawn as [mm]."""
        return 1000 * self.scale * np.linalg.norm(self.displacement, axis=1).max()


def draw_one(mode, picture, view, title, width):
    """Draws a mode into the file `picture`; title may be None."""
    limits = common_limits([mode.colours])
    table = colour_table(mode.colours.anchors, limits)
    actors = mode.actors(table)
    window, overlay = new_window()

    if view == "iso":
        direction, up = VIEWS["iso"]
        add_renderer(window, (0.02, 0.13, 0.69, 0.93), actors, VIEWS["iso"])
        add_renderer(window, (0.71, 0.50, 0.99, 0.86), actors, ((direction[0], direction[1], -direction[2]), up))
        add_renderer(window, (0.71, 0.13, 0.99, 0.36), actors, VIEWS["side"])
        overlay.AddActor2D(text_actor("from below", 0.72, 0.875, 20, grey=0.35))
        overlay.AddActor2D(text_actor("from the side", 0.72, 0.375, 20, grey=0.35))
    else:
        add_renderer(window, (0.01, 0.14, 0.99, 0.93), actors, VIEWS[view])

    overlay.AddActor2D(text_actor(title or mode.title, 0.03, 0.945, 30, bold=True))
    overlay.AddActor2D(text_actor(f"largest displacement drawn as {mode.drawn():.3g} mm; grey lines: the bodies at rest", 0.50, 0.05, 20,
                                  grey=0.35))
    colour_bar(table, mode.colours.caption, limits, overlay)
    save(window, overlay, picture, width)


def draw_several(modes, picture, view, width):
    """Draws modes side by side, in two columns, into the file `picture`: each says below its title what its colours are."""
    columns, rows = 2, (len(modes) + 1) // 2
    size = (columns * PANEL[0], rows * PANEL[1] + FOOT)
    limits = common_limits([mode.colours for mode in modes])
    table = colour_table(modes[0].colours.anchors, limits)
    window, overlay = new_window(size)
    for number, mode in enumerate(modes):
        left, top = number % columns / columns, 1 - number // columns * PANEL[1] / size[1]
        viewport = (left + 0.01, top - (PANEL[1] - 4) / size[1], left + 1 / columns - 0.01, top - HEAD / size[1])
        add_renderer(window, viewport, mode.actors(table), VIEWS[view])
        letter = f"({chr(ord('a') + number)})  "
        overlay.AddActor2D(text_actor(letter + mode.title, left + 0.03, top - 42 / size[1], 26, bold=True))
        what = mode.colours.caption.removesuffix(", share of the largest")
        overlay.AddActor2D(text_actor(what, left + 0.03, top - 72 / size[1], 20, grey=0.35))
    overlay.AddActor2D(text_actor("deformation magnified; grey lines: the bodies at rest", 0.50, 50 / size[1], 20, grey=0.35))
    colour_bar(table, "share of the largest" if limits[1] <= 1 else "", limits, overlay, size)
    save(window, overlay, picture, width)


@exit_on_error()
def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("modes", metavar="MODE", type=pathlib.Path, nargs="+")
    parser.add_argument("-o", "--output", metavar="PICTURE.png", type=pathlib.Path, help="(default: MODE.png beside the first MODE)")
    parser.add_argument("--field", default="displacement",
                        help="displacement (its real part), displacement_imag, amplitude, phase or another point field "
                             "(default: %(default)s)")
    parser.add_argument("--bodies", choices=("all", "moving"), default="all",
                        help="moving: only those that take part in the mode (default: %(default)s)")
    parser.add_argument("--scale", default="auto", help="factor of the displacement, or auto (default)")
    parser.add_argument("--view", choices=tuple(VIEWS), default="iso", help="(default: %(default)s)")
    parser.add_argument("--title", help="of a single mode (default: the file's field data, or its name)")
    parser.add_argument("--width", type=int, help="of the picture [pixels] (default: 1600)")
    arguments = parser.parse_args()
    for path in arguments.modes:
        if not path.is_file():
            raise Error(f"there is no file {path}", "MODE", "name a file of results")
    if arguments.title and len(arguments.modes) > 1:
        parser.error("--title is of a single mode")
    if arguments.width is not None and arguments.width < 1:
        parser.error(f"--width takes a positive number, not {arguments.width}")
    try:
        scale = None if arguments.scale == "auto" else float(arguments.scale)
    except ValueError:
        parser.error(f"--scale takes a number or auto, not {arguments.scale}")
    ensure_display("pictures")
    picture = arguments.output or arguments.modes[0].with_suffix(".png")
    modes = [Mode(path, arguments.field, scale, arguments.bodies) for path in arguments.modes]
    if len(modes) == 1:
        draw_one(modes[0], picture, arguments.view, arguments.title, arguments.width)
    else:
        draw_several(modes, picture, arguments.view, arguments.width)
    print(picture)


if __name__ == "__main__":
    main()
