"""Reads the .vtu files of a run without VTK."""

import array
import base64
import struct
import xml.etree.ElementTree
import zlib

TYPE_CODES = {"Float32": "f", "Float64": "d", "Int32": "i", "UInt8": "B"}


class VtuFile:
    """
    Points and point fields, as tuples of three numbers and as numbers; coincident points of several cells are repeated.
    The cells' VTK types: 9 is a quadrilateral, 12 a hexahedron.
    """

    def __init__(self, path):
        self.points, self.fields, self.cell_types = [], {}, []
        for piece in xml.etree.ElementTree.parse(path).iter("Piece"):
            self.points += triples(decode(piece.find("Points/DataArray")))
            self.cell_types += decode(piece.find("Cells/DataArray[@Name='types']"))
            for data in piece.findall("PointData/DataArray"):
                values = decode(data)
                if data.get("NumberOfComponents") == "3":
                    values = triples(values)
                self.fields.setdefault(data.get("Name"), []).extend(values)


def decode(data):
    """Numbers of a DataArray: base64 of the sizes of blocks, and of the blocks compressed by zlib."""
    text = "".join(data.text.split())
    n_blocks, = struct.unpack("<I", base64.b64decode(text[:8])[:4])
    length = 4 * ((4 * (3 + n_blocks) + 2) // 3)
    sizes = struct.unpack(f"<{n_blocks}I", base64.b64decode(text[:length])[12:12 + 4 * n_blocks])
    compressed, start, plain = base64.b64decode(text[length:]), 0, b""
    for size in sizes:
        plain += zlib.decompress(compressed[start:start + size])
        start += size
    return array.array(TYPE_CODES[data.get("type")], plain).tolist()


def triples(values):
    return list(zip(values[0::3], values[1::3], values[2::3]))
