#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Draws modes as coloured deformed bodies over the outline of the undeformed bodies, or as points if there are no cells.

    scripts/render_mode.py MODE... [-o PICTURE] [--field FIELD] [--view VIEW] [--bodies all|moving]

Each MODE is a file `modes/NAME.vtu` of a complex, real or component mode. Several modes are drawn side by side with one
colour scale. The bodies are deformed by the real part of the mode. Without a display, the script restarts under
xvfb-run. Requires Debian's python3-vtk9, xvfb and xauth (scripts/setup.sh pictures).
"""

import dataclasses
import math
import pathlib
import sys

import numpy as np
from scipy.spatial import cKDTree

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from pictures import ONE_SIGN, PHASE, SIZE, TWO_SIGNS, Page, nice_range
from squeal.command_line import Parser, ensure_display, exit_on_error
from squeal.errors import Error
from squeal.surface import edges_of, outer_faces, sharp_edges
from squeal.vtu_file import VtuFile

with exit_on_error():
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

INK, GREY = (0.13, 0.13, 0.15), (0.45, 0.45, 0.48)
LARGEST_DISPLACEMENT = 0.08  # fraction of the size of the bodies
SHORTEST_EDGE, LARGEST_SHEAR = 0.35, 1.0  # relative to the length of an element edge at rest
VIEW_ANGLE = 24  # [degree]
MANY_EDGES, FAINT, CLEAR = 2000, 0.16, 0.5  # number of element edges, and opacity for more and for fewer edges
MARGIN = 1.03  # margin around the bodies
POINT_RADIUS = 0.35  # fraction of the distance to the nearest point
LEAST_MOTION = 0.01  # fraction of the largest amplitude below which a body is at rest
OVERSAMPLING = 2
PANEL, HEAD, FOOT = (800, 500), 84, 130  # one of several panels; heights of title and bottom area [pixels]

VIEWS = {  # direction from the bodies to the eye, and upward direction
    "iso": ((0.62, -0.52, 0.62), (0, 0, 1)),
    "top": ((0, 0, 1), (0, 1, 0)),
    "side": ((1, -0.08, 0.10), (0, 0, 1)),
}
FROM_BELOW = ((0.62, -0.52, -0.62), (0, 0, 1))


@dataclasses.dataclass
class Colours:
    """Values to draw with caption and colour map, and limits unless they follow from the values."""

    values: np.ndarray
    caption: str
    map: object
    limits: tuple = None


def colours_of(mesh, mode, field):
    """Colours of a field. Displacements are divided by the largest amplitude, because the scale of a mode is arbitrary.
    """
    if field not in ("displacement", "displacement_real", "displacement_imag", "amplitude", "phase"):
        values = mesh.field(field)
        values = values if values.ndim == 1 else np.linalg.norm(values, axis=1)
        return Colours(values, field.replace("_", " "), ONE_SIGN if values.min() >= 0 else TWO_SIGNS)
    amplitude = np.linalg.norm(mode, axis=1)
    largest = amplitude.max() or 1.0
    if field == "amplitude":
        return Colours(amplitude / largest, "amplitude, share of the largest", ONE_SIGN, (0, 1))
    # Show the dominant component, because its sign or phase reveals the shape
    azimuth = np.arctan2(*mesh.points[:, [1, 0]].T)
    components = {"axial": mode[:, 2],
                  "radial": mode[:, 0] * np.cos(azimuth) + mode[:, 1] * np.sin(azimuth),
                  "circumferential": mode[:, 1] * np.cos(azimuth) - mode[:, 0] * np.sin(azimuth)}
    name, values = max(components.items(), key=lambda item: np.sum(abs(item[1]) ** 2))
    if field == "phase":
        return Colours(np.degrees(np.angle(values)), f"phase of the {name} displacement [degree]", PHASE, (-180, 180))
    part = ", imaginary part" if field == "displacement_imag" else ", real part" if np.any(mode.imag) else ""
    values = values.imag if field == "displacement_imag" else values.real
    return Colours(values / largest, f"{name} displacement{part}, share of the largest", TWO_SIGNS)


def common_limits(colours):
    """Colour limits for several modes; symmetric if one of them has two signs."""
    if colours[0].limits:
        return colours[0].limits
    values = np.concatenate([one.values for one in colours])
    return nice_range(np.append(values, -values) if any(one.map is TWO_SIGNS for one in colours) else values)


def polygons_of(points, corners=None):
    """VTK lines or faces from points and indices of corners; without corners, points only."""
    vertices, result = vtk.vtkPoints(), vtk.vtkPolyData()
    vertices.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    result.SetPoints(vertices)
    if corners is not None:
        cells = vtk.vtkCellArray()
        cells.SetData(corners.shape[1], numpy_to_vtkIdTypeArray(np.ascontiguousarray(corners, dtype=np.int64).ravel(), deep=True))
        (result.SetLines if corners.shape[1] == 2 else result.SetPolys)(cells)
    return result


def set_scalars(data, values):
    data.GetPointData().SetScalars(numpy_to_vtk(np.ascontiguousarray(values, dtype=float), deep=True))


def actor_of(mapper, colour, **properties):
    """An actor with one colour, or coloured by a table; `properties` have VTK's names."""
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    if isinstance(colour, vtk.vtkLookupTable):
        mapper.SetLookupTable(colour)
        mapper.UseLookupTableScalarRangeOn()
    else:
        mapper.ScalarVisibilityOff()
        actor.GetProperty().SetColor(*colour)
    for name, value in properties.items():
        getattr(actor.GetProperty(), f"Set{name}")(value)
    return actor


