#!/usr/bin/python3
"""Draws a field on the contact faces of the pins of one side, over the outline of the disc.

    scripts/render_contact.py RESULTS/sliding_state_contact.vtu [-o PICTURE.png] [--field FIELD] [--view VIEW]

The disc is that of sliding_state.vtu beside the file, the sliding direction that of parameters.prm. Rings mark open
nodes. Needs no screen: without one the script starts itself again under xvfb-run. Needs Debian's python3-vtk9, xvfb and
xauth (scripts/setup.sh pictures).
"""

import argparse
import dataclasses
import math
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from pictures import (INK, RED_BLUE, SIZE, YELLOW_BLUE, add_array, colour_bar, colour_table, line_actor, new_window,
                      nice_range, read, save, sharp_edges, surface_of, text_actor, values_of)

from squeal.command_line import ensure_display, exit_on_error
from squeal.errors import Error
from squeal.parameter_file import read_parameters

import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

GREY = (0.94, 0.94, 0.945)  # of the disc
VIEWPORT = (0.01, 0.15, 0.99, 0.92)
MARGIN = 1.04  # around what the picture is to show
VIEWS = {"above": 1, "below": -1}  # side of the disc from which its pins are seen


@dataclasses.dataclass
class Quantity:
    """How a field is shown: caption, its factor, and units with what one of them is in SI, smallest first."""

    caption: str
    factor: float
    units: tuple


QUANTITIES = {
    "pressure": Quantity("contact pressure", 1, (("Pa", 1), ("kPa", 1e3), ("MPa", 1e6))),
    "normal_reaction": Quantity("normal force of a node", -1, (("N", 1), ("kN", 1e3))),
    "gap": Quantity("opening", -1, (("nm", 1e-9), ("\u00b5m", 1e-6), ("mm", 1e-3))),
    "closed": Quantity("closed (1) or open (0)", 1, (("", 1),)),
    "c_b": Quantity("radial damping of a node", 1, (("N s/m", 1),)),
    "c_t": Quantity("damping of a node along the sliding", 1, (("N s/m", 1),)),
}


def in_units(field, values):
    """Values in a unit that suits the largest, with caption and unit."""
    quantity = QUANTITIES.get(field, Quantity(field.replace("_", " "), 1, (("", 1),)))
    largest = abs(values).max()
    unit, size = quantity.units[0]
    for larger in quantity.units:
        if largest >= 2 * larger[1]:
            unit, size = larger
    return quantity.factor * values / size + 0.0, quantity.caption, unit  # + 0 turns -0 into 0


def part_of(grid, points):
    """The cells of a grid whose points are all among the chosen ones."""
    ids = vtk.vtkIdTypeArray()
    for cell in range(grid.GetNumberOfCells()):
        numbers = grid.GetCell(cell).GetPointIds()
        if all(points[numbers.GetId(i)] for i in range(numbers.GetNumberOfIds())):
            ids.InsertNextValue(cell)
    node = vtk.vtkSelectionNode()
    node.SetFieldType(vtk.vtkSelectionNode.CELL)
    node.SetContentType(vtk.vtkSelectionNode.INDICES)
    node.SetSelectionList(ids)
    selection = vtk.vtkSelection()
    selection.AddNode(node)
    extract = vtk.vtkExtractSelection()
    extract.SetInputData(0, grid)
    extract.SetInputData(1, selection)
    extract.Update()
    return extract.GetOutput()


def points_of(grid):
    return vtk_to_numpy(grid.GetPoints().GetData()).astype(float)


def body_actor(polygons):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(polygons)
    mapper.ScalarVisibilityOff()
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*GREY)
    actor.GetProperty().LightingOff()
    return actor


def face_actors(faces, table):
    """Coloured faces, their elements and their rims."""
    surface = surface_of(faces)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(surface)
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("colour")
    mapper.SetLookupTable(table)
    mapper.UseLookupTableScalarRangeOn()
    mapper.InterpolateScalarsBeforeMappingOn()
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().LightingOff()

    elements = vtk.vtkExtractEdges()
    elements.SetInputData(surface)
    elements.Update()
    rims = vtk.vtkFeatureEdges()
    rims.SetInputData(surface)
    rims.BoundaryEdgesOn()
    rims.FeatureEdgesOff()
    rims.NonManifoldEdgesOff()
    rims.ManifoldEdgesOff()
    rims.ColoringOff()
    rims.Update()
    return [actor, line_actor(elements.GetOutput(), INK, 0.6, 0.2), line_actor(rims.GetOutput(), INK, 1.5, 1)]


