"""What the scripts that draw results have in common: reading a field file, colours, lines, texts, and the finished picture.

Needs Debian's python3-vtk9, xvfb and xauth (scripts/setup.sh pictures).
"""

import math
import sys

import numpy as np

from squeal.errors import Error

try:
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
except ImportError:
    sys.exit(f'error: {Error("VTK is missing", "vtk", "apt-get install python3-vtk9 (or scripts/setup.sh pictures)")}')

# Anchors of colour maps that are readable with every kind of colour vision: YlGnBu and RdBu of ColorBrewer, whose pale
# ends leave what is at rest pale, and twilight of Matplotlib, which is cyclic.
YELLOW_BLUE = ("ffffe5", "edf8b1", "c7e9b4", "7fcdbb", "41b6c4", "1d91c0", "225ea8", "253494", "081d58")
TWILIGHT = ("e2d9e2", "9ebbc9", "6785be", "5e43a5", "2f1436", "741e4f", "b25652", "d0a28d", "e2d9e2")
RED_BLUE = ("0a3a70", "2166ac", "4393c3", "92c5de", "d1e5f0", "f7f7f7", "fddbc7", "f4a582", "d6604d", "b2182b", "78061f")

SIZE = (1600, 1000)
OVERSAMPLING = 2
INK = (0.13, 0.13, 0.15)


def grid_of(points, offsets, connectivity):
    """An unstructured grid of these points, and the cells that it has still to be given with their types."""
    grid = vtk.vtkUnstructuredGrid()
    vertices = vtk.vtkPoints()
    vertices.SetData(numpy_to_vtk(np.ascontiguousarray(points, dtype=float), deep=True))
    grid.SetPoints(vertices)
    cells = vtk.vtkCellArray()
    cells.SetData(numpy_to_vtkIdTypeArray(offsets.astype(np.int64), deep=True),
                  numpy_to_vtkIdTypeArray(connectivity.astype(np.int64), deep=True))
    return grid, cells


def read(path):
    """The grid of a field file (.vtu) with a point field `component`, and with the vertices of a body shared by its cells.

    Every process writes its cells with vertices of its own, and coincident vertices of disc and pins must stay apart:
    the array `component` tells them apart.
    """
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    if grid.GetNumberOfCells() == 0:
        raise Error("the file holds no cells", path, "name a file of fields")

    points = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
    offsets = vtk_to_numpy(grid.GetCells().GetOffsetsArray())
    connectivity = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    body = np.zeros(len(points))
    if grid.GetPointData().HasArray("component"):
        body = vtk_to_numpy(grid.GetPointData().GetArray("component"))
    elif grid.GetCellData().HasArray("component"):
        component = vtk_to_numpy(grid.GetCellData().GetArray("component"))
        body[connectivity] = np.repeat(component, np.diff(offsets))
    resolution = 1e-5 * np.ptp(points, axis=0).max()
    keys = np.column_stack([body, np.round(points / resolution)]).astype(np.int64)
    _, kept, number = np.unique(keys, axis=0, return_index=True, return_inverse=True)

    merged, cells = grid_of(points[kept], offsets, number.reshape(-1)[connectivity])
    merged.SetCells(grid.GetCellTypesArray(), cells)
    for i in range(grid.GetPointData().GetNumberOfArrays()):
        array = grid.GetPointData().GetArray(i)
        if array is not None:
            add_array(merged, array.GetName(), vtk_to_numpy(array)[kept])
    if not merged.GetPointData().HasArray("component"):
        add_array(merged, "component", body[kept])
    merged.SetFieldData(grid.GetFieldData())
    return merged


def add_array(grid, name, values):
    array = numpy_to_vtk(np.ascontiguousarray(values, dtype=float), deep=True)
    array.SetName(name)
    grid.GetPointData().AddArray(array)


def values_of(grid, name):
    if not grid.GetPointData().HasArray(name):
        names = [grid.GetPointData().GetArrayName(i) for i in range(grid.GetPointData().GetNumberOfArrays())]
        raise Error(f"the file has no point field {name}", "--field", f"name one of: {', '.join(names)}")
    return vtk_to_numpy(grid.GetPointData().GetArray(name)).astype(float)


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


def colour_bar(table, caption, limits, overlay, size=SIZE):
    """A horizontal bar with ticks and labels, drawn at the lower edge of a picture of that size [pixels]."""
    left, right, bottom, height = 0.03, 0.43, 48 / size[1], 22 / size[1]
    steps = 128

    points, cells, colours = vtk.vtkPoints(), vtk.vtkCellArray(), vtk.vtkUnsignedCharArray()
    colours.SetNumberOfComponents(3)
    width, depth = size[0] * OVERSAMPLING, size[1] * OVERSAMPLING
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
        label = text_actor(f"{value:.3g}".replace("-", "\u2212"), left + (right - left) * share, bottom - 12 / size[1], 20)
        label.GetTextProperty().SetJustification(0 if i == 0 else 2 if i == n_ticks - 1 else 1)  # left, right, centred
        label.GetTextProperty().SetVerticalJustificationToTop()
        overlay.AddActor2D(label)
    overlay.AddActor2D(text_actor(caption, left, bottom + height + 14 / size[1], 21))


def new_window(size=SIZE):
    """A window without a screen for a picture of that size [pixels], white, and the layer above it for texts."""
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(size[0] * OVERSAMPLING, size[1] * OVERSAMPLING)
    window.SetNumberOfLayers(2)
    page = vtk.vtkRenderer()
    page.SetBackground(1, 1, 1)
    window.AddRenderer(page)
    overlay = vtk.vtkRenderer()
    overlay.SetLayer(1)
    overlay.InteractiveOff()
    return window, overlay


def save(window, overlay, picture, width=None):
    """Draws the window, texts last, into the file `picture`, which is as wide as the window was asked to be, or `width` pixels."""
    window.AddRenderer(overlay)
    window.Render()
    grabber = vtk.vtkWindowToImageFilter()
    grabber.SetInput(window)
    grabber.ReadFrontBufferOff()
    grabber.Update()
    smaller = vtk.vtkImageResize()
    smaller.SetInputConnection(grabber.GetOutputPort())
    full = [pixels // OVERSAMPLING for pixels in window.GetSize()]
    smaller.SetOutputDimensions(*([width, round(width * full[1] / full[0])] if width else full), 1)
    writer = vtk.vtkPNGWriter()
    writer.SetCompressionLevel(9)
    writer.SetFileName(str(picture))
    writer.SetInputConnection(smaller.GetOutputPort())
    writer.Write()
