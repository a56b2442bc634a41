"""doc/elements.md"""

from reproduction.numbers import Number, entry

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
        ("trilinear", "true area", 3): ("2355.9", "0.719", "3455.3", "0.875", "3578.7", "1.066"),
        ("incompatible modes", "inscribed", 3): ("2324.9", "0.710", "3416.9", "0.862", "3546.2", "1.028"),
        ("incompatible modes", "true area", 3): ("2327.9", "0.751", "3419.3", "0.870", "3556.8", "1.017"),
        ("quadratic", "inscribed", 2): ("2315.1", "0.770", "3481.3", "1.134", "3369.2", "0.908")}


def pin_frequency(runs, label, element, outlines, nodes, layers):
    results = runs(f"pin_{element}_{outlines}_{nodes}_{layers}".replace(" ", "_"), "disc_pins.prm", *ONE_PIN,
                   f"Discretization/Element={element}", f"Geometry/Outlines={outlines}", f"Geometry/Nodes per pin face={nodes}",
                   f"Geometry/Pin layers={layers}")
    return min(mode["frequency [Hz]"] for mode in results.table("component_modes.csv")
               if mode["component"] == "pins" and mode["contact"] == "sliding" and mode["label"].startswith(label))


@entry("elements", "F1 and T1 of a sliding pin by element, outlines, nodes per face and layers")
def pins(runs):
    for (label, element, outlines), quoted in PINS.items():
        for (nodes, layers), frequency in zip(MESHES, quoted):
            yield Number(f"{label}, {element}, {outlines}, {nodes} nodes, {layers} layers [Hz]", frequency,
                         pin_frequency(runs, label, element, outlines, nodes, layers))


@entry("elements", "A0-4, A0-5 and F1 of the default scene by element and outlines")
def disc(runs):
    for (element, outlines, layers), quoted in DISC.items():
        results = runs(f"elements_{element}_{outlines}".replace(" ", "_"), "disc_pins.prm", NO_SHAPES, f"Discretization/Element={element}",
                       f"Geometry/Outlines={outlines}", f"Geometry/Disc layers={layers}")
        leading = [results.leading(label) for label in ("A0-4", "A0-5", "F1")]
        found = [mode[column] for mode in leading for column in ("frequency [Hz]", "divergence rate [%]")]
        for name, number, value in zip(("A0-4 [Hz]", "A0-4 [%]", "A0-5 [Hz]", "A0-5 [%]", "F1 [Hz]", "F1 [%]"), quoted, found):
            yield Number(f"{name}, {element}, {outlines}", number, value)
