# SPDX-License-Identifier: GPL-3.0-or-later

"""Builds a system from matrices of other programs as described by a configuration file."""

import csv
import math
import pathlib

import numpy as np
import scipy.sparse as sparse

from squeal.errors import Error
from squeal.expressions import Expression
from squeal.importing import foreign_mesh, matrices
from squeal.importing.configuration import read_yaml
from squeal.system import SYMMETRY_TOLERANCE, Parameter, System, Term, as_kind, check_keys, is_range, read_entry, symmetry_defect, unique

OF_FILE = ("file", "variable", "format", "scale")
KNOWN = ("description", "parameters", "terms", "groups", "nodes", "unit")


def number_of(value, where):
    """A number, or an expression such as 4*_pi."""
    return float(value) if isinstance(value, (int, float)) else Expression(str(value), [], where)({})


def ranges_of(numbers):
    """Increasing numbers as inclusive ranges (first, last)."""
    parts = np.split(numbers, np.flatnonzero(np.diff(numbers) > 1) + 1)
    return [[int(part[0]), int(part[-1])] for part in parts if len(part)]


def groups_of(entries, numbering, where):
    """Ranges of dofs of each group, from ranges of dofs or of `nodes`."""
    groups = {}
    for name, entry in as_kind(entries, dict, f"{where}, groups").items():
        if isinstance(entry, dict):
            check_keys(entry, ("nodes",), f"{where}, group `{name}`")
            if numbering.labels is None:
                raise Error("the matrices are numbered by rows, not by nodes", f"{where}, group `{name}`", "write ranges of dofs")
            ranges = as_kind(entry.get("nodes"), list, f"{where}, group `{name}`, nodes")
            if not all(is_range(ends, math.inf) for ends in ranges):
                raise Error("`nodes` contains an invalid range", f"{where}, group `{name}`", "write nodes: [[first, last], ...]")
            entry = ranges_of([row for row, (node, _) in enumerate(numbering.labels, start=1) if any(a <= node <= b for a, b in ranges)])
        groups[name] = entry
    return groups


def points_of(config, folder, numbering, where):
    """Positions of nodes and the matrix of their displacements (dofs 1 to 3), if `nodes` is given."""
    if "nodes" not in config:
        return {}
    if numbering.labels is None or config.get("unit") not in foreign_mesh.UNITS:
        raise Error("`nodes` requires matrices numbered by nodes and dofs, and a unit of length", where,
                    f"export such matrices and write `unit`, one of: {', '.join(foreign_mesh.UNITS)}")
    path = folder / as_kind(config["nodes"], str, f"{where}, nodes")
    reader = foreign_mesh.READERS.get(path.suffix.lower())
    if reader is None or not path.is_file():
        raise Error(f"`{path}` is missing or has an unsupported suffix", where, f"name a file that ends in one of: {', '.join(foreign_mesh.READERS)}")
    points, scale = reader(path).points, foreign_mesh.UNITS[config["unit"]]
    moves = [(node, dof, column) for column, (node, dof) in enumerate(numbering.labels) if node > 0 and dof in (1, 2, 3)]
    number = {node: i for i, node in enumerate(dict.fromkeys(node for node, *_ in moves))}
    if lost := [node for node in number if node not in points]:
        raise Error(f"node {lost[0]} of the matrices is missing", path, "name the input file from which the matrices were computed")
    rows = [3 * number[node] + dof - 1 for node, dof, _ in moves]
    displacements = sparse.csr_matrix((np.ones(len(moves)), (rows, [column for *_, column in moves])), (3 * len(number), len(numbering.labels)))
    return {"positions": scale * np.array([points[node] for node in number]), "displacements": displacements}


def import_system(path):
    """The system described by a configuration file, notes to print, and the numbering of its dofs. Raises Error for invalid input."""
    path = pathlib.Path(path)
    config = as_kind(read_yaml(path, "configuration"), dict, path)
    check_keys(config, KNOWN, path)
    parameters = {}
    for name, entry in as_kind(config.get("parameters", {}), dict, f"{path}, parameters").items():
        where = f"{path}, parameter `{name}`"
        parameters[name] = read_entry(Parameter, {key: number_of(value, where) if key in ("value", "lower", "upper") else value
                                                  for key, value in as_kind(entry, dict, where).items()}, where, needed=("value",))
    loaded, names = [], set()
    for number, entry in enumerate(as_kind(config.get("terms"), list, f"{path}, terms"), start=1):
        where = f"{path}, term {number}"
        entry = dict(as_kind(entry, dict, where))
        for key in ("file", "variable", "format"):
            as_kind(entry.get(key, ""), str, f"{where}, {key}")
        source = {key: entry.pop(key) for key in OF_FILE if key in entry}
        if "file" not in source:
            raise Error("the entry `file` is missing", where, "name the file of the matrix")
        file = path.parent / source["file"]
        entry.setdefault("name", unique(source.get("variable") or file.stem, names))
        term = read_entry(Term, {**entry, "coefficient": str(entry.get("coefficient", "1"))}, where, needed=("power",))
        found = matrices.read(file, source.get("variable"), source.get("format"))
        loaded.append((file, found, term, number_of(source.get("scale", 1.0), where)))
    if not loaded:
        raise Error("there are no terms", path, "add entries to the list `terms`")
    numbering = matrices.Numbering([(str(file), found) for file, found, *_ in loaded])
    remarks = []
    if numbering.held:
        remarks.append(f"fixed dofs ({matrices.HELD:g} or more on the diagonal) are omitted: {len(numbering.held)}")
    for file, found, term, scale in loaded:
        term.matrix = scale * numbering.matrix(found, term.symmetry, file)
        if term.symmetry == "none" and term.matrix.nnz and term.matrix.shape[0] == term.matrix.shape[1]:
            remarks += [f"term `{term.name}` is {symmetry}; write `symmetry: {symmetry}` to check this" for symmetry, sign in
                        (("symmetric", 1), ("skew", -1)) if symmetry_defect(term.matrix, sign) < SYMMETRY_TOLERANCE]
    system = System(parameters, [term for _, _, term, _ in loaded], groups_of(config.get("groups", {}), numbering, path),
                    **points_of(config, path.parent, numbering, path), description=config.get("description", ""), where=path)
    return system, remarks, numbering


def write_labels(path, labels):
    """Writes the node and dof of each row."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerows([("row", "node", "dof"), *((row, *label) for row, label in enumerate(labels, start=1))])
