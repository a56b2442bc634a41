// SPDX-License-Identifier: GPL-3.0-or-later

// Plan of a disc with one brake pad on each face instead of pins: a sector of an annulus, the same on both faces. This
// is an example of a custom plan, from which squeal extrudes the disc and both pads. The plan defines neither volumes
// nor layers: thickness, height, the radii of the disc and the element size come from section "Geometry" of the
// parameter file. Opened in Gmsh, the file shows the plan with the values below. Units: m, degree.

DefineConstant[
  disc_inner_radius = 0.1505,
  disc_outer_radius = 0.3155,
  element_size      = 0.0115,
  pad_inner_radius  = 0.1750,
  pad_outer_radius  = 0.2850,
  pad_angle         = 50
];

// Every element is halved after meshing
size = 2 * element_size;
Mesh.RecombineAll         = 1;
Mesh.SubdivisionAlgorithm = 1;
Mesh.MeshSizeMax          = size;

centre = newp; Point(centre) = {0, 0, 0};

// Bore and rim
For ring In {0 : 1}
  r = (ring == 0) ? disc_inner_radius : disc_outer_radius;
  p = newp;
  For i In {0 : 2}
    Point(p + i) = {r * Cos(2 * Pi * i / 3), r * Sin(2 * Pi * i / 3), 0, size};
  EndFor
  c = newc;
  For i In {0 : 2}
    Circle(c + i) = {p + i, centre, p + (i + 1) % 3};
  EndFor
  ring_curves~{ring}() = {c : c + 2};
  loop~{ring} = newll; Curve Loop(loop~{ring}) = {c : c + 2};
EndFor

// Pad: disc and pad share its curves, so that their faces coincide
a = pad_angle * Pi / 360;
p = newp;
Point(p)     = {pad_inner_radius * Cos(a), -pad_inner_radius * Sin(a), 0, size};
Point(p + 1) = {pad_outer_radius * Cos(a), -pad_outer_radius * Sin(a), 0, size};
Point(p + 2) = {pad_outer_radius * Cos(a),  pad_outer_radius * Sin(a), 0, size};
Point(p + 3) = {pad_inner_radius * Cos(a),  pad_inner_radius * Sin(a), 0, size};
c = newc;
Line(c)       = {p, p + 1};
Circle(c + 1) = {p + 1, centre, p + 2};
Line(c + 2)   = {p + 2, p + 3};
Circle(c + 3) = {p + 3, centre, p};
pad_loop = newll; Curve Loop(pad_loop) = {c : c + 3};
pad = news; Plane Surface(pad) = {pad_loop};

// Number of element rows along and across the pad
radial     = Ceil((pad_outer_radius - pad_inner_radius) / size);
tangential = Ceil(2 * a * (pad_inner_radius + pad_outer_radius) / 2 / size);
Transfinite Curve{c, c + 2}     = radial + 1;
Transfinite Curve{c + 1, c + 3} = tangential + 1;
Transfinite Surface{pad};

disc = news; Plane Surface(disc) = {loop_1, loop_0, pad_loop};

Physical Surface("disc")         = {disc};
Physical Surface("pin_top_1")    = {pad};
Physical Surface("pin_bottom_1") = {pad};
Physical Curve("disc_bore")      = {ring_curves_0()};
Physical Curve("disc_rim")       = {ring_curves_1()};
