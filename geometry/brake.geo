// SPDX-License-Identifier: GPL-3.0-or-later

// A disc brake: a disc with its hat, and two chamfered pads with one slot each, which consist of lining and backplate.
// Pads and disc are meshed separately, with quadratic tetrahedra; their faces need not match. This is an example of a
// custom solid; prm/brake.prm defines the sliding surfaces and the materials. Units: m, degree.

SetFactory("OpenCASCADE");

DefineConstant[
  disc_radius         = 0.140,
  ring_inner_radius   = 0.086,
  ring_thickness      = 0.0463,
  hat_radius          = 0.078,
  hat_height          = 0.045,
  hat_wall            = 0.008,
  bore_radius         = 0.035,
  pad_inner_radius    = 0.094,
  pad_outer_radius    = 0.136,
  pad_angle           = 64,
  lining_thickness    = 0.011,
  backplate_thickness = 0.006,
  chamfer             = 0.004,
  slot_width          = 0.003,
  slot_depth          = 0.007,
  disc_size           = 0.0095,
  pad_size            = 0.0060
];

h = ring_thickness / 2;

// Disc: friction ring with a hat that opens downwards
Cylinder(1) = {0, 0, -h, 0, 0, 2 * h, disc_radius};
Cylinder(2) = {0, 0, -h, 0, 0, h + hat_height, hat_radius + hat_wall / 2};
disc() = BooleanUnion{ Volume{1}; Delete; }{ Volume{2}; Delete; };
Cylinder(3) = {0, 0, -2 * h, 0, 0, 2 * h + hat_height - hat_wall, hat_radius - hat_wall / 2};
Cylinder(4) = {0, 0, 0, 0, 0, 2 * hat_height, bore_radius};
disc() = BooleanDifference{ Volume{disc()}; Delete; }{ Volume{3, 4}; Delete; };

// A pad above the disc: a sector of a ring with chamfers at both ends and a slot
angle = pad_angle * Pi / 180;
edge  = Sqrt(2) * chamfer;
For part In {0 : 1}
  z = (part == 0) ? h : h + lining_thickness;
  t = (part == 0) ? lining_thickness : backplate_thickness;
  v = newv;
  Cylinder(v)     = {0, 0, z, 0, 0, t, pad_outer_radius, angle};
  Cylinder(v + 1) = {0, 0, z, 0, 0, t, pad_inner_radius};
  sector~{part}() = BooleanDifference{ Volume{v}; Delete; }{ Volume{v + 1}; Delete; };
EndFor
v = newv;
Box(v)     = {0, -edge / 2, h - edge / 2, 2 * disc_radius, edge, edge};
Box(v + 1) = {0, -edge / 2, h - edge / 2, 2 * disc_radius, edge, edge};
Rotate{ {1, 0, 0}, {0, 0, h}, Pi / 4 }{ Volume{v, v + 1}; }
Rotate{ {0, 0, 1}, {0, 0, 0}, angle }{ Volume{v + 1}; }
Box(v + 2) = {0, -slot_width / 2, h, 2 * disc_radius, slot_width, slot_depth};
Rotate{ {0, 0, 1}, {0, 0, 0}, angle / 2 }{ Volume{v + 2}; }
lining() = BooleanDifference{ Volume{sector_0()}; Delete; }{ Volume{v : v + 2}; Delete; };
outer()  = BooleanFragments{ Volume{lining()}; Delete; }{ Volume{sector_1()}; Delete; };
Rotate{ {0, 0, 1}, {0, 0, 0}, -angle / 2 }{ Volume{outer()}; }
copy()  = Symmetry{0, 0, 1, 0}{ Duplicata{ Volume{outer()}; } };
inner() = BooleanFragments{ Volume{copy(0)}; Delete; }{ Volume{copy(1)}; Delete; }; // merge the surface shared by both copies

// Identify parts and surfaces by bounding boxes
e = 1e-5;
top = h + lining_thickness;
far = 2 * disc_radius;
Physical Volume("disc")                = {disc()};
Physical Volume("pad_outer_lining")    = {Volume In BoundingBox{0, -far, h - e, far, far, top + e}};
Physical Volume("pad_outer_backplate") = {Volume In BoundingBox{0, -far, top - e, far, far, top + backplate_thickness + e}};
Physical Volume("pad_inner_lining")    = {Volume In BoundingBox{0, -far, -top - e, far, far, -h + e}};
Physical Volume("pad_inner_backplate") = {Volume In BoundingBox{0, -far, -top - backplate_thickness - e, far, far, -top + e}};

all_disc() = Abs(Boundary{ Volume{disc()}; });
upper() = {Surface In BoundingBox{-far, -far, h - e, far, far, h + e}};
lower() = {Surface In BoundingBox{-far, -far, -h - e, far, far, -h + e}};
disc_upper() = {}; disc_lower() = {}; pad_upper() = {}; pad_lower() = {};
For i In {0 : #upper() - 1}
  box() = BoundingBox Surface{upper(i)};
  If(box(0) < -ring_inner_radius) disc_upper() += {upper(i)}; Else pad_upper() += {upper(i)}; EndIf
EndFor
For i In {0 : #lower() - 1}
  box() = BoundingBox Surface{lower(i)};
  If(box(0) < -ring_inner_radius) disc_lower() += {lower(i)}; Else pad_lower() += {lower(i)}; EndIf
EndFor
Physical Surface("disc_top")       = {disc_upper()};
Physical Surface("disc_bottom")    = {disc_lower()};
Physical Surface("pad_outer_face") = {pad_upper()};
Physical Surface("pad_inner_face") = {pad_lower()};
Physical Surface("disc_hub")       = {Surface In BoundingBox{-far, -far, hat_height - e, far, far, hat_height + e}};
Physical Surface("pad_outer_back") =
  {Surface In BoundingBox{0, -far, top + backplate_thickness - e, far, far, top + backplate_thickness + e}};
Physical Surface("pad_inner_back") =
  {Surface In BoundingBox{0, -far, -top - backplate_thickness - e, far, far, -top - backplate_thickness + e}};

MeshSize{ PointsOf{ Volume{:}; } } = pad_size;
MeshSize{ PointsOf{ Volume{disc()}; } } = disc_size;
Mesh.ElementOrder = 2;
Mesh.HighOrderOptimize = 0;
