# SPDX-License-Identifier: GPL-3.0-or-later

"""Reads the .vtu files of a run without VTK."""

import array
import struct
import xml.etree.ElementTree
import zlib

from squeal.errors import Error

# Names of VTK cell types
SHAPES = {1: "vertex", 5: "triangle", 9: "quad", 10: "tetra", 12: "hexahedron", 13: "wedge", 14: "pyramid"}
TYPE_CODES = {"Float32": "f", "Int32": "i", "UInt8": "B"}


class VtuFile:
    """Points and point fields (triples or numbers); cells as lists of their points, with fields and VTK types (see SHAPES); the title, or
    None. Coincident points of several pieces are repeated."""

    def __init__(self, path):
        self.path = path
        head, _, self.data = path.read_bytes().partition(b'<AppendedData encoding="raw">\n_')
        root = xml.etree.ElementTree.fromstring(head + b"</VTKFile>")
        assert root.get("compressor") == "vtkZLibDataCompressor" and root.get("header_type") == "UInt64", path
        title = root.find(".//FieldData/DataArray[@Name='mode']")
        self.title = None if title is None else bytes(map(int, title.text.split()[:-1])).decode()
        self.points, self.fields, self.cells, self.cell_fields, self.cell_types = [], {}, [], {}, []
        self.n_pieces = 0
        for piece in root.iter("Piece"):
            self.n_pieces += 1
            first, (n_points, n_cells) = len(self.points), (int(piece.get(f"NumberOf{what}")) for what in ("Points", "Cells"))
            cells = {data.get("Name"): self.values(data) for data in piece.findall("Cells/DataArray")}
            self.points += self.values(piece.find("Points/DataArray"))
            starts = [0, *cells["offsets"]]
            self.cells += [[first + vertex for vertex in cells["connectivity"][a:b]] for a, b in zip(starts, starts[1:])]
            self.cell_types += cells["types"]
            for place, fields, n in (("PointData", self.fields, n_points), ("CellData", self.cell_fields, n_cells)):
                for data in piece.findall(f"{place}/DataArray"):
                    values = self.values(data)
                    assert len(values) == n, (path, data.get("Name"))
                    fields.setdefault(data.get("Name"), []).extend(values)
            assert starts[-1] == len(cells["connectivity"]) and len(starts) == n_cells + 1, path
            assert all(0 <= vertex < n_points for vertex in cells["connectivity"]) and len(self.points) == first + n_points, path

    def values(self, data):
        """Numbers or triples of an array: the sizes, then a single block compressed by zlib."""
        offset = int(data.get("offset"))
        n_blocks, size, _, length = struct.unpack_from("<4Q", self.data, offset)
        plain = zlib.decompress(self.data[offset + 32:offset + 32 + length])
        assert n_blocks == 1 and len(plain) == size, data.get("Name")
        values = array.array(TYPE_CODES[data.get("type")], plain).tolist()
        return list(zip(values[0::3], values[1::3], values[2::3])) if data.get("NumberOfComponents") == "3" else values

    def field(self, name):
        """A point field as an array. Raises Error if there is none."""
        import numpy

        if name not in self.fields:
            raise Error(f"the file has no point field {name}", self.path, f"name one of: {', '.join(self.fields)}")
        return numpy.array(self.fields[name])

    def as_meshio(self):
        """A Mesh of meshio."""
        import meshio

        blocks, of_blocks = [], []
        for kind in sorted(set(self.cell_types)):
            numbers = [cell for cell, of_cell in enumerate(self.cell_types) if of_cell == kind]
            blocks.append((SHAPES[kind], [self.cells[cell] for cell in numbers]))
            of_blocks.append(numbers)
        cell_data = {name: [[values[cell] for cell in numbers] for numbers in of_blocks] for name, values in self.cell_fields.items()}
        return meshio.Mesh(self.points, blocks, point_data=dict(self.fields), cell_data=cell_data)
