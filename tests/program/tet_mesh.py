# SPDX-License-Identifier: GPL-3.0-or-later

"""Small brake of quadratic tetrahedra with nonmatching faces, which tests modify and write in several formats."""

import itertools
import math
import random

from hex_mesh import CORNERS, SIDES, angles, cylindrical, write

# Edges of a tetrahedron in Gmsh's order of mid-side nodes; the first three are the edges of a triangle
EDGES = ((0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3))
KUHN = []  # division of a hexahedron into six tetrahedra that share its main diagonal
for axes in itertools.permutations(range(3)):
    tetrahedron, corner = [(0, 0, 0)], [0, 0, 0]
    for axis in axes:
        corner[axis] = 1
        tetrahedron.append(tuple(corner))
    first, second, *rest = (CORNERS.index(place) for place in tetrahedron)
    is_even = axes in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
    KUHN.append((first, second, *rest) if is_even else (second, first, *rest))


class TetMesh:
    """Mesh of ten-node tetrahedra in named volumes, with named six-node faces."""

    def __init__(self):
        self.points = []
        self.cells = []  # (volume, nodes)
        self.faces = []  # (name, nodes)
        self._known = {}  # (body, coordinates) -> node

    def _node(self, body, coordinates):
        key = (body, *(round(x, 9) for x in coordinates))
        if key not in self._known:
            self._known[key] = len(self.points)
            self.points.append(cylindrical(*coordinates))
        return self._known[key]

    def block(self, volume, a, b, c, sides, body=None, is_ring=False):
        """Adds a grid given by radii, angles and heights, cut into tetrahedra. `sides`: name of each side in SIDES.
        Blocks of a body share nodes."""
        n = [len(a) - 1, len(b) - 1, len(c) - 1]
        last = {"-": lambda axis: 0, "+": lambda axis: n[axis] - 1}
        for cell in itertools.product(*map(range, n)):
            corners = [tuple(axis[i + p] for axis, i, p in zip((a, b, c), cell, corner)) for corner in CORNERS]

            def nodes_of(numbers, edges):
                places = [corners[i] for i in numbers]
                places += [tuple((x + y) / 2 for x, y in zip(places[i], places[j])) for i, j in edges]
                turn = 2 * math.pi if is_ring else math.inf
                return [self._node(body or volume, (r, angle - turn if angle > turn - 1e-9 else angle, z)) for r, angle, z in places]

            for tetrahedron in KUHN:
                self.cells.append((volume, nodes_of(tetrahedron, EDGES)))
                for side, name in sides.items():
                    axis = "abc".index(side[1])
                    face = [i for i in tetrahedron if i in SIDES[side]]
                    if len(face) == 3 and cell[axis] == last[side[0]](axis):
                        self.faces.append((name, nodes_of(face, EDGES[:3])))

    def moved(self, place, where=lambda volume: True):
        """Moves the nodes of the volumes for which `where` is true to place(x, y, z)."""
        for node in {node for volume, nodes in self.cells if where(volume) for node in nodes}:
            self.points[node] = place(*self.points[node])
        return self

    def renumbered(self, seed):
        """Permutes nodes and elements."""
        rng = random.Random(seed)
        order = rng.sample(range(len(self.points)), len(self.points))
        self.points = [self.points[node] for node in order]
        new = {node: number for number, node in enumerate(order)}
        self.cells, self.faces = ([(name, [new[node] for node in nodes]) for name, nodes in rng.sample(elements, len(elements))]
                                  for elements in (self.cells, self.faces))
        return self

    def volumes(self):
        return list(dict.fromkeys(name for name, _ in self.cells))

    def surfaces(self):
        return list(dict.fromkeys(name for name, _ in self.faces))

    def write_msh(self, path, version="2.2"):
        surfaces, volumes = self.surfaces(), self.volumes()
        names = [f'2 {i} "{name}"' for i, name in enumerate(surfaces, 1)] + [f'3 {i} "{name}"' for i, name in enumerate(volumes, 1)]
        points = [" ".join(repr(float(x)) for x in point) for point in self.points]
        blocks = [(2, i, 9, [f for name, f in self.faces if name == surface]) for i, surface in enumerate(surfaces, 1)]
        blocks += [(3, i, 11, [c for name, c in self.cells if name == volume]) for i, volume in enumerate(volumes, 1)]
        number, rows = itertools.count(1), []
        for dimension, tag, kind, elements in blocks:
            if version == "4.1":
                rows.append(f"{dimension} {tag} {kind} {len(elements)}")
            middle = " " if version == "4.1" else f" {kind} 2 {tag} {tag} "
            rows += [f"{next(number)}{middle}{' '.join(str(n + 1) for n in nodes)}" for nodes in elements]
        n, n_elements = len(points), len(self.faces) + len(self.cells)
        sections = {"PhysicalNames": [len(names), *names]}
        if version == "4.1":
            sections["Entities"] = [f"0 0 {len(surfaces)} {len(volumes)}", *(f"{tag} -1 -1 -1 1 1 1 1 {tag} 0" for _, tag, _, _ in blocks)]
            sections["Nodes"] = [f"1 {n} 1 {n}", f"3 1 0 {n}", *range(1, n + 1), *points]
            rows.insert(0, f"{len(blocks)} {n_elements} 1 {n_elements}")
        else:
            sections["Nodes"] = [n, *(f"{i} {point}" for i, point in enumerate(points, 1))]
            rows.insert(0, n_elements)
        write(path, version, {**sections, "Elements": rows})


