# SPDX-License-Identifier: GPL-3.0-or-later

"""The cases of doc/extremes.md as data: settings and expected outcomes."""

import dataclasses

# One pin on each side of a disc with one layer of elements: 780 dofs and 32 modes, one of them unstable
BASE = """
subsection Geometry
  set Disc inner radius = 0.2
  set Top pin radii = 0.257
  set Top pin angles = 0
  set Bottom pin radii = 0.257
  set Bottom pin angles = 0
  set Nodes per pin face = 7
  set Pin layers = 2
  set Disc layers = 1
  set Element size = 0.0577
end
subsection Output
  set Mode shapes = none
end
"""

DISC_MODULUS, DISC_DENSITY = 2.1e11, 7850.0
OUTER_RADIUS, PIN_DIAMETER = 0.3155, 0.052
RIGHT = "right"
LENGTHS = {"Disc inner radius": 0.2, "Disc outer radius": 0.3155, "Disc thickness": 0.0463, "Pin diameter": 0.052, "Pin height": 0.0318,
           "Element size": 0.0577, "Top pin radii": 0.257, "Bottom pin radii": 0.257, "Pairing tolerance": 1e-6}
MOUNT = (0, 7.8e10, 1.88e10)


@dataclasses.dataclass(frozen=True)
class Case:
    """One model. If `expected` is RIGHT, the results must be correct; otherwise the run must stop with a message that
    contains `expected`."""

    group: str
    value: str
    settings: tuple
    expected: str = RIGHT
    argument_count: bool = True  # True if the complex modes are also counted by the argument principle
    quick: bool = False  # True if ctest runs this case
    scale: float = 1.0  # ratio of the lengths to the lengths of `unit`
    unit: tuple = ()  # settings of the same model in metres; dimensionless results must be the same

    @property
    def name(self):
        return f"{self.group}, {self.value}"


def scaled(s, *, held=True, damped=False):
    """Settings of the small model with lengths scaled by s, for the same dimensionless results.

    At constant Young's moduli, densities and pressures, frequencies, rates and rotation speeds scale with 1 / s, forces with s^2, mount stiffnesses
    per area with 1 / s, and damping coefficients of contact nodes with s^2.
    """
    settings = [f"Geometry/{name}={value * s!r}" for name, value in LENGTHS.items()]
    settings += [f"Band/Maximum frequency={5000 / s!r}", f"Operation/Load per side={1000 * s**2!r}", f"Operation/Rotation speed={4 / s!r}"]
    stiffnesses = ", ".join(repr(stiffness / s) for stiffness in MOUNT)
    settings.append(f"Mounts/Elastic mounts={f'disc_bore: {stiffnesses}' if held else ''}")
    if damped:
        settings += ["Operation/Radial dissipation=consistent", f"Disc material/Rayleigh beta={1e-7 * s!r}", f"Pin material/Rayleigh alpha={20 / s!r}"]
    return tuple(settings)


CASES = []


def add(group, value, *settings, **options):
    CASES.append(Case(group, value, settings, **options))


def band(frequency):
    return f"Band/Maximum frequency={frequency!r}"


def mount(radial, tangential, axial):
    return f"Mounts/Elastic mounts=disc_bore: {radial!r}, {tangential!r}, {axial!r}"


def pins(radii, angles, sides=("Top", "Bottom")):
    """Settings for pins on the given sides; other sides have no pins."""
    return tuple(f"Geometry/{side} pin {what}={', '.join(map(str, values)) if side in sides else ''}"
                 for side in ("Top", "Bottom") for what, values in (("radii", radii), ("angles", angles)))


NO_MOUNT = "Mounts/Elastic mounts="
CONSISTENT = "Operation/Radial dissipation=consistent"
UNRESOLVED = "the mesh does not resolve"

for mu in (0, 1e-6, 0.1, 0.4, 1, 2, 3, 5, 10):
    add("friction coefficient", f"{mu:g}", f"Operation/Friction coefficient={mu}", quick=mu == 10)
add("friction coefficient", "10.1", "Operation/Friction coefficient=10.1", expected="Friction coefficient", quick=True)

for element, setting in (("trilinear", ()), ("incompatible modes", ("Discretization/Element=incompatible modes",)), ("quadratic", ("Discretization/Element=quadratic",))):
    for ratio in (-0.9, 0, 0.45, 0.49, 0.499, 0.4999):
        add(f"Poisson's ratio of the pins, {element}", f"{ratio:g}", f"Pin material/Poisson ratio={ratio}", *setting,
            argument_count=ratio == 0.4999 and element == "trilinear",
            quick=ratio == 0.4999 and element == "trilinear")
    add(f"Poisson's ratio of disc and pins, {element}", "0.4999", "Pin material/Poisson ratio=0.4999", "Disc material/Poisson ratio=0.4999",
        *setting, argument_count=False)
