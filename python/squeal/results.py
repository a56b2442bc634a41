# SPDX-License-Identifier: GPL-3.0-or-later

"""The files of a run: tables, parameters, fields and the record."""

import csv
import functools
import json
import math
import os
import pathlib
import re

from squeal.errors import Error
from squeal.parameter_file import read_parameters

FILES = "files [byte]"  # key of the list of files in run.json
MU = "mu [-]"


def axis_title(column):
    """Axis title for the column of a parameter."""
    return "friction coefficient μ [-]" if column == MU else column


def symbol(column):
    """Symbol of the parameter in a column, as in `μ = 0.4`."""
    return "μ" if column == MU else column.split(" [")[0]


class Row(dict):
    """Cells of a row by column name. Raises Error if there is no such column."""

    def __init__(self, table, cells):
        super().__init__(zip(table.columns, cells))
        self.table = table

    def __missing__(self, column):
        raise self.table.missing(column)


class Table:
    """The rows of a CSV table by column name. Lines that begin with # are comments."""

    def __init__(self, path):
        """Raises Error if the table cannot be read or has incomplete rows."""
        self.path = path
        try:
            with open(path, newline="", encoding="utf-8") as file:
                reader = csv.reader("\n" if line.startswith("#") else line for line in file)
                (_, self.columns), *rows = [(reader.line_num, cells) for cells in reader if cells] or [(1, [])]
        except (OSError, UnicodeDecodeError, csv.Error) as problem:
            raise Error(f"the table cannot be read: {problem}", f"file {path}", "check its name and permissions, or run squeal again") from problem
        if bad := [line for line, cells in rows if len(cells) != len(self.columns)]:
            raise Error("a row does not have one cell for each column", f"file {path}, line {bad[0]}", "correct it, or run squeal again")
        self.rows, self.lines = [Row(self, cells) for _, cells in rows], [line for line, _ in rows]

    def __len__(self):
        return len(self.rows)

    @property
    def parameter(self):
        """Name of the first column; in tables of a sweep this is the varied parameter, such as `mu [-]`."""
        return self.columns[0]

    def texts(self, column):
        """Cells of a column. Raises Error if there is no such column."""
        if column not in self.columns:
            raise self.missing(column)
        return [row[column] for row in self.rows]

    def missing(self, column):
        """The Error for a column that does not exist."""
        return Error(f"there is no column `{column}`", f"file {self.path}", "check the name; if an older version wrote the table, run squeal again")

    def numbers(self, column):
        """Numbers in a column, NaN for empty cells. Raises Error if a cell is not a number."""
        result = []
        for line, text in zip(self.lines, self.texts(column)):
            try:
                result.append(float(text) if text else math.nan)
            except ValueError:
                where = f"file {self.path}, line {line}, column `{column}`"
                raise Error(f"`{text}` is not a number", where, "name a column of numbers, or run squeal again") from None
        return result

    def flags(self, column):
        """For each number in a column, True if it is not zero; False for empty cells."""
        return [abs(number) > 0 for number in self.numbers(column)]

    def groups(self, *columns):
        """Groups of rows with the same values in the given columns, in the order of the table."""
        found = {}
        for row in self.rows:
            found.setdefault(tuple(row[column] for column in columns), []).append(row)
        return list(found.values())

    def eigenvalues(self):
        """λ [1/s] of the mode in each row."""
        return [complex(rate, 2 * math.pi * frequency) for rate, frequency in zip(self.numbers("growth rate [1/s]"), self.numbers("frequency [Hz]"))]

    def frame(self):
        """The table as a pandas data frame. Units are stored in `attrs["units"]` and removed from the column names, unless
        columns differ only in their units. Numeric columns are converted to numbers, and empty cells to NaN."""
        import pandas

        parts = [re.fullmatch(r"(.*?)(?: \[([^\]]*)\])?", column).groups() for column in self.columns]
        short = [name for name, _ in parts]
        names = [name if short.count(name) == 1 else column for name, column in zip(short, self.columns)]
        columns = {}
        for name, column in zip(names, self.columns):
            try:
                columns[name] = [float(cell) if cell else math.nan for cell in self.texts(column)]
                if all(value.is_integer() for value in columns[name]):
                    columns[name] = [int(value) for value in columns[name]]
            except ValueError:
                columns[name] = self.texts(column)
        frame = pandas.DataFrame(columns, columns=names)
        frame.attrs["units"] = {name: unit for name, (_, unit) in zip(names, parts) if unit}
        return frame


def shape_files(folder):
    """Files of the complex mode shapes by row of complex_modes.csv, counted from 1."""
    return {int(match[1]): path for path in sorted((pathlib.Path(folder) / "modes").glob("complex_*.vtu"))
            if (match := re.match(r"complex_(\d+)_", path.name)) and not path.stem.endswith("_contact")}


