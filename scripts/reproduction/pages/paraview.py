# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/paraview.md"""

import math

from reproduction.numbers import Number, entry


@entry("paraview", "A mode grows by a factor of e in 1 / (2 pi xi) periods")
def growth(runs):
    rate = max(mode["divergence rate [%]"] for mode in runs.default().complex_modes()) / 100
    yield Number("periods for a factor of e", "15", 1 / (2 * math.pi * rate))
    yield Number("growth in three periods [%]", "22", 100 * (math.exp(2 * math.pi * rate * 3) - 1))