add("Poisson's ratio of the pins, trilinear", "0.5", "Pin material/Poisson ratio=0.5", expected="Poisson ratio")

for exponent in range(-6, 7):
    ratio = 10.0**exponent
    # Lower the end of the band for soft pins, because the mesh does not resolve their short waves at higher frequencies
    end = 5000 * min(1, (ratio / 1e-2) ** 0.5)
    add("ratio of Young's moduli, pin to disc", f"1e{exponent}", f"Pin material/Young modulus={ratio * DISC_MODULUS!r}", band(end),
        quick=exponent == -6, argument_count=exponent in (-6, 6))
add("ratio of Young's moduli, pin to disc", "1e-6, 5 kHz", f"Pin material/Young modulus={1e-6 * DISC_MODULUS!r}", expected=UNRESOLVED)
for exponent in range(-6, 7):
    ratio = 10.0**exponent
    end = 5000 * min(1, (1 / ratio) ** 0.5)
    add("ratio of densities, pin to disc", f"1e{exponent}", f"Pin material/Density={ratio * DISC_DENSITY!r}", band(end), quick=exponent == 6,
        argument_count=exponent in (-6, 6))
add("ratio of densities, pin to disc", "1e6, 5 kHz", f"Pin material/Density={1e6 * DISC_DENSITY!r}", expected=UNRESOLVED)

for ratio in (1e-3, 3e-3, 1e-2, 0.03, 0.1, 0.3, 1):
    end = 5000 if ratio > 0.01 else 2000
    add("thickness / radius of the disc", f"{ratio:g}", f"Geometry/Disc thickness={ratio * OUTER_RADIUS!r}", band(end), quick=ratio == 1e-3)
for ratio in (0.02, 0.05, 0.1, 0.5, 1, 2, 5, 10, 20):
    end = 5000 * min(1, 1 / ratio)
    add("height / diameter of the pins", f"{ratio:g}", f"Geometry/Pin height={ratio * PIN_DIAMETER!r}",
        f"Geometry/Pin layers={max(2, round(2 * ratio))}", band(end), quick=ratio == 20)

for what, options in (("", {}), (", damped", {"damped": True}), (", free disc", {"held": False})):
    for unit, scale in (("micrometres", 1e-6), ("millimetres", 1e-3), ("kilometres", 1e3)):
        add(f"length unit{what}", unit, *scaled(scale, **options), scale=scale, unit=scaled(1.0, **options),
            argument_count=False,
            quick=unit != "millimetres" and what == ", damped")

add("mounts", "none", NO_MOUNT)
for exponent in (0, 3, 6, 8, 9, 10, 12, 15, 18, 20):
    add("mounts in all directions [N/m^3]", f"1e{exponent}", mount(*3 * (10.0**exponent,)), quick=exponent == 20)
add("mounts in all directions [N/m^3]", "0", mount(0, 0, 0))
add("mounts: radial, tangential, axial [N/m^3]", "0, 0, 1e20", mount(0, 0, 1e20))
add("mounts: radial, tangential, axial [N/m^3]", "1e20, 1, 0", mount(1e20, 1, 0))
for speed in (0, 1e-9, 1e-6, 1e-3, 1, 1e3, 1e6, 1e9):
    add("rotation speed, dissipation [rad/s]", f"{speed:g}", CONSISTENT, f"Operation/Rotation speed={speed!r}", quick=speed in (0, 1e-6),
        expected="Rotation speed" if speed == 0 else RIGHT)
add("rotation speed, published dissipation [rad/s]", "1e-3", "Operation/Radial dissipation=published", "Operation/Rotation speed=1e-3")
for speed in (1e2, 1e4, 1e9):
    add("rotation speed, gyroscopic forces [rad/s]", f"{speed:g}", "Operation/Gyroscopic forces=true", f"Operation/Rotation speed={speed!r}",
        expected=RIGHT if speed < 1e3 else "critical speed")
for load in (0, 1e-6, 1, 1e3, 1e6, 1e9):
    add("load, dissipation [N]", f"{load:g}", CONSISTENT, f"Operation/Load per side={load!r}", quick=load == 1e9,
        expected="the load is zero" if load == 0 else RIGHT)
for load in (0, 1e-6, 1e9):
    add("load, steady sliding [N]", f"{load:g}", CONSISTENT, "Steady sliding/Contact state=steady sliding", f"Operation/Load per side={load!r}",
        expected="the load is zero" if load == 0 else RIGHT)

