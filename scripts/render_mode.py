#!/usr/bin/python3
"""Draws a mode: the deformed bodies, coloured, over the outline of the undeformed ones.

    scripts/render_mode.py MODE.vtu [-o PICTURE.png] [--field FIELD] [--view VIEW]

MODE.vtu is one of the mode files of a run. The bodies are displaced by the real part of the mode. Needs no screen:
without one the script starts itself again under xvfb-run. Needs Debian's python3-vtk9, xvfb and xauth
(scripts/setup.sh pictures).
"""

import argparse
import math
import os
import pathlib
import shutil
import sys

import numpy as np

try:
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
except ImportError:
    sys.exit("VTK is missing: apt-get install python3-vtk9 (or scripts/setup.sh pictures)")

# Anchors of colour maps that are readable with every kind of colour vision: YlGnBu and RdBu of ColorBrewer, whose pale
# ends leave what is at rest pale, and twilight of Matplotlib, which is cyclic.
YELLOW_BLUE = ("ffffe5", "edf8b1", "c7e9b4", "7fcdbb", "41b6c4", "1d91c0", "225ea8", "253494", "081d58")
TWILIGHT = ("e2d9e2", "9ebbc9", "6785be", "5e43a5", "2f1436", "741e4f", "b25652", "d0a28d", "e2d9e2")
RED_BLUE = ("0a3a70", "2166ac", "4393c3", "92c5de", "d1e5f0", "f7f7f7", "fddbc7", "f4a582", "d6604d", "b2182b", "78061f")

SIZE = (1600, 1000)
OVERSAMPLING = 2
INK = (0.13, 0.13, 0.15)
LARGEST_DISPLACEMENT = 0.08  # of the size of the bodies
SHORTEST_EDGE, LARGEST_SHEAR = 0.35, 1.0  # of the length of an element edge at rest
VIEW_ANGLE = 24  # degree
MARGIN = 1.03  # around the bodies

VIEWS = {  # direction from the bodies to the eye, and what is up
    "iso": ((0.62, -0.52, 0.62), (0, 0, 1)),
    "top": ((0, 0, 1), (0, 1, 0)),
    "side": ((1, -0.08, 0.10), (0, 0, 1)),
}


def ensure_display():
    """Debian's VTK draws through X; without a screen this starts a virtual one around the script."""
    if os.environ.get("DISPLAY"):
        return
    if os.environ.get("SQUEAL_RENDER_UNDER_XVFB") or not shutil.which("xvfb-run") or not shutil.which("xauth"):
        sys.exit("There is no X display, and xvfb-run is missing: apt-get install xvfb xauth (or scripts/setup.sh pictures)")
    os.environ["SQUEAL_RENDER_UNDER_XVFB"] = "1"
    os.execvp("xvfb-run", ["xvfb-run", "-a", "-s", "-screen 0 1280x1024x24", sys.executable, *sys.argv])


def read(path):
    """The grid of a .vtu file with the vertices of a body shared by its cells again.

    deal.II writes every cell with vertices of its own, and coincident vertices of disc and pins must stay apart:
    the array `component` tells them apart. deal.II writes cell data as data of these vertices.
    """
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    if grid.GetNumberOfCells() == 0:
        sys.exit(f"{path} holds no cells.")

    points = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
    offsets = vtk_to_numpy(grid.GetCells().GetOffsetsArray())
    connectivity = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    body = np.zeros(len(points))
    if grid.GetPointData().HasArray("component"):
        body = vtk_to_numpy(grid.GetPointData().GetArray("component"))
    elif grid.GetCellData().HasArray("component"):
        component = vtk_to_numpy(grid.GetCellData().GetArray("component"))
        body[connectivity] = np.repeat(component, np.diff(offsets))
    resolution = 1e-7 * np.ptp(points, axis=0).max()
    keys = np.column_stack([body, np.round(points / resolution)]).astype(np.int64)
    _, kept, number = np.unique(keys, axis=0, return_index=True, return_inverse=True)

    merged = vtk.vtkUnstructuredGrid()
    vertices = vtk.vtkPoints()
    vertices.SetData(numpy_to_vtk(points[kept], deep=True))
    merged.SetPoints(vertices)
    cells = vtk.vtkCellArray()
    cells.SetData(numpy_to_vtkIdTypeArray(offsets.astype(np.int64), deep=True),
                  numpy_to_vtkIdTypeArray(number.reshape(-1)[connectivity].astype(np.int64), deep=True))
    merged.SetCells(grid.GetCellTypesArray(), cells)
    for i in range(grid.GetPointData().GetNumberOfArrays()):
        array = grid.GetPointData().GetArray(i)
        if array is not None:
            add_array(merged, array.GetName(), vtk_to_numpy(array)[kept])
    merged.SetFieldData(grid.GetFieldData())
    return merged


