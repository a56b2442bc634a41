# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/own_geometry.md"""

from reproduction.numbers import Number, entry, of_mode


@entry("own_geometry", "The disc brake: modes below 5 kHz, the unstable one at mu = 0.5")
def brake(runs):
    results = runs("brake", "brake.prm", "Output/Mode shapes=none")
    yield Number("modes", "18", len(results.complex_modes()))
    yield Number("unstable modes", "1", results.n_unstable())
    yield from of_mode("A0-3", results.leading("A0-3"), "4441", "0.74")