def line_actor(points, ends, colour, width, opacity):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(polygons_of(points, ends))
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    mapper.SetRelativeCoincidentTopologyLineOffsetParameters(-2, -2)
    return actor_of(mapper, colour, LineWidth=width * OVERSAMPLING, Opacity=opacity, Lighting=False)


def colour_table(scale):
    """VTK's lookup table for a matplotlib colour scale."""
    table = vtk.vtkLookupTable()
    table.SetNumberOfTableValues(256)
    table.SetRange(*scale.get_clim())
    for i, colour in enumerate(scale.cmap(np.linspace(0, 1, 256))):
        table.SetTableValue(i, *colour)
    return table


def sphere_actor(data, radius, colour):
    sphere, mapper = vtk.vtkSphereSource(), vtk.vtkGlyph3DMapper()
    sphere.SetRadius(radius)
    sphere.SetThetaResolution(12)
    sphere.SetPhiResolution(8)
    mapper.SetInputData(data)
    mapper.SetSourceConnection(sphere.GetOutputPort())
    mapper.ScalingOff()
    return actor_of(mapper, colour)


class Mode:
    """A mode to be drawn: surfaces of bodies or points, real part of the shape, magnification and colours."""

    def __init__(self, path, field, scale, bodies):
        mesh = VtuFile(path)
        self.points, is_complex = mesh.points, "displacement_real" in mesh.fields
        shape = mesh.field("displacement_real") + 1j * mesh.field("displacement_imag") if is_complex else mesh.field("displacement").astype(complex)
        chosen = moving_bodies(mesh, shape) if bodies == "moving" else None
        self.faces = outer_faces(mesh, chosen)
        self.used = np.unique(self.faces) if len(self.faces) else np.unique(
            [cell[0] for cell, body in zip(mesh.cells, mesh.cell_fields["component"]) if chosen is None or body in chosen])
        self.title = mesh.title or path.stem.replace("_", " ")
        self.displacement = shape.real
        self.edges, _ = edges_of(self.faces)
        self.scale = self.automatic_scale() if scale is None else scale
        self.colours = colours_of(mesh, shape, field)

    def automatic_scale(self):
        """Magnification that gives displacements of 8 % of the size of the bodies, or less to limit the distortion of
        elements."""
        largest = np.linalg.norm(self.displacement[self.used], axis=1).max()
        if largest == 0:
            return 1.0
        scale = LARGEST_DISPLACEMENT * np.ptp(self.points[self.used], axis=0).max() / largest
        if len(self.faces) == 0:
            return scale
        (sides,), (changes,) = (np.diff(values[self.edges.T], axis=0) for values in (self.points, self.displacement))
        squares = np.sum(sides**2, axis=1)
        shortening = (-np.sum(changes * sides, axis=1) / squares).max()
        change = (np.linalg.norm(changes, axis=1) / np.sqrt(squares)).max()
        for allowed, value in ((1 - SHORTEST_EDGE, shortening), (LARGEST_SHEAR, change)):
            if value * scale > allowed:
                scale = allowed / value
        return scale

    def drawn(self):
        """The largest displacement in the picture [mm]."""
        return 1000 * self.scale * np.linalg.norm(self.displacement[self.used], axis=1).max()

    def actors(self, table):
        """Deformed surface, its element edges and sharp edges, and the sharp edges of the undeformed bodies; or points."""
        if len(self.faces) == 0:
            return self.point_actors(table)
        deformed, sharp = self.points + self.scale * self.displacement, sharp_edges(self.points, self.faces)
        polygons = polygons_of(deformed, self.faces)
        set_scalars(polygons, self.colours.values)
        normals = vtk.vtkPolyDataNormals()
        normals.SetInputData(polygons)
        normals.SetFeatureAngle(50)
        normals.SplittingOn()
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputConnection(normals.GetOutputPort())
        # Do not interpolate a phase, which jumps from 180 to -180 degrees: its colours are continuous there
        mapper.SetInterpolateScalarsBeforeMapping(self.colours.map is not PHASE)
        mapper.SetResolveCoincidentTopologyToPolygonOffset()
        return [actor_of(mapper, table, Ambient=0.42, Diffuse=0.62, Specular=0.08, SpecularPower=20),
                line_actor(deformed, self.edges, INK, 0.6, FAINT if len(self.edges) > MANY_EDGES else CLEAR),
                line_actor(deformed, sharp, INK, 1.3, 0.9), line_actor(self.points, sharp, GREY, 1.0, 0.55)]

    def point_actors(self, table):
        """Coloured spheres at the displaced points, and small grey spheres at the points at rest."""
        distances, _ = cKDTree(self.points[self.used]).query(self.points[self.used], k=2)
        spacing = np.median(distances[np.isfinite(distances).all(axis=1), 1]) if len(self.used) > 1 else 0.0
        spacing = spacing or 0.02 * (np.ptp(self.points[self.used], axis=0).max() or 1.0)
        moved = polygons_of((self.points + self.scale * self.displacement)[self.used])
        set_scalars(moved, self.colours.values[self.used])
        return [sphere_actor(moved, POINT_RADIUS * spacing, table),
                sphere_actor(polygons_of(self.points[self.used]), 0.4 * POINT_RADIUS * spacing, GREY)]

    def draw(self, page, place, view):
        """Draws the mode on a page within `place`: left, bottom, right and top."""
        used, axes = self.used, page.axes(*place)
        around = np.vstack([self.points[used], (self.points + self.scale * self.displacement)[used]])  # at rest and displaced
        size = [round(page.size[i] * (place[i + 2] - place[i])) for i in (0, 1)]
        axes.imshow(rendered(self.actors(colour_table(page.scale)), around, size, *view), interpolation="antialiased", aspect="auto")


