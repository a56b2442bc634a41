#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Draws a field on the contact faces of the pins on one side, over the outline of the disc.

    scripts/render_contact.py RESULTS/sliding_state_contact.vtu [-o PICTURE] [--field FIELD] [--view VIEW]

The disc is read from sliding_state.vtu in the same folder, the sliding direction from parameters.prm. Rings mark open nodes. PICTURE is a
.png, .svg or .pdf file. Requires Debian's python3-matplotlib.
"""

import math
import pathlib
import sys

import numpy as np
from matplotlib.collections import LineCollection, PolyCollection

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from pictures import GREY, INK, ONE_SIGN, TWO_SIGNS, Page, nice_range
from squeal.command_line import Parser, exit_on_error
from squeal.errors import Error
from squeal.parameter_file import read_parameters
from squeal.surface import edges_of, outer_faces, sharp_edges
from squeal.vtu_file import VtuFile

PALE = "#f0f0f1"  # colour of the disc
VIEWS = {"above": 1, "below": -1}  # side of the disc whose pins are shown: sign of z
# For each field: caption, factor, and units with their SI values, smallest first
QUANTITIES = {
    "pressure": ("contact pressure", 1, {"Pa": 1, "kPa": 1e3, "MPa": 1e6}),
    "normal_reaction": ("normal force of a node", -1, {"N": 1, "kN": 1e3}),
    "gap": ("opening", -1, {"nm": 1e-9, "\u00b5m": 1e-6, "mm": 1e-3}),
    "closed": ("closed (1) or open (0)", 1, {"": 1}),
    "c_b": ("radial damping of a node", 1, {"N s/m": 1}),
    "c_t": ("tangential damping of a node", 1, {"N s/m": 1}),
}


def in_units(field, values):
    """Values in a unit that suits the largest value, with caption and unit."""
    values = values if values.ndim == 1 else np.linalg.norm(values, axis=1)
    caption, factor, units = QUANTITIES.get(field, (field.replace("_", " "), 1, {"": 1}))
    unit = max((unit for unit in units if abs(values).max() >= 2 * units[unit]), key=units.get, default=next(iter(units)))
    return factor * values / units[unit] + 0.0, caption, unit  # adding 0 replaces -0 by 0


def rotation_of(path):
    """Sense of rotation about the z axis, 1 or -1, in the run that wrote the file."""
    for folder in path.resolve().parents[:2]:
        if (folder / "parameters.prm").is_file():
            return -1 if read_parameters(folder / "parameters.prm").get("Operation/Rotation") == "negative" else 1
    raise Error("there is no parameters.prm with the sliding direction", path, "name a file in a results folder")


def draw(path, picture, field, view):
    """Draws the field of the contact file `path` into the file `picture`."""
    bodies = path.with_name(path.name.replace("_contact.vtu", ".vtu"))
    if bodies == path or not bodies.is_file():
        raise Error("there is no file of disc and pins", path, "name a contact file NAME_contact.vtu next to NAME.vtu")
    side, contact = VIEWS[view], VtuFile(path)
    values, caption, unit = in_units(field, contact.field(field))
    points, faces = contact.points, outer_faces(contact)
    faces = faces[(side * points[faces, 2] > 0).all(axis=1)]
    if not len(faces):
        raise Error(f"no contact face is visible from {view}", path, "choose another --view")
    shown, mesh = np.unique(faces), VtuFile(bodies)
    disc, disc_points = outer_faces(mesh, [0]), mesh.points

    # If the contact faces are not centred on the axis, draw their side upwards, with the width of the disc there
    distances, centre = np.linalg.norm(points[shown, :2], axis=1), points[shown, :2].mean(axis=0)
    up, around = np.array([0.0, 1.0]), disc_points[np.unique(disc), :2]
    if np.linalg.norm(centre) > 0.3 * distances.max():
        up = centre / np.linalg.norm(centre)
        radii = np.linalg.norm(around, axis=1)
        around = np.outer([radii.min(), radii.max()], up)
    axes_of_picture = np.column_stack([side * np.array([up[1], -up[0]]), up])
    places, disc_places = points[:, :2] @ axes_of_picture, disc_points[:, :2] @ axes_of_picture
    extent = np.ptp(points[shown, :2], axis=0).max()

    page = Page(ONE_SIGN if values.min() >= 0 else TWO_SIGNS, nice_range(values))  # limits for both sides of the disc
    axes = page.axes(0.01, 0.15, 0.99, 0.92)
    axes.add_collection(PolyCollection(disc_places[disc], facecolor=PALE, edgecolor=PALE, linewidth=0.5))
    triangles = np.vstack([faces[:, :3], faces[faces[:, 2] != faces[:, 3]][:, [0, 2, 3]]])
    low, high = page.scale.get_clim()
    beyond = 1e-6 * (high - low)  # margin that includes values at the limits
    axes.tricontourf(*places.T, triangles, values, levels=np.linspace(low - beyond, high + beyond, 129), norm=page.scale.norm, cmap=page.scale.cmap)
    sides, count = edges_of(faces)
    for ends, look in ((disc_places[sharp_edges(disc_points, disc)], {"colors": GREY, "linewidths": 1}),
                       (places[sides], {"colors": INK, "linewidths": 0.6, "alpha": 0.2}), (places[sides[count == 1]], {"colors": INK, "linewidths": 1.2})):
        axes.add_collection(LineCollection(ends, **look))
    is_open = contact.field("closed")[shown] == 0
    axes.plot(*places[shown[is_open]].T, linestyle="", marker="o", markersize=8, markerfacecolor="none", markeredgecolor=INK)

    radius = distances.max() + 0.06 * extent
    angles = 0.175 * extent / radius * side * rotation_of(path) * np.array([1, -1])  # angles of tail and tip from the outward direction
    tail, tip = radius * np.column_stack([np.sin(angles), np.cos(angles)])
    axes.annotate("", tip, tail, arrowprops={
        "arrowstyle": "-|>,head_length=0.8,head_width=0.3", "mutation_scale": 40, "linewidth": 5, "color": INK, "shrinkA": 0, "shrinkB": 0,
        "joinstyle": "miter", "connectionstyle": f"arc3,rad={math.tan(angles[0] / 2)}"})
    axes.text(0, radius + 0.022 * extent, "sliding of the disc", color=INK, fontsize=14, horizontalalignment="center")
    axes.set_aspect("equal", adjustable="datalim")
    corners = np.vstack([places[shown], [tail, tip], [(0, radius + 0.07 * extent)], around @ axes_of_picture])
    margin = 0.02 * np.ptp(corners, axis=0)
    (left, low), (right, high) = corners.min(axis=0) - margin, corners.max(axis=0) + margin
    axes.set(xlim=(left, right), ylim=(low, high))

    page.title(f"{caption[0].upper()}{caption[1:]} on the {'upper' if side > 0 else 'lower'} pins, seen from {view}")
    page.colour_bar(f"{caption} [{unit}]" if unit else caption)
    note = f"largest {values[shown].max():.3g} {unit}, smallest {values[shown].min():.3g} {unit}"
    page.text(note.replace(" ,", ",") + (f";  rings: {is_open.sum()} open nodes of {len(shown)}" if is_open.any() else ""), 0.5, 0.05)
    page.save(picture)


@exit_on_error()
def main():
    parser = Parser(__doc__)
    parser.add_argument("contact", metavar="CONTACT.vtu", type=pathlib.Path)
    parser.add_argument("-o", "--output", metavar="PICTURE", type=pathlib.Path, help="(default: CONTACT.png next to CONTACT.vtu)")
    parser.add_argument("--field", default="pressure", help=", ".join(QUANTITIES) + " or another point field (default: %(default)s)")
    parser.add_argument("--view", choices=tuple(VIEWS), default="above", help="(default: %(default)s)")
    arguments = parser.parse_args()
    if not arguments.contact.is_file():
        raise Error(f"there is no file {arguments.contact}", "CONTACT.vtu", "name a contact file in a results folder")
    picture = arguments.output or arguments.contact.with_suffix(".png")
    draw(arguments.contact, picture, arguments.field, arguments.view)
    print(picture)


if __name__ == "__main__":
    main()
