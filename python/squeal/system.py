# SPDX-License-Identifier: GPL-3.0-or-later

"""Systems Q(λ; p) = Σ θ_k(p) λ^(power_k) A_k, in a folder with `system.json` and Matrix Market files."""

import csv
import dataclasses
import json
import math
import numbers
import pathlib
import re

import numpy as np
import scipy.io
import scipy.sparse as sparse

from squeal import quadratic
from squeal.errors import Error
from squeal.expressions import NAME, Expression
from squeal.importing.configuration import read_json
from squeal.results import Table

FORMAT, VERSION, FILE = "squeal system", 1, "system.json"
SYMMETRIES = {"none": 0, "symmetric": 1, "skew": -1}
KINDS = ("body", "mount", "rotation", "friction", "circulatory", "contact damping", "modal damping")
# Tolerance for A - A^T (symmetric) or A + A^T (skew), relative to the largest entry of A
SYMMETRY_TOLERANCE = 1e-12
# Largest number of dofs for which M(p), C(p) and K(p) return dense matrices
LARGEST_DENSE = 5000


@dataclasses.dataclass
class Parameter:
    """The value of a parameter, with optional range, unit and description."""

    value: float
    lower: float = None
    upper: float = None
    unit: str = ""
    description: str = ""

    def as_json(self):
        return {name: float(value) if is_number(value) else value for name, value in dataclasses.asdict(self).items() if value not in (None, "")}


@dataclasses.dataclass
class Term:
    """θ(p) λ^power A with A = `matrix` or A = left diag(weights) right^T; matrices are sparse, weights a vector."""

    name: str
    power: int
    coefficient: str = "1"
    matrix: sparse.csr_matrix = None
    left: sparse.csr_matrix = None
    right: sparse.csr_matrix = None
    weights: np.ndarray = None
    symmetry: str = "none"
    kind: str = ""

    def __post_init__(self):
        for name in ("matrix", "left", "right"):
            if getattr(self, name) is not None:
                setattr(self, name, sparse.csr_matrix(getattr(self, name), dtype=float))
        if self.left is not None and self.right is not None:
            self.weights = np.ones(self.left.shape[1]) if self.weights is None else np.asarray(self.weights, dtype=float).ravel()

    @property
    def product(self):
        """The matrix A of the term as a sparse matrix."""
        return self.matrix if self.matrix is not None else sparse.csr_matrix(self.left @ sparse.diags(self.weights) @ self.right.T)


