// SPDX-License-Identifier: GPL-3.0-or-later

// Plan of a ring-shaped disc and a pad on its upper face that covers the whole circumference between the mean radius
// and the rim, so that waves along the contact do not reach an edge. element_size is the largest length of the
// elements along the mean circle. Units: m.

DefineConstant[
  disc_inner_radius = 0.0055,
  disc_outer_radius = 0.0065,
  element_size      = 0.0024
];

// Every element is halved after meshing
mean_radius         = (disc_inner_radius + disc_outer_radius) / 2;
elements_of_quarter = Ceil(Pi / 4 * mean_radius / element_size);

centre = newp; Point(centre) = {0, 0, 0};

// Bore, mean circle and rim, each of four arcs
r() = {disc_inner_radius, mean_radius, disc_outer_radius};
For ring In {0 : 2}
  p~{ring} = newp;
  For i In {0 : 3}
    Point(p~{ring} + i) = {r(ring) * Cos(Pi * i / 2), r(ring) * Sin(Pi * i / 2), 0};
  EndFor
EndFor
arc = newc;
For ring In {0 : 2}
  For i In {0 : 3}
    Circle(arc + 4 * ring + i) = {p~{ring} + i, centre, p~{ring} + (i + 1) % 4};
  EndFor
EndFor
ray = newc;
For ring In {0 : 1}
  For i In {0 : 3}
    Line(ray + 4 * ring + i) = {p~{ring} + i, p~{ring + 1} + i};
  EndFor
EndFor

face = news;
For ring In {0 : 1}
  For i In {0 : 3}
    Curve Loop(face + 4 * ring + i) =
      {ray + 4 * ring + i, arc + 4 * (ring + 1) + i, -(ray + 4 * ring + (i + 1) % 4), -(arc + 4 * ring + i)};
    Plane Surface(face + 4 * ring + i) = {face + 4 * ring + i};
  EndFor
EndFor
Transfinite Curve{arc : arc + 11} = elements_of_quarter + 1;
Transfinite Curve{ray : ray + 7} = 2;
Transfinite Surface{:};
Mesh.RecombineAll = 1;

Physical Surface("disc")      = {face : face + 3};
Physical Surface("pin_top_1") = {face + 4 : face + 7};
Physical Curve("disc_bore")   = {arc : arc + 3};
Physical Curve("disc_rim")    = {arc + 8 : arc + 11};
