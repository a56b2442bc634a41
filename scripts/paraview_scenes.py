# SPDX-License-Identifier: GPL-3.0-or-later

"""ParaView pipelines, views and pictures of the modes of a run.

This is a separate module because the scripts of ParaView's filters run in the namespace of the main module and would
overwrite its names.
"""

import math
import pathlib
import tempfile

from squeal.errors import Error

VIEWS = {"iso": ((0.62, -0.62, 0.62), (0, 0, 1)), "top": ((0, 0, 1), (0, 1, 0)), "side": ((1, -0.08, 0.12), (0, 0, 1)),
         "below": ((0.62, -0.62, -0.62), (0, 0, 1)), "faces": ((0.25, -0.25, -0.94), (-1, 0, 0)), "energy": ((0.25, -0.25, -0.94), (-1, 0, 0))}  # towards the eye; upwards
WIDTH, ASPECT = 1600, 0.625  # width of pictures [pixels], and ratio of height to width
INK, GREY, EDGES = (0.13, 0.13, 0.15), (0.6, 0.6, 0.62), (0.35, 0.35, 0.38)
CLOSER = 1.25  # zoom relative to the bounding sphere
FRAMES = 24  # frames per period
# Colour scales of scripts/pictures.py: YlGnBu and RdBu of ColorBrewer
YELLOW_BLUE = ("ffffe5", "edf8b1", "c7e9b4", "7fcdbb", "41b6c4", "1d91c0", "225ea8", "253494", "081d58")
RED_BLUE = ("0a3a70", "2166ac", "4393c3", "92c5de", "d1e5f0", "f7f7f7", "fddbc7", "f4a582", "d6604d", "b2182b", "78061f")

# Scripts of ParaView's programmable filter that move a mode; they are stored in the session
TIMES = """
executive = self.GetExecutive()
information = executive.GetOutputInformation(0)
times = [{period} * step / {frames} for step in range({frames} * {periods} + 1)]
information.Remove(executive.TIME_STEPS())
information.Remove(executive.TIME_RANGE())
for time in times:
    information.Append(executive.TIME_STEPS(), time)
information.Append(executive.TIME_RANGE(), times[0])
information.Append(executive.TIME_RANGE(), times[-1])
"""
MOTION = """
import numpy
executive = self.GetExecutive()
information = executive.GetOutputInformation(0)
time = information.Get(executive.UPDATE_TIME_STEP()) if information.Has(executive.UPDATE_TIME_STEP()) else 0.0
turn = numpy.exp(complex({growth}, {omega}) * time - {largest})
real, imaginary = (inputs[0].PointData["displacement_" + part] for part in ("real", "imag"))
output.ShallowCopy(inputs[0].VTKObject)
output.PointData.append(turn.real * real - turn.imag * imaginary, "displacement")
information.Set(output.DATA_TIME_STEP(), time)
"""


