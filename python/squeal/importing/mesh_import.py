# SPDX-License-Identifier: GPL-3.0-or-later

"""Converts a mesh of another pre-processor to a .msh file with named volumes and faces, and writes a parameter file."""

import collections
import os
import pathlib
import re
import tempfile

import numpy as np

from squeal.errors import Error
from squeal.importing.configuration import read_yaml
from squeal.importing.foreign_mesh import UNITS, read, with_meshio
from squeal.importing.mesh_shapes import faces_of, middle_nodes

STRESS_AND_DENSITY = {"m": (1.0, 1.0), "mm": (1e6, 1e12)}  # factors to SI from N, m, kg, s and N, mm, t, s
FACES = {3: "triangle", 4: "quad", 6: "triangle6", 8: "quad8"}  # shape of a face by its number of nodes
SURFACES = ("disc_contact", "pin_contact", "pin_clamp", "pin_side", "disc_bore", "disc_rim")
PLAUSIBLE = (0.05, 1.5)  # plausible extent of a brake [m]
PLAUSIBLE_DENSITY = (100, 30000)  # plausible density [kg/m^3]


def length_hint(mesh):
    extent = np.ptp(mesh.points[sorted({node for number, (_, nodes) in enumerate(mesh.elements) if mesh.is_solid(number) for node in nodes})], axis=0)
    fitting = [f"--unit {unit} ({size * extent.max():.3g} m)" for unit, size in UNITS.items() if PLAUSIBLE[0] <= size * extent.max() <= PLAUSIBLE[1]]
    return " x ".join(f"{x:.4g}" for x in extent), " or ".join(fitting) or f"no unit for a brake of {PLAUSIBLE[0]} to {PLAUSIBLE[1]} m"


def is_of_disc(name):
    return name == "disc" or name.startswith("disc_")


def is_volume(name):
    """True if a set of this name becomes a volume by default."""
    return name.lower() == "disc" or name.lower().startswith("pin_") and not is_surface(name)


def is_surface(name):
    return name.lower() in SURFACES


def chosen(given, sets, what, is_known, path):
    """Name in squeal -> names in the file, for the given names and for names that need no renaming."""
    result = {}
    for name, members in given.items():
        for member in members:
            found = [member] if member in sets else [other for other in sets if other.lower() == member.lower()]
            if len(found) != 1:
                raise Error(f"there is no {what} `{member}`" if not found else f"`{member}` is ambiguous: {' or '.join(found)}", path,
                            f"choose from: {', '.join(sorted(sets)) or '(none)'}")
            result.setdefault(name, []).extend(found)
    used = {member for members in result.values() for member in members}
    for name in sorted(sets):
        if is_known(name) and name.lower() not in given and name not in used:
            result.setdefault(name.lower(), []).append(name)
    return result


