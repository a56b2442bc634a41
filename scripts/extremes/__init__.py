# SPDX-License-Identifier: GPL-3.0-or-later

"""Models with extreme parameters: settings, an independent solution of each model, and the assessment of the results.

    cases.py     the models as data
    oracle.py    all eigenvalues of the exported matrices by SciPy, refined in extended precision
    judge.py     runs a case and decides whether it is right, refused, wrong or not judged
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))