def ring_actor(places, radius):
    """Rings around points of horizontal faces."""
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(places), deep=True))
    at = vtk.vtkPolyData()
    at.SetPoints(points)
    ring = vtk.vtkRegularPolygonSource()
    ring.SetNumberOfSides(24)
    ring.SetRadius(radius)
    ring.GeneratePolygonOff()
    glyphs = vtk.vtkGlyph3D()
    glyphs.SetInputData(at)
    glyphs.SetSourceConnection(ring.GetOutputPort())
    glyphs.ScalingOff()
    glyphs.OrientOff()
    glyphs.Update()
    return line_actor(glyphs.GetOutput(), INK, 1.2, 1)


def arrow_actor(radius, angle, length, sense, height):
    """An arrow along the circle of a radius, its middle at an angle, and the points that it covers."""
    head = 0.16 * length
    angles = angle + sense * np.linspace(-length / 2, length / 2 - 0.9 * head, 60) / radius
    points, cells = vtk.vtkPoints(), vtk.vtkCellArray()

    def add(r, phi):
        return points.InsertNextPoint(r * math.cos(phi), r * math.sin(phi), height)

    half = 0.09 * head
    for before, after in zip(angles[:-1], angles[1:]):
        corners = [add(radius - half, before), add(radius + half, before), add(radius + half, after), add(radius - half, after)]
        cells.InsertNextCell(4, corners)
    tip, base = angle + sense * length / 2 / radius, angle + sense * (length / 2 - head) / radius
    cells.InsertNextCell(3, [add(radius, tip), add(radius + 0.34 * head, base), add(radius - 0.34 * head, base)])
    arrow = vtk.vtkPolyData()
    arrow.SetPoints(points)
    arrow.SetPolys(cells)
    actor = body_actor(arrow)
    actor.GetProperty().SetColor(*INK)
    return actor, vtk_to_numpy(points.GetData())


def rotation_of(path):
    """Sense of rotation about the z axis of the run that left the file: 1 or -1."""
    for folder in path.resolve().parents[:2]:
        if (folder / "parameters.prm").is_file():
            return -1 if read_parameters(folder / "parameters.prm").get("Operation/Rotation") == "negative" else 1
    raise Error("there is no parameters.prm, which has the sliding direction", path, "name a file in a folder of results")


def look_along_the_axis(renderer, points, side, up):
    """Makes the picture of the points fill the viewport, without perspective."""
    backward = np.array([0.0, 0.0, side])
    right = np.cross(up, backward)
    x, y = points @ right, points @ up
    centre = (x.max() + x.min()) / 2 * right + (y.max() + y.min()) / 2 * up
    aspect = (VIEWPORT[2] - VIEWPORT[0]) * SIZE[0] / ((VIEWPORT[3] - VIEWPORT[1]) * SIZE[1])
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetParallelScale(MARGIN * max(np.ptp(y), np.ptp(x) / aspect) / 2)
    camera.SetFocalPoint(*centre)
    camera.SetPosition(*(centre + backward))
    camera.SetViewUp(*up)
    renderer.ResetCameraClippingRange()


