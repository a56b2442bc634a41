# SPDX-License-Identifier: GPL-3.0-or-later

"""`Study = sensitivity`: tables, and derivatives compared with finite differences between runs."""

import functools
import math

from mesh_file import MeshFile
from program import COARSE, ProgramTest, read_table

STUDY = "Study=sensitivity"
NO_THRESHOLDS, NO_GEOMETRY = "Sensitivity/Thresholds=false", "Sensitivity/Geometry=none"
ITERATED = ["Complex modes/Solver=residual iteration", "Complex modes/Iteration tolerance=1e-12"]
# Model with contact damping, material damping and rotation
RICH = ["Operation/Radial dissipation=consistent", "Operation/Friction slope=-0.002", "Operation/Gyroscopic forces=true",
        "Operation/Rotation speed=20", "Operation/Load per side=2000", "Disc material/Rayleigh alpha=2", "Disc material/Rayleigh beta=1e-8",
        "Pin material/Rayleigh alpha=3", "Pin material/Rayleigh beta=2e-8", "Mounts/Elastic mounts=disc_bore: 3e10, 7.8e10, 1.88e10"]
RATIOS = {"500": 0.01, "2000": 0.02, "3500": 0.015}
MOUNTS = {"radial": 3e10, "tangential": 7.8e10, "axial": 1.88e10}
THRESHOLDS = ["Sweep/First friction coefficient=0.05", "Sweep/Last friction coefficient=0.6", "Sweep/Number of friction coefficients=16",
              "Sweep/Tolerance=1e-8", "Sweep/Threshold tolerance=1e-10"]

STEADY = "Steady sliding/Contact state=steady sliding"
# Gaps that leave two of 28 contact nodes open at a backplate travel of about 1e-5 m
GAPS = "Steady sliding/Gaps=pin_top_2: 1e-6, 5e-4, -3e-4; pin_bottom_1: 0, -2e-4, 4e-4"

# Relative rounding error of the difference of two frequencies printed with twelve digits [-]
PRINTED = 5e-12

# Relative step of a parameter [-]
STEP = 3e-5

# Relative step of a parameter for thresholds [-]
THRESHOLD_STEP = 2e-5

# Error of difference quotients of thresholds with respect to ln p [-]
RESOLUTION = 2e-6


def eigenvalue(row):
    return complex(float(row["growth rate [1/s]"]), 2 * math.pi * float(row["frequency [Hz]"]))


def derivative(row):
    """Derivative of lambda with respect to the parameter, from a row of a table."""
    return complex(float(row["growth rate per unit [1/s]"]), 2 * math.pi * float(row["frequency per unit [Hz]"]))


def modal(ratios):
    return "Damping/Modal damping ratio=" + ", ".join(f"{frequency}: {ratio!r}" for frequency, ratio in ratios.items())


def override(path, value):
    """Override that sets the parameter `path` to `value`."""
    if path.startswith("Mounts/"):
        direction = path.rsplit(" ", 1)[1]
        return "Mounts/Elastic mounts=disc_bore: " + ", ".join(repr(value if name == direction else stiffness)
                                                               for name, stiffness in MOUNTS.items())
    if path.startswith("Damping/"):
        entry = path.split(": ")[1].split()[0]
        return modal({**RATIOS, entry: value})
    return f"{path}={value!r}"


# ---------------------------------------------------------------- moving nodes

THICKNESS, HEIGHT, INNER, OUTER, DIAMETER = 0.0463, 0.0318, 0.1505, 0.3155, 0.052
# Side and angle [degree] of each pin; all pins have the same distance from the axis
PINS = {"pin_top_1": (1, -10), "pin_top_2": (1, 10), "pin_bottom_1": (-1, -10), "pin_bottom_2": (-1, 10)}
PIN_RADIUS = 0.2275


def centre(pin):
    angle = math.radians(PINS[pin][1])
    return PIN_RADIUS * math.cos(angle), PIN_RADIUS * math.sin(angle)


GAP = min(2 * PIN_RADIUS * math.sin(math.radians(10)) - DIAMETER, PIN_RADIUS - DIAMETER / 2 - INNER, OUTER - PIN_RADIUS - DIAMETER / 2)


def share(pin, x, y, z, component):
    """Fraction of the motion of a pin that a node follows: 1 on the pin, falling to 0 at other pins, rims and the other
    face of the disc."""
    if component not in ("disc", pin):
        return 0.0
    if component == pin:
        return 1.0
    outside = math.dist((x, y), centre(pin)) - DIAMETER / 2
    return min(1.0, max(0.0, 1 - outside / GAP)) * min(1.0, max(0.0, 0.5 + PINS[pin][0] * z / THICKNESS))


