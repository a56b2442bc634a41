# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/rotation.md"""

from reproduction.numbers import Number, entry, of_mode

NO_SHAPES = "Output/Mode shapes=none"


@entry("rotation", "What it does to the default scene: frequencies and divergence rates without and with gyroscopic forces")
def default_scene(runs):
    still = runs("default", "disc_pins.prm", NO_SHAPES)
    turning = runs("rotating", "disc_pins.prm", NO_SHAPES, "Operation/Gyroscopic forces=true")
    for label, *quoted in (("A0-0", "313.13", "313.15", "0", "0.0176"), ("A1-0", "1463.99", "1464.02", "0", "0.0319"),
                           ("R0-2 +", "1812.06", "1811.25", "0.0005", "0.0082"), ("A0-4 +", "2352.97", "2355.47", "0.6798", "0.6792"),
                           ("A0-4 -", "2352.97", "2350.48", "-0.6798", "-0.6811"), ("A1-2 +", "3324.19", "3324.27", "0", "0.0413"),
                           ("A0-5 +", "3452.13", "3454.30", "0.8563", "0.8560"), ("A0-5 -", "3452.13", "3449.93", "-0.8563", "-0.8565"),
                           ("F1", "3569.05", "3568.1", "1.0677", "1.0622"), ("A0-6 +", "4769.24", "4772.00", "0", "0.0251")):
        for name, results, frequency, rate in (("without", still, quoted[0], quoted[2]), ("with", turning, quoted[1], quoted[3])):
            yield from of_mode(f"{label}, {name}", results.leading(label), frequency, rate)
    yield Number("growing modes without", "9", still.n_unstable())
    yield Number("growing modes with", "25", turning.n_unstable())