add("end of the band [Hz]", "1", band(1.0), expected="no mode of the coupled system lies in the band", quick=True)
add("end of the band [Hz]", "400: no mode", band(400.0), expected="no mode of the coupled system lies in the band")
add("end of the band [Hz]", "440: one mode", band(440.0))
# Frequencies of real and complex modes of the model, with the digits printed in the tables
for which, frequency in (("a real mode", 468.738364319), ("a complex mode", 563.560037244), ("a complex mode of a doublet", 901.629050712)):
    add("end of the band on a mode [Hz]", f"{frequency!r}: {which}", band(frequency), quick=which == "a real mode")
add("end of the band [Hz]", "12000", band(12000.0))
add("end of the band [Hz]", "100000", band(1e5), expected=UNRESOLVED)
add("end of the band [Hz]", "0", band(0.0), expected="Maximum frequency")
add("end of the band [Hz]", "100000, mesh 20 times smaller",
    *(f"Geometry/{name}={value / 20!r}" for name, value in LENGTHS.items() if name != "Pairing tolerance"), band(1e5))

add("layout", "one pin", *pins([0.257], [0], sides=("Top",)))
add("layout", "three pins, one side only", *pins([0.257] * 3, [-20, 0, 20], sides=("Top",)))
add("layout", "60 pins", *pins([0.257] * 30, [12 * k for k in range(30)]), "Geometry/Pin diameter=0.03", "Geometry/Pin layers=1",
    band(2000.0))
add("layout", "no pin", *pins([], [], sides=()), expected="pin")
add("mesh", "one layer everywhere", "Geometry/Pin layers=1")
add("mesh", "coarsest: 0.05774 m", "Geometry/Pin layers=1", "Geometry/Element size=0.05774")
add("mesh", "too coarse: 0.058 m", "Geometry/Element size=0.058", expected="Element size")
add("mesh", "fine: 61 nodes per pin face, element size 0.02 m", "Geometry/Nodes per pin face=61", "Geometry/Element size=0.02",
    "Geometry/Disc layers=2", "Geometry/Pin layers=6")

for beta in (1e-9, 1e-6, 2.6e-5):
    add("Rayleigh beta [s]", f"{beta:g}", f"Disc material/Rayleigh beta={beta!r}", f"Pin material/Rayleigh beta={beta!r}", quick=beta == 2.6e-5)
for beta in (1e-4, 1e9):
    add("Rayleigh beta [s]", f"{beta:g}", f"Disc material/Rayleigh beta={beta!r}", expected="Rayleigh beta")
for alpha in (1, 1e3, 1e4, 3e4, 1e5, 1e9):
    add("Rayleigh alpha [1/s]", f"{alpha:g}", f"Disc material/Rayleigh alpha={alpha!r}", f"Pin material/Rayleigh alpha={alpha!r}",
        quick=alpha == 1e4, expected=RIGHT if alpha < 1e6 else "Rayleigh alpha")
for slope in (-10, 10):
    add("friction slope [s/m]", f"{slope:g}", f"Operation/Friction slope={slope}")

for diameter in (1e-3, 1e-4, 1e-5, 1e-6, 1e-8):
    add("diameter of the pins [m]", f"{diameter:g}", f"Geometry/Pin diameter={diameter!r}", f"Geometry/Pin height={diameter!r}")
for tolerance in (0.1, 0.0):
    add("pairing tolerance [m]", f"{tolerance:g}", f"Geometry/Pairing tolerance={tolerance!r}", expected="Pairing tolerance")
# At 11.6128 degrees, the chord 2 r sin(angle / 2) equals the pin diameter of 0.052 m
for angle, gap in ((11.7, "4e-4"), (11.615, "1e-5")):
    add("gap between two pins [m]", gap, *pins([0.257] * 2, [0, angle]))
add("gap between two pins [m]", "overlap", *pins([0.257] * 2, [0, 11.5]), expected="pins")

add("free disc", "friction", NO_MOUNT)
add("free disc", "soft pins", NO_MOUNT, "Pin material/Young modulus=1.9e7", band(500.0))
add("free disc", "dissipation", NO_MOUNT, CONSISTENT)
add("free disc", "Rayleigh damping", NO_MOUNT, "Disc material/Rayleigh beta=1e-6", "Pin material/Rayleigh alpha=10")
add("free disc", "one pin", NO_MOUNT, *pins([0.257], [0], sides=("Top",)))
add("free disc", "friction coefficient 10", NO_MOUNT, "Operation/Friction coefficient=10")
add("free disc", "gyroscopic forces", NO_MOUNT, "Operation/Gyroscopic forces=true", expected="Gyroscopic forces")
