# SPDX-License-Identifier: GPL-3.0-or-later

"""Reproduces the numbers quoted in the documentation: the runs for each statement, and the quantities to extract from them.

Each page has a module with its name in pages/. An entry is a function with the decorator entry(page, statement) that takes the runs
(runs.Runs) and yields a Number for each number of the statement or of a table of the page, which table() reads.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))