class Import:
    """The requested volumes and faces of a mesh."""

    def __init__(self, mesh, volumes, surfaces, path):
        self.mesh, self.path, self.volume_of, self.left = mesh, path, {}, list(mesh.dropped)
        solids = {name for name, numbers in mesh.element_sets.items() if any(map(mesh.is_solid, numbers))}
        self.volumes = chosen(volumes, solids, "set of solids", is_volume, path)
        if not any(map(is_of_disc, self.volumes)):
            raise Error("no set of elements is assigned to the disc", path,
                        f"use --volume disc=SET with a set from: {', '.join(sorted(solids)) or '(none)'}")
        for name, member in ((name, member) for name, members in self.volumes.items() for member in members):
            for number in mesh.element_sets[member]:
                if not faces_of(mesh.elements[number][0]):
                    raise Error(f"`{member}` has elements of type {mesh.elements[number][0]}, which are not supported", path,
                                "choose sets without such elements")
                if mesh.is_solid(number) and self.volume_of.setdefault(number, name) != name:
                    raise Error(f"elements of `{member}` are in volumes {self.volume_of[number]} and {name}", path,
                                "choose sets that share no elements")
        self.outer = self._outer_faces()
        regions = {*mesh.node_sets, *mesh.faces, *filter(mesh.shells, mesh.element_sets)}
        self.surfaces = chosen(surfaces, regions, "surface, set of shells or set of nodes", is_surface, path)
        if both := self.surfaces.keys() & self.volumes.keys():
            raise Error(f"`{both.pop()}` is the name of a volume and of a surface", path, "give the surface another name")
        self.faces = {name: list({key: self.outer[key] for member in members for key in self._faces_of(name, member)}.values())
                      for name, members in self.surfaces.items()}
        self.is_quadratic = any(middle_nodes(*mesh.elements[number]) for number in self.volume_of)

    def _outer_faces(self):
        """Faces that belong to one element only: sorted corners -> corners and mid-side nodes."""
        found = collections.defaultdict(list)
        for number in self.volume_of:
            shape, nodes = self.mesh.elements[number]
            middle = middle_nodes(shape, nodes)
            for face in faces_of(shape):
                corners = tuple(nodes[i] for i in face)
                edges = zip(corners, (*corners[1:], corners[0])) if middle else ()
                found[tuple(sorted(corners))].append(corners + tuple(middle[frozenset(edge)] for edge in edges))
        if any(len(faces) > 2 for faces in found.values()):
            raise Error("more than two elements share a face", self.path, "remove duplicate elements")
        return {key: faces[0] for key, faces in found.items() if len(faces) == 1}

    def _faces_of(self, name, member):
        """Boundary faces of a set, as keys of `outer`."""
        found = [{tuple(sorted(face)) for face in faces} for faces in (self.mesh.faces.get(member), self.mesh.shells(member)) if faces]
        if nodes := set(self.mesh.node_sets.get(member, ())):
            found.append({key for key in self.outer if nodes.issuperset(key)})
            if len(found) == 1 and (alone := len(nodes & {node for key in self.outer for node in key} - {node for key in found[0] for node in key})):
                self.left.append(f"boundary nodes of {member} that do not form a complete face: {alone}")
        outside = [sorted(keys & self.outer.keys()) for keys in found] or [[]]
        if any(other != outside[0] for other in outside):
            raise Error(f"several sets are called `{member}` and contain different faces", self.path, "rename one of them")
        if not outside[0]:
            raise Error(f"`{member}` has no face on the boundary of the volumes", self.path, f"choose boundary faces for {name}")
        if inside := len(found[0]) - len(outside[0]):
            self.left.append(f"faces of {member} that are not on the boundary of a volume: {inside}")
        return outside[0]

    def write(self, path, scale):
        """Writes Gmsh's format 2.2; a face that belongs to several surfaces is written for each of them."""
        order = sorted(self.volume_of)
        used = sorted({node for number in order for node in self.mesh.elements[number][1]})
        new = {node: number for number, node in enumerate(used)}
        tags = {name: tag for tag, name in enumerate([*self.faces, *self.volumes], 1)}
        blocks = collections.defaultdict(lambda: ([], []))  # shape -> nodes of elements, tags
        elements = [(FACES[len(nodes)], nodes, name) for name, faces in self.faces.items() for nodes in faces]
        for shape, nodes, name in elements + [(*self.mesh.elements[number], self.volume_of[number]) for number in order]:
            blocks[shape][0].append([new[node] for node in nodes])
            blocks[shape][1].append(tags[name])
        physical = [np.array(tag) for _, tag in blocks.values()]
        fields = {name: np.array([tag, 3 if name in self.volumes else 2]) for name, tag in tags.items()}
        cells = [(shape, np.array(nodes)) for shape, (nodes, _) in blocks.items()]
        with_meshio(lambda meshio: meshio.write(path, meshio.Mesh(
            scale * self.mesh.points[used], cells, cell_data={"gmsh:physical": physical, "gmsh:geometrical": physical}, field_data=fields),
            file_format="gmsh22", binary=False), path)

    def is_on_disc(self, name):
        nodes = {node for number, volume in self.volume_of.items() if is_of_disc(volume) for node in self.mesh.elements[number][1]}
        return nodes.issuperset(self.faces[name][0])

    def report(self):
        lines = []
        for name, members in self.volumes.items():
            shapes = collections.Counter(self.mesh.elements[n][0] for n, volume in self.volume_of.items() if volume == name)
            lines.append(f"  volume {name}: {', '.join(f'{n} {shape}' for shape, n in shapes.items())} of {', '.join(members)}")
        lines += [f"  surface {name}: {', '.join(self.surfaces[name])} (faces: {len(faces)})" for name, faces in self.faces.items()]
        named = {member for members in [*self.volumes.values(), *self.surfaces.values()] for member in members}
        faces = {number for members in self.surfaces.values() for member in members for number in self.mesh.element_sets.get(member, [])}
        left = collections.Counter(shape for number, (shape, _) in enumerate(self.mesh.elements)
                                   if number not in self.volume_of and (number not in faces or self.mesh.is_solid(number)))
        unused = sorted({*self.mesh.element_sets, *self.mesh.faces, *self.mesh.node_sets} - named)
        self.left += [f"elements of type {shape}: {n}" for shape, n in left.items()] + (["sets " + ", ".join(unused)] if unused else [])
        return "\n".join(lines + [f"  left out: {what}" for what in self.left])

    def materials(self, unit):
        """Volume -> (constants, rho, axes) in SI units, for volumes with a single material in known units."""
        found, (stress, density) = {}, STRESS_AND_DENSITY.get(unit, (0.0, 0.0))
        for name in self.volumes:
            known = {self.mesh.materials.get(number) for number, volume in self.volume_of.items() if volume == name}
            if len(known) == 1 and (material := known.pop()) and PLAUSIBLE_DENSITY[0] <= material[1] * density <= PLAUSIBLE_DENSITY[1]:
                constants, rho, axes = material
                is_modulus = (1, 0) if axes is None else (1, 1, 1, 0, 0, 0, 1, 1, 1)
                found[name] = tuple(x * stress if scaled else x for x, scaled in zip(constants, is_modulus)), rho * density, axes
            elif self.mesh.materials:
                self.left.append(f"material of {name}; required: one material at one temperature, isotropic or with engineering constants in "
                                 "Cartesian axes or cylindrical axes about z, and a density in SI units or N, mm, t, s")
        return found


