# SPDX-License-Identifier: GPL-3.0-or-later

"""Reads matrices from files of other programs, with entries by row and column or by node and dof."""

import dataclasses

import numpy as np
import pandas
import scipy.io
import scipy.sparse as sparse

from squeal.errors import Error
from squeal.importing import nastran_input
from squeal.importing.mesh_shapes import read_text

# Diagonal stiffness with which Abaqus fixes a dof
HELD = 1e36


@dataclasses.dataclass
class Entries:
    """Entries of a matrix by zero-based row and column or, if `shape` is None, by labels (node, dof).
    is_half: True if the file contains one triangle of the symmetric matrix; None if this is unknown."""

    rows: np.ndarray
    columns: np.ndarray
    values: np.ndarray
    shape: tuple = None
    is_half: bool = None

    @classmethod
    def of(cls, matrix, path):
        if not sparse.issparse(matrix) and np.ndim(matrix) != 2 or matrix.dtype.kind not in "fiub":
            raise Error(f"the data are a {np.ndim(matrix)}-dimensional array of type {matrix.dtype}, not a real matrix", path,
                        "write a real matrix")
        matrix = sparse.coo_matrix(matrix)
        return cls(matrix.row, matrix.col, matrix.data.astype(float), matrix.shape, False)


def choose(found, variable, path):
    """The matrix called `variable`, or the only matrix if `variable` is None."""
    if variable is None and len(found) == 1:
        return next(iter(found.values()))
    if not found:
        raise Error("the file contains no matrix", path, "export it again with the matrix, or name another file")
    if variable not in found:
        what = "the file contains several matrices" if variable is None else f"there is no matrix `{variable}`"
        raise Error(what, path, f"write `variable`, one of: {', '.join(sorted(found))}")
    return found[variable]


def read_matlab(path, variable):
    try:
        found = scipy.io.loadmat(path)
    except NotImplementedError:
        return Entries.of(read_hdf5(path, variable), path)
    return Entries.of(choose({name: value for name, value in found.items() if not name.startswith("__")}, variable, path), path)


def read_hdf5(path, variable):
    """A matrix of a .mat file of version 7.3, in which dense matrices are transposed and sparse matrices are groups."""
    try:
        import h5py
    except ImportError as error:
        raise Error("the .mat file has version 7.3 (HDF5), and h5py is not installed", path,
                    "apt-get install python3-h5py, or save it with '-v7' in MATLAB") from error
    with h5py.File(path) as file:
        found = choose({name: value for name, value in file.items() if not name.startswith("#")}, variable, path)
        if isinstance(found, h5py.Dataset):
            return found[()].T
        if not {"data", "ir", "jc"} <= found.keys():
            raise Error("the variable is not a numeric matrix", path, "choose or save a numeric matrix")
        columns = found["jc"][()].astype(int)
        return sparse.csc_matrix((found["data"][()], found["ir"][()].astype(int), columns), (int(found.attrs["MATLAB_sparse"]), len(columns) - 1))


def read_numpy(path, variable):
    found = np.load(path, allow_pickle=False)
    if isinstance(found, np.ndarray):
        return Entries.of(found, path)
    return Entries.of(sparse.load_npz(path) if "format" in found and variable is None else choose(dict(found), variable, path), path)


def read_text_matrix(path, variable):
    """A matrix from a Matrix Market file or from the text of Abaqus' *MATRIX OUTPUT."""
    text = read_text(path)
    return Entries.of(scipy.io.mmread(path), path) if text.startswith("%%MatrixMarket") else read_abaqus(path, text)


