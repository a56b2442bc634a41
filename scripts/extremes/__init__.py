# SPDX-License-Identifier: GPL-3.0-or-later

"""Parameters far from those of a brake: scenes, an independent solution of each, and the judgement of what the program says.

    cases.py     the scenes as data
    oracle.py    all eigenvalues of the exported matrices by SciPy, refined in extended precision
    judge.py     runs a case and says whether it is right, refused or wrong
    scaling.py   the small scene in other units of length
    page.py      the table of doc/extremes.md
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))
