# SPDX-License-Identifier: GPL-3.0-or-later

"""Runs of squeal, shared by the entries and kept in a folder."""

import squeal.results
from squeal.program import SOURCE, find_program, run


class Results(squeal.results.Results):
    """The folder of a finished run."""

    def rows(self, name):
        """Rows of a table as dictionaries, with numbers as floats and empty cells as None."""
        return [{column: value_of(cell) for column, cell in row.items()} for row in self.table(name).rows]

    def complex_modes(self, label=None):
        """All complex modes, or the modes whose label begins with `label`."""
        return [mode for mode in self.rows("complex_modes") if label is None or mode["label"].startswith(label)]

    def eigenvalues(self):
        """lambda of every complex mode."""
        return self.table("complex_modes").eigenvalues()

    def leading(self, label):
        """The mode of this label with the largest divergence rate."""
        return max(self.complex_modes(label), key=lambda mode: mode["divergence rate [%]"])

    def sliding_pin(self, label):
        """The lowest frequency [Hz] of the modes with this label of individual sliding pins."""
        return min(mode["frequency [Hz]"] for mode in self.rows("component_modes")
                   if mode["component"] == "pins" and mode["contact"] == "sliding" and mode["label"].startswith(label))

    def n_unstable(self):
        return sum(mode["unstable [-]"] == 1 for mode in self.complex_modes())


class Runs:
    """Runs in a folder; a run is skipped if its results exist and are up to date."""

    def __init__(self, folder):
        self.folder = folder

    def __call__(self, name, parameter_file, *settings):
        """Results of prm/PARAMETER_FILE with settings "Section/Name=value", in the subfolder NAME."""
        folder, command = self.folder / name, "\n".join([parameter_file, *settings, ""])
        marker = folder / "command.txt"
        if not (marker.is_file() and marker.read_text(encoding="utf-8") == command and marker.stat().st_mtime > find_program().stat().st_mtime):
            print(f"    running {parameter_file} {' '.join(settings)}", flush=True)
            run(SOURCE / "prm" / parameter_file, dict(setting.split("=", 1) for setting in settings), folder)
            marker.write_text(command, encoding="utf-8")
        return Results(folder)

    def default(self, name="default", *settings):
        """Results of the default model without mode shapes."""
        return self(name, "disc_pins.prm", "Output/Mode shapes=none", *settings)


def value_of(cell):
    """Value of a cell: a number, a string, or None if it is empty."""
    try:
        return float(cell)
    except (TypeError, ValueError):
        return cell or None