def brake(n_parts=12, n_rings=2, pad_parts=3, backplate_parts=None, has_bond=False):
    """A ring and two nonmatching pads, each with lining and backplate."""
    mesh, t = TetMesh(), 0.012
    radii = [0.08 + 0.06 * i / n_rings for i in range(n_rings + 1)]
    mesh.block("disc", radii, angles(n_parts), [-t, t], {"-a": "disc_hub", "+c": "disc_top", "-c": "disc_bottom"}, is_ring=True)

    def span(n):
        return [math.radians(10 + 50 * i / n) for i in range(n + 1)]

    for pad, sign in (("pad_outer", 1), ("pad_inner", -1)):
        near, far = ("-c", "+c") if sign > 0 else ("+c", "-c")
        lining, backplate = {near: f"{pad}_face"}, {far: f"{pad}_back"}
        if has_bond:
            lining[far], backplate[near] = f"{pad}_lining_back", f"{pad}_front"
        mesh.block(f"{pad}_lining", [0.09, 0.12, 0.135], span(pad_parts), sorted((sign * t, sign * (t + 0.012))), lining, body=pad)
        mesh.block(f"{pad}_backplate", [0.09, 0.12, 0.135], span(backplate_parts or pad_parts), sorted((sign * (t + 0.012), sign * (t + 0.018))), backplate,
                   body=f"{pad}_backplate" if backplate_parts else pad)
    return mesh


def clutch():
    """Two coaxial discs and a pad between them that touches both."""
    mesh, radii = TetMesh(), [0.08, 0.11, 0.14]
    for disc, low, high, face, side in (("disc_rear", -0.02, -0.008, "rear_face", "+c"), ("disc_front", 0.008, 0.02, "front_face", "-c")):
        mesh.block(disc, radii, angles(12), [low, high], {"-a": f"{disc}_hub", side: face}, body=disc, is_ring=True)
    mesh.block("pad", [0.09, 0.12, 0.135], [math.radians(10 + 12 * i) for i in range(5)], [-0.008, 0.008],
               {"-c": "pad_rear", "+c": "pad_front", "+a": "pad_back"})
    return mesh


BRAKE = """
subsection Geometry
  set File = {file}
end
subsection Contact
  set Pairs = disc_top / pad_outer_face; disc_bottom / pad_inner_face
end
subsection Disc material
  set Young modulus = 110e9
  set Poisson ratio = 0.28
  set Density       = 7200
end
subsection Pin material
  set Young modulus = 5e9
  set Poisson ratio = 0.25
  set Density       = 2600
end
subsection Materials
  set Volumes = pad_outer_backplate: 210e9, 0.3, 7850; pad_inner_backplate: 210e9, 0.3, 7850
end
subsection Mounts
  set Elastic mounts = disc_hub: 1e12, 1e12, 1e12; pad_outer_back: 2e10, 2e10, 2e10; pad_inner_back: 2e10, 2e10, 2e10
end
subsection Discretization
  set Element = quadratic
end
subsection Operation
  set Friction coefficient = 0.5
end
subsection Output
  set Mode shapes = none
end
"""
