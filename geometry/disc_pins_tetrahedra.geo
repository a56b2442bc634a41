// SPDX-License-Identifier: GPL-3.0-or-later

// The built-in disc and pins as a solid of quadratic tetrahedra, with curved elements on round surfaces. Disc and pins
// are meshed separately; their contact faces do not match. Squeal sets the variables from section "Geometry" of the
// parameter file; pin_size and refinement are set only if they are given there. The numbers of layers and of nodes per
// pin face have no effect. Edges of disc elements have twice the element size, because nodes of quadratic elements are
// half an edge apart. Units: m, degree.

SetFactory("OpenCASCADE");

DefineConstant[
  disc_inner_radius = 0.1505,
  disc_outer_radius = 0.3155,
  disc_thickness    = 0.0463,
  pin_diameter      = 0.0520,
  pin_height        = 0.0318,
  element_size      = 0.0115,
  pin_size          = 0.0130,
  refinement        = 1
];
If(!Exists(top_pin_radii))
  top_pin_radii()  = {0.1970, 0.1970, 0.1970, 0.2585, 0.2585, 0.2585};
  top_pin_angles() = {-18.4, 0, 18.4, -18.4, 0, 18.4};
EndIf
If(!Exists(bottom_pin_radii))
  bottom_pin_radii()  = {0.1970, 0.1970, 0.1970, 0.2585, 0.2585, 0.2585};
  bottom_pin_angles() = {-18.4, 0, 18.4, -18.4, 0, 18.4};
EndIf

h = disc_thickness / 2;

// Disc
Cylinder(1) = {0, 0, -h, 0, 0, disc_thickness, disc_outer_radius};
Cylinder(2) = {0, 0, -h, 0, 0, disc_thickness, disc_inner_radius};
disc() = BooleanDifference{ Volume{1}; Delete; }{ Volume{2}; Delete; };
Physical Volume("disc") = {disc()};
faces() = Abs(Boundary{ Volume{disc()}; });
flat() = {}; bore() = {}; rim() = {};
For i In {0 : #faces() - 1}
  box() = BoundingBox Surface{faces(i)};
  If(box(5) - box(2) < disc_thickness / 2)
    flat() += {faces(i)};
  ElseIf(box(3) < (disc_inner_radius + disc_outer_radius) / 2)
    bore() += {faces(i)};
  Else
    rim() += {faces(i)};
  EndIf
EndFor

// Pins, first above, then below the disc
n_top = #top_pin_radii();
pins() = {}; contact() = {}; clamp() = {}; side() = {};
For pin In {1 : n_top + #bottom_pin_radii()}
  If(pin <= n_top)
    r    = top_pin_radii(pin - 1);
    a    = top_pin_angles(pin - 1) * Pi / 180;
    sign = 1;
    name = Sprintf("pin_top_%g", pin);
  Else
    r    = bottom_pin_radii(pin - n_top - 1);
    a    = bottom_pin_angles(pin - n_top - 1) * Pi / 180;
    sign = -1;
    name = Sprintf("pin_bottom_%g", pin - n_top);
  EndIf
  v = newv;
  Cylinder(v) = {r * Cos(a), r * Sin(a), sign * h, 0, 0, sign * pin_height, pin_diameter / 2};
  Physical Volume(Str(name)) = {v};
  pins() += {v};
  faces() = Abs(Boundary{ Volume{v}; });
  For i In {0 : #faces() - 1}
    box() = BoundingBox Surface{faces(i)};
    If(box(5) - box(2) > pin_height / 2)
      side() += {faces(i)};
    ElseIf(Abs(box(2) + box(5)) / 2 < h + pin_height / 2)
      contact() += {faces(i)};
    Else
      clamp() += {faces(i)};
    EndIf
  EndFor
EndFor

Physical Surface("disc_contact") = {flat()};
Physical Surface("disc_bore")    = {bore()};
Physical Surface("disc_rim")     = {rim()};
Physical Surface("pin_contact")  = {contact()};
Physical Surface("pin_clamp")    = {clamp()};
Physical Surface("pin_side")     = {side()};

MeshSize{ PointsOf{ Volume{disc()}; } } = 2 * element_size / refinement;
MeshSize{ PointsOf{ Volume{pins()}; } } = pin_size / refinement;
Mesh.ElementOrder      = 2;
Mesh.HighOrderOptimize = 0;
