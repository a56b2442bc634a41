"""What a run has left in its folder: tables and parameters."""

import csv
import json
import math
import pathlib

from parameter_file import read_parameters


class ResultsError(Exception):
    """What is wrong with a folder of results, where, and what to change."""

    def __init__(self, what, where, change):
        super().__init__(what)
        self.what, self.where, self.change = what, where, change

    def __str__(self):
        return f"{self.what}\n  where:  {self.where}\n  change: {self.change}"


class Table:
    """The rows of a CSV table, by the names of its columns."""

    def __init__(self, path):
        self.path = path
        try:
            with open(path, newline="", encoding="utf-8") as file:
                reader = csv.DictReader(file)
                self.columns = list(reader.fieldnames or [])
                self.rows = list(reader)
        except (OSError, UnicodeDecodeError, csv.Error) as problem:
            raise ResultsError(f"the table cannot be read: {problem}", f"file {path}", "run squeal again") from problem
        for number, row in enumerate(self.rows, start=2):
            if None in row or None in row.values():
                raise ResultsError("a row has not one cell for each column", f"file {path}, line {number}", "run squeal again")

    def __len__(self):
        return len(self.rows)

    def texts(self, column):
        """Cells of a column. Throws ResultsError if there is no such column."""
        if column not in self.columns:
            raise ResultsError(f"there is no column `{column}`", f"file {self.path}", "run squeal again: it writes this column now")
        return [row[column] for row in self.rows]

    def numbers(self, column):
        """Numbers of a column, NaN for an empty cell. Throws ResultsError if a cell holds something else."""
        result = []
        for line, text in enumerate(self.texts(column), start=2):
            try:
                result.append(float(text) if text else math.nan)
            except ValueError:
                where = f"file {self.path}, line {line}, column `{column}`"
                raise ResultsError(f"`{text}` is no number", where, "run squeal again") from None
        return result

    def flags(self, column):
        """Whether the number in each cell of a column is not zero."""
        return [number != 0 for number in self.numbers(column)]


class Results:
    """A folder of results. Throws ResultsError if it is none."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        if not self.folder.is_dir():
            raise ResultsError(f"there is no folder `{folder}`", "RESULTS", "name the folder in which a run has left its results")
        for name in ("run.json", "parameters.prm"):
            if not (self.folder / name).is_file():
                raise ResultsError(f"`{folder}` holds no results: {name} is missing", "RESULTS",
                                   "name the folder in which a run has left its results")
        try:
            self.record = dict(json.loads(self.record_file.read_text(encoding="utf-8")))
            self.parameters = read_parameters(self.folder / "parameters.prm")
        except (OSError, TypeError, ValueError) as problem:
            what = f"the record of the run or its parameters cannot be read: {problem}"
            raise ResultsError(what, f"folder {folder}", "run squeal again") from problem

    @property
    def record_file(self):
        return self.folder / "run.json"

    def has(self, name):
        return (self.folder / f"{name}.csv").is_file()

    def table(self, name):
        return Table(self.folder / f"{name}.csv")

    def names(self):
        """Names of the tables."""
        return sorted(path.stem for path in self.folder.glob("*.csv"))

    def parameter(self, name):
        """The text of a parameter "Section/Name"."""
        if name not in self.parameters:
            raise ResultsError(f"the parameter {name} is missing", f"file {self.folder / 'parameters.prm'}", "run squeal again")
        return self.parameters[name]

    def number(self, name):
        return self.number_list(name)[0]

    def number_list(self, name):
        """The numbers of a parameter, separated by commas; none if it is empty."""
        text = self.parameter(name)
        try:
            return [float(word) for word in text.split(",")] if text.strip() else []
        except ValueError:
            where = f"file {self.folder / 'parameters.prm'}, parameter {name}"
            raise ResultsError(f"`{text}` is no list of numbers", where, "run squeal again") from None
