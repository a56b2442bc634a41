# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/well_posedness.md"""

import numpy as np
import scipy.linalg

from squeal import exported_matrices
from reproduction.numbers import Number, entry, numbers_in, of_mode, several, table
from reproduction.sliding_layer import Layer

# Meshes of the ring: pin layers -> element size [m], end of the band [Hz]
MESHES = {5: (0.0024, 46e3), 8: (0.0016, 70e3), 10: (0.0012, 94e3), 12: (0.00095, 118e3)}
HALF_SPACE = {0.999: "0", 1.2: "4.3", 1.5: "9.1", 2.0: "14.5"}
PAD = Layer(0.012, 1.9e9, 0.25, 3070)
PAD_RADIUS = 0.00625
LARGEST_FREQUENCY = 500e3
NUMBERS_OF_WAVES = range(1, 25)
LARGEST = ("growing modes", "largest growth rate [1/s]", "its frequency [kHz]")

DAMPING = {"none": (),
           "radial dissipation": ("Operation/Radial dissipation=consistent",),
           "friction slope 0.1 s/m": ("Operation/Friction slope=0.1",),
           "Rayleigh alpha 1000 1/s": ("Disc material/Rayleigh alpha=1000", "Pin material/Rayleigh alpha=1000"),
           "modal damping ratio 5 %": ("Damping/Modal damping ratio=0: 0.05",),
           "Rayleigh beta 2e-7 s": ("Disc material/Rayleigh beta=2e-7", "Pin material/Rayleigh beta=2e-7"),
           "Rayleigh beta 1e-6 s": ("Disc material/Rayleigh beta=1e-6", "Pin material/Rayleigh beta=1e-6")}


def leading(results):
    return max(results.complex_modes(), key=lambda mode: mode["growth rate [1/s]"])


def ring(runs, friction_coefficient, layers, *settings, suffix=""):
    element_size, band = MESHES[layers]
    return runs(f"sliding_ring_{friction_coefficient}_{layers}{suffix}".replace(" ", "_"), "studies/sliding_ring.prm",
                f"Operation/Friction coefficient={friction_coefficient}", f"Geometry/Element size={element_size}",
                f"Geometry/Pin layers={layers}", f"Band/Maximum frequency={band:g}", *settings)


def n_face_nodes(factor):
    return 3 * factor * (factor + 1) + 1


def one_pin(runs, friction_coefficient, factor, band):
    return runs(f"one_pin_{friction_coefficient}_{factor}_{band:g}", "studies/accuracy_one_pin.prm", "Study=stability",
                f"Geometry/Nodes per pin face={n_face_nodes(factor)}", f"Geometry/Pin layers={2 * factor}",
                f"Geometry/Disc layers={factor}", f"Geometry/Element size={0.048 / factor!r}", "Discretization/Element=incompatible modes",
                f"Operation/Friction coefficient={friction_coefficient}", f"Band/Maximum frequency={band:g}", "Output/Mode shapes=none")


@entry("well_posedness", "Growth rates of waves in a layer, by friction coefficient and thickness over wavelength")
def layer(_):
    for friction_coefficient, *quoted in table("well_posedness", "H/ℓ ≤ 0.5"):
        for turns, number in zip((0.5, 1, 2, 4), quoted):
            wave_numbers = 2 * np.pi / PAD.thickness * turns * np.arange(1, 21) / 20
            growth = PAD.largest_growth(wave_numbers, float(friction_coefficient), LARGEST_FREQUENCY)
            yield Number(f"mu = {friction_coefficient}, up to H / l = {turns} [1000/s]", number, growth / 1e3)


@entry("well_posedness", "Divergence rate of the growing wave of a half-space")
def half_space(_):
    for friction_coefficient, quoted in HALF_SPACE.items():
        yield Number(f"mu = {friction_coefficient} [%]", quoted, 100 * PAD.half_space(friction_coefficient))