def add_array(grid, name, values):
    array = numpy_to_vtk(np.ascontiguousarray(values, dtype=float), deep=True)
    array.SetName(name)
    grid.GetPointData().AddArray(array)


def values_of(grid, name):
    if not grid.GetPointData().HasArray(name):
        names = [grid.GetPointData().GetArrayName(i) for i in range(grid.GetPointData().GetNumberOfArrays())]
        sys.exit(f"The file has no point field {name}; it has {', '.join(names)}.")
    return vtk_to_numpy(grid.GetPointData().GetArray(name)).astype(float)


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


def nice_range(values):
    """Round limits around the values: from zero, or symmetric where some are negative."""
    largest = abs(values).max() or 1.0
    unit = 10.0 ** math.floor(math.log10(largest))
    top = next(step for step in (1, 1.2, 1.6, 2, 2.4, 3, 4, 5, 6, 8, 10) if step * unit >= 0.999 * largest) * unit
    return (-top if values.min() < 0 else 0.0, top)


def colour_table(anchors, limits):
    function = vtk.vtkColorTransferFunction()
    function.SetColorSpaceToLab()
    for i, anchor in enumerate(anchors):
        red, green, blue = (int(anchor[j:j + 2], 16) / 255 for j in (0, 2, 4))
        function.AddRGBPoint(limits[0] + (limits[1] - limits[0]) * i / (len(anchors) - 1), red, green, blue)
    table = vtk.vtkLookupTable()
    table.SetNumberOfTableValues(256)
    table.SetRange(*limits)
    for i in range(256):
        table.SetTableValue(i, *function.GetColor(limits[0] + (limits[1] - limits[0]) * i / 255), 1.0)
    return table


def surface_of(grid):
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputData(grid)
    surface.SetNonlinearSubdivisionLevel(2)
    surface.Update()
    return surface.GetOutput()


def sharp_edges(surface):
    edges = vtk.vtkFeatureEdges()
    edges.SetInputData(surface)
    edges.SetFeatureAngle(50)
    edges.BoundaryEdgesOff()
    edges.NonManifoldEdgesOff()
    edges.ManifoldEdgesOff()
    edges.ColoringOff()
    edges.Update()
    return edges.GetOutput()


def displaced(polygons, scale):
    """The polygons displaced by the real part of the mode."""
    result = vtk.vtkPolyData()
    result.DeepCopy(polygons)
    displacement = vtk_to_numpy(polygons.GetPointData().GetArray("displacement_real"))
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(vtk_to_numpy(polygons.GetPoints().GetData()) + scale * displacement, deep=True))
    result.SetPoints(points)
    return result


def line_actor(polygons, colour, width, opacity):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(polygons)
    mapper.ScalarVisibilityOff()
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    mapper.SetRelativeCoincidentTopologyLineOffsetParameters(-2, -2)
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*colour)
    actor.GetProperty().SetLineWidth(width * OVERSAMPLING)
    actor.GetProperty().SetOpacity(opacity)
    actor.GetProperty().LightingOff()
    return actor


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


def text_actor(text, x, y, size, bold=False, grey=0.13):
    """Text at a place given in fractions of the window, size in pixels of the finished picture."""
    actor = vtk.vtkTextActor()
    actor.SetInput(text)
    properties = actor.GetTextProperty()
    properties.SetFontFamilyToArial()
    properties.SetFontSize(size * OVERSAMPLING)
    properties.SetBold(bold)
    properties.SetColor(grey, grey, grey)
    actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedDisplay()
    actor.GetPositionCoordinate().SetValue(x, y)
    return actor


