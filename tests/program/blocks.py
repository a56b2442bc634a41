# SPDX-License-Identifier: GPL-3.0-or-later

"""Parts of a small geometry script, which tests combine and change."""

# Two stacked blocks without physical names
BLOCKS = """
SetFactory("OpenCASCADE");
Box(1) = {0.1, 0, -0.05, 0.1, 0.1, 0.05};
Box(2) = {0.1, 0, 0, 0.1, 0.1, 0.02};
"""
HEXAHEDRA = "Transfinite Curve{:} = 3; Transfinite Surface{:}; Recombine Surface{:}; Transfinite Volume{:};\n"
VOLUMES = 'Physical Volume("disc") = {1}; Physical Volume("pin_1") = {2};\n'
SURFACES = 'Physical Surface("disc_contact") = {6}; Physical Surface("pin_contact") = {11}; Physical Surface("pin_clamp") = {12};\n'
