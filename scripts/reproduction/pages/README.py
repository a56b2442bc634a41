"""README.md"""

import math

from reproduction.numbers import Number, entry, of_mode


@entry("README", "A mode grows by a factor of e in 1 / (2 pi xi) periods")
def growth(runs):
    rate = max(mode["divergence rate [%]"] for mode in runs("default", "disc_pins.prm", "Output/Mode shapes=none").complex_modes()) / 100
    yield Number("periods of a factor of e", "15", 1 / (2 * math.pi * rate))
    yield Number("growth in three periods [%]", "22", 100 * (math.exp(2 * math.pi * rate * 3) - 1))


@entry("README", "The disc brake: modes below 5 kHz, the unstable one at mu = 0.5")
def brake(runs):
    results = runs("brake", "brake.prm", "Output/Mode shapes=none")
    yield Number("modes", "18", len(results.complex_modes()))
    yield Number("unstable modes", "1", results.n_unstable())
    yield from of_mode("A0-3", results.leading("A0-3"), "4441", "0.74")