def parameter_file(mesh_file, result, materials, contact, mounts):
    """Text of the parameter file of the brake, with comments to be completed for unknown contact pairs and mounts."""
    def section(name, *lines):
        return f"subsection {name}\n" + "".join(f"  {line}\n" for line in lines) + "end\n"

    def names(is_wanted):
        return ", ".join(filter(is_wanted, result.surfaces)) or "(none)"

    text = section("Geometry", f"set File = {mesh_file.name}")
    if contact:
        text += section("Contact", "set Pairs = " + "; ".join(contact))
    elif not {"disc_contact", "pin_contact"} <= result.surfaces.keys():
        text += section("Contact", f"# Surfaces of the disc: {names(result.is_on_disc)}; of other bodies: {names(lambda name: not result.is_on_disc(name))}",
                        "# set Pairs = surface of the disc / surface of another body: friction factor; ...")
    disc = next(filter(is_of_disc, result.volumes))
    isotropic = {name: (*constants, rho) for name, (constants, rho, axes) in materials.items() if axes is None}
    if disc in isotropic:
        text += section("Disc material", *(f"set {name} = {value:.10g}" for name, value in
                                           zip(("Young modulus", "Poisson ratio", "Density"), isotropic[disc])))
    lists = {"Volumes": {name: values for name, values in isotropic.items() if not is_of_disc(name) or values != isotropic.get(disc)},
             "Orthotropic": {name: (*constants, rho) for name, (constants, rho, axes) in materials.items() if axes is not None},
             "Axes": {name: axes for name, (_, _, axes) in materials.items() if axes}}
    if any(lists.values()):
        text += section("Materials", *(f"set {parameter} = " + "; ".join(f"{name}: " + ", ".join(f"{x:.10g}" for x in values)
                                                                         for name, values in entries.items())
                                       for parameter, entries in lists.items() if entries))
    if mounts:
        text += section("Mounts", "set Elastic mounts = " + "; ".join(mounts))
    elif "disc_bore" not in result.surfaces:
        text += section("Mounts", f"# Surfaces: {names(lambda name: True)}; stiffness in N/m^3",
                        "# set Elastic mounts = surface: radial, tangential, axial; ...")
    if result.is_quadratic:
        text += section("Discretization", "set Element = quadratic")
    return text


