// SPDX-License-Identifier: GPL-3.0-or-later

// Plan of the built-in geometry: an annular disc and round pins on its two faces. Squeal meshes this plan in two
// dimensions, fills the pins' circles with a structured grid and extrudes disc and pins layer by layer. Squeal sets the
// values below from section "Geometry" of the parameter file. Opened in Gmsh, the file shows the plan with these
// values. Units: m, degree.

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

// Three blocks of k x k elements fill a pin: 3 k (k + 1) + 1 nodes, 6 k of them on the circle. Because every element is
// halved after meshing, each third of a circle has k intervals here, and elements are twice as large as requested.
k    = Round((Sqrt(12 * nodes_per_pin_face - 3) - 3) / 6);
size = 2 * element_size;

Mesh.RecombineAll         = 1;
Mesh.Algorithm            = 6;
Mesh.SubdivisionAlgorithm = 1;
Mesh.MeshSizeMax          = size;

// Pins. A top pin and the nearest bottom pin that overlaps it share a hole in the plan. If a hole and its pin have
// different positions, a physical point marks the position of the pin, and the mesh of the disc is sheared between its
// two faces.
n_top     = #top_pin_radii();
n_pins    = n_top + #bottom_pin_radii();
tolerance = 1e-6 * pin_diameter;
For pin In {1 : n_pins}
  If(pin <= n_top)
    radius~{pin} = top_pin_radii(pin - 1);
    angle~{pin}  = top_pin_angles(pin - 1) * Pi / 180;
  Else
    radius~{pin} = bottom_pin_radii(pin - n_top - 1);
    angle~{pin}  = bottom_pin_angles(pin - n_top - 1) * Pi / 180;
  EndIf
  x~{pin} = radius~{pin} * Cos(angle~{pin});
  y~{pin} = radius~{pin} * Sin(angle~{pin});
  twin~{pin} = 0;
EndFor
For pair In {1 : n_top}
  nearest = pin_diameter;
  For top In {1 : n_top}
    For bottom In {n_top + 1 : n_pins}
      distance = Hypot(x~{top} - x~{bottom}, y~{top} - y~{bottom});
      If(!twin~{top} && !twin~{bottom} && distance < nearest - tolerance)
        nearest = distance;
        first   = top;
        second  = bottom;
      EndIf
    EndFor
  EndFor
  If(nearest < pin_diameter)
    twin~{first}  = second;
    twin~{second} = first;
  EndIf
EndFor

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

// Position of a hole: position of its pin or, for a pair of pins, mean radius in the direction of the midpoint
For pin In {1 : n_pins}
  other = twin~{pin};
  hole_x~{pin} = x~{pin};
  hole_y~{pin} = y~{pin};
  opposite~{pin} = other > 0;
  If(other)
    If(Hypot(x~{pin} - x~{other}, y~{pin} - y~{other}) > tolerance)
      opposite~{pin} = 0;
      mean_x = (x~{pin} + x~{other}) / 2;
      mean_y = (y~{pin} + y~{other}) / 2;
      scale  = (radius~{pin} + radius~{other}) / 2 / Hypot(mean_x, mean_y);
      hole_x~{pin} = scale * mean_x;
      hole_y~{pin} = scale * mean_y;
    EndIf
  EndIf
EndFor

