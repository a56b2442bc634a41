# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/mechanics.md"""

from reproduction.numbers import Number, entry

QUADRATIC = ("Discretization/Element=quadratic", "Geometry/Nodes per pin face=19", "Geometry/Element size=0.04", "Geometry/Disc layers=2")


def bending(runs, ratio, *settings, suffix=""):
    """The lowest F1 frequency [Hz] of a sliding pin."""
    return runs.default(f"poisson_{ratio}{suffix}", f"Pin material/Poisson ratio={ratio}", *settings).sliding_pin("F1")


@entry("mechanics", "Volumetric locking: F1 of a sliding pin relative to quadratic elements, in excess of Poisson's ratio 0.25")
def locking(runs):
    def excess(ratio):
        return 100 * (bending(runs, ratio) / bending(runs, ratio, *QUADRATIC, suffix="_quadratic") - 1)

    for ratio, quoted in ((0.47, "1.4"), (0.49, "2.3"), (0.499, "3.6")):
        yield Number(f"at {ratio} [%]", quoted, excess(ratio) - excess(0.25))