def names_of(arguments):
    """Volumes, surfaces, contact, mounts and unit from the command line and the file --names."""
    given = read_yaml(arguments.names, 'names') if arguments.names else {}
    if not (isinstance(given, dict) and given.keys() <= {"unit", "volumes", "surfaces", "contact", "mounts"} and
            all(isinstance(given.get(key, {}), dict) for key in ("volumes", "surfaces")) and
            all(isinstance(given.get(key, []), list) and all(isinstance(entry, str) for entry in given.get(key, [])) for key in ("contact", "mounts"))):
        raise Error("an entry is not unit, volumes, surfaces, contact or mounts, or has the wrong type", arguments.names,
                    'write {unit: mm, volumes: {disc: [ROTOR]}, surfaces: {}, contact: [disc_top / pad_face], mounts: ["pad_back: 0, 0, 1e10"]}')
    result = []
    for key, words, is_known in (("volumes", arguments.volume, is_volume), ("surfaces", arguments.surface, is_surface)):
        pairs = [(str(name), members if isinstance(members, list) else [members]) for name, members in given.get(key, {}).items()]
        pairs += [(name, members.split(",")) for name, _, members in (word.partition("=") for word in words)]
        names = {}
        for name, members in pairs:
            name = name.lower() if is_known(name) else name
            if not (re.fullmatch(r"[\w.-]+", name) and members and all(isinstance(m, (str, int)) and str(m).strip() for m in members)):
                raise Error(f"`{name}` is not a valid name or has no set", arguments.names or "command line",
                            "use letters, digits, _, . and -, and name a set, e.g. disc=ROTOR")
            if name in names:
                raise Error(f"`{name}` is given twice", arguments.names or "command line", "give each name once")
            names[name] = [str(member).strip() for member in members]
        result.append(names)
    return *result, given.get("contact", []) + arguments.contact, given.get("mounts", []) + arguments.mount, arguments.unit or given.get("unit")


def check_entries(entries, parse, surfaces, what, path):
    """Raises Error if an entry of Contact/Pairs or Mounts/Elastic mounts has the wrong form or an unknown surface."""
    for entry in entries:
        match = re.fullmatch(parse, entry)
        unknown = [name for name in match.groups() if name not in surfaces] if match else [""]
        if unknown:
            fault = f"contains the unknown surface `{unknown[0]}`" if match else f"does not have the form `{what}`"
            raise Error(f"`{entry}` {fault}", path, f"write, e.g., `{what}` with surfaces from: {', '.join(surfaces) or '(none)'}")


def run(arguments):
    path = pathlib.Path(arguments.file)
    if not path.is_file():
        raise Error("the file is missing", path, "add it, or correct its name")
    mesh = read(path)
    shapes = ", ".join(f"{n} {shape}" for shape, n in collections.Counter(shape for shape, _ in mesh.elements).items())
    if not any(map(mesh.is_solid, range(len(mesh.elements)))):
        raise Error(f"the file has no supported solid elements; it has {shapes or 'no elements'}", path,
                    "mesh the volumes with tetrahedra, wedges, pyramids or hexahedra, and export these elements")
    if not np.isfinite(mesh.points).all():
        raise Error("a coordinate is not finite", path, "export the mesh again")
    size, fitting = length_hint(mesh)
    summary = f"{path}: {len(mesh.points)} nodes, {shapes}; {size} in the file's unit"
    if not arguments.output:
        print(summary)
        for what, sets in (("elements", mesh.element_sets), ("faces", mesh.faces), ("nodes", mesh.node_sets)):
            for name, members in sets.items():
                print(f"  set of {what} {name}: {len(members)}")
        print(*(f"  left out: {what}" for what in mesh.dropped), f"  the size suits {fitting}", sep="\n")
        return
    output = pathlib.Path(arguments.output)
    if output.suffix != ".msh" or not output.parent.is_dir() or output.is_dir() or output.exists() and output.samefile(path):
        raise Error("the mesh cannot be written to this file", output, "name another .msh file in an existing folder")
    volumes, surfaces, contact, mounts, unit = names_of(arguments)
    if unit not in tuple(UNITS):
        raise Error("no unit of length is given" if unit is None else f"`{unit}` is not a unit of length", path,
                    f"use --unit {' or '.join(UNITS)}; the mesh is {size}, which suits {fitting}")
    result = Import(mesh, volumes, surfaces, path)
    check_entries(contact, r"\s*([\w.-]+)\s*/\s*([\w.-]+)\s*(?::[^:;]+)?", result.surfaces, "disc_top / pad_face: 0.9", path)
    check_entries(mounts, r"\s*([\w.-]+)\s*:(?:[^:;,]+,){2}[^:;,]+", result.surfaces, "pad_back: 0, 0, 1e10", path)
    materials, stub = result.materials(unit), output.with_suffix(".prm")
    with tempfile.TemporaryDirectory(dir=output.parent) as folder:
        written = pathlib.Path(folder) / output.name
        result.write(written, UNITS[unit])
        written.with_suffix(".prm").write_text(parameter_file(output, result, materials, contact, mounts), encoding="utf-8")
        os.replace(written, output)
        if is_new := not stub.exists():
            os.replace(written.with_suffix(".prm"), stub)
    print(summary, result.report(), f"written: {output}", sep="\n")
    known = f", with the materials of {', '.join(materials)}" if materials else ""
    print(f"written: {stub}{known}" if is_new else f"kept: {stub}; delete it to create a new one")