def moving_bodies(mesh, shape):
    """Components of the bodies that move in the mode."""
    amplitude, largest = np.linalg.norm(shape, axis=1), {}
    for cell, body in zip(mesh.cells, mesh.cell_fields["component"]):
        largest[body] = max(largest.get(body, 0.0), amplitude[cell].max())
    return [body for body, value in largest.items() if value > LEAST_MOTION * amplitude.max()]


def rendered(actors, points, size, direction, up):
    """Pixels of the actors, seen from a direction so that `points` fill the picture."""
    renderer, window = vtk.vtkRenderer(), vtk.vtkRenderWindow()
    renderer.SetBackground(1, 1, 1)
    for actor in actors:
        renderer.AddActor(actor)
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(*(OVERSAMPLING * pixels for pixels in size))
    window.AddRenderer(renderer)

    backward = np.array(direction, dtype=float) / np.linalg.norm(direction)
    right = np.cross(up, backward)
    right /= np.linalg.norm(right)
    upward = np.cross(backward, right)
    tangent = math.tan(math.radians(VIEW_ANGLE) / 2)

    # Iterate: choose the distance at which all points fit, then centre the picture, which changes the distance
    centre = (points.min(axis=0) + points.max(axis=0)) / 2
    for _ in range(4):
        x, y, z = ((points - centre) @ axis for axis in (right, upward, backward))
        distance = MARGIN * max((z + abs(y) / tangent).max(), (z + abs(x) / (tangent * size[0] / size[1])).max())
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
    lights.SetKeyLightAngle(25, 15)  # elevation and azimuth from the eye
    lights.SetKeyToHeadRatio(1.6)
    lights.SetKeyToFillRatio(2.5)
    for set_warmth in (lights.SetKeyLightWarmth, lights.SetFillLightWarmth, lights.SetHeadLightWarmth, lights.SetBackLightWarmth):
        set_warmth(0.5)  # neutral light preserves the colours
    lights.AddLightsToRenderer(renderer)

    window.Render()
    grabber = vtk.vtkWindowToImageFilter()
    grabber.SetInput(window)
    grabber.ReadFrontBufferOff()
    grabber.Update()
    image = grabber.GetOutput()
    width, height, _ = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)[::-1]


