# SPDX-License-Identifier: GPL-3.0-or-later

"""Reads nodes and elements of Nastran bulk data in free, small and large field format; properties become element sets."""

import collections
import re

from squeal.errors import Error
from squeal.importing.mesh_shapes import SHELLS, SOLIDS, read_text

ELEMENTS = {"CHEXA": SOLIDS, "CPENTA": SOLIDS, "CTETRA": SOLIDS, "CPYRA": SOLIDS, "CPYRAM": SOLIDS, "CQUAD4": SHELLS, "CQUAD8": SHELLS,
            "CQUADR": SHELLS, "CTRIA3": SHELLS, "CTRIA6": SHELLS, "CTRIAR": SHELLS}
CORNERS = {"CQUAD4": 4, "CQUADR": 4, "CTRIA3": 3, "CTRIAR": 3}  # number of corner nodes; angle and offsets follow on the card
# Nastran lists the mid-side nodes of the vertical edges before the mid-side nodes of the top
ORDER = {"hexahedron20": (*range(12), *range(16, 20), *range(12, 16)), "wedge15": (*range(9), *range(12, 15), *range(9, 12))}


def number(word):
    """The value of a Nastran real number: 1.5-3 means 1.5e-3, and a blank field means zero."""
    return float(re.sub(r"(?<=[\d.])([+-]\d+)$", r"e\1", word.upper().replace("D", "E")) if word else 0.0)


def cards(path):
    """(line number, fields) of every card of the bulk data; continuation lines begin with a blank field, + or *."""
    text = read_text(path)
    has_control = re.search(r"^\s*BEGIN\s+BULK", text, re.IGNORECASE | re.MULTILINE)
    begun, card, first = not has_control, [], 0
    for count, line in enumerate(text.split("\n"), 1):
        line = line.split("$")[0].rstrip().expandtabs(8)
        if not begun or not line:
            begun = begun or bool(re.match(r"\s*BEGIN\s+BULK", line, re.IGNORECASE))
            continue
        if line.upper().startswith("ENDDATA"):
            has_control = None
            break
        if "," in line:
            fields = [word.strip() for word in line.split(",")]
            width = 4 if fields[0].endswith("*") else 8
        else:
            width = 4 if "*" in line[:8] else 8
            fields = [line[:8].strip()] + [line[i:i + 64 // width].strip() for i in range(8, 72, 64 // width)]
        data = (fields[1:width + 1] + width * [""])[:width]
        if card and (not fields[0] or fields[0][0] in "+*"):
            card += data
            continue
        if card:
            yield first, card
        card, first = [fields[0].upper().rstrip("*").strip(), *data], count
    if has_control:
        raise Error("the file ends without ENDDATA", path, "export it again; it may be incomplete")
    if card:
        yield first, card


class NastranInput:
    """The content of a Nastran file, with the attributes of AbaqusInput, but no node sets, surfaces or materials."""

    def __init__(self, path):
        self.points, self.elements, self.element_sets = {}, {}, {}
        self.node_sets, self.surfaces, self.materials, self._unread = {}, {}, {}, collections.Counter()
        for line, card in cards(path):
            try:
                self._take(*card)
            except (ValueError, IndexError) as error:
                raise Error(f"{card[0]} cannot be read ({error})", f"{path}, line {line}", "correct this card") from error
        self.dropped = [f"elements {name}: {n}" for name, n in self._unread.items()]

    def _take(self, name, *fields):
        if name.startswith("INCLUDE"):
            raise ValueError("includes are not supported; write all cards to one file")
        if name == "GRID":
            if fields[1] not in ("", "0"):
                raise ValueError(f"node {fields[0]} is in coordinate system {fields[1]}; use the basic system")
            self._add_unique(self.points, "node", fields[0], [number(word) for word in fields[2:5]])
        elif name == "GRDSET" and fields[1] not in ("", "0"):
            raise ValueError(f"nodes are in coordinate system {fields[1]}; use the basic system")
        elif name in ELEMENTS:
            words = list(fields[2:CORNERS[name] + 2] if name in CORNERS else fields[2:])
            if name in ("CQUAD8", "CTRIA6"):
                words = words[:8 if name == "CQUAD8" else 6]
            nodes = [int(word) for word in words if word]
            shape = ELEMENTS[name].get(len(nodes))
            if not shape or CORNERS.get(name, len(nodes)) != len(nodes) or "" in words[:len(nodes)]:
                raise ValueError(f"element {fields[0]} has {len(nodes)} nodes")
            self._add_unique(self.elements, "element", fields[0], (shape, [nodes[i] for i in ORDER.get(shape, range(len(nodes)))]))
            self.element_sets.setdefault(fields[1] or fields[0], []).append(int(fields[0]))
        elif name.startswith(("C", "RBE", "PLOTEL", "RBAR")) and not name.startswith("CORD"):
            self._unread[name] += 1

    @staticmethod
    def _add_unique(known, what, label, value):
        if int(label) in known:
            raise ValueError(f"{what} {label} is defined twice")
        known[int(label)] = value
