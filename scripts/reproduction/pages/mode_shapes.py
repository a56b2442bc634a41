# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/mode_shapes.md"""

from reproduction.numbers import Number, entry


@entry("mode_shapes", "Component modes and real modes; the pins split the doublet A0-4")
def modes(runs):
    results = runs.default()
    real = {mode["label"]: mode["frequency [Hz]"] for mode in results.rows("real_modes")}
    yield Number("component modes", "102", len(results.rows("component_modes")))
    yield Number("real modes", "66", len(results.rows("real_modes")))
    yield Number("A0-4 + and A0-4 - are apart by [Hz]", "7", real["A0-4 +"] - real["A0-4 -"])
