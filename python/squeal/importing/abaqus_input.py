# SPDX-License-Identifier: GPL-3.0-or-later

"""Reads nodes, elements, sets, surfaces and elastic materials of an Abaqus input file with its includes."""

import itertools
import re

from squeal.errors import Error
from squeal.importing.mesh_shapes import faces_of, read_text, shape_of

# Unsupported keywords that generate or transform nodes and elements
GENERATORS = ("NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM", "IMPORT", "SYMMETRIC MODEL GENERATION", "IMPERFECTION")
WITHOUT_PARTS = "write the input file with the option `Do not use parts and assemblies in input files`"


def split(line):
    """Words separated by commas outside quotes."""
    words = re.split(r',(?=(?:[^"]*"[^"]*")*[^"]*$)', line) if '"' in line else line.split(",")
    return [word.strip() for word in words]


def axes_of(options, rows):
    """Vectors along axis 1 and in the plane of axes 1 and 2; () for cylindrical axes about z; None for unsupported
    axes."""
    points, angles = [float(word or 0) for word in rows[0]], [float(word or 0) for row in rows[1:] for word in row[1:]]
    a, b, c = ((points + [0.0] * 9)[i:i + 3] for i in (0, 3, 6))
    if options.get("DEFINITION", "COORDINATES") == "COORDINATES" and not any(angles):
        if options.get("SYSTEM", "RECTANGULAR") == "RECTANGULAR":
            return tuple(x - origin for point in (a, b) for x, origin in zip(point, c))
        if options["SYSTEM"] == "CYLINDRICAL" and not any((*a[:2], *b[:2])):
            return ()
    return None