class System:
    """A system of matrices: parameters by name, terms, groups of dofs (name -> inclusive ranges from 1), and the
    `reduction` of a reduced model with its basis.

    Mode shapes are drawn at points with `positions` [m] (n_points x 3). The matrix `displacements` (3 n_points x n,
    sparse) maps a vector to x, y and z of each point in turn; if it is None, dofs 3 i - 2 to 3 i belong to point i.

    Arguments `p` are dictionaries of parameter values, which override the values of `parameters`.
    """

    def __init__(self, parameters, terms, groups=None, positions=None, displacements=None, reduction=None, description="",
                 measured_modes=None, where=FILE):
        """Raises Error if the data are inconsistent; the message names the file `where`."""
        self.parameters = {name: parameter if isinstance(parameter, Parameter) else Parameter(parameter) for name, parameter in parameters.items()}
        self.terms, self.groups, self.reduction = list(terms), dict(groups or {}), reduction
        self.positions, self.displacements = positions, displacements
        self.measured_modes = measured_modes
        self.description, self.where = description, where
        self._check_parameters()
        if not self.terms:
            raise Error("the system has no terms", where, "add at least a mass and a stiffness")
        self._expressions = [self._checked_term(term, f"{where}, term `{term.name}`") for term in self.terms]
        for name, ranges in self.groups.items():
            if not (isinstance(ranges, list) and all(is_range(ends, self.size) for ends in ranges)):
                raise Error(f"group `{name}` is not a list of valid ranges of dofs", f"{where}, groups",
                            f"write [[first, last], ...] with dofs from 1 to {self.size}")
        self._check_points()

    @property
    def size(self):
        """Number of dofs."""
        first = self.terms[0]
        return (first.matrix if first.matrix is not None else first.left).shape[0]

    def _check_points(self):
        if self.positions is None:
            if self.displacements is not None:
                raise Error("`displacements` are given without `positions`", f"{self.where}, displacements", "also give `positions`")
            return
        self.positions = np.asarray(self.positions, dtype=float)
        if self.positions.ndim != 2 or self.positions.shape[1] != 3 or not np.isfinite(self.positions).all():
            raise Error("the positions are not an n x 3 matrix of finite numbers", f"{self.where}, positions", "give x, y and z of each point")
        n_rows = 3 * len(self.positions)
        shape = (self.size, self.size) if self.displacements is None else self.displacements.shape
        if shape != (n_rows, self.size):
            raise Error(f"the displacements are {shape[0]} x {shape[1]}, expected {n_rows} x {self.size}", f"{self.where}, displacements",
                        "give `displacements` with rows x, y and z of each point and a column for each dof")

    def _check_parameters(self):
        for name, parameter in self.parameters.items():
            where = f"{self.where}, parameter `{name}`"
            if not NAME.fullmatch(as_kind(name, str, where)) or name == "_pi":
                raise Error(f"`{name}` is not a valid parameter name", where, "use letters, digits and _, beginning with a letter")
            for key in ("value", "lower", "upper"):
                value = getattr(parameter, key)
                if not (value is None and key != "value") and not (is_number(value) and math.isfinite(value)):
                    raise Error(f"`{key}` is {value!r}, which is not a finite number", where, "write a finite number")
            lower, upper = self.range(name)
            if not lower <= parameter.value <= upper:
                raise Error(f"the value {parameter.value:g} is outside the range {lower:g} to {upper:g}", where, "change the value or the range")

    def range(self, name):
        """Limits of a parameter; missing limits equal the value."""
        parameter = self.parameters[name]
        return (parameter.value if parameter.lower is None else parameter.lower, parameter.value if parameter.upper is None else parameter.upper)

    def _checked_term(self, term, where):
        """Checks a term and returns its coefficient as an Expression."""
        if not isinstance(term.power, int) or isinstance(term.power, bool) or not 0 <= term.power <= 2:
            raise Error(f"the power {term.power!r} is invalid", where, "write 0, 1 or 2")
        as_kind(term.name, str, f"{where}, name")
        if term.symmetry not in tuple(SYMMETRIES):
            raise Error(f"the symmetry `{term.symmetry}` is unknown", where, f"write one of: {', '.join(SYMMETRIES)}")
        if term.kind and term.kind not in KINDS:
            raise Error(f"the kind `{term.kind}` is unknown", where, f"write one of: {', '.join(KINDS)}")
        if (term.matrix is None) != (term.left is not None and term.right is not None) or (term.matrix is not None) == (term.left is not None):
            raise Error("the term must have either `matrix`, or `left` and `right`", where, "give the matrix or both factors")
        for name in ("matrix", "left", "right"):
            if (matrix := getattr(term, name)) is not None:
                self._check_matrix(term, name, matrix, where)
        if term.matrix is None and not np.isfinite(term.weights).all():
            raise Error(f"weight {np.flatnonzero(~np.isfinite(term.weights))[0] + 1} is not finite", f"{where}, weights", "write finite numbers")
        expression = Expression(str(term.coefficient), list(self.parameters), f"{where}, coefficient")
        expression.check_range({name: self.range(name) for name in self.parameters})
        expression({name: parameter.value for name, parameter in self.parameters.items()})
        return expression

    def _check_matrix(self, term, name, matrix, where):
        where = f"{where}, {name}"
        n_columns = self.size if name == "matrix" else term.left.shape[1]
        if matrix.shape != (self.size, n_columns) or name != "matrix" and len(term.weights) != n_columns:
            found = f"{matrix.shape[0]} x {matrix.shape[1]}" + ("" if name == "matrix" else f" with {len(term.weights)} weights")
            raise Error(f"the matrix is {found}, expected {self.size} x {n_columns}", where,
                        "give n x n matrices and n x m factors with m weights, with the same n in all terms")
        if not np.isfinite(matrix.data).all():
            entries = matrix.tocoo()
            first = np.flatnonzero(~np.isfinite(entries.data))[0]
            raise Error(f"entry ({entries.row[first] + 1}, {entries.col[first] + 1}) is {entries.data[first]}", where, "write finite numbers")
        if sign := SYMMETRIES[term.symmetry]:
            if name != "matrix":
                raise Error("`symmetry` is specified for a product of factors", where, "remove `symmetry`")
            if (defect := symmetry_defect(matrix, sign)) > SYMMETRY_TOLERANCE:
                raise Error(f"the matrix is not {term.symmetry}: the largest deviation is {defect:.1e} of the largest entry", where,
                            "write symmetry `none` or correct the matrix")

    @classmethod
    def read(cls, path):
        """Reads a system from a folder or from its system.json. Raises Error if a file is missing or invalid."""
        path = pathlib.Path(path)
        path = path / FILE if path.is_dir() else path
        data = read_json(path)
        if not isinstance(data, dict) or data.get("format") != FORMAT or data.get("version") != VERSION:
            raise Error(f"the file is not a `{FORMAT}` of version {VERSION}", path, f'write "format": "{FORMAT}", "version": {VERSION}')
        known = ("format", "version", "description", "parameters", "terms", "groups", "positions", "displacements", "measured modes", "reduction")
        check_keys(data, known, path)
        parameters = {name: read_entry(Parameter, entry, f"{path}, parameter `{name}`", needed=("value",))
                      for name, entry in as_kind(data.get("parameters", {}), dict, f"{path}, parameters").items()}
        terms = []
        for number, entry in enumerate(as_kind(data.get("terms", []), list, f"{path}, terms"), start=1):
            where = f"{path}, term {number}"
            entry = dict(as_kind(entry, dict, where))
            entry.setdefault("name", f"term {number}")
            where = f"{path}, term `{entry['name']}`"
            for key in ("matrix", "left", "right", "weights"):
                if key in entry:
                    entry[key] = read_matrix(path.parent, entry[key], f"{where}, {key}")
                    entry[key] = entry[key].toarray() if key == "weights" else entry[key]
            terms.append(read_entry(Term, entry, where, needed=("power",)))
        reduction = data.get("reduction")
        if reduction is not None:
            reduction = dict(as_kind(reduction, dict, f"{path}, reduction"))
            if "basis" in reduction:
                reduction["basis"] = read_matrix(path.parent, reduction["basis"], f"{path}, reduction, basis").toarray()
            if "points" in reduction:
                reduction["points"] = read_rows(path.parent, reduction["points"], f"{path}, reduction, points")
        measured = path.parent.resolve() / data["measured modes"] if "measured modes" in data else None
        points = {key: read_matrix(path.parent, data[key], f"{path}, {key}") for key in ("positions", "displacements") if key in data}
        if "positions" in points:
            points["positions"] = points["positions"].toarray()
        return cls(parameters, terms, as_kind(data.get("groups", {}), dict, f"{path}, groups"), reduction=reduction,
                   description=data.get("description", ""), measured_modes=measured, where=path, **points)

    def write(self, folder):
        """Writes the system to a folder, which is created if necessary."""
        folder = pathlib.Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        names, entries = set(), []
        for term in self.terms:
            stem = unique(re.sub(r"[^\w.-]+", "_", term.name) or "term", names)
            entry = {"name": term.name, "power": term.power, "coefficient": str(term.coefficient)}
            if term.matrix is not None:
                entry.update(matrix=f"{stem}.mtx", **({} if term.symmetry == "none" else {"symmetry": term.symmetry}))
                write_matrix(folder / entry["matrix"], term.matrix, term.symmetry)
            else:
                entry.update({key: f"{stem}_{key}.mtx" for key in ("left", "right", "weights")})
                for key in ("left", "right"):
                    write_matrix(folder / entry[key], getattr(term, key))
                write_array(folder / entry["weights"], term.weights.reshape(-1, 1))
            entries.append({**entry, **({"kind": term.kind} if term.kind else {})})
        data = {"format": FORMAT, "version": VERSION, "description": self.description,
                "parameters": {name: parameter.as_json() for name, parameter in self.parameters.items()}, "terms": entries}
        if self.groups:
            data["groups"] = {name: [[int(end) for end in ends] for ends in ranges] for name, ranges in self.groups.items()}
        if self.measured_modes is not None:
            data["measured modes"] = str(self.measured_modes)
        for key, write in (("positions", write_array), ("displacements", write_matrix)):
            if getattr(self, key) is not None:
                data[key] = f"{key}.mtx"
                write(folder / data[key], getattr(self, key))
        if self.reduction is not None:
            data["reduction"] = dict(self.reduction)
            for key, file, write in (("basis", "basis.mtx", write_array), ("points", "points.csv", write_rows)):
                if key in self.reduction:
                    data["reduction"][key] = file
                    write(folder / file, self.reduction[key])
        (folder / FILE).write_text(json.dumps(data, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")

    def values(self, p=None):
        """Values of all parameters as a dictionary. Raises Error for unknown names, and for values that are not numbers
        or outside a given range."""
        values = {name: parameter.value for name, parameter in self.parameters.items()}
        for name, value in (p or {}).items():
            if name not in values:
                raise Error(f"there is no parameter `{name}`", self.where, f"name one of: {', '.join(values) or '(none)'}")
            lower, upper = self.parameters[name].lower, self.parameters[name].upper
            if not is_number(value):
                raise Error(f"{name} = {value!r} is not a number", f"{self.where}, parameter `{name}`", "give a number")
            if not math.isfinite(value) or lower is not None and value < lower or upper is not None and value > upper:
                ends = f"{'-inf' if lower is None else format(lower, 'g')} to {'inf' if upper is None else format(upper, 'g')}"
                raise Error(f"{name} = {value:g} is not finite or is outside the range {ends}", f"{self.where}, parameter `{name}`",
                            "change the value or the range")
            values[name] = float(value)
        return values

    def term(self, name):
        """The term called `name`."""
        found = [term for term in self.terms if term.name == name]
        if not found:
            raise Error(f"there is no term `{name}`", self.where, f"name one of: {', '.join(term.name for term in self.terms)}")
        return found[0]

    def coefficient(self, term, p=None):
        """θ(p) of a Term, or of the term with this name."""
        term = self.term(term) if isinstance(term, str) else term
        index = next(index for index, other in enumerate(self.terms) if other is term)
        return self._expressions[index](self.values(p))

    def matrices(self, p=None):
        """M, C and K as sparse matrices, with Q(λ; p) = λ² M + λ C + K."""
        values = self.values(p)
        sums = [sparse.csr_matrix((self.size, self.size)) for _ in range(3)]
        for term, expression in zip(self.terms, self._expressions):
            sums[term.power] = sums[term.power] + expression(values) * term.product
        return sums[2], sums[1], sums[0]

    def Q(self, lam, p=None):
        """Q(λ; p) as a sparse matrix."""
        M, C, K = self.matrices(p)
        return lam**2 * M + lam * C + K

    def linearise(self, p=None):
        """A and B (2n x 2n, sparse) of the first companion form A z = λ B z, z = (x, λ x)."""
        return quadratic.linearise(*self.matrices(p))

    def solve(self, p=None, number=None, largest=None, region=None, shift=None):
        """Eigenvalues and right vectors with their errors as `quadratic.Eigenpairs`; the arguments select them as in
        `quadratic.solve`."""
        return quadratic.solve(*self.matrices(p), number=number, largest=largest, region=region, shift=shift, where=self.where)

    def _dense(self, position, p):
        if self.size > LARGEST_DENSE:
            raise Error(f"a dense matrix of {self.size} dofs is too large", self.where, "use `matrices(p)`, or a reduced model")
        return self.matrices(p)[position].toarray()

    def M(self, p=None):
        """The mass matrix as a dense array."""
        return self._dense(0, p)

    def C(self, p=None):
        """The damping matrix as a dense array."""
        return self._dense(1, p)

    def K(self, p=None):
        """The stiffness matrix as a dense array."""
        return self._dense(2, p)

    def to_pymor(self, B=None, Cp=None):
        """A SecondOrderModel of pyMOR with the parameters of the system; inputs B (n x m) and outputs Cp (l x n) are
        identities by default."""
        try:
            from pymor.models.iosys import SecondOrderModel
            from pymor.operators.constructions import LincombOperator
            from pymor.operators.numpy import NumpyMatrixOperator
            from pymor.parameters.functionals import GenericParameterFunctional
        except ImportError as error:
            raise Error(f"pyMOR cannot be imported: {error}", "System.to_pymor()", "install pyMOR: pip install pymor") from error

        def operator(power):
            terms = [(term, expression) for term, expression in zip(self.terms, self._expressions) if term.power == power]
            if not terms:
                return NumpyMatrixOperator(sparse.csr_matrix((self.size, self.size)))
            coefficients = []
            for _, expression in terms:
                def value(mu, expression=expression):
                    return expression({name: float(mu[name][0]) for name in expression.names})

                coefficients.append(GenericParameterFunctional(value, {name: 1 for name in expression.names}, name=expression.text)
                                    if expression.names else expression({}))
            return LincombOperator([NumpyMatrixOperator(term.product) for term, _ in terms], coefficients)

        unit = sparse.identity(self.size, format="csr")
        ends = [NumpyMatrixOperator(unit if matrix is None else matrix) for matrix in (B, Cp)]
        return SecondOrderModel(operator(2), operator(1), operator(0), *ends, name=self.description or "system")


def is_number(value):
    return isinstance(value, numbers.Real) and not isinstance(value, bool)


def is_range(ends, size):
    """True if the value is a range [first, last] of dofs between 1 and `size`."""
    is_pair = isinstance(ends, (list, tuple)) and len(ends) == 2 and all(isinstance(end, numbers.Integral) for end in ends)
    return is_pair and 1 <= ends[0] <= ends[1] <= size


def symmetry_defect(matrix, sign):
    """Largest entry of A - sign A^T, relative to the largest entry of A."""
    difference = abs(matrix - sign * matrix.T)
    return float(difference.max() / abs(matrix).max()) if difference.nnz else 0.0


def as_kind(value, kind, where):
    if not isinstance(value, kind):
        raise Error(f"the entry is {value!r}", where, f"write {({dict: 'an object', list: 'a list', str: 'a text'})[kind]}")
    return value


def check_keys(entry, known, where):
    if unknown := [key for key in entry if key not in known]:
        raise Error(f"the entry `{unknown[0]}` is unknown", where, f"use only these entries: {', '.join(known)}")


def read_entry(kind, entry, where, needed):
    """A Parameter or a Term read from a JSON object."""
    check_keys(as_kind(entry, dict, where), [field.name for field in dataclasses.fields(kind)], where)
    if missing := [key for key in needed if key not in entry]:
        raise Error(f"the entry `{missing[0]}` is missing", where, "add it")
    return kind(**entry)


def inside(folder, name, where):
    if not isinstance(name, str) or not (folder / name).is_file():
        raise Error(f"the file {name if not isinstance(name, str) else folder / name} is missing", where, "add it, or correct its name")
    return folder / name


def read_matrix(folder, name, where):
    """A matrix read from a Matrix Market file of real numbers."""
    path = inside(folder, name, where)
    try:
        matrix = scipy.io.mmread(path)
    except (OSError, ValueError, IndexError, TypeError, OverflowError, StopIteration) as problem:
        raise Error(f"{path} cannot be read: {problem}", where, "write a readable Matrix Market file") from problem
    if np.iscomplexobj(matrix):
        raise Error(f"{path} has complex entries", where, "write real matrices; represent structural damping by a term of power 1")
    return sparse.csr_matrix(matrix, dtype=float)


def read_rows(folder, name, where):
    """Rows of a CSV file as dictionaries of numbers, NaN for empty cells."""
    path = inside(folder, name, where)
    try:
        table = Table(path)
        columns = [table.numbers(column) for column in table.columns]
    except Error as problem:
        raise Error(f"{path} cannot be read: {problem.what}", where, "write a number or an empty cell for each column") from problem
    return [dict(zip(table.columns, row)) for row in zip(*columns)]


def write_rows(path, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]) if rows else [], lineterminator="\n")
        writer.writeheader()
        writer.writerows({key: "" if math.isnan(value) else repr(float(value)) for key, value in row.items()} for row in rows)


def write_matrix(path, matrix, symmetry="none"):
    if sign := SYMMETRIES[symmetry]:
        matrix = 0.5 * (matrix + sign * matrix.T)
    matrix = sparse.coo_matrix(matrix)
    matrix.eliminate_zeros()
    with open(path, "wb") as file:  # mmwrite would append a suffix to a path
        scipy.io.mmwrite(file, matrix, precision=17, symmetry={0: "general", 1: "symmetric", -1: "skew-symmetric"}[sign])


def write_array(path, array):
    with open(path, "wb") as file:
        scipy.io.mmwrite(file, np.asarray(array, dtype=float), precision=17, symmetry="general")


def unique(name, names):
    """The name, with a number appended if it is already in `names`; adds the result to `names`."""
    found, number = name, 1
    while found.lower() in names:
        number += 1
        found = f"{name}_{number}"
    names.add(found.lower())
    return found
