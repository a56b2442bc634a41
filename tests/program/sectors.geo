// A plan whose mesh is its own mirror image: three rings of 24 sectors, of which
// some are pads on both faces. The mesh that includes this sets ring(), the rings
// (0 ... 2), and sector(), the sectors (0 ... 23) of the pads. Units: m.
r() = {0.15, 0.20, 0.26, 0.31};
n   = 24;

centre = newp; Point(centre) = {0, 0, 0};
For j In {0 : 3}
  p~{j} = newp;
  For i In {0 : n - 1}
    Point(p~{j} + i) = {r(j) * Cos(2 * Pi * i / n), r(j) * Sin(2 * Pi * i / n), 0};
  EndFor
EndFor
arc = newc;
For j In {0 : 3}
  For i In {0 : n - 1}
    Circle(arc + n * j + i) = {p~{j} + i, centre, p~{j} + (i + 1) % n};
  EndFor
EndFor
ray = newc;
For j In {0 : 2}
  For i In {0 : n - 1}
    Line(ray + n * j + i) = {p~{j} + i, p~{j + 1} + i};
  EndFor
EndFor
face = news;
For j In {0 : 2}
  For i In {0 : n - 1}
    Curve Loop(face + n * j + i) = {ray + n * j + i, arc + n * (j + 1) + i, -(ray + n * j + (i + 1) % n), -(arc + n * j + i)};
    Plane Surface(face + n * j + i) = {face + n * j + i};
  EndFor
EndFor
Transfinite Curve{:} = 2;
Transfinite Surface{:};

pads() = {};
For k In {0 : #ring() - 1}
  pad = face + n * ring(k) + sector(k);
  pads() += pad;
  Physical Surface(Str(Sprintf("pin_top_%g", k + 1)))    = {pad};
  Physical Surface(Str(Sprintf("pin_bottom_%g", k + 1))) = {pad};
EndFor
rest() = {face : face + 3 * n - 1};
rest() -= pads();
Physical Surface("disc")    = {rest()};
Physical Curve("disc_bore") = {arc : arc + n - 1};
Physical Curve("disc_rim")  = {arc + 3 * n : arc + 4 * n - 1};