def motion(path, pin):
    """Derivative of the position of a node with respect to a parameter, as a function of position and component: see
    include/squeal/sensitivity/mesh_motions.h."""
    def radial(x, y, component, rim, nearest):
        r = math.hypot(x, y)
        s = max(0.0, (r - nearest) / (rim - nearest)) if component == "disc" else 0.0
        return s * x / r, s * y / r, 0.0

    def widened(x, y, z, component):
        v = [0.0, 0.0]
        for name in PINS:
            c = centre(name)
            distance = math.dist((x, y), c)
            factor = share(name, x, y, z, component) * min(1.0, DIAMETER / 2 / distance if distance > 0 else 1.0) / DIAMETER
            v[0] += factor * (x - c[0])
            v[1] += factor * (y - c[1])
        return *v, 0.0

    def outwards(x, y, z, component):
        factor = share(pin, x, y, z, component)
        return factor * centre(pin)[0] / PIN_RADIUS, factor * centre(pin)[1] / PIN_RADIUS, 0.0

    def turned(x, y, z, component):
        factor = share(pin, x, y, z, component) * math.pi / 180
        return -factor * y, factor * x, 0.0

    return {"Disc thickness": lambda _, __, z, component: (0.0, 0.0, z / THICKNESS if component == "disc" else math.copysign(0.5, z)),
            "Pin height": lambda _, __, z, component: (0.0, 0.0, 0.0 if component == "disc" else
                                                      math.copysign((abs(z) - THICKNESS / 2) / HEIGHT, z)),
            "Disc inner radius": lambda x, y, _, component: radial(x, y, component, INNER, PIN_RADIUS - DIAMETER / 2),
            "Disc outer radius": lambda x, y, _, component: radial(x, y, component, OUTER, PIN_RADIUS + DIAMETER / 2),
            "Pin diameter": widened, "Top pin radii": outwards, "Bottom pin angles": turned}[path]


def move_nodes(still, path, motions):
    """Writes the mesh of a run with displaced nodes; `motions`: (motion, change of the parameter) for each parameter."""
    mesh = MeshFile(still / "mesh.msh")
    for component in ("disc", *PINS):
        for node in mesh.nodes_of(component):
            place = mesh.nodes[node][1]
            moves = [[change * x for x in velocity(*place, component)] for velocity, change in motions]
            mesh.move(node, [sum(parts) for parts in zip(place, *moves)])
    mesh.write(path)


def steps_of(slopes, step, most):
    """Relative changes of parameters with similar effects: at most step * most, and `step` for a single parameter."""
    largest = {key: max(map(abs, of_key.values())) for key, of_key in slopes.items()}
    share = max(largest.values()) / len(largest)
    return {key: step * min(most, share / size) for key, size in largest.items()}


