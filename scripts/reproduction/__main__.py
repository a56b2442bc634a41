# SPDX-License-Identifier: GPL-3.0-or-later

"""Lists or reproduces the numbers in the documentation: see scripts/reproduce.sh."""

import importlib
import pathlib
import pkgutil
import sys
import textwrap

from reproduction import pages
from reproduction.numbers import ENTRIES
from reproduction.runs import SOURCE, Runs
from squeal.command_line import Parser, exit_on_error
from squeal.errors import Error


def reproduce(runs, page, chosen):
    """Prints the numbers of the statements; returns the number of differences."""
    n_differing = 0
    for sentence, numbers_of in chosen:
        print(f"\n{page}: {sentence}", flush=True)
        for number in numbers_of(runs):
            print(number, flush=True)
            n_differing += not number.agrees()
    return n_differing


@exit_on_error()
def main():
    parser = Parser(__doc__, prog="scripts/reproduce.sh")
    parser.add_argument("pages", nargs="*", metavar="PAGE")
    parser.add_argument("--list", action="store_true", help="prints pages and statements without any run")
    parser.add_argument("--only", default="", metavar="WORDS", help="only the statements that contain WORDS")
    parser.add_argument("--results", type=pathlib.Path, default=SOURCE / "results" / "reproduce", metavar="DIR")
    arguments = parser.parse_args()
    for module in pkgutil.iter_modules(pages.__path__):
        importlib.import_module(f"reproduction.pages.{module.name}")
    unknown = [page for page in arguments.pages if page not in ENTRIES]
    if unknown:
        raise Error(f"no numbers are reproduced for {', '.join(unknown)}", "PAGE", f"choose from {', '.join(ENTRIES)}")

    n_differing = 0
    for page in arguments.pages or ENTRIES:
        chosen = [entry for entry in ENTRIES[page] if arguments.only in entry[0]]
        if arguments.list:
            print(page)
            for sentence, _ in chosen:
                print(textwrap.indent(textwrap.fill(sentence, 130), "    "))
        else:
            n_differing += reproduce(Runs(arguments.results), page, chosen)
    if n_differing:
        print(f"\nnumbers that differ from the pages: {n_differing}", file=sys.stderr)
    return 1 if n_differing else 0


if __name__ == "__main__":
    sys.exit(main())
