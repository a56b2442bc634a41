# SPDX-License-Identifier: GPL-3.0-or-later

"""The numbers that the pages quote: for each sentence the runs it needs, and what is to be read from them.

A page has a module of its name here. An entry of it is a function with the decorator `entry(sentence)` that is given the runs
(runs.Runs) and yields a Number for each number of the sentence, or of a table of the page, which table() reads. A new number in a page is a
new entry.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))