@entry("well_posedness", "Largest growth rates of a ring, up to the frequency that its mesh resolves, and of the layer")
def rings(runs):
    for layers, _, *cells in table("well_posedness", "up to [kHz]"):
        for friction_coefficient, quoted in ((0.4, cells[:3]), (1.5, cells[3:])):
            results = ring(runs, friction_coefficient, int(layers))
            exact = PAD.largest_growth(np.array(NUMBERS_OF_WAVES) / PAD_RADIUS, friction_coefficient, MESHES[int(layers)][1])
            yield from several(f"mu = {friction_coefficient}, {layers} layers, ", ("growing modes", "ring [1/s]", "layer [1/s]"), quoted,
                               (results.n_unstable(), leading(results)["growth rate [1/s]"], exact))


@entry("well_posedness", "One pin on each side: modes up to 5 kHz")
def in_band(runs):
    for factor, *cells in table("well_posedness", "mesh | μ = 0.4: modes"):
        for friction_coefficient, (n_modes, axial, *quoted) in ((0.4, cells[:4]), (1, cells[4:])):
            results = one_pin(runs, friction_coefficient, int(factor), 5000)
            name = f"mu = {friction_coefficient}, mesh {factor}"
            yield Number(f"{name}, modes", n_modes, len(results.complex_modes()))
            yield Number(f"{name}, A0-4 [Hz]", axial, max(mode["frequency [Hz]"] for mode in results.complex_modes("A0-4")))
            yield from of_mode(f"{name}, leading mode", leading(results), *numbers_in(*quoted))


@entry("well_posedness", "One pin on each side: modes beyond 5 kHz")
def beyond_band(runs):
    for name, *quoted in table("well_posedness", "largest growth rate [1/s]"):
        friction_coefficient, factor, band = numbers_in(name)
        results = one_pin(runs, friction_coefficient, int(factor), 1e3 * float(band))
        beyond = [mode for mode in results.complex_modes() if mode["frequency [Hz]"] > 5000 and mode["divergence rate [%]"] > 0.01]
        first = leading(results)
        yield from several(f"{name}, ", LARGEST, quoted, (len(beyond), first["growth rate [1/s]"], first["frequency [Hz]"] / 1000))


def all_eigenvalues(results, friction_coefficient):
    """lambda with Re >= 0 and Im >= 0 of the undamped problem from exported matrices; every growing mode occurs once."""
    problem = exported_matrices.couple(exported_matrices.read_matrices(results.folder), friction_coefficient)
    squares = scipy.linalg.eigvals(scipy.linalg.solve(problem.mass.toarray(), problem.stiffness.toarray()))
    roots = np.sqrt(-squares[squares.imag >= 0])
    return abs(roots.real) + 1j * abs(roots.imag)


@entry("well_posedness", "One pin on a coarse disc: all eigenvalues")
def whole_spectrum(runs):
    for factor, *cells in table("well_posedness", "mesh of the pin"):
        results = runs(f"whole_{factor}", "disc_pins.prm", "Geometry/Top pin radii=0.2275", "Geometry/Top pin angles=0",
                       "Geometry/Bottom pin radii=", "Geometry/Bottom pin angles=", f"Geometry/Nodes per pin face={n_face_nodes(int(factor))}",
                       f"Geometry/Pin layers={2 * int(factor)}", "Geometry/Disc layers=1", "Geometry/Element size=0.06",
                       "Discretization/Element=incompatible modes", "Output/Write matrices=true", "Output/Mode shapes=none")
        for friction_coefficient, cell in zip((0.4, 1, 1.5), cells):
            if cell:
                values = all_eigenvalues(results, friction_coefficient)
                first, n_growing = values[np.argmax(values.real)], np.sum((values.real > 1e-3 * values.imag) & (values.imag > 0))
                yield from several(f"mu = {friction_coefficient}, mesh {factor}, ", LARGEST, numbers_in(cell),
                                   (n_growing, first.real, first.imag / 2 / np.pi / 1000))


@entry("well_posedness", "Effect of damping on the growth rates of a ring")
def damping(runs):
    for name, *quoted in table("well_posedness", "damping | 5 layers"):
        for layers, number in zip((5, 8), quoted):
            settings = DAMPING[name]
            results = ring(runs, 1.5, layers, *settings, suffix=f"_{name.replace('/', '_per_')}" if settings else "")
            yield Number(f"{name}, {layers} layers [1/s]", number, leading(results)["growth rate [1/s]"])