def read_abaqus(path, text):
    """A matrix from lines `node, dof, node, dof, value` or `row, column, value`."""
    places = [number for number, line in enumerate(text.split("\n"), 1) if line.strip() and not line.lstrip().startswith(("*", "%", "#"))]
    lines = text.replace(",", " ").replace("D", "E").split("\n")
    width = len(lines[places[0] - 1].split()) if places else 0
    if width not in (3, 5):
        raise Error("the data do not begin with `node, dof, node, dof, value` or `row, column, value`", path,
                    "use *MATRIX OUTPUT with FORMAT=MATRIX INPUT or FORMAT=COORDINATE in Abaqus")
    if bad := next((number for number in places if not is_entry(lines[number - 1].split(), width)), None):
        raise Error(f"`{lines[bad - 1].strip()}` does not consist of {width - 1} integers and a number", f"{path}, line {bad}", "export it again")
    table = np.loadtxt([lines[number - 1] for number in places], ndmin=2, comments=None)
    numbers, values = table[:, :-1].astype(int), table[:, -1]
    if width == 5:
        return Entries(numbers[:, :2], numbers[:, 2:], values)
    if (numbers <= 0).any():  # numbers of internal nodes are not positive
        labels = [np.column_stack([column, np.zeros(len(column), dtype=int)]) for column in numbers.T]
        return Entries(*labels, values)
    return Entries(numbers[:, 0] - 1, numbers[:, 1] - 1, values, (numbers.max(), numbers.max()))


def is_entry(words, width):
    """True if the words are `width` - 1 integers and a number."""
    try:
        return len(words) == width and bool([*map(int, words[:-1]), float(words[-1])])
    except ValueError:
        return False


def read_dmig(path, variable):
    """A real square matrix from DMIG cards; if it is symmetric (form 6), the file contains one triangle."""
    headers, found = {}, {}
    for line, (card, name, *fields) in nastran_input.cards(path):
        if card != "DMIG":
            continue
        try:
            if name not in headers:
                if fields[0] != "0":
                    raise ValueError("the first card of a matrix must have 0 in its third field")
                headers[name], found[name] = (int(fields[1]), int(fields[2])), []
                continue
            column = (int(fields[0]), int(fields[1] or 0))
            for at in range(3, len(fields) - 2, 4):
                if fields[at]:
                    found[name].append(((int(fields[at]), int(fields[at + 1] or 0)), column, nastran_input.number(fields[at + 2])))
        except (ValueError, IndexError) as problem:
            raise Error(f"DMIG cannot be read ({problem})", f"{path}, line {line}", "correct this card") from problem
    entries = choose(found, variable, path)
    form, kind = headers[next(name for name in found if found[name] is entries)]
    if form not in (1, 6) or kind not in (1, 2):
        raise Error(f"the matrix has form {form} and type {kind}", path, "write a square (form 1) or symmetric (form 6) real matrix (type 1 or 2)")
    table = np.array([(*row, *column, value) for row, column, value in entries]).reshape(-1, 5)
    return Entries(table[:, :2].astype(int), table[:, 2:4].astype(int), table[:, 4], is_half=form == 6)


def read_output4(path, variable):
    try:
        from pyNastran.op4.op4 import OP4
    except ImportError as error:
        raise Error("reading OUTPUT4 requires pyNastran, which is not installed", path,
                    "pip install pyNastran, or write the matrix as DMIG (PARAM,EXTOUT,DMIGPCH)") from error
    found = choose(OP4(log=None, debug=False).read_op4(str(path)), variable, path)
    return Entries.of(found[1] if isinstance(found, tuple) else found.data, path)


READERS = {"matlab": read_matlab, "numpy": read_numpy, "text": read_text_matrix, "dmig": read_dmig, "output4": read_output4,
           "harwell-boeing": lambda path, _: Entries.of(scipy.io.hb_read(path), path)}
ENDINGS = {".mat": "matlab", ".npy": "numpy", ".npz": "numpy", ".mtx": "text", ".mm": "text", ".op4": "output4",
           **dict.fromkeys((".bdf", ".nas", ".dat", ".pch", ".dmig"), "dmig"), **dict.fromkeys((".hb", ".rua", ".rsa", ".rza", ".rb"), "harwell-boeing")}