class Scene:
    """Pipelines and a view in ParaView; `simple` is ParaView's module."""

    def __init__(self, simple, view, width):
        self.simple, self.view_name = simple, view
        self.view = simple.CreateRenderView()
        self.view.ViewSize = [width, round(ASPECT * width)]
        self.view.OrientationAxesVisibility = 0
        self.view.UseColorPaletteForBackground = 0
        self.view.Background = (1, 1, 1)
        self.font = width / WIDTH  # size of texts relative to a picture of default width
        # Light mainly from the eye and less from above, to show the colours of faces that point downwards
        self.view.KeyLightElevation, self.view.KeyLightAzimuth = 25, 15
        self.view.HeadLightKHRatio, self.view.FillLightKFRatio = 2, 2
        self.view.KeyLightWarmth = self.view.FillLightWarmth = self.view.HeadLightWarmth = self.view.BackLightWarmth = 0.5
        simple.SetActiveView(self.view)

    def open(self, path):
        reader = self.simple.OpenDataFile(str(path))
        reader.UpdatePipelineInformation()
        times = reader.TimestepValues
        reader.UpdatePipeline(times[0] if times else 0)
        return reader

    def scale(self, reader, size):
        """Factor of the displacements, whose largest value is about one."""
        bounds = reader.GetDataInformation().GetBounds()
        return size * max(bounds[1] - bounds[0], bounds[3] - bounds[2]) / 2

    def show_bodies(self, source, vectors, factor):
        """Shows disc and pins deformed and coloured by the amplitude, over their outline at rest."""
        simple = self.simple
        self.show_edges(source, 50)
        warp = simple.WarpByVector(Input=source)
        warp.Vectors, warp.ScaleFactor = ["POINTS", vectors], factor
        shown = simple.Show(warp, self.view)
        shown.Representation = "Surface With Edges"
        shown.EdgeColor = EDGES
        shown.LineWidth = 0.5
        simple.ColorBy(shown, ("POINTS", "amplitude"))
        self.colours("amplitude", YELLOW_BLUE, 0, 1, shown, "amplitude over largest displacement", "%.1f")

    def show_edges(self, source, angle):
        """Shows sharp edges of bodies at rest."""
        edges = self.simple.FeatureEdges(Input=self.simple.ExtractSurface(Input=source), FeatureAngle=angle)
        shown = self.simple.Show(edges, self.view)
        self.simple.ColorBy(shown, None)
        shown.AmbientColor = shown.DiffuseColor = GREY

    def show_faces(self, bodies, faces, field, caption):
        """Shows the contact faces of the upper pins, coloured by a field, and the edges of these pins at rest."""
        simple = self.simple
        faces.UpdatePipeline(max(faces.TimestepValues or [0]))
        if field not in faces.PointData.keys():
            raise Error(f"the contact faces have no field {field}", "--view", "choose another --view, or a growing mode for `energy`")
        bounds = faces.GetDataInformation().GetBounds()
        middle = [0, 0, (bounds[4] + bounds[5]) / 2]
        pins = simple.Threshold(Input=bodies)
        pins.Scalars, pins.LowerThreshold, pins.UpperThreshold = ["CELLS", "component"], 0.5, 1e9
        upper_pins, upper_faces = simple.Clip(Input=pins), simple.Clip(Input=faces)
        for clip in (upper_pins, upper_faces):
            clip.ClipType, clip.Invert = "Plane", 0
            clip.ClipType.Origin, clip.ClipType.Normal = middle, (0, 0, 1)
        self.show_edges(upper_pins, 50)
        shown = simple.Show(upper_faces, self.view)
        shown.Representation = "Surface With Edges"
        shown.EdgeColor = EDGES
        shown.Ambient, shown.Diffuse = 1, 0  # no shading, so that the colours are exact
        simple.ColorBy(shown, ("POINTS", field))
        low, high = faces.PointData[field].GetRange(0)
        limit = max(abs(low), abs(high)) or 1
        self.colours(field, RED_BLUE, -limit, limit, shown, caption, "%.1e")

    def colours(self, field, anchors, low, high, shown, caption, number_format):
        table = self.simple.GetColorTransferFunction(field)
        table.ColorSpace = "Lab"
        table.RGBPoints = [number for i, anchor in enumerate(anchors)
                           for number in (low + (high - low) * i / (len(anchors) - 1),
                                          *(int(anchor[j:j + 2], 16) / 255 for j in (0, 2, 4)))]
        shown.LookupTable = table
        shown.SetScalarBarVisibility(self.view, True)
        legend = self.simple.GetScalarBar(table, self.view)
        legend.Title, legend.ComponentTitle = caption, ""
        legend.TitleColor = legend.LabelColor = INK
        legend.TitleFontSize = legend.LabelFontSize = max(8, round(16 * self.font))
        legend.ScalarBarLength, legend.ScalarBarThickness = 0.33, max(8, round(16 * self.font))
        legend.AutomaticLabelFormat, legend.LabelFormat, legend.RangeLabelFormat = 0, number_format, number_format
        legend.WindowLocation, legend.Orientation = "Lower Center", "Horizontal"

    def show_title(self, source, titles):
        """Shows the title of the current time step; a single title is shown at all steps."""
        annotation = self.simple.PythonAnnotation(Input=source)
        annotation.ArrayAssociation = "Point Data"
        annotation.Expression = repr(titles[0]) if len(titles) == 1 else f"{titles!r}[int(t_index)]"
        shown = self.simple.Show(annotation, self.view)
        shown.Color, shown.FontSize, shown.WindowLocation, shown.Bold = INK, max(9, round(22 * self.font)), "Upper Left Corner", 1

    def look(self):
        toward, up = VIEWS[self.view_name]
        self.simple.ResetCamera(self.view)
        centre = list(self.view.CameraFocalPoint)
        distance = math.dist(self.view.CameraPosition, centre)
        length = math.hypot(*toward)
        self.view.CameraPosition = [c + distance * d / length for c, d in zip(centre, toward)]
        self.view.CameraViewUp = up
        self.view.ResetCamera(True)
        self.view.GetActiveCamera().Dolly(0.9 if self.view_name in ("faces", "energy") else CLOSER)

    def save(self, path, time=None):
        if time is not None:
            self.view.ViewTime = time
        self.simple.SaveScreenshot(str(path), self.view, ImageResolution=list(self.view.ViewSize))