def colour_bar(table, caption, limits, overlay):
    """A horizontal bar with ticks and labels, drawn at the lower edge of the window."""
    left, right, bottom, height = 0.03, 0.43, 0.048, 0.022
    steps = 128

    points, cells, colours = vtk.vtkPoints(), vtk.vtkCellArray(), vtk.vtkUnsignedCharArray()
    colours.SetNumberOfComponents(3)
    width, depth = SIZE[0] * OVERSAMPLING, SIZE[1] * OVERSAMPLING
    for i in range(steps):
        x = [width * (left + (right - left) * (i + k) / steps) for k in (0, 1)]
        y = [depth * bottom, depth * (bottom + height)]
        corners = [points.InsertNextPoint(a, b, 0) for a, b in ((x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1]))]
        cells.InsertNextCell(4, corners)
        colour = table.GetTableValue(min(255, int(256 * (i + 0.5) / steps)))
        colours.InsertNextTuple3(*(255 * part for part in colour[:3]))
    bar = vtk.vtkPolyData()
    bar.SetPoints(points)
    bar.SetPolys(cells)
    bar.GetCellData().SetScalars(colours)
    mapper = vtk.vtkPolyDataMapper2D()
    mapper.SetInputData(bar)
    actor = vtk.vtkActor2D()
    actor.SetMapper(mapper)
    overlay.AddActor2D(actor)

    n_ticks = 5
    for i in range(n_ticks):
        share = i / (n_ticks - 1)
        value = limits[0] + (limits[1] - limits[0]) * share
        label = text_actor(f"{value:.3g}".replace("-", "\u2212"), left + (right - left) * share, bottom - 0.012, 20)
        label.GetTextProperty().SetJustification(0 if i == 0 else 2 if i == n_ticks - 1 else 1)  # left, right, centred
        label.GetTextProperty().SetVerticalJustificationToTop()
        overlay.AddActor2D(label)
    overlay.AddActor2D(text_actor(caption, left, bottom + height + 0.014, 21))


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

    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(SIZE[0] * OVERSAMPLING, SIZE[1] * OVERSAMPLING)
    window.SetNumberOfLayers(2)

    overlay = vtk.vtkRenderer()
    overlay.SetLayer(1)
    overlay.InteractiveOff()
    page = vtk.vtkRenderer()
    page.SetBackground(1, 1, 1)
    window.AddRenderer(page)

    if view == "iso":
        direction, up = VIEWS["iso"]
        add_renderer(window, (0.02, 0.13, 0.69, 0.93), actors, direction, up)
        add_renderer(window, (0.71, 0.50, 0.99, 0.86), actors, (direction[0], direction[1], -direction[2]), up)
        add_renderer(window, (0.71, 0.13, 0.99, 0.36), actors, *VIEWS["side"])
        overlay.AddActor2D(text_actor("from below", 0.72, 0.875, 20, grey=0.35))
        overlay.AddActor2D(text_actor("from the side", 0.72, 0.375, 20, grey=0.35))
    else:
        add_renderer(window, (0.01, 0.14, 0.99, 0.93), actors, *VIEWS[view])

    window.AddRenderer(overlay)
    drawn = 1000 * scale * np.linalg.norm(displacement, axis=1).max()
    overlay.AddActor2D(text_actor(title, 0.03, 0.945, 30, bold=True))
    overlay.AddActor2D(text_actor(f"largest displacement drawn as {drawn:.3g} mm; grey lines: the bodies at rest", 0.50, 0.05, 20, grey=0.35))
    colour_bar(table, caption, limits, overlay)

    window.Render()
    grabber = vtk.vtkWindowToImageFilter()
    grabber.SetInput(window)
    grabber.ReadFrontBufferOff()
    grabber.Update()
    smaller = vtk.vtkImageResize()
    smaller.SetInputConnection(grabber.GetOutputPort())
    smaller.SetOutputDimensions(*SIZE, 1)
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(str(picture))
    writer.SetInputConnection(smaller.GetOutputPort())
    writer.Write()


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
