# SPDX-License-Identifier: GPL-3.0-or-later

"""Command line, error messages and virtual display of the scripts."""

import argparse
import contextlib
import os
import shutil
import sys

from squeal.errors import Error


class Parser(argparse.ArgumentParser):
    """An argument parser that prints its description verbatim and raises Error for invalid arguments."""

    def __init__(self, description, **more):
        super().__init__(description=description, formatter_class=argparse.RawDescriptionHelpFormatter, **more)

    def error(self, message):
        raise Error(message, "command line", "correct the arguments; --help lists them")


# Debian packages that provide a module, unless the package is python3-MODULE
PACKAGES = {"PIL": "python3-pil", "netCDF4": "python3-netcdf4", "paraview": "paraview python3-paraview (or scripts/setup.sh paraview)",
            "vtk": "python3-vtk9 (or scripts/setup.sh pictures)"}


@contextlib.contextmanager
def exit_on_error():
    """Prints errors and exits with status 1."""
    try:
        yield
    except Error as error:
        sys.exit(f"error: {error}")
    except OSError as error:
        where = error.filename or sys.argv[0]
        sys.exit(f"error: {error.strerror or error}\n  where:  {where}\n  change: check the path, its permissions and the free space")
    except ModuleNotFoundError as missing:
        package = PACKAGES.get(missing.name, f"python3-{missing.name}")
        sys.exit(f"error: the Python module {missing.name} is missing\n  where:  {sys.argv[0]}\n  change: apt-get install {package}")


def make_of_results(what, parser, make):
    """Creates `what` (for example, plots) from the results folder RESULTS of the command line, and prints the names of
    the files.

    make(results, arguments) returns a file or a list of files, and notes to print.
    """
    from squeal.results import Results

    parser.add_argument("results", metavar="RESULTS", help="results folder of a run")
    arguments = parser.parse_args()
    try:
        found, remarks = make(Results(arguments.results), arguments)
    except ModuleNotFoundError as missing:
        sys.exit(f"No {what}: install python3-{missing.name} (or run scripts/setup.sh), then: "
                 f"scripts/{os.path.basename(sys.argv[0])} {arguments.results}")
    except (ArithmeticError, LookupError, TypeError, ValueError) as problem:  # tables are not checked for all the plots and pages
        raise Error(f"no {what}: a table or run.json is empty or has an invalid entry ({problem!r})", f"folder {arguments.results}",
                    "run squeal again") from problem
    print(*remarks, f"  {what}: {', '.join(map(str, found if isinstance(found, list) else [found]))}", sep="\n")


def ensure_display(packages, command=(sys.executable,), screen="1280x1024x24"):
    """Restarts the script under Xvfb if there is no display, for libraries that require an X server to render."""
    if os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"):
        return
    if os.environ.get("SQUEAL_RENDER_UNDER_XVFB") or not shutil.which("xvfb-run") or not shutil.which("xauth"):
        raise Error("there is no X display, and xvfb-run cannot provide one", "environment variable DISPLAY",
                    f"apt-get install xvfb xauth (or scripts/setup.sh {packages})")
    os.environ["SQUEAL_RENDER_UNDER_XVFB"] = "1"
    os.execvp("xvfb-run", ["xvfb-run", "-a", "-s", f"-screen 0 {screen}", *command, *sys.argv])