def scene_of_all(simple, results, titles, files, arguments):
    """Scene with all modes by frequency, and the time at which each mode is shown, by row of complex_modes.csv."""
    scene = Scene(simple, arguments.view, arguments.width)
    reader = scene.open(results / "modes.pvd")
    if arguments.view == "faces":
        scene.show_faces(reader, scene.open(results / "modes_contact.pvd"), "normal_reaction_real",
                         "normal reaction, real part [N]; red: less pressure")
    else:
        scene.show_bodies(reader, "displacement_real", scene.scale(reader, arguments.size))
    scene.show_title(reader, [titles[number] for number in sorted(files)])
    simple.GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
    scene.look()
    return scene, dict(zip(sorted(files), reader.TimestepValues))


def scene_of_energy(simple, file, title, arguments):
    """Scene that shows the energy sources of a growing mode."""
    scene = Scene(simple, arguments.view, arguments.width)
    reader = scene.open(file)
    scene.show_faces(reader, scene.open(file.with_name(file.stem + "_contact.vtu")), "energy_input",
                     "contribution of friction and damping to the divergence rate per area [1/m2]; red: energy input")
    scene.show_title(reader, [title])
    scene.look()
    return scene


def scene_of_one(simple, file, row, title, arguments):
    """Scene that shows the motion of a mode, and its times."""
    growth, omega = float(row["growth rate [1/s]"]), 2 * math.pi * float(row["frequency [Hz]"])
    period = 2 * math.pi / omega
    scene = Scene(simple, arguments.view, arguments.width)
    reader = scene.open(file)
    moving = simple.ProgrammableFilter(Input=reader)
    moving.RequestInformationScript = TIMES.format(period=period, frames=FRAMES, periods=arguments.periods)
    moving.RequestUpdateExtentScript = ""
    moving.Script = MOTION.format(growth=growth, omega=omega, largest=max(growth, 0) * arguments.periods * period)
    moving.UpdatePipeline()
    scene.show_bodies(moving, "displacement", scene.scale(reader, arguments.size))
    scene.show_title(moving, [title])
    simple.GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
    scene.look()
    return scene, [period * step / FRAMES for step in range(FRAMES * arguments.periods + 1)]


def write_film(scene, times, path):
    """Writes a film with a frame for each time."""
    from PIL import Image

    with tempfile.TemporaryDirectory() as folder:
        frames = []
        for step, time in enumerate(times):
            picture = pathlib.Path(folder) / f"{step:04d}.png"
            scene.save(picture, time)
            with Image.open(picture) as image:
                frames.append(image.convert("RGB").quantize(128))
        frames[0].save(path, save_all=True, append_images=frames[1:], duration=1000 // FRAMES, loop=0, optimize=True)
