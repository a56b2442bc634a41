# SPDX-License-Identifier: GPL-3.0-or-later

"""Python module of squeal: results of runs, and systems Q(λ; p) = Σ θ_k(p) λ^(power_k) A_k.

    results = squeal.run("x.prm", {"Operation/Friction coefficient": 0.3})
    system = squeal.System.read("folder")

What a name needs is imported when it is first used: reading tables needs no NumPy.
"""

import importlib

from squeal.errors import Error

PLACES = {"Results": "squeal.results", "run": "squeal.program", "System": "squeal.system", "Parameter": "squeal.system", "Term": "squeal.system"}


def __getattr__(name):
    if name not in PLACES:
        raise AttributeError(f"module `squeal` has no attribute `{name}`")
    return getattr(importlib.import_module(PLACES[name]), name)


__all__ = ["Error", *PLACES]
