# SPDX-License-Identifier: GPL-3.0-or-later

"""Reproduces the numbers quoted in the documentation: the runs for each statement, and the quantities to extract from them.

Each page with reproduced numbers has a module of the same name in pages/. An entry is a function with the decorator
entry(page, statement). It takes the runs (runs.Runs) and yields a Number for each reproduced number in the statement, or
in a table of the page read by table().
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))