def draw_one(mode, picture, view, width):
    """Draws a mode into the file `picture`."""
    page = Page(mode.colours.map, common_limits([mode.colours]))
    if view == "iso":
        mode.draw(page, (0.02, 0.13, 0.69, 0.93), VIEWS["iso"])
        mode.draw(page, (0.71, 0.50, 0.99, 0.86), FROM_BELOW)
        mode.draw(page, (0.71, 0.13, 0.99, 0.36), VIEWS["side"])
        page.text("from below", 0.72, 0.875)
        page.text("from the side", 0.72, 0.375)
    else:
        mode.draw(page, (0.01, 0.14, 0.99, 0.93), VIEWS[view])
    page.title(mode.title)
    page.text(f"largest displacement drawn as {mode.drawn():.3g} mm; grey: at rest", 0.50, 0.05)
    page.colour_bar(mode.colours.caption)
    page.save(picture, width)


def draw_several(modes, picture, view, width):
    """Draws modes in two columns into the file `picture`; the captions of their colours are below the titles."""
    columns, rows = 2, (len(modes) + 1) // 2
    size, limits = (columns * PANEL[0], rows * PANEL[1] + FOOT), common_limits([mode.colours for mode in modes])
    page = Page(modes[0].colours.map, limits, size)
    for number, mode in enumerate(modes):
        left, top = number % columns / columns, 1 - number // columns * PANEL[1] / size[1]
        mode.draw(page, (left + 0.01, top - (PANEL[1] - 4) / size[1], left + 1 / columns - 0.01, top - HEAD / size[1]), VIEWS[view])
        page.title(f"({chr(ord('a') + number)})  {mode.title}", left + 0.03, top - 42 / size[1], 22)
        page.text(mode.colours.caption.removesuffix(", share of the largest"), left + 0.03, top - 72 / size[1])
    page.text("deformation magnified; grey: at rest", 0.50, 50 / size[1])
    page.colour_bar("share of the largest" if limits[1] <= 1 else "")
    page.save(picture, width)


@exit_on_error()
def main():
    parser = Parser(__doc__)
    parser.add_argument("modes", metavar="MODE", type=pathlib.Path, nargs="+")
    parser.add_argument("-o", "--output", metavar="PICTURE.png", type=pathlib.Path, help="(default: MODE.png next to the first MODE)")
    parser.add_argument("--field", default="displacement",
                        help="displacement (its real part), displacement_imag, amplitude, phase or another point field "
                             "(default: %(default)s)")
    parser.add_argument("--bodies", choices=("all", "moving"), default="all",
                        help="moving: only bodies that participate in the mode (default: %(default)s)")
    parser.add_argument("--scale", type=float, help="magnification of the displacement (default: from the size of the bodies)")
    parser.add_argument("--view", choices=tuple(VIEWS), default="iso", help="(default: %(default)s)")
    parser.add_argument("--width", type=int, default=SIZE[0], help="width of the picture [pixels] (default: %(default)s)")
    arguments = parser.parse_args()
    for path in arguments.modes:
        if not path.is_file():
            raise Error(f"there is no file {path}", "MODE", "name a file modes/NAME.vtu in a results folder")
    if arguments.width < 1:
        parser.error(f"--width takes a positive number, not {arguments.width}")
    ensure_display("pictures")
    picture = arguments.output or arguments.modes[0].with_suffix(".png")
    modes = [Mode(path, arguments.field, arguments.scale, arguments.bodies) for path in arguments.modes]
    if len(modes) == 1:
        draw_one(modes[0], picture, arguments.view, arguments.width)
    else:
        draw_several(modes, picture, arguments.view, arguments.width)
    print(picture)


if __name__ == "__main__":
    main()