class Sensitivity(ProgramTest):
    # The band ends above the first bending modes of the pins
    scene = COARSE + "subsection Band\n  set Maximum frequency = 4200\nend\n"

    @classmethod
    def mesh_of_scene(cls, *overrides):
        """Result folder of a minimal run that writes the mesh."""
        return cls.shared("Band/Maximum frequency=1000", "Operation/Friction coefficient=0", *overrides)

    def eigenvalues_at(self, *overrides):
        return [eigenvalue(row) for row in read_table(self.run_scene("single", *ITERATED, *overrides) / "complex_modes.csv")]

    def check_modes(self, rows, keys, eigenvalues_at, most=100, least=2):
        """Compares derivatives of lambda and of its real part with central differences along one direction that changes
        all parameters in `keys`, (path, pin). `eigenvalues_at` maps these changes to eigenvalues."""
        slopes, here, values = {}, {}, {}
        for key in keys:
            of_key = [row for row in rows if (row["parameter"], row["body"]) == key]
            self.assertGreaterEqual(len(of_key), least, key)
            slopes[key] = {row["mode [-]"]: float(row["value"]) * derivative(row) for row in of_key}
            values[key] = float(of_key[0]["value"])
            here.update({row["mode [-]"]: eigenvalue(row) for row in of_key})
        self.assertNotIn(0, values.values())
        steps = steps_of(slopes, STEP, most)

        @functools.cache
        def at(size):
            return eigenvalues_at({key: size * step * values[key] for key, step in steps.items()})

        for mode, value in here.items():
            parts = [step * slopes[key][mode] for key, step in steps.items()]
            resolution = PRINTED * abs(value)

            def agrees(difference, parts=parts, resolution=resolution):
                error = sum(parts) - difference
                return (abs(error) <= 1e-5 * sum(map(abs, parts)) + resolution and
                        abs(error.real) <= 1e-5 * sum(abs(part.real) for part in parts) + resolution)

            def difference(size, value=value):
                before, after = (min(at(side * size), key=lambda other: abs(other - value)) for side in (-1, 1))
                return (after - before) / (2 * size)

            with self.subTest(mode=mode):
                plain = difference(1)
                # Near a coalescence, the error O(h^2) of the central difference is large: extrapolate
                self.assertTrue(agrees(plain) or agrees((4 * plain - difference(2)) / 3), (plain, parts))

    def check_parameters(self, scene, paths):
        """Compares derivatives with differences of complete runs; returns the names of all parameters."""
        folder = self.run_scene("rich", STUDY, NO_THRESHOLDS, NO_GEOMETRY, "Sensitivity/Tolerance=1e-7",
                                "Sensitivity/Largest number of modes=4", *scene)
        rows = read_table(folder / "sensitivities.csv")
        self.assertEqual({row["derivative of"] for row in rows}, {"lambda"})
        values = {row["parameter"]: float(row["value"]) for row in rows if not row["body"]}
        self.check_modes(rows, [(path, "") for path in paths], lambda changes: self.eigenvalues_at(
            *scene, *(override(path, values[path] + change) for (path, _), change in changes.items())))
        return set(values)

    def test_differences(self):
        """Model with contact and material damping, a rotating disc and steady sliding; tests/sensitivity covers all material
        constants."""
        paths = [*(f"Operation/{name}" for name in ("Friction coefficient", "Friction slope", "Load per side", "Rotation speed")),
                 "Disc material/Young modulus", "Disc material/Rayleigh beta", "Pin material/Poisson ratio", "Pin material/Rayleigh alpha",
                 "Mounts/Elastic mounts: disc_bore axial"]
        self.assertEqual(len(self.check_parameters([*RICH, STEADY, GAPS], paths)), 17)

    def test_modal_damping(self):
        """Derivatives include the changes of the damped modes and of their damping ratios, which depend on frequency."""
        ratios = [f"Damping/Modal damping ratio: {frequency} Hz" for frequency in RATIOS]
        paths = ["Disc material/Density", "Operation/Friction coefficient", "Operation/Load per side",
                 "Mounts/Elastic mounts: disc_bore tangential", ratios[1]]
        names = self.check_parameters([*RICH, modal(RATIOS)], paths)
        self.assertEqual({name for name in names if "ratio: " in name}, set(ratios))

    def test_orthotropic_pin(self):
        """All constants of an orthotropic pin with fixed axes."""
        self.check_orthotropic("pin_top_1", (2e9, 1.5e9, 1e9, 0.25, 0.4, 0.3, 0.8e9, 0.4e9, 0.3e9), 3070, "1, 0.2, 0, 0, 1, 0.3")

    def test_orthotropic_disc(self):
        """Constants of an orthotropic disc with cylindrical axes."""
        self.check_orthotropic("disc", (210e9, 180e9, 150e9, 0.3, 0.25, 0.2, 80e9, 70e9, 60e9), 7850, "", ("E2", "nu12", "G23"))

    def check_orthotropic(self, volume, values, density, axes, checked=()):
        """Compares derivatives for elastic constants with differences of complete runs; `E1` scales all moduli."""
        numbers = dict(zip(("E1", "E2", "E3", "nu12", "nu13", "nu23", "G12", "G13", "G23"), values))

        def scene(**changed):
            return [f"Materials/Orthotropic={volume}: " + ", ".join(map(repr, ({**numbers, **changed}).values())) + f", {density}, 10, 1e-7",
                    "Materials/Axes=" + (f"{volume}: {axes}" if axes else ""), "Pin material/Rayleigh beta=2e-8"]

        folder = self.run_scene("orthotropic", STUDY, NO_THRESHOLDS, NO_GEOMETRY, "Sensitivity/Tolerance=1e-7",
                                "Sensitivity/Largest number of modes=3", *scene())
        rows = [row for row in read_table(folder / "sensitivities.csv") if row["parameter"].startswith("Materials/Orthotropic:/")]
        self.assertEqual({row["body"] for row in rows}, {volume})
        names = {key: key[0].rsplit("/", 1)[1].split()[0] for key in ((row["parameter"], volume) for row in rows)}
        names = {key: name for key, name in names.items() if name in (checked or numbers)}
        self.assertEqual(set(names.values()), set(checked or numbers))

        def eigenvalues_at(changes):
            changed = dict(numbers)
            for key, change in changes.items():
                name = names[key]
                for scaled in [each for each in numbers if name == "E1" and not each.startswith("nu")] or [name]:
                    changed[scaled] *= 1 + change / numbers[name]
            return self.eigenvalues_at(*scene(**changed))

        self.check_modes(rows, names, eigenvalues_at)

    def test_identities(self):
        """Because lambda ~ sqrt(stiffness / density), p dlambda/dp sums to lambda / 2 for stiffnesses and to -lambda / 2
        for densities. Derivatives for all pins are sums over the pins."""
        folder = self.run_scene("plain", STUDY, NO_THRESHOLDS, "Sensitivity/Tolerance=1e-8")
        rows = read_table(folder / "sensitivities.csv")
        for mode in {row["mode [-]"] for row in rows}:
            of_mode = [row for row in rows if row["mode [-]"] == mode]
            own = {row["parameter"]: float(row["value"]) * derivative(row) for row in of_mode if not row["body"]}
            here = eigenvalue(of_mode[0])
            stiffness = sum(value for path, value in own.items() if "Young" in path or "Mounts" in path)
            density = sum(value for path, value in own.items() if "Density" in path)
            self.assertLessEqual(abs(stiffness - here / 2), 1e-8 * abs(here))
            self.assertLessEqual(abs(density + here / 2), 1e-8 * abs(here))
            for path in ("Pin material/Young modulus", "Pin material/Density"):
                single = [float(row["value"]) * derivative(row) for row in of_mode if row["parameter"] == path and row["body"]]
                self.assertEqual(len(single), 4)
                self.assertLessEqual(abs(sum(single) - own[path]), 1e-10 * abs(here))
            for row in of_mode:
                if float(row["value"]) != 0:
                    slope = float(row["value"]) * derivative(row)
                    xi = (slope.real - here.real / here.imag * slope.imag) / here.imag
                    self.assertAlmostEqual(float(row["divergence rate per 1 % [percentage points]"]), xi, delta=1e-9)
                    self.assertAlmostEqual(float(row["growth rate per 1 % [1/s]"]), slope.real / 100, delta=1e-8)
                else:
                    self.assertEqual(row["growth rate per 1 % [1/s]"], "")
        ranking = [float(row["divergence rate per 1 % [percentage points]"]) for row in read_table(folder / "sensitivity_ranking.csv")]
        self.assertEqual(ranking, sorted(ranking, key=abs, reverse=True))

    def test_thresholds(self):
        """Compares dmu_c/dp with differences of thresholds; lengths and positions are changed by moving nodes."""
        folder = self.run_scene("thresholds", STUDY, *THRESHOLDS, "Sensitivity/Geometry=sizes and places")
        rows = [row for row in read_table(folder / "sensitivities_thresholds.csv") if row["derivative of"] != "none"]
        self.assertEqual({row["derivative of"] for row in rows}, {"squared difference of the pair"})
        poisson, places = "Pin material/Poisson ratio", [("Geometry/Disc thickness", ""), ("Geometry/Bottom pin angles", "pin_bottom_1")]
        value = float(next(row["value"] for row in rows if row["parameter"] == poisson))

        def overrides(changes):
            return [*self.moved({place: changes[place] for place in places}), override(poisson, value + changes[poisson, ""])]

        self.check_thresholds(rows, [(poisson, ""), *places], overrides, most=10)

    def test_damped_thresholds(self):
        """Thresholds with damping in steady sliding, where modes lose stability individually."""
        light = {frequency: 0.1 * ratio for frequency, ratio in RATIOS.items()}
        scene = [*RICH, modal(light), STEADY]
        folder = self.run_scene("damped", STUDY, NO_GEOMETRY, *THRESHOLDS, *scene)
        rows = [row for row in read_table(folder / "sensitivities_thresholds.csv") if not row["body"]]
        self.assertEqual({row["derivative of"] for row in rows}, {"growth rate"})
        load, ratio = "Operation/Load per side", "Damping/Modal damping ratio: 2000 Hz"
        values = {row["parameter"]: float(row["value"]) for row in rows}

        def overrides(changes):
            return [*scene, override(load, values[load] + changes[load, ""]), modal({**light, "2000": values[ratio] + changes[ratio, ""]})]

        self.check_thresholds(rows, [(load, ""), (ratio, "")], overrides, most=100)

    def check_thresholds(self, rows, keys, overrides, most):
        """Compares derivatives of thresholds with central differences along one direction, as check_modes() does.
        `overrides` maps changes of the parameters to settings."""
        of_keys = {key: [row for row in rows if (row["parameter"], row["body"]) == key] for key in keys}
        slopes = {key: {float(row["mu [-]"]): float(row["mu per unit [-]"]) * float(row["value"]) for row in of_key} for key, of_key in of_keys.items()}
        steps = steps_of(slopes, THRESHOLD_STEP, most)
        found = []
        for side in (-1, 1):
            folder = self.run_scene("shifted", "Study=sweep", "Sweep/Compare dissipation=false", *THRESHOLDS,
                                    *overrides({key: side * step * float(of_keys[key][0]["value"]) for key, step in steps.items()}))
            found.append([(float(row["mu [-]"]), row["event"], float(row["uncertainty [-]"])) for row in read_table(folder / "thresholds.csv")])
        self.assertGreaterEqual(len(of_keys[keys[0]]), 3)
        detectable = dict.fromkeys(keys, math.inf)
        for row in of_keys[keys[0]]:
            here = float(row["mu [-]"])
            before, after = (min((other for other in others if other[1] == row["event"]), key=lambda other, here=here: abs(other[0] - here))
                             for others in found)
            parts = {key: step * slopes[key][here] for key, step in steps.items()}
            tolerance = 1e-5 * sum(map(abs, parts.values())) + THRESHOLD_STEP * RESOLUTION + (before[2] + after[2]) / 2
            with self.subTest(mu=here, label=row["label"]):
                self.assertLessEqual(abs(sum(parts.values()) - (after[0] - before[0]) / 2), tolerance)
            detectable = {key: min(detectable[key], tolerance / abs(part)) for key, part in parts.items()}
        # At one threshold or more, the tolerance must detect an error of 1 % in the derivative with respect to each parameter
        self.assertLess(max(detectable.values()), 0.01, detectable)

    def test_geometry(self):
        """Lengths and positions: derivatives agree with runs on meshes with moved nodes; gaps move with their pins."""
        of_all = ("Disc thickness", "Pin height", "Disc inner radius", "Disc outer radius", "Pin diameter")
        self.check_geometry([*RICH, STEADY, GAPS], [*((path, "") for path in of_all), ("Top pin radii", "pin_top_2"),
                                                    ("Bottom pin angles", "pin_bottom_1")])

    def test_curved_elements(self):
        """Pin diameter with quadratic elements, whose curved edges grow with the circle."""
        self.check_geometry([*RICH, "Discretization/Element=quadratic"], [("Pin diameter", "")], "sizes")

    def test_geometry_of_orthotropic_volumes(self):
        """Cylindrical axes follow the nodes; fixed axes do not."""
        materials = ("disc: 210e9, 180e9, 150e9, 0.3, 0.25, 0.2, 80e9, 70e9, 60e9, 7850; "
                     "pin_bottom_1: 2e9, 1.5e9, 1e9, 0.25, 0.4, 0.3, 0.8e9, 0.4e9, 0.3e9, 3070; "
                     "pin_top_2: 2e9, 1.5e9, 1e9, 0.25, 0.4, 0.3, 0.8e9, 0.4e9, 0.3e9, 3070")
        axes = "Materials/Axes=pin_top_2: 1, 0.2, 0, 0, 1, 0.3"
        self.check_geometry([f"Materials/Orthotropic={materials}", axes, "Operation/Friction coefficient=0.7"],
                            [("Disc thickness", ""), ("Top pin radii", "pin_top_2"), ("Bottom pin angles", "pin_bottom_1")], least=1)

    def check_geometry(self, scene, places, lengths="sizes and places", least=2):
        folder = self.run_scene("moving", STUDY, NO_THRESHOLDS, f"Sensitivity/Geometry={lengths}", "Sensitivity/Tolerance=1e-8",
                                "Sensitivity/Largest number of modes=3", *scene)
        element = [setting for setting in scene if setting.startswith("Discretization/Element")]
        self.check_modes(read_table(folder / "sensitivities.csv"), [("Geometry/" + path, pin) for path, pin in places],
                         lambda changes: self.eigenvalues_at(*scene, *self.moved(changes, *element)), most=10, least=least)

    def moved(self, changes, *overrides):
        """Override that selects a mesh whose nodes are displaced by `changes`."""
        motions = [(motion(path.removeprefix("Geometry/"), pin), change) for (path, pin), change in changes.items()]
        move_nodes(self.mesh_of_scene(*overrides), self.folder / "moved.msh", motions)
        return ["Geometry/File=moved.msh"]