class Results:
    """The result folder of a run. Raises Error if the folder does not contain results."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        if not self.folder.is_dir():
            raise Error(f"there is no folder `{folder}`", "results folder", "name the results folder of a run")
        for name in ("run.json", "parameters.prm"):
            if not (self.folder / name).is_file():
                raise Error(f"`{folder}` contains no results: {name} is missing", "results folder", "name the results folder of a run")
        try:
            self.record = dict(json.loads(self.record_file.read_text(encoding="utf-8")))
            self.parameters = read_parameters(self.folder / "parameters.prm")
        except (OSError, LookupError, TypeError, ValueError) as problem:
            what = f"the record of the run or its parameters cannot be read: {problem}"
            raise Error(what, f"folder {folder}", "check the permissions, or run squeal again") from problem

    @property
    def record_file(self):
        return self.folder / "run.json"

    def has(self, name):
        return (self.folder / f"{name}.csv").is_file()

    def table(self, name):
        """A table of the run. Raises Error if it is truncated."""
        table, size = Table(self.folder / f"{name}.csv"), self.record.get(FILES, {}).get(f"{name}.csv", 0)
        if table.path.stat().st_size < size:
            raise Error(f"the table is truncated: the run wrote {size} bytes", f"file {table.path}", "copy it again, or run squeal again")
        return table

    def names(self):
        return sorted(path.stem for path in self.folder.glob("*.csv"))

    def frame(self, name):
        """A table as a pandas data frame, see Table.frame(). Raises Error if the run has no such table."""
        if not self.has(name):
            raise Error(f"there is no table `{name}`", f"folder {self.folder}", f"name one of: {', '.join(self.names()) or '(none)'}")
        return self.table(name).frame()

    modes = functools.cached_property(lambda self: self.frame("complex_modes"))
    branches = functools.cached_property(lambda self: self.frame("branches"))
    thresholds = functools.cached_property(lambda self: self.frame("thresholds"))
    designs = functools.cached_property(lambda self: self.frame("designs"))

    def field_names(self):
        """Names of field files relative to the folder, without suffix, such as `modes/complex_001_A0-4`."""
        return sorted(str(path.relative_to(self.folder).with_suffix("")) for path in self.folder.rglob("*.vtu")
                      if ".unfinished" not in path.parts)

    def fields(self, name):
        """A field file as a meshio Mesh: points, cells, and arrays in point_data and cell_data."""
        from squeal.vtu_file import VtuFile

        path = self.folder / f"{name}.vtu"
        if not path.is_file():
            raise Error(f"there is no field file `{name}`", f"folder {self.folder}", f"name one of: {', '.join(self.field_names()) or '(none)'}")
        return VtuFile(path).as_meshio()

    def system(self):
        """The system of matrices written by the run. Raises Error if there is none."""
        from squeal.system import FILE, System

        path = self.folder / "system" / FILE
        if not path.is_file():
            raise Error(f"there is no system/{FILE}", f"folder {self.folder}", "run squeal with Output/Write system = full or reduced")
        return System.read(path)

    def parameter(self, name):
        """The value of a parameter "Section/Name" as text."""
        if name not in self.parameters:
            raise Error(f"the parameter {name} is missing", f"file {self.folder / 'parameters.prm'}", "check its name, or run squeal again")
        return self.parameters[name]

    def number(self, name):
        """The value of a parameter as a number; the first number if there are several, separated by commas."""
        text = self.parameter(name)
        try:
            return float(text.split(",")[0])
        except ValueError:
            where = f"file {self.folder / 'parameters.prm'}, parameter {name}"
            raise Error(f"`{text}` is not a number", where, "name a numeric parameter, or run squeal again") from None

    def plot(self, ending="svg", output=None):
        """Draws the plots of the tables; returns their files and notes on renamed files."""
        from squeal.plotting import draw

        folder = pathlib.Path(output) if output else self.folder / "plots"
        pictures = {folder / f"{name}.{ending}": draw.render(figure, ending) for name, figure in draw.figures(self).items()}
        return list(pictures), self.save(pictures, is_listed=not output)

    def report(self, output=None):
        """Writes the report; returns its file and notes on renamed files."""
        from squeal.reporting import content, page

        place = pathlib.Path(output) if output else self.folder / "report.html"
        return place, self.save({place: page.page(content.content(self)).encode()}, is_listed=not output)

    def save(self, files, is_listed):
        """Writes files (path -> bytes) and lists them in run.json if `is_listed`; returns notes on renamed files."""
        try:
            for path in files:
                path.parent.mkdir(parents=True, exist_ok=True)
            remarks = self.enlist({str(path.relative_to(self.folder)): content for path, content in files.items()}) if is_listed else []
            for path, content in files.items():
                replace(path, content)
        except OSError as problem:
            change = "check permissions and free space, or choose another folder"
            raise Error(f"the files cannot be written: {problem}", ", ".join(map(str, files)), change) from problem
        return remarks

    def enlist(self, files):
        """Lists files (name -> bytes) in run.json; returns notes on renamed files."""
        known = self.record.get(FILES, {})
        remarks = [make_way(self.folder / name) for name in files if name not in known and (self.folder / name).exists()]
        self.record[FILES] = dict(sorted({**known, **{name: len(content) for name, content in files.items()}}.items()))
        replace(self.record_file, (json.dumps(self.record, indent=2, ensure_ascii=False) + "\n").encode())
        return remarks


def replace(path, content):
    """Writes a file atomically."""
    temporary = path.with_name(path.name + ".unfinished")
    temporary.write_bytes(content)
    os.replace(temporary, path)


def make_way(path):
    """Renames a file that was not written by the run; returns a note."""
    kept = path.with_name(path.name + ".kept")
    number = 1
    while kept.exists():
        number += 1
        kept = path.with_name(f"{path.name}.kept-{number}")
    path.rename(kept)
    return f"note: {path} was not written by this run and has been renamed to {kept.name}"
