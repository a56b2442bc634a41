# SPDX-License-Identifier: GPL-3.0-or-later

"""Edits meshes in Gmsh's text format 4.1."""


class MeshFile:
    """Nodes and elements of a .msh file by tag; all other lines are kept."""

    def __init__(self, path):
        self.lines = path.read_text(encoding="utf-8").splitlines()
        self.names = {}     # (dimension, tag) -> name of the physical group
        self.nodes = {}     # tag -> (line, [x, y, z])
        self.elements = {}  # (dimension, tag of the entity) -> {tag: line}
        for line in self._section("PhysicalNames")[1:]:
            dimension, tag, name = self.lines[line].split(maxsplit=2)
            self.names[int(dimension), int(tag)] = name.strip('"')

        lines = iter(self._section("Nodes")[1:])
        for line in lines:
            n_nodes = int(self.lines[line].split()[3])
            tags = [int(self.lines[next(lines)]) for _ in range(n_nodes)]
            for tag in tags:
                line = next(lines)
                self.nodes[tag] = line, [float(x) for x in self.lines[line].split()]

        lines = iter(self._section("Elements")[1:])
        for line in lines:
            dimension, entity, _, n_elements = (int(x) for x in self.lines[line].split())
            block = self.elements.setdefault((dimension, entity), {})
            for _ in range(n_elements):
                line = next(lines)
                block[int(self.lines[line].split()[0])] = line

    def _section(self, name):
        first, last = self.lines.index(f"${name}"), self.lines.index(f"$End{name}")
        return range(first + 1, last)

    def entity(self, name):
        """(dimension, tag) of a physical group. The program writes one entity per group, with the same tag."""
        return next(key for key, value in self.names.items() if value == name)

    def element_nodes(self, dimension, entity, element):
        return [int(x) for x in self.lines[self.elements[dimension, entity][element]].split()[1:]]

    def set_element_nodes(self, dimension, entity, element, nodes):
        self.lines[self.elements[dimension, entity][element]] = " ".join(str(x) for x in [element, *nodes])

    def nodes_of(self, name):
        dimension, entity = self.entity(name)
        return {node for element in self.elements[dimension, entity] for node in self.element_nodes(dimension, entity, element)}

    def move(self, tag, position):
        line, _ = self.nodes[tag]
        self.nodes[tag] = line, position
        self.lines[line] = " ".join(repr(x) for x in position)

    def mirror(self):
        """Mirrors the mesh in y and reorders the nodes of elements to preserve their orientation."""
        for tag, (_, (x, y, z)) in list(self.nodes.items()):
            self.move(tag, [x, -y, z])
        for (dimension, entity), block in self.elements.items():
            for element in block:
                nodes = self.element_nodes(dimension, entity, element)
                layers = [nodes[i:i + 4] for i in range(0, len(nodes), 4)]
                self.set_element_nodes(dimension, entity, element, [node for layer in layers for node in (layer[0], *layer[:0:-1])])

    def write(self, path):
        path.write_text("\n".join(self.lines) + "\n", encoding="utf-8")
