#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Converts a mesh of another pre-processor to a .msh file that squeal can read.

    scripts/import_mesh.py brake.inp                       lists the contents of the file
    scripts/import_mesh.py brake.inp brake.msh --unit mm \\
        --volume disc=ROTOR --volume pad_lining=PAD --volume pad_backplate=PLATE \\
        --surface disc_top=ROTOR_SURF --surface pad_face=PAD_SURF --surface pad_back=BACKS --surface disc_bore=HUB \\
        --contact "disc_top / pad_face" --mount "disc_bore: 0, 7.8e10, 1.88e10" --mount "pad_back: 2e10, 2e10, 2e10"

Element sets become volumes. Surfaces, shell sets and node sets become faces; a node set selects the boundary faces whose
corners it contains. Sets with the name of a volume or surface of squeal, in upper or lower case, need no --volume or
--surface. --names FILE reads names from a YAML or JSON file: {unit: mm, volumes: {disc: [ROTOR]}, surfaces: {...},
contact: [disc_top / pad_face], mounts: ["pad_back: 2e10, 2e10, 2e10"]}. The unit of length of
the file is required. Omitted elements and sets are listed. A parameter file FILE.prm is written next to FILE.msh unless it exists. It contains
the given contact pairs and mounts, or comments to be completed; quadratic elements, if the mesh has them; and the
elastic materials of an Abaqus file.

Supported formats are Abaqus .inp (sets, surfaces, elastic materials), Nastran .bdf (volumes by property number), Exodus (blocks, side sets,
node sets) and the formats of meshio: MED (groups), VTK (integer cell data: a set `part:3` for each value), Gmsh and others, but not Ansys,
Fluent and Permas. Requires python3-meshio, for Exodus python3-netcdf4, for MED python3-h5py.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from squeal.command_line import Parser, exit_on_error
from squeal.importing.foreign_mesh import UNITS
from squeal.importing.mesh_import import run


@exit_on_error()
def main():
    parser = Parser(__doc__)
    parser.add_argument("file")
    parser.add_argument("output", nargs="?", help=".msh file to write; by default, the sets of FILE are listed")
    parser.add_argument("--unit", help=f"unit of length of FILE: {', '.join(UNITS)}")
    parser.add_argument("--volume", action="append", default=[], metavar="NAME=SET[,SET]")
    parser.add_argument("--surface", action="append", default=[], metavar="NAME=SET[,SET]")
    parser.add_argument("--contact", action="append", default=[], metavar="DISC_SURFACE / SURFACE[: FACTOR]")
    parser.add_argument("--mount", action="append", default=[], metavar="SURFACE: RADIAL, TANGENTIAL, AXIAL", help="N/m^3")
    parser.add_argument("--names", metavar="FILE")
    run(parser.parse_args())


if __name__ == "__main__":
    main()
