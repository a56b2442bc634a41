# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/well_posedness.md"""

import numpy as np
import scipy.linalg

from squeal import exported_matrices
from reproduction.numbers import Number, entry, of_mode
from reproduction.sliding_layer import Layer

# Ring: pin layers, element size [m], end of the band [Hz]
MESHES = {5: (0.0024, 46e3), 8: (0.0016, 70e3), 10: (0.0012, 94e3), 12: (0.00095, 118e3)}
RING = {0.4: {5: ("18", "11027", "13351"), 8: ("48", "12230", "13351"), 10: ("80", "13218", "13351"), 12: ("127", "12930", "13351")},
        1.5: {5: ("18", "39188", "43491"), 8: ("47", "42738", "43491"), 10: ("81", "46695", "59297"), 12: ("128", "60998", "59297")}}
LAYER = {0.4: ("13.0", "13.6", "13.5", "13.5"), 0.8: ("25", "26", "26", "29"), 1.0: ("30", "31", "35", "42"),
         1.2: ("35", "36", "47", "70"), 1.5: ("42", "44", "72", "136"), 2.0: ("52", "60", "112", "224")}
HALF_SPACE = {1.2: "4.3", 1.5: "9.1", 2.0: "14.5"}
PAD = Layer(0.012, 1.9e9, 0.25, 3070)
PAD_RADIUS = 0.00625
LARGEST_FREQUENCY = 500e3
NUMBERS_OF_WAVES = range(1, 25)

# One pin on each side: by mesh factor
IN_BAND = {0.4: {1: ("34", "2353.1", "3711.8", "0.257"), 2: ("36", "2308.5", "3534.6", "0.322"),
                 3: ("36", "2285.9", "3488.7", "0.230"), 4: ("36", "2278.5", "3470.7", "0.242")},
           1: {1: ("34", "2353.3", None, None), 2: ("36", "2308.6", "3321.7", "0.844"),
               3: ("36", "2285.8", "3281.6", "1.076"), 4: ("36", "2278.4", "3261.9", "1.048")}}
# (friction coefficient, mesh factor, end of the band [Hz])
BEYOND = {(1, 1, 18000): ("11", "9629", "12.4"), (1, 2, 18000): ("16", "7660", "10.8"),
          (1.5, 1, 18000): ("12", "14457", "11.8"), (1.5, 2, 24000): ("39", "12087", "14.9"), (1.5, 3, 24000): ("54", "11268", "14.5")}
# One pin on a coarse disc, all eigenvalues
WHOLE = {0.4: {1: ("7", "2700", "15.3"), 2: ("48", "4223", "30.5"), 3: ("140", "3401", "28.4")},
         1: {1: ("5", "9478", "12.4"), 2: ("65", "8309", "30.0"), 3: ("225", "9770", "28.0")},
         1.5: {1: ("6", "14407", "11.8"), 2: ("70", "12812", "51.0"), 3: ("248", "14311", "27.3"), 4: ("556", "13147", "26.6")}}

DAMPING = {"none": ((), "39188", "42738"),
           "radial dissipation": (("Operation/Radial dissipation=consistent",), "43194", "45559"),
           "friction slope 0.1 s/m": (("Operation/Friction slope=0.1",), "9118", "13624"),
           "Rayleigh alpha 1000 1/s": (("Disc material/Rayleigh alpha=1000", "Pin material/Rayleigh alpha=1000"), "38688", "42238"),
           "modal damping ratio 5 %": (("Damping/Modal damping ratio=0: 0.05",), "27437", "26678"),
           "Rayleigh beta 2e-7 s": (("Disc material/Rayleigh beta=2e-7", "Pin material/Rayleigh beta=2e-7"), "33533", "32900"),
           "Rayleigh beta 1e-6 s": (("Disc material/Rayleigh beta=1e-6", "Pin material/Rayleigh beta=1e-6"), "16470", "15507")}


def leading(results):
    return max(results.complex_modes(), key=lambda mode: mode["growth rate [1/s]"])


def ring(runs, friction_coefficient, layers, *settings, suffix=""):
    element_size, band = MESHES[layers]
    return runs(f"sliding_ring_{friction_coefficient}_{layers}{suffix}".replace(" ", "_"), "studies/sliding_ring.prm",
                f"Operation/Friction coefficient={friction_coefficient}", f"Geometry/Element size={element_size}",
                f"Geometry/Pin layers={layers}", f"Band/Maximum frequency={band:g}", *settings)


def one_pin(runs, friction_coefficient, factor, band):
    return runs(f"one_pin_{friction_coefficient}_{factor}_{band:g}", "studies/accuracy_one_pin.prm", "Study=stability",
                f"Geometry/Nodes per pin face={3 * factor * (factor + 1) + 1}", f"Geometry/Pin layers={2 * factor}",
                f"Geometry/Disc layers={factor}", f"Geometry/Element size={0.048 / factor!r}", "Discretization/Element=incompatible modes",
                f"Operation/Friction coefficient={friction_coefficient}", f"Band/Maximum frequency={band:g}", "Output/Mode shapes=none")


