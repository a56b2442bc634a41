"""Runs of squeal that entries share, kept in results/reproduce/."""

import json
import pathlib
import subprocess

from squeal.program import SOURCE, error_of, find_program, words_of
from squeal.results import Table, read_table


class Results:
    """The folder of a finished run."""

    def __init__(self, folder):
        self.folder = folder
        self.record = json.loads((folder / "run.json").read_text(encoding="utf-8"))

    def table(self, name):
        """Rows of a table as dictionaries; numbers are numbers, empty cells None."""
        return [{column: value_of(cell) for column, cell in row.items()} for row in read_table(self.folder / name)]

    def modes(self, label=None):
        """Complex modes, all or those whose label begins so."""
        return [mode for mode in self.table("complex_modes.csv") if label is None or mode["label"].startswith(label)]

    def eigenvalues(self):
        """lambda of every complex mode."""
        return Table(self.folder / "complex_modes.csv").eigenvalues()

    def leading(self, label):
        """The mode of that label that grows most."""
        return max(self.modes(label), key=lambda mode: mode["divergence rate [%]"])

    def n_unstable(self):
        return sum(mode["unstable [-]"] == 1 for mode in self.modes())


class Runs:
    """Makes runs below a folder, or finds them there."""

    def __init__(self, folder):
        self.folder = folder

    def __call__(self, name, parameter_file, *settings, environment=None):
        """Results of prm/PARAMETER_FILE with settings "Section/Name=value", in the folder NAME."""
        folder = self.folder / name
        command = [str(find_program()), f"prm/{parameter_file}", "--output", str(folder), *words_of(settings)]
        if not self.is_done(folder, command):
            print(f"    running {' '.join(command[1:])}", flush=True)
            process = subprocess.run(command, cwd=SOURCE, env=environment, text=True, capture_output=True, check=False)
            if process.returncode != 0:
                raise error_of(process, parameter_file)
            (folder / "command.txt").write_text(" ".join(command) + "\n", encoding="utf-8")
        return Results(folder)

    @staticmethod
    def is_done(folder, command):
        marker = folder / "command.txt"
        return (marker.is_file() and marker.read_text(encoding="utf-8").strip() == " ".join(command)
                and marker.stat().st_mtime > pathlib.Path(command[0]).stat().st_mtime)


def value_of(cell):
    """A number, a text, or None where the cell is empty."""
    try:
        return float(cell)
    except (TypeError, ValueError):
        return cell or None
