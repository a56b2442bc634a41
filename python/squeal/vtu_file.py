# SPDX-License-Identifier: GPL-3.0-or-later

"""Reads the .vtu files of a run without VTK."""

import struct
import xml.etree.ElementTree
import zlib

import numpy as np

from squeal.errors import Error

# Names of VTK's cell types by number
SHAPES = {1: "vertex", 5: "triangle", 9: "quad", 10: "tetra", 12: "hexahedron", 13: "wedge", 14: "pyramid"}
TYPES = {"Float32": ("<f4", float), "Int32": ("<i4", int), "UInt8": ("u1", int)}  # types in the file and in memory


class VtuFile:
    """Content of a .vtu file: points (n x 3) and point fields (n x 3 or n) as arrays; cells as a list of arrays of
    point indices, with fields and VTK types (see SHAPES); the title, or None. Points shared by pieces are repeated.
    Raises Error if the file is damaged or was not written by squeal."""

    def __init__(self, path):
        self.path = path
        try:
            self._read(path.read_bytes())
        except (ArithmeticError, AttributeError, LookupError, SyntaxError, TypeError, ValueError, struct.error, zlib.error) as problem:
            raise Error(f"the field file cannot be read ({problem!r})", f"file {path}", "name a .vtu file of squeal, or run squeal again") from problem

    def _read(self, content):
        head, _, self.data = content.partition(b'<AppendedData encoding="raw">\n_')
        root = xml.etree.ElementTree.fromstring(head + b"</VTKFile>")
        if root.get("compressor") != "vtkZLibDataCompressor" or root.get("header_type") != "UInt64":
            raise ValueError("the compressor or the type of headers is unknown")
        title = root.find(".//FieldData/DataArray[@Name='mode']")
        self.title = None if title is None else bytes(map(int, title.text.split()[:-1])).decode()
        pieces = [{(part.tag, data.get("Name")): self.values(data) for part in piece for data in part}
                  for piece in root.iter("Piece")]

        def joined(tag):
            names = [name for part, name in pieces[0] if part == tag]
            return {name: np.concatenate([piece[tag, name] for piece in pieces]) for name in names}

        self.n_pieces, self.fields, self.cell_fields = len(pieces), joined("PointData"), joined("CellData")
        self.points, = joined("Points").values()
        self.cell_types, self.cells, first = joined("Cells")["types"], [], 0
        for piece in pieces:
            starts = [0, *piece["Cells", "offsets"]]
            self.cells += [first + piece["Cells", "connectivity"][a:b] for a, b in zip(starts, starts[1:])]
            first += sum(len(values) for (tag, _), values in piece.items() if tag == "Points")
        if not (all(len(values) == len(self.points) for values in self.fields.values())
                and all(len(values) == len(self.cells) for values in (self.cell_types, *self.cell_fields.values()))
                and all((0 <= cell).all() and (cell < len(self.points)).all() for cell in self.cells)):
            raise ValueError("the arrays do not match")

    def values(self, data):
        """Values of an array that is stored as sizes followed by one zlib block."""
        offset, (in_file, in_memory) = int(data.get("offset")), TYPES[data.get("type")]
        n_blocks, size, _, length = struct.unpack_from("<4Q", self.data, offset)
        plain = zlib.decompress(self.data[offset + 32:offset + 32 + length])
        if n_blocks != 1 or len(plain) != size:
            raise ValueError(f"the array {data.get('Name')} is incomplete")
        values = np.frombuffer(plain, in_file).astype(in_memory)
        return values.reshape(-1, 3) if data.get("NumberOfComponents") == "3" else values

    def field(self, name):
        """A point field. Raises Error if the file does not contain it."""
        if name not in self.fields:
            raise Error(f"the file has no point field {name}", self.path, f"name one of: {', '.join(self.fields)}")
        return self.fields[name]

    def as_meshio(self):
        """The content as a meshio Mesh."""
        import meshio

        of_blocks = {SHAPES[kind]: np.flatnonzero(self.cell_types == kind) for kind in np.unique(self.cell_types)}
        blocks = [(shape, np.array([self.cells[cell] for cell in numbers])) for shape, numbers in of_blocks.items()]
        cell_data = {name: [values[numbers] for numbers in of_blocks.values()]
                     for name, values in self.cell_fields.items()}
        return meshio.Mesh(self.points, blocks, point_data=dict(self.fields), cell_data=cell_data)
