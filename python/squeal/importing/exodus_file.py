# SPDX-License-Identifier: GPL-3.0-or-later

"""Reads nodes, element blocks, side sets and node sets of an Exodus II file; meshio omits block names and side sets."""

import re

import numpy as np

from squeal.errors import Error
from squeal.importing.mesh_shapes import SHELLS, SOLIDS, faces_of
from squeal.importing.nastran_input import ORDER

SHAPES = {"HEX": SOLIDS, "TET": SOLIDS, "WED": SOLIDS, "PYR": SOLIDS, "QUA": SHELLS, "SHE": SHELLS, "TRI": SHELLS}


def face_number(shape, side):
    """Index in faces_of() of side 1, 2, ... of a solid; Exodus numbers the lateral sides first."""
    return (side - 1 + (2 if shape.startswith(("hexahedron", "wedge")) else 1)) % len(faces_of(shape))


class ExodusFile:
    """The content of an Exodus file, with the attributes of AbaqusInput; elements are numbered in the order of the
    file. The name of an unnamed set consists of its kind and ID, such as block_3, sideset_3 or nodeset_3."""

    def __init__(self, path):
        self.elements, self.element_sets, self.surfaces, self.materials, self.dropped = {}, {}, {}, {}, []
        try:
            self._read(path)
        except (OSError, RuntimeError, AttributeError, LookupError, ValueError) as error:
            raise Error(f"the Exodus file cannot be read ({error!r})", path, "export it again") from error

    def _read(self, path):
        import netCDF4
        with netCDF4.Dataset(path) as file:
            file.set_auto_mask(False)
            self._variables = {name: np.array(variable[:]) for name, variable in file.variables.items()
                               if re.match("coord|(connect|node_ns|elem_ss|side_ss)\\d|(eb|ns|ss)_(names|prop1)$", name)}
            types = {name: file.variables[name].elem_type.upper() for name in self._variables if name.startswith("connect")}
        coordinates = self._variables["coord"] if "coord" in self._variables else [self._variables[f"coord{x}"] for x in "xyz"]
        self.points = dict(enumerate(map(list, np.transpose(coordinates)), 1))
        for name, connect in self._sets("eb", "block", "connect"):
            first, kind, n_nodes = len(self.elements) + 1, types[connect], self._variables[connect].shape[1]
            shape = SHAPES.get(kind[:3], {}).get(n_nodes)
            order = ORDER.get(shape, range(n_nodes))
            for nodes in self._variables[connect].tolist():
                self.elements[len(self.elements) + 1] = (shape, [nodes[i] for i in order]) if shape else (kind, [])
            self.element_sets[name] = list(range(first, len(self.elements) + 1))
        self.node_sets = {name: self._variables[nodes].tolist() for name, nodes in self._sets("ns", "nodeset", "node_ns")}
        for name, elements in self._sets("ss", "sideset", "elem_ss"):
            sides = zip(self._variables[elements].tolist(), self._variables[elements.replace("elem", "side")].tolist())
            solids = [(element, side) for element, side in sides if len(faces_of(self.elements[element][0])) > 1]
            self.surfaces[name] = [(element, face_number(self.elements[element][0], side)) for element, side in solids]

    def _sets(self, kind, what, variable):
        """Yields the name of each nonempty set and the variable with its members."""
        names = [b"".join(row).decode("utf-8", "replace").strip("\0 ") for row in self._variables.get(f"{kind}_names", [])]
        for number, identity in enumerate(self._variables.get(f"{kind}_prop1", []), 1):
            if f"{variable}{number}" in self._variables:
                yield names[number - 1] if len(names) >= number and names[number - 1] else f"{what}_{identity}", f"{variable}{number}"
