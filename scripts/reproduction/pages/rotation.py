# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/rotation.md"""

from reproduction.numbers import Number, entry, of_mode, table


@entry("rotation", "Effect on the default model: frequencies and divergence rates without and with gyroscopic forces")
def default_scene(runs):
    still = runs.default()
    turning = runs.default("rotating", "Operation/Gyroscopic forces=true")
    for label, *quoted in table("rotation", "frequency without [Hz]"):
        for name, results, frequency, rate in (("without", still, quoted[0], quoted[2]), ("with", turning, quoted[1], quoted[3])):
            yield from of_mode(f"{label}, {name}", results.leading(label), frequency, rate)
    yield Number("growing modes without", "9", still.n_unstable())
    yield Number("growing modes with", "25", turning.n_unstable())
