# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/elements.md"""

from reproduction.numbers import Number, entry, numbers_in, of_mode, table

NO_SHAPES = "Output/Mode shapes=none"
ONE_PIN = (NO_SHAPES, "Operation/Friction coefficient=0", "Geometry/Top pin radii=0.2275", "Geometry/Top pin angles=0",
           "Geometry/Bottom pin radii=", "Geometry/Bottom pin angles=", "Geometry/Element size=0.03", "Geometry/Disc layers=1")
MESHES = ((7, 2), (19, 4), (37, 6), (61, 8))


def pin_frequency(runs, label, element, outlines, nodes, layers, *, rings=0, grading=1, ratio=0.25):
    results = runs(f"pin_{element}_{outlines}_{nodes}_{layers}_{rings}_{grading}_{ratio}".replace(" ", "_"), "disc_pins.prm", *ONE_PIN,
                   f"Discretization/Element={element}", f"Geometry/Outlines={outlines}", f"Geometry/Nodes per pin face={nodes}",
                   f"Geometry/Pin layers={layers}", f"Geometry/Pin rings={rings}", f"Geometry/Pin grading={grading}",
                   f"Pin material/Poisson ratio={ratio}")
    return results.sliding_pin(label)


@entry("elements", "F1 and T1 of a sliding pin by element, outlines, nodes per face and layers")
def pins(runs):
    for name, outlines, *quoted in table("elements", "19, 4 | 37, 6"):
        label, element = name.split(", ")
        outlines = "inscribed" if outlines == "on the circle" else outlines
        for (nodes, layers), frequency in zip(MESHES, quoted):
            yield Number(f"{label}, {element}, {outlines}, {nodes} nodes, {layers} layers [Hz]", frequency,
                         pin_frequency(runs, label, element, outlines, nodes, layers))


@entry("elements", "F1 of a sliding pin with rings at its outline and thinner layers at its clamped end")
def rings_of_pins(runs):
    of_table = [("quadratic", *numbers_in(*cells)) for cells in table("elements", "rings | grading")]
    of_text = ("quadratic", 7, 2, 0, 1.5, "3485.9"), ("incompatible modes", 19, 4, 2, 1.5, "3542.7")
    for element, nodes, layers, rings, grading, quoted in (*of_table, *of_text):
        yield Number(f"{element}, {nodes} nodes, {layers} layers, {rings} rings, {grading} [Hz]", quoted,
                     pin_frequency(runs, "F1", element, "inscribed", nodes, layers, rings=rings, grading=grading))


@entry("elements", "Locking: F1 of a sliding pin by element and Poisson's ratio")
def locking(runs):
    for element, *cells in table("elements", "0.25 | 0.47"):
        for ratio, cell in zip((0.25, 0.47, 0.49, 0.499, 0.4999), cells):
            found, exact = (pin_frequency(runs, "F1", kind, "inscribed", 19, 4, ratio=ratio) for kind in (element, "quadratic"))
            yield from map(Number, (f"{element}, {ratio} [Hz]", "  too high by [%]"), numbers_in(cell), (found, 100 * (found / exact - 1)))


@entry("elements", "A0-4, A0-5 and F1 of the default model by element and outlines")
def disc(runs):
    for name, layers, _, *quoted in table("elements", "disc layers"):
        if not name.startswith("the same"):
            element = name
        outlines = "true area" if name.endswith("true area") else "inscribed"
        results = runs.default(f"elements_{element}_{outlines}".replace(" ", "_"), f"Discretization/Element={element}",
                               f"Geometry/Outlines={outlines}", f"Geometry/Disc layers={layers}")
        for label, frequency, rate in zip(("A0-4", "A0-5", "F1"), quoted[::2], quoted[1::2]):
            yield from of_mode(f"{element}, {outlines}, {label}", results.leading(label), frequency, rate)


@entry("elements", "Quadratic tetrahedra on faces that do not match: A0-4 of the free disc, leading F1")
def tetrahedra(runs):
    for name, _, _, disc, _, leading_mode, *_ in table("elements", "contact nodes | A0-4")[:3]:
        refinement, = numbers_in(name)
        results = runs.default(f"tetrahedra_{refinement}", "Geometry/File=disc_pins_tetrahedra.geo",
                               f"Geometry/refinement={refinement}", "Discretization/Element=quadratic")
        free = [mode["frequency [Hz]"] for mode in results.rows("component_modes") if mode["label"].startswith("A0-4")]
        yield Number(f"refinement {refinement}, A0-4 [Hz]", disc, sum(free) / len(free))
        leading = max(results.rows("complex_modes"), key=lambda mode: mode["divergence rate [%]"])
        yield from of_mode(f"refinement {refinement}, F1", leading, *numbers_in(leading_mode))
