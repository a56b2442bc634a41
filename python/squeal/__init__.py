# SPDX-License-Identifier: GPL-3.0-or-later

"""Python module of squeal: results of runs, and systems Q(λ; p) = Σ θ_k(p) λ^(power_k) A_k.

    results = squeal.run("x.prm", {"Operation/Friction coefficient": 0.3})
    system = squeal.System.read("folder")

Names are imported on first use, so that reading tables does not require NumPy.
"""

import importlib

from squeal.errors import Error

MODULES = {"Results": "squeal.results", "run": "squeal.program",
           "System": "squeal.system", "Parameter": "squeal.system", "Term": "squeal.system"}


def __getattr__(name):
    if name not in MODULES:
        raise AttributeError(f"module `squeal` has no attribute `{name}`")
    return getattr(importlib.import_module(MODULES[name]), name)


__all__ = ["Error", *MODULES]
