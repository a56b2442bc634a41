"""Runs of squeal that entries share, kept in results/reproduce/."""

import csv
import json
import math
import os
import pathlib
import subprocess

SOURCE = pathlib.Path(__file__).resolve().parents[2]
SQUEAL = pathlib.Path(os.environ.get("SQUEAL", SOURCE / "build" / "release" / "squeal"))


class Results:
    """The folder of a finished run."""

    def __init__(self, folder):
        self.folder = folder
        self.record = json.loads((folder / "run.json").read_text(encoding="utf-8"))

    def table(self, name):
        """Rows of a table as dictionaries; numbers are numbers, empty cells None."""
        with open(self.folder / name, newline="", encoding="utf-8") as file:
            return [{column: value_of(cell) for column, cell in row.items()}
                    for row in csv.DictReader(line for line in file if not line.startswith("#"))]

    def modes(self, label=None):
        """Complex modes, all or those whose label begins so."""
        return [mode for mode in self.table("complex_modes.csv") if label is None or mode["label"].startswith(label)]

    def eigenvalues(self):
        """lambda of every complex mode."""
        return [complex(mode["growth rate [1/s]"], 2 * math.pi * mode["frequency [Hz]"]) for mode in self.modes()]

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
        command = [str(SQUEAL), f"prm/{parameter_file}", "--output", str(folder)]
        command += [word for setting in settings for word in ("--set", setting)]
        if not self.is_done(folder, command):
            print(f"    running {' '.join(command[1:])}", flush=True)
            process = subprocess.run(command, cwd=SOURCE, env=environment, text=True, capture_output=True, check=False)
            if process.returncode != 0:
                raise RuntimeError(f"squeal failed:\n{process.stdout}{process.stderr}")
            (folder / "command.txt").write_text(" ".join(command) + "\n", encoding="utf-8")
        return Results(folder)

    @staticmethod
    def is_done(folder, command):
        marker = folder / "command.txt"
        return (marker.is_file() and marker.read_text(encoding="utf-8").strip() == " ".join(command)
                and marker.stat().st_mtime > SQUEAL.stat().st_mtime)


def value_of(cell):
    """A number, a text, or None where the cell is empty."""
    try:
        return float(cell)
    except (TypeError, ValueError):
        return cell or None
