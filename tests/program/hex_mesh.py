# SPDX-License-Identifier: GPL-3.0-or-later

"""Hexahedral meshes of a disc with pads; tests add typical faults of real meshes."""

import math

# Corners of a hexahedron in Gmsh's order, and corner numbers of its faces by outward normal
CORNERS = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
SIDES = {"-a": (0, 4, 7, 3), "+a": (1, 2, 6, 5), "-b": (0, 1, 5, 4), "+b": (3, 7, 6, 2), "-c": (0, 3, 2, 1), "+c": (4, 5, 6, 7)}


def cylindrical(r, theta, z):
    return r * math.cos(theta), r * math.sin(theta), z


class HexMesh:
    """Hexahedral mesh of several bodies with named faces. Blocks share no nodes."""

    def __init__(self):
        self.points = []
        self.cells = []  # (body, nodes)
        self.faces = []  # (names, nodes)

    def block(self, body, a, b, c, place=cylindrical, is_ring=False):
        """Adds a grid given by three lists of coordinates; a ring is closed along b. Returns {side: {cell: nodes}}."""
        n_b = len(b) - is_ring
        first = len(self.points)
        self.points += [place(x, y, z) for x in a for y in b[:n_b] for z in c]
        faces = {side: {} for side in SIDES}
        for i in range(len(a) - 1):
            for j in range(len(b) - 1):
                for k in range(len(c) - 1):
                    nodes = [first + ((i + p) * n_b + (j + q) % n_b) * len(c) + k + r for p, q, r in CORNERS]
                    self.cells.append((body, nodes))
                    for side, corners in SIDES.items():
                        place_along, last = {"a": (i, len(a)), "b": (j, len(b)), "c": (k, len(c))}[side[1]]
                        if place_along == (0 if side[0] == "-" else last - 2):
                            faces[side][i, j, k] = [nodes[corner] for corner in corners]
        return faces

    def name(self, faces, *names):
        """Adds faces, given as lists of nodes, with these names."""
        self.faces += [(names, list(nodes)) for nodes in faces]

    def bodies(self):
        return list(dict.fromkeys(body for body, _ in self.cells))

    def surfaces(self):
        return list(dict.fromkeys(name for names, _ in self.faces for name in names))

    def write_2(self, path, elementary=None):
        """Writes Gmsh's text format 2.2, with a copy of a face for each of its names. `elementary`: tag of all
        entities; by default one tag per name."""
        surfaces, bodies = self.surfaces(), self.bodies()
        elements = [(3, surfaces.index(name) + 1, nodes) for names, nodes in self.faces for name in names]
        elements += [(5, len(surfaces) + bodies.index(body) + 1, nodes) for body, nodes in self.cells]
        groups = [f'2 {i} "{name}"' for i, name in enumerate(surfaces, 1)]
        groups += [f'3 {i} "{name}"' for i, name in enumerate(bodies, len(surfaces) + 1)]
        points = [f"{i} " + " ".join(repr(float(x)) for x in point) for i, point in enumerate(self.points, 1)]
        rows = [f"{i} {kind} 2 {tag} {tag if elementary is None else elementary} {numbers(nodes)}"
                for i, (kind, tag, nodes) in enumerate(elements, 1)]
        write(path, "2.2", {"PhysicalNames": [len(groups), *groups], "Nodes": [len(points), *points], "Elements": [len(rows), *rows]})

    def write_4(self, path):
        """Writes Gmsh's text format 4.1, with one entity for each combination of names."""
        combinations = {}  # (dimension, names) -> nodes of elements
        for dimension, named in ((2, self.faces), (3, [((body,), nodes) for body, nodes in self.cells])):
            for names, nodes in named:
                combinations.setdefault((dimension, names), []).append(nodes)
        groups = list(dict.fromkeys((dimension, name) for dimension, names in combinations for name in names))
        tags = {key: number for number, key in enumerate(combinations, 1)}
        n = {dimension: sum(key[0] == dimension for key in combinations) for dimension in (2, 3)}
        entities = [f"0 0 {n[2]} {n[3]}"]
        for (dimension, names), tag in tags.items():
            physical = [groups.index((dimension, name)) + 1 for name in names]
            entities.append(f"{tag} -1 -1 -1 1 1 1 {len(physical)} {' '.join(map(str, physical))} 0")
        n_points = len(self.points)
        body = next(tag for (dimension, _), tag in tags.items() if dimension == 3)
        nodes = [f"1 {n_points} 1 {n_points}", f"3 {body} 0 {n_points}", *range(1, n_points + 1)]
        nodes += [" ".join(repr(float(x)) for x in point) for point in self.points]
        elements, number = [], 0
        for (dimension, names), some in combinations.items():
            elements.append(f"{dimension} {tags[dimension, names]} {3 if dimension == 2 else 5} {len(some)}")
            for element in some:
                number += 1
                elements.append(f"{number} {numbers(element)}")
        elements.insert(0, f"{len(combinations)} {number} 1 {number}")
        names = [f'{dimension} {i} "{name}"' for i, (dimension, name) in enumerate(groups, 1)]
        write(path, "4.1", {"PhysicalNames": [len(names), *names], "Entities": entities, "Nodes": nodes, "Elements": elements})


def numbers(nodes):
    return " ".join(str(node + 1) for node in nodes)


def write(path, version, sections):
    lines = ["$MeshFormat", f"{version} 0 8", "$EndMeshFormat"]
    for name, content in sections.items():
        lines += [f"${name}", *map(str, content), f"$End{name}"]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def angles(n, first=0, last=None):
    """Angles that divide the circle into n equal parts, from index `first` to index `last`."""
    return [2 * math.pi * part / n for part in range(first, (n if last is None else last) + 1)]


def disc_with_pads(n_parts=24, pad_parts=(0, 3), disc_layers=1):
    """A ring with one matching pad on each side, solved within a second. Returns the mesh and the faces of `disc`, `pin_top` and `pin_bottom`
    by side: -a and +a are bore and rim, -c and +c bottom and top."""
    mesh = HexMesh()
    radii, t = [0.15, 0.2, 0.25, 0.3], 0.02
    levels = [-t + 2 * t * layer / disc_layers for layer in range(disc_layers + 1)]
    faces = {"disc": mesh.block("disc", radii, angles(n_parts), levels, is_ring=True)}
    mesh.name(faces["disc"]["-a"].values(), "disc_bore")
    rubbed = [(1, part) for part in range(*pad_parts)]  # cells of the disc that face the pads
    for body, side, z in (("pin_top", "+c", [t, t + 0.015, t + 0.03]), ("pin_bottom", "-c", [-t - 0.03, -t - 0.015, -t])):
        pad = mesh.block(body, radii[1:3], angles(n_parts, *pad_parts), z)
        faces[body] = pad
        inner, outer = ("-c", "+c") if side == "+c" else ("+c", "-c")
        mesh.name([nodes for (i, j, _), nodes in faces["disc"][side].items() if (i, j) in rubbed], "disc_contact")
        mesh.name(pad[inner].values(), "pin_contact")
        mesh.name(pad[outer].values(), "pin_clamp")
    return mesh, faces


PARAMETERS = """
subsection Geometry
  set File = {file}
end
subsection Mounts
  set Elastic mounts = {mount}: 0, 7.8e10, 1.88e10
end
subsection Band
  set Maximum frequency = 4000
end
subsection Output
  set Mode shapes = none
end
"""
