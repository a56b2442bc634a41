// Plan of the built-in geometry: an annular disc and round pins on its two
// faces. Squeal meshes this plan in two dimensions, fills the pins' circles
// with a structured grid and extrudes disc and pins layer by layer; opened in
// Gmsh by itself, the file shows the plan with the values below. Squeal sets
// them from section "Geometry" of its parameter file. Units: m, degree.

DefineConstant[
  disc_inner_radius  = 0.1505,
  disc_outer_radius  = 0.3155,
  pin_diameter       = 0.0520,
  nodes_per_pin_face = 19,
  element_size       = 0.0115
];
If(!Exists(top_pin_radii))
  top_pin_radii()  = {0.1970, 0.1970, 0.1970, 0.2585, 0.2585, 0.2585};
  top_pin_angles() = {-18.4, 0, 18.4, -18.4, 0, 18.4};
EndIf
If(!Exists(bottom_pin_radii))
  bottom_pin_radii()  = {0.1970, 0.1970, 0.1970, 0.2585, 0.2585, 0.2585};
  bottom_pin_angles() = {-18.4, 0, 18.4, -18.4, 0, 18.4};
EndIf

// Three blocks of k x k elements fill a pin: 3 k (k + 1) + 1 nodes, 6 k of them
// on the circle. Every element is halved after meshing, hence k intervals for
// each third of a circle and twice the wanted element size.
k    = Round((Sqrt(12 * nodes_per_pin_face - 3) - 3) / 6);
size = 2 * element_size;

Mesh.RecombineAll         = 1;
Mesh.Algorithm            = 6;
Mesh.SubdivisionAlgorithm = 1;
Mesh.MeshSizeMax          = size;

// Bore and rim
centre = newp; Point(centre) = {0, 0, 0};
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

// Pins: a circle that a top and a bottom pin have in common is made once.
n_top    = #top_pin_radii();
n_bottom = #bottom_pin_radii();
n_pins   = n_top + n_bottom;
holes()  = {};
For pin In {1 : n_pins}
  If(pin <= n_top)
    pin_r = top_pin_radii(pin - 1);
    pin_a = top_pin_angles(pin - 1) * Pi / 180;
  Else
    pin_r = bottom_pin_radii(pin - n_top - 1);
    pin_a = bottom_pin_angles(pin - n_top - 1) * Pi / 180;
  EndIf
  x~{pin} = pin_r * Cos(pin_a);
  y~{pin} = pin_r * Sin(pin_a);

  twin = 0;
  If(pin > n_top)
    For other In {1 : n_top}
      If(Hypot(x~{pin} - x~{other}, y~{pin} - y~{other}) < 1e-6 * pin_diameter)
        twin = other;
      EndIf
    EndFor
  EndIf

  If(twin > 0)
    pin_curves~{pin}() = pin_curves~{twin}();
  Else
    p = newp;
    Point(p) = {x~{pin}, y~{pin}, 0};
    For i In {0 : 2}
      a = pin_a + 2 * Pi * i / 3;
      Point(p + 1 + i) = {x~{pin} + pin_diameter / 2 * Cos(a), y~{pin} + pin_diameter / 2 * Sin(a), 0, size};
    EndFor
    c = newc;
    For i In {0 : 2}
      Circle(c + i) = {p + 1 + i, p, p + 1 + (i + 1) % 3};
    EndFor
    pin_curves~{pin}() = {c : c + 2};
    Transfinite Curve{c : c + 2} = k + 1;
    l = newll; Curve Loop(l) = {c : c + 2};
    holes() += l;
  EndIf
EndFor

s = news; Plane Surface(s) = {loop_1, loop_0, holes()};

Physical Surface("disc")    = {s};
Physical Curve("disc_bore") = {ring_curves_0()};
Physical Curve("disc_rim")  = {ring_curves_1()};
For pin In {1 : n_pins}
  If(pin <= n_top)
    Physical Curve(Sprintf("pin_top_%g", pin)) = {pin_curves~{pin}()};
  Else
    Physical Curve(Sprintf("pin_bottom_%g", pin - n_top)) = {pin_curves~{pin}()};
  EndIf
EndFor