class AbaqusInput:
    """The content of an Abaqus input file.

    points: label -> coordinates; elements: label -> (shape, node labels); element_sets, node_sets: name -> labels;
    surfaces: name -> [(element label, face index)]; materials: element label -> (constants, rho, axes) in the units of
    the file, or None if incomplete, unsupported or ambiguous; dropped: descriptions of omitted surfaces and set members.
    The constants are E and nu without axes, or nine engineering constants with axes as returned by axes_of(). Names are
    in capitals, because Abaqus ignores case."""

    def __init__(self, path):
        self.points, self.elements, self.element_sets, self.node_sets = {}, {}, {}, {}
        self.surfaces, self.materials, self.dropped = {}, {}, []
        self._path, self._sections, self._properties, self._material = path, [], {}, None
        self._axes = {None: (1.0, 0.0, 0.0, 0.0, 1.0, 0.0)}
        self._parts, self._instance, self._of_part = 0, "", set()
        self._read()
        for sets, known in ((self.element_sets, self.elements), (self.node_sets, self.points)):
            sets.update({name: self._labels(sets, known, name) for name in sets})
        faces = {name: [face for entry in entries for face in self._faces(name, *entry)] for name, entries in self.surfaces.items()}
        self.surfaces = {name: members for name, members in faces.items() if None not in members}
        self.dropped += [f"surface {name}, which has edges or faces of unsupported elements" for name in faces if name not in self.surfaces]
        for elements, material, orientation in self._sections:
            properties = self._properties.get(material, {})
            is_isotropic = len(properties.get("constants", ())) == 2
            axes = None if is_isotropic else self._axes.get(orientation)
            value = (properties["constants"], properties["rho"], axes) if len(properties) == 2 and (is_isotropic or axes is not None) else None
            for label in self._known(self.element_sets, elements, "*SOLID SECTION"):
                self.materials[label] = value if self.materials.get(label, value) == value else None

    def _error(self, what, change, where=None):
        return Error(what, where or self._path, change)

    def _lines(self, path, above=()):
        """(where, line) of a file and its includes, without comments; a keyword line that ends with a comma is joined
        with the next line."""
        if path in above or not path.is_file():
            what = "includes itself" if path in above else "is missing"
            raise self._error(f"the included file {path} {what}", "correct the INPUT parameter, or add the file")
        begun = ""
        for number, line in enumerate(read_text(path).split("\n"), 1):
            line = line.strip()
            if line.startswith("**") or not line:
                continue
            if begun and line.startswith("*"):
                raise self._error("the previous keyword line ends with a comma", "remove the comma", f"{path}, line {number}")
            begun += line
            if line.endswith(",") and begun.startswith("*"):
                continue
            line, begun = begun, ""
            if re.match(r"\*\s*INCLUDE\b", line, re.IGNORECASE):
                name = line.partition("=")[2].strip().strip('"')
                yield from self._lines(self._path.parent / name, (*above, path))
            else:
                yield f"{path}, line {number}", line

    def _read(self):
        keyword, options, rows, where = "", {}, [], ""
        for place, line in itertools.chain(self._lines(self._path), [("", "*END")]):
            if not line.startswith("*"):
                rows.append([word.strip('"') for word in split(line)])
                continue
            try:
                self._take(keyword, options, rows)
            except (ValueError, IndexError, KeyError, TypeError) as error:
                raise self._error(f"*{keyword} cannot be read ({error})", "correct this line or its data lines", where) from error
            where, (keyword, *words) = place, split(line[1:])
            keyword = " ".join(keyword.upper().split())
            options = {key.strip().upper(): value.strip().strip('"') for key, _, value in (word.partition("=") for word in words)}
            rows = [split(data) for _, data in self._lines(self._path.parent / options["INPUT"])] if "INPUT" in options else []
            options = {key: value.upper() for key, value in options.items()}

    def _take(self, keyword, options, rows):
        if keyword in GENERATORS or keyword == "NODE" and options.get("SYSTEM", "R") != "R":
            raise self._error(f"*{keyword} generates or transforms nodes or elements", "write all nodes and elements in global Cartesian coordinates")
        if keyword in ("PART", "INSTANCE"):
            self._parts += keyword == "PART"
            if self._parts > 1 or keyword == "INSTANCE" and (self._instance or any(float(word) for row in rows for word in row if word)):
                raise self._error("the file has several parts or instances, or a moved instance", WITHOUT_PARTS)
            if keyword == "INSTANCE":
                self._instance = options["NAME"] + "."
        elif keyword == "END INSTANCE":
            self._of_part = {(id(sets), name) for sets in (self.element_sets, self.node_sets, self.surfaces) for name in sets}
        elif keyword == "NODE":
            new = [(int(label), [float(x), float(y), float(z)]) for label, x, y, z, *_ in rows]
            self._add_unique(self.points, new, "node", self.node_sets, options.get("NSET"))
        elif keyword == "ELEMENT":
            self._take_elements(options, rows)
        elif keyword in ("NSET", "ELSET"):
            if "GENERATE" in options:
                members = [range(int(row[0]), int(row[1]) + 1, *map(int, filter(None, row[2:]))) for row in rows]
                if any(not member or member.step < 0 for member in members):
                    raise ValueError("a range is empty or descending")
            else:
                members = [self._member(word) for row in rows for word in row if word]
            # With the option ELSET, the nodes of an element set form a node set
            members += [(options["ELSET"],)] if keyword == "NSET" and "ELSET" in options else []
            self._add(self.node_sets if keyword == "NSET" else self.element_sets, options[keyword], members)
        elif keyword == "SURFACE" and options.get("TYPE", "ELEMENT") in ("ELEMENT", "NODE") and not {"COMBINE", "CROP"} & options.keys():
            sets = self.node_sets if options.get("TYPE") == "NODE" else self.surfaces
            new = [self._member(row[0]) for row in rows] if sets is self.node_sets else [(self._member(row[0]), *row[1:2]) for row in rows]
            if options["NAME"] in sets and not (sets is self.node_sets and new == [options["NAME"]]):
                raise self._error(f"surface {options['NAME']} is defined twice, or is also a node set", "rename one of them")
            sets.setdefault(options["NAME"], new)
        elif keyword == "SURFACE":
            self.dropped.append(f"surface {options['NAME']}, which is not a list of faces or nodes")
        elif keyword == "SOLID SECTION":
            self._sections.append((options["ELSET"], options.get("MATERIAL"), options.get("ORIENTATION")))
        elif keyword == "ORIENTATION":
            self._axes[options["NAME"]] = axes_of(options, rows)
        elif keyword == "MATERIAL":
            if options["NAME"] in self._properties:
                raise ValueError(f"{options['NAME']} is defined twice")
            self._material = options["NAME"]
            self._properties[self._material] = {}
        elif keyword == "ELASTIC" and options.get("TYPE", "ISOTROPIC") in ("ISOTROPIC", "ISO") and len(rows) == 1:
            self._properties[self._material].update(constants=(float(rows[0][0]), float(rows[0][1])))
        elif keyword == "ELASTIC" and options.get("TYPE") == "ENGINEERING CONSTANTS" and len(rows) == 2:
            self._properties[self._material].update(constants=tuple(float(word) for word in [*rows[0][:8], rows[1][0]]))
        elif keyword == "DENSITY" and len(rows) == 1:
            self._properties[self._material].update(rho=float(rows[0][0]))

    def _take_elements(self, options, rows):
        shape, n_nodes = shape_of(options["TYPE"])
        new, numbers = [], []
        for row in rows:
            numbers += [int(word) for word in row if word]
            if len(numbers) > n_nodes if n_nodes else row[-1] or len(row) < 9:
                new.append((numbers[0], (shape, numbers[1:] if n_nodes else [])))
                if n_nodes and len(numbers) != n_nodes + 1:
                    break
                numbers = []
        if numbers:
            raise ValueError(f"element {numbers[0]} of type {options['TYPE']} has {len(numbers) - 1} nodes")
        self._add_unique(self.elements, new, "element", self.element_sets, options.get("ELSET"))

    def _add_unique(self, known, new, what, sets, name):
        for label, value in new:
            if label in known:
                raise self._error(f"{what} {label} is defined twice", f"renumber the parts, or {WITHOUT_PARTS}")
            known[label] = value
        if name:
            self._add(sets, name, [label for label, _ in new])

    def _add(self, sets, name, members):
        if (id(sets), name) in self._of_part:
            raise self._error(f"set {name} is defined in the part and in the assembly", f"rename one of them, or {WITHOUT_PARTS}")
        sets.setdefault(name, []).extend(members)

    def _member(self, word):
        """A label or a set name, without the instance name."""
        word = word.upper().removeprefix(self._instance)
        return int(word) if word.isdigit() else word

    def _known(self, sets, name, where):
        if name not in sets:
            raise self._error(f"{where} refers to `{name}`, which is not in the file", "define it, or remove the reference")
        return sets[name]

    def _labels(self, sets, known, name, above=()):
        """Labels of a set with its member sets and ranges; labels in a range need not exist."""
        labels = {}
        for member in self._known(sets, name, f"set {above[-1] if above else name}"):
            if isinstance(member, str):
                if member in above or member == name:
                    raise self._error(f"set {name} contains itself", "remove the reference")
                member = self._labels(sets, known, member, (*above, name))
            elif isinstance(member, tuple):
                member = [node for element in self._known(self.element_sets, member[0], f"set {name}") for node in self.elements[element][1]]
            elif isinstance(member, range):
                member = [label for label in known if label in member] if len(member) > len(known) else list(filter(known.__contains__, member))
            labels.update(dict.fromkeys(member if isinstance(member, list) else [member]))
        if unknown := [label for label in labels if label not in known]:
            self.dropped += [] if above else [f"members of set {name} that are not in the file: {len(unknown)}, such as {unknown[0]}"]
        return [label for label in labels if label in known]

    def _faces(self, surface, elements, side=""):
        labels = [elements] if isinstance(elements, int) else self._known(self.element_sets, elements, f"surface {surface}")
        for label in labels:
            faces = faces_of(self._known(self.elements, label, f"surface {surface}")[0])
            sides = ["SPOS", "SNEG"] if len(faces) == 1 else [f"S{number + 1}" for number in range(len(faces))]
            if not faces or len(faces) == 1 and side.upper().startswith("E"):
                yield None
            elif side and side.upper() not in sides:
                raise self._error(f"element {label} of surface {surface} has no side {side}", f"use one of: {', '.join(sides)}")
            else:
                yield from ((label, number) for number in ([sides.index(side.upper()) % len(faces)] if side else range(len(faces))))