// Separate holes that overlap because a pin overlaps two pins of the other side. Also separate holes of pins on
// different sides if no elements fit between them: halving a circle of three intervals moves nodes by half its radius.
closest = (k > 1) ? 1.05 : 1.25;
least   = disc_inner_radius + 0.55 * pin_diameter;
most    = disc_outer_radius - 0.55 * pin_diameter;
crowded = 1;
For pass In {1 : 50}
  If(crowded)
    crowded = 0;
    For pin In {2 : n_pins}
      For other In {1 : pin - 1}
        If(twin~{pin} != other)
          dx = hole_x~{pin} - hole_x~{other};
          dy = hole_y~{pin} - hole_y~{other};
          distance = Hypot(dx, dy);
          // A pin exactly opposite another pin counts as a pin on both sides
          same_side = (pin <= n_top) == (other <= n_top) || opposite~{pin} || opposite~{other};
          If(distance < (same_side ? 1 : closest) * pin_diameter)
            crowded = 1;
            push = ((closest + 0.05) * pin_diameter / distance - 1) / 2;
            For which In {0 : 1}
              pushed = which ? pin : other;
              sign   = which ? 1 : -1;
              new_x  = hole_x~{pushed} + sign * push * dx;
              new_y  = hole_y~{pushed} + sign * push * dy;
              r      = Hypot(new_x, new_y);
              scale  = Min(Max(r, least), most) / r;
              hole_x~{pushed} = scale * new_x;
              hole_y~{pushed} = scale * new_y;
              If(twin~{pushed})
                hole_x~{twin~{pushed}} = hole_x~{pushed};
                hole_y~{twin~{pushed}} = hole_y~{pushed};
              EndIf
            EndFor
          EndIf
        EndIf
      EndFor
    EndFor
  EndIf
EndFor
If(crowded)
  Error("The plan has no space for top and bottom pins that overlap without being opposite. Change the radii or angles of the pins of one side in section Geometry, or set Geometry/File to a custom plan");
EndIf

// Circles of three arcs; the first pin of a pair creates the common circle
holes() = {};
For pin In {1 : n_pins}
  other = twin~{pin};
  If(other && other < pin)
    pin_curves~{pin}() = pin_curves~{other}();
  Else
    p = newp;
    Point(p) = {hole_x~{pin}, hole_y~{pin}, 0};
    For i In {0 : 2}
      a = Atan2(hole_y~{pin}, hole_x~{pin}) + 2 * Pi * i / 3;
      Point(p + 1 + i) = {hole_x~{pin} + pin_diameter / 2 * Cos(a), hole_y~{pin} + pin_diameter / 2 * Sin(a), 0, size};
    EndFor
    c = newc;
    For i In {0 : 2}
      Circle(c + i) = {p + 1 + i, p, p + 1 + (i + 1) % 3};
    EndFor
    Transfinite Curve{c : c + 2} = k + 1;
    pin_curves~{pin}() = {c : c + 2};
    l = newll; Curve Loop(l) = {c : c + 2};
    holes() += l;
  EndIf

  If(pin <= n_top)
    name = Sprintf("pin_top_%g", pin);
  Else
    name = Sprintf("pin_bottom_%g", pin - n_top);
  EndIf
  Physical Curve(Str(name)) = {pin_curves~{pin}()};
  If(Hypot(x~{pin} - hole_x~{pin}, y~{pin} - hole_y~{pin}) > tolerance)
    p = newp; Point(p) = {x~{pin}, y~{pin}, 0};
    Physical Point(Str(name)) = {p};
  EndIf
EndFor

s = news; Plane Surface(s) = {loop_1, loop_0, holes()};

// Let element sizes grow by two fifths of the distance from the pin if edges of pins are much shorter than elements of
// the disc, because Gmsh's default would fill the space between pins with small elements.
edge = Pi * pin_diameter / (3 * k);
If(edge < size / 4)
  outlines() = {};
  For pin In {1 : n_pins}
    outlines() += pin_curves~{pin}();
  EndFor
  Field[1]            = Distance;
  Field[1].CurvesList = {outlines()};
  Field[1].NumPointsPerCurve = 10 * k;
  Field[2]   = MathEval;
  Field[2].F = Sprintf("Min(%g, %g + 0.4 * F1)", size, edge);
  Background Field = 2;
  Mesh.MeshSizeExtendFromBoundary = 0;
  Mesh.MeshSizeFromPoints         = 0;
EndIf

Physical Surface("disc")    = {s};
Physical Curve("disc_bore") = {ring_curves_0()};
Physical Curve("disc_rim")  = {ring_curves_1()};