@entry("well_posedness", "Growth rates of waves of a layer, by friction coefficient and thickness over wave length")
def layer(_):
    for friction_coefficient, quoted in LAYER.items():
        for turns, number in zip((0.5, 1, 2, 4), quoted):
            wave_numbers = 2 * np.pi / PAD.thickness * turns * np.arange(1, 21) / 20
            growth = PAD.largest_growth(wave_numbers, friction_coefficient, LARGEST_FREQUENCY)
            yield Number(f"mu = {friction_coefficient}, up to H / l = {turns} [1000/s]", number, growth / 1e3)


@entry("well_posedness", "Divergence rate of the growing wave of a half-space")
def half_space(_):
    yield Number("mu = 0.999 [%]", "0", PAD.half_space(0.999))
    for friction_coefficient, quoted in HALF_SPACE.items():
        yield Number(f"mu = {friction_coefficient} [%]", quoted, 100 * PAD.half_space(friction_coefficient))


@entry("well_posedness", "The largest growth rate of a ring up to the frequency that its mesh resolves, beside that of the layer")
def rings(runs):
    for friction_coefficient, meshes in RING.items():
        for layers, (n_growing, growth, exact) in meshes.items():
            results = ring(runs, friction_coefficient, layers)
            yield Number(f"mu = {friction_coefficient}, {layers} layers, growing modes", n_growing, results.n_unstable())
            yield Number(f"mu = {friction_coefficient}, {layers} layers [1/s]", growth, leading(results)["growth rate [1/s]"])
            yield Number(f"mu = {friction_coefficient}, {layers} layers, layer [1/s]", exact, PAD.largest_growth(
                np.array(NUMBERS_OF_WAVES) / PAD_RADIUS, friction_coefficient, MESHES[layers][1]))


@entry("well_posedness", "One pin on each side: modes up to 5 kHz")
def in_band(runs):
    for friction_coefficient, meshes in IN_BAND.items():
        for factor, (n_modes, axial, frequency, rate) in meshes.items():
            results = one_pin(runs, friction_coefficient, factor, 5000)
            name = f"mu = {friction_coefficient}, mesh {factor}"
            yield Number(f"{name}, modes", n_modes, len(results.complex_modes()))
            yield Number(f"{name}, A0-4 [Hz]", axial, max(mode["frequency [Hz]"] for mode in results.complex_modes("A0-4")))
            yield from of_mode(f"{name}, leading mode", leading(results), frequency, rate)


@entry("well_posedness", "One pin on each side: modes beyond 5 kHz")
def beyond_band(runs):
    for (friction_coefficient, factor, band), (n_growing, growth, frequency) in BEYOND.items():
        results = one_pin(runs, friction_coefficient, factor, band)
        name = f"mu = {friction_coefficient}, mesh {factor}, to {band / 1000:g} kHz"
        beyond = [mode for mode in results.complex_modes() if mode["frequency [Hz]"] > 5000 and mode["divergence rate [%]"] > 0.01]
        yield Number(f"{name}, modes above 0.01 %", n_growing, len(beyond))
        yield Number(f"{name}, largest growth rate [1/s]", growth, leading(results)["growth rate [1/s]"])
        yield Number(f"{name}, its frequency [kHz]", frequency, leading(results)["frequency [Hz]"] / 1000)


def all_eigenvalues(results, friction_coefficient):
    """lambda with Re >= 0 and Im >= 0 of the exported matrices without damping, every growing mode once."""
    problem = exported_matrices.couple(exported_matrices.read_matrices(results.folder), friction_coefficient)
    squares = scipy.linalg.eigvals(scipy.linalg.solve(problem.mass.toarray(), problem.stiffness.toarray()))
    roots = np.sqrt(-squares[squares.imag >= 0])
    return abs(roots.real) + 1j * abs(roots.imag)


@entry("well_posedness", "One pin on a coarse disc: all eigenvalues")
def whole_spectrum(runs):
    for friction_coefficient, meshes in WHOLE.items():
        for factor, (n_growing, growth, frequency) in meshes.items():
            results = runs(f"whole_{factor}", "disc_pins.prm", "Geometry/Top pin radii=0.2275", "Geometry/Top pin angles=0",
                           "Geometry/Bottom pin radii=", "Geometry/Bottom pin angles=", f"Geometry/Nodes per pin face={3 * factor * (factor + 1) + 1}",
                           f"Geometry/Pin layers={2 * factor}", "Geometry/Disc layers=1", "Geometry/Element size=0.06",
                           "Discretization/Element=incompatible modes", "Output/Write matrices=true", "Output/Mode shapes=none")
            values = all_eigenvalues(results, friction_coefficient)
            first = values[np.argmax(values.real)]
            name = f"mu = {friction_coefficient}, mesh {factor}"
            yield Number(f"{name}, modes above 0.1 %", n_growing, np.sum((values.real > 1e-3 * values.imag) & (values.imag > 0)))
            yield Number(f"{name}, largest growth rate [1/s]", growth, first.real)
            yield Number(f"{name}, its frequency [kHz]", frequency, first.imag / 2 / np.pi / 1000)


@entry("well_posedness", "What damping does to the growth rates of a ring")
def damping(runs):
    for name, (settings, *quoted) in DAMPING.items():
        for layers, number in zip((5, 8), quoted):
            results = ring(runs, 1.5, layers, *settings, suffix=f"_{name.replace('/', '_per_')}" if settings else "")
            yield Number(f"{name}, {layers} layers [1/s]", number, leading(results)["growth rate [1/s]"])