def read(path, variable=None, form=None):
    """Entries of a matrix in the format `form`, by default the format of the file's suffix. Raises Error if the file is missing or invalid."""
    if not path.is_file():
        raise Error("the file is missing", path, "add it, or correct its name")
    form = form or ENDINGS.get(path.suffix.lower())
    if form not in READERS:
        raise Error(f"the format of `{path.name}` is unknown", path, f"write `format`, one of: {', '.join(READERS)}")
    try:
        return READERS[form](path, variable)
    except Error:
        raise
    except Exception as problem:  # readers raise various exceptions for invalid files
        raise Error(f"the file cannot be read: {' '.join(str(problem).split()) or type(problem).__name__}", path,
                    f"check its permissions, export it again, or give its `format`, one of: {', '.join(READERS)}") from problem


class Numbering:
    """Numbering of the labels (node, dof) of all matrices by node and dof, with internal (negative) nodes last.
    `labels` is None if the matrices have no labels."""

    def __init__(self, matrices):
        """matrices: pairs (source, Entries); their labels become row indices, -1 for fixed dofs. Raises Error if only
        some matrices have labels."""
        self.labels, self.held = None, []
        with_labels = [where for where, entries in matrices if entries.shape is None]
        if with_labels and len(with_labels) < len(matrices):
            without = next(where for where, entries in matrices if entries.shape is not None)
            raise Error(f"{with_labels[0]} is numbered by nodes and dofs, {without} by rows", without, "write all matrices in the same form")
        if not with_labels:
            self.size = max(max(entries.shape) for _, entries in matrices)
            return
        parts = [part for _, entries in matrices for part in (entries.rows, entries.columns)]
        groups = pandas.DataFrame(np.vstack(parts)).groupby([0, 1])
        labels, rows = groups.size().index.to_frame().to_numpy(), groups.ngroup().to_numpy()
        rows = np.split(rows, np.cumsum([len(part) for part in parts])[:-1])
        is_held = np.zeros(len(labels), dtype=bool)
        for (_, entries), own, other in zip(matrices, rows[0::2], rows[1::2]):
            is_held[own[(own == other) & (entries.values >= HELD)]] = True
        order = np.lexsort((labels[:, 1], labels[:, 0], labels[:, 0] < 0))
        order = order[~is_held[order]]
        self.held, self.labels, self.size = labels[is_held].tolist(), [tuple(label) for label in labels[order].tolist()], len(order)
        new = np.full(len(labels), -1)
        new[order] = np.arange(self.size)
        for (_, entries), own, other in zip(matrices, rows[0::2], rows[1::2]):
            entries.rows, entries.columns = new[own], new[other]

    def matrix(self, entries, symmetry, where):
        """The sparse matrix with both triangles. Raises Error if a missing triangle requires a symmetry that is not given."""
        rows, columns, values = entries.rows, entries.columns, entries.values
        if self.labels is not None:
            kept = (rows >= 0) & (columns >= 0)
            rows, columns, values = rows[kept], columns[kept], values[kept]
        # Use the common size: the form row, column, value omits empty trailing rows
        shape = (self.size, self.size) if self.labels is not None or entries.is_half is None else entries.shape
        matrix = sparse.csr_matrix((values, (rows, columns)), shape)
        other = sparse.csr_matrix((np.ones(len(rows)), (columns, rows)), shape)
        triangle = matrix - sparse.diags(matrix.diagonal()) if shape[0] == shape[1] else matrix
        triangle.eliminate_zeros()
        is_half = entries.is_half
        if is_half is None:
            is_half = triangle.nnz > 0 and triangle.multiply(other).nnz == 0
            if is_half and symmetry == "none":
                raise Error("only one triangle of the matrix is in the file", where, "write `symmetry: symmetric` or `symmetry: skew`")
        return matrix + (-1 if symmetry == "skew" else 1) * triangle.T if is_half else matrix