def draw(path, picture, field, view, title):
    """Draws the field of the contact file `path` into the file `picture`; title may be None."""
    bodies_path = path.with_name(path.name.replace("_contact.vtu", ".vtu"))
    if bodies_path == path or not bodies_path.is_file():
        raise Error("there is no file of disc and pins", path, "name a contact file NAME_contact.vtu next to NAME.vtu")
    side, sense = VIEWS[view], rotation_of(path)
    faces = read(path)
    values, caption, unit = in_units(field, values_of(faces, field))
    add_array(faces, "colour", values)
    # Colours of both sides are the same.
    limits = nice_range(values)
    table = colour_table(YELLOW_BLUE if values.min() >= 0 else RED_BLUE, limits)
    on_side = side * points_of(faces)[:, 2] > 0
    if not on_side.any():
        raise Error(f"no contact face is seen from {view}", path, "choose another --view")
    faces = part_of(faces, on_side)
    places = points_of(faces)
    shown = vtk_to_numpy(faces.GetPointData().GetArray("colour"))

    bodies = read(bodies_path)
    disc = surface_of(part_of(bodies, values_of(bodies, "component") == 0))

    # Where the pins lie on one side of the axis, outwards is up, and the picture shows the disc's width there.
    distances = np.hypot(places[:, 0], places[:, 1])
    centre = places.mean(axis=0)
    eccentricity = math.hypot(centre[0], centre[1])
    if eccentricity > 0.3 * distances.max():
        up = np.array([centre[0], centre[1], 0]) / eccentricity
        radii = np.hypot(points_of(disc)[:, 0], points_of(disc)[:, 1])
        around = np.outer([radii.min(), radii.max()], up)
    else:
        up, around = np.array([0.0, 1.0, 0.0]), points_of(disc)
    extent = np.ptp(places, axis=0)[:2].max()
    height = side * (abs(points_of(bodies)[:, 2]).max() + 0.1 * extent)
    arrow, covered = arrow_actor(distances.max() + 0.06 * extent, math.atan2(up[1], up[0]), 0.35 * extent, sense, height)

    window, overlay = new_window()
    renderer = vtk.vtkRenderer()
    renderer.SetViewport(*VIEWPORT)
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(body_actor(disc))
    renderer.AddActor(line_actor(sharp_edges(disc), (0.45, 0.45, 0.48), 1.2, 1))
    # Faces lie in the disc's; nothing is foreshortened, so that they may be lifted.
    lifted = face_actors(faces, table)
    is_open = values_of(faces, "closed") == 0
    if is_open.any():
        lifted.append(ring_actor(places[is_open], 0.007 * extent))
    for layer, actor in enumerate(lifted):
        actor.SetPosition(0, 0, side * 1e-3 * extent * (layer + 1))
        renderer.AddActor(actor)
    renderer.AddActor(arrow)
    window.AddRenderer(renderer)

    label = text_actor("sliding of the disc", 0, 0, 20)
    label.GetPositionCoordinate().SetCoordinateSystemToWorld()
    label.GetPositionCoordinate().SetValue(*((distances.max() + 0.06 * extent + 0.022 * extent) * up))
    label.GetTextProperty().SetJustificationToCentered()
    renderer.AddActor2D(label)
    above_label = (distances.max() + 0.13 * extent) * up
    look_along_the_axis(renderer, np.vstack([places, covered, above_label, around]), side, up)

    which = "upper" if side > 0 else "lower"
    title = title or f"{caption[0].upper()}{caption[1:]} on the {which} pins, seen from {view}"
    overlay.AddActor2D(text_actor(title, 0.03, 0.945, 30, bold=True))
    colour_bar(table, f"{caption} [{unit}]" if unit else caption, limits, overlay)
    note = f"largest {shown.max():.3g} {unit}, smallest {shown.min():.3g} {unit}"
    if is_open.any():
        note += f";  rings: {is_open.sum()} open nodes of {len(places)}"
    overlay.AddActor2D(text_actor(note, 0.50, 0.05, 20, grey=0.35))
    save(window, overlay, picture)


@exit_on_error()
def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("contact", metavar="CONTACT.vtu", type=pathlib.Path)
    parser.add_argument("-o", "--output", metavar="PICTURE.png", type=pathlib.Path, help="(default: CONTACT.png beside CONTACT.vtu)")
    parser.add_argument("--field", default="pressure", help=", ".join(QUANTITIES) + " or another point field (default: %(default)s)")
    parser.add_argument("--view", choices=tuple(VIEWS), default="above", help="(default: %(default)s)")
    parser.add_argument("--title", help="(default: field and side)")
    arguments = parser.parse_args()
    if not arguments.contact.is_file():
        raise Error(f"there is no file {arguments.contact}", "CONTACT.vtu", "name a file of results")
    ensure_display("pictures")
    picture = arguments.output or arguments.contact.with_suffix(".png")
    draw(arguments.contact, picture, arguments.field, arguments.view, arguments.title)
    print(picture)


if __name__ == "__main__":
    main()
