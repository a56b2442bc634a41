# SPDX-License-Identifier: GPL-3.0-or-later

"""Finds the program and runs it."""

import os
import pathlib
import re
import shutil
import subprocess

from squeal.errors import Error
from squeal.results import Results

PACKAGE = pathlib.Path(__file__).resolve().parent
SOURCE = PACKAGE.parents[1]
# Paths of the executable in an installation and in a source tree
PLACES = (PACKAGE.parents[3] / "bin" / "squeal", SOURCE / "build" / "release" / "squeal")


def find_program():
    """Path of the executable, from the variable SQUEAL, the installation, the source tree or PATH. Raises Error if there
    is none."""
    if given := os.environ.get("SQUEAL"):
        if not pathlib.Path(given).is_file():
            raise Error(f"there is no program {given}", "environment variable SQUEAL", "set it to the path of the executable")
        return pathlib.Path(given).resolve()
    found = next((path for path in PLACES if path.is_file()), None) or shutil.which("squeal")
    if not found:
        raise Error("there is no program squeal in the installation, the source tree or PATH", "squeal.run()",
                    "build it with scripts/setup.sh, or set the environment variable SQUEAL")
    return pathlib.Path(found)


def text_of(value):
    """A value in the syntax of parameter files."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (list, tuple)):
        return ", ".join(map(text_of, value))
    return repr(float(value)) if isinstance(value, float) else str(value)


def words_of(settings):
    """Command-line arguments for settings "Section/Name=value"."""
    return [word for setting in settings for word in ("--set", setting)]


def run(prm, overrides=None, output=None, n_processes=1):
    """Runs a parameter file with overrides "Section/Name" -> value and returns the Results.

    Results are written to the folder `output`, by default results/NAME for NAME.prm. Raises Error with the message of
    the program.
    """
    output = pathlib.Path(output) if output else pathlib.Path("results") / pathlib.Path(prm).stem
    launcher = ["mpirun", "-np", str(n_processes)] if n_processes > 1 else []
    settings = words_of(f"{name}={text_of(value)}" for name, value in (overrides or {}).items())
    process = subprocess.run([*launcher, find_program(), prm, "--output", output, *settings], text=True, capture_output=True, check=False)
    if process.returncode != 0:
        raise error_of(process, prm)
    return Results(output)


def error_of(process, prm):
    """The exception for a run that failed."""
    if match := re.search(r"^error: (.*?)\n  where: *(.*?)\n  change: *(.*?)(?:\n\S|\Z)", process.stderr, re.DOTALL | re.MULTILINE):
        return Error(*(part.strip() for part in match.groups()))
    last = process.stderr.strip().splitlines()[-10:]
    return Error("\n".join([f"squeal ended with exit status {process.returncode}", *last]), prm,
                 "read this output, or run squeal in a terminal")
