# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/elements.md"""

from reproduction.numbers import Number, entry, of_mode

NO_SHAPES = "Output/Mode shapes=none"
ONE_PIN = (NO_SHAPES, "Operation/Friction coefficient=0", "Geometry/Top pin radii=0.2275", "Geometry/Top pin angles=0",
           "Geometry/Bottom pin radii=", "Geometry/Bottom pin angles=", "Geometry/Element size=0.03", "Geometry/Disc layers=1")
MESHES = ((7, 2), (19, 4), (37, 6), (61, 8))
PINS = {("F1", "trilinear", "inscribed"): ("3753.8", "3555.6", "3504.1", "3482.6"),
        ("F1", "trilinear", "true area"): ("3792.3", "3567.7", "3509.6", "3485.7"),
        ("F1", "incompatible modes", "inscribed"): ("3724.8", "3539.5", "3494.5", "3476.0"),
        ("F1", "incompatible modes", "true area"): ("3769.0", "3552.0", "3500.1", "3479.2"),
        ("F1", "quadratic", "inscribed"): ("3487.4", "3457.0", "3451.4", "3449.4"),
        ("T1", "trilinear", "inscribed"): ("4012.7", "3936.7", "3922.7", "3917.9"),
        ("T1", "incompatible modes", "inscribed"): ("3797.1", "3897.9", "3906.7", "3909.0"),
        ("T1", "quadratic", "inscribed"): ("3912.6", "3911.6", "3911.6", "3911.6")}
DISC = {("trilinear", "inscribed", 3): ("2353.0", "0.680", "3452.1", "0.856", "3569.1", "1.068"),
        ("trilinear", "true area", 3): ("2355.9", "0.719", "3455.3", "0.875", "3578.7", "1.065"),
        ("incompatible modes", "inscribed", 3): ("2324.9", "0.710", "3416.9", "0.862", "3546.2", "1.028"),
        ("incompatible modes", "true area", 3): ("2327.9", "0.751", "3419.3", "0.870", "3556.8", "1.017"),
        ("quadratic", "inscribed", 2): ("2315.1", "0.770", "3481.3", "1.134", "3369.2", "0.908")}


# Element, nodes, layers, rings, grading
RINGS = {("quadratic", 7, 3, 2, 1.5): "3451.0", ("quadratic", 7, 4, 2, 1.5): "3449.2", ("quadratic", 19, 4, 3, 1.5): "3448.6",
         ("quadratic", 19, 5, 3, 1.5): "3447.9", ("quadratic", 37, 8, 5, 1.5): "3447.0", ("quadratic", 7, 2, 0, 1.5): "3485.9",
         ("incompatible modes", 19, 4, 2, 1.5): "3542.7"}
LOCKING = {"trilinear": (("3555.6", "2.9"), ("3468.2", "4.2"), ("3511.8", "5.2"), ("3576.1", "6.5"), ("3591.6", "6.8")),
           "incompatible modes": (("3539.5", "2.4"), ("3390.9", "1.9"), ("3388.5", "1.5"), ("3403.0", "1.3"), ("3420.1", "1.7")),
           "quadratic": (("3457.0", None), ("3327.3", None), ("3338.4", None), ("3359.1", None), ("3363.8", None))}


def pin_frequency(runs, label, element, outlines, nodes, layers, *, rings=0, grading=1, ratio=0.25):
    results = runs(f"pin_{element}_{outlines}_{nodes}_{layers}_{rings}_{grading}_{ratio}".replace(" ", "_"), "disc_pins.prm", *ONE_PIN,
                   f"Discretization/Element={element}", f"Geometry/Outlines={outlines}", f"Geometry/Nodes per pin face={nodes}",
                   f"Geometry/Pin layers={layers}", f"Geometry/Pin rings={rings}", f"Geometry/Pin grading={grading}",
                   f"Pin material/Poisson ratio={ratio}")
    return min(mode["frequency [Hz]"] for mode in results.rows("component_modes")
               if mode["component"] == "pins" and mode["contact"] == "sliding" and mode["label"].startswith(label))


@entry("elements", "F1 and T1 of a sliding pin by element, outlines, nodes per face and layers")
def pins(runs):
    for (label, element, outlines), quoted in PINS.items():
        for (nodes, layers), frequency in zip(MESHES, quoted):
            yield Number(f"{label}, {element}, {outlines}, {nodes} nodes, {layers} layers [Hz]", frequency,
                         pin_frequency(runs, label, element, outlines, nodes, layers))


@entry("elements", "F1 of a sliding pin with rings at its outline and thinner layers at its held end")
def rings_of_pins(runs):
    for (element, nodes, layers, rings, grading), quoted in RINGS.items():
        yield Number(f"{element}, {nodes} nodes, {layers} layers, {rings} rings, {grading} [Hz]", quoted,
                     pin_frequency(runs, "F1", element, "inscribed", nodes, layers, rings=rings, grading=grading))


@entry("elements", "Locking: F1 of a sliding pin by element and Poisson's ratio")
def locking(runs):
    for element, quoted in LOCKING.items():
        for ratio, (frequency, excess) in zip((0.25, 0.47, 0.49, 0.499, 0.4999), quoted):
            found, exact = (pin_frequency(runs, "F1", kind, "inscribed", 19, 4, ratio=ratio) for kind in (element, "quadratic"))
            yield Number(f"{element}, {ratio} [Hz]", frequency, found)
            if excess is not None:
                yield Number(f"{element}, {ratio} [%]", excess, 100 * (found / exact - 1))


@entry("elements", "A0-4, A0-5 and F1 of the default scene by element and outlines")
def disc(runs):
    for (element, outlines, layers), quoted in DISC.items():
        results = runs(f"elements_{element}_{outlines}".replace(" ", "_"), "disc_pins.prm", NO_SHAPES, f"Discretization/Element={element}",
                       f"Geometry/Outlines={outlines}", f"Geometry/Disc layers={layers}")
        for label, frequency, rate in zip(("A0-4", "A0-5", "F1"), quoted[::2], quoted[1::2]):
            yield from of_mode(f"{element}, {outlines}, {label}", results.leading(label), frequency, rate)


TETRAHEDRA = {1: ("2256.8", "3495.3", "1.117"), 1.3: ("2254.7", "3486.2", "1.131"), 1.65: ("2253.5", "3481.9", "1.134")}


@entry("elements", "Quadratic tetrahedra on faces that do not match: A0-4 of the free disc, leading F1")
def tetrahedra(runs):
    for refinement, (disc, frequency, divergence) in TETRAHEDRA.items():
        results = runs(f"tetrahedra_{refinement}", "disc_pins.prm", NO_SHAPES, "Geometry/File=disc_pins_tetrahedra.geo",
                       f"Geometry/refinement={refinement}", "Discretization/Element=quadratic")
        free = [mode["frequency [Hz]"] for mode in results.rows("component_modes") if mode["label"].startswith("A0-4")]
        yield Number(f"refinement {refinement}, A0-4 [Hz]", disc, sum(free) / len(free))
        leading = max(results.rows("complex_modes"), key=lambda mode: mode["divergence rate [%]"])
        yield from of_mode(f"refinement {refinement}, F1", leading, frequency, divergence)
