# SPDX-License-Identifier: GPL-3.0-or-later

"""`Study = sensitivity`: derivatives held against differences of runs with other parameters, and its tables."""

import math

from mesh_file import MeshFile
from program import ProgramTest, read_table

STUDY = "Study=sensitivity"
NO_THRESHOLDS, NO_GEOMETRY = "Sensitivity/Thresholds=false", "Sensitivity/Geometry=none"
ITERATED = ["Complex modes/Solver=residual iteration", "Complex modes/Iteration tolerance=1e-12"]
# Every parameter has a value other than zero
RICH = ["Operation/Radial dissipation=consistent", "Operation/Friction slope=-0.002", "Operation/Gyroscopic forces=true",
        "Operation/Rotation speed=20", "Operation/Load per side=2000", "Disc material/Rayleigh alpha=2", "Disc material/Rayleigh beta=1e-8",
        "Pin material/Rayleigh alpha=3", "Pin material/Rayleigh beta=2e-8", "Mounts/Elastic mounts=disc_bore: 3e10, 7.8e10, 1.88e10"]
RATIOS = {"500": 0.01, "2000": 0.02, "3500": 0.015}
MOUNTS = {"radial": 3e10, "tangential": 7.8e10, "axial": 1.88e10}
THRESHOLDS = ["Sweep/First friction coefficient=0.05", "Sweep/Last friction coefficient=0.45", "Sweep/Number of friction coefficients=12",
              "Sweep/Tolerance=1e-8", "Sweep/Threshold tolerance=1e-10"]

STEADY = "Steady sliding/Contact state=steady sliding"
# Beside a travel of some 1e-5 m: two of 28 nodes are open
GAPS = "Steady sliding/Gaps=pin_top_2: 1e-6, 5e-4, -3e-4; pin_bottom_1: 0, -2e-4, 4e-4"

# Twelve digits are printed: what two of a frequency may leave of their difference, over twice the step [-]
PRINTED = 5e-12

# Of a parameter, relative [-]
STEP = 3e-5

# What the uncertainty of thresholds leaves open of their differences, with respect to ln p [-]
RESOLUTION = 2e-6


def eigenvalue(row):
    return complex(float(row["growth rate [1/s]"]), 2 * math.pi * float(row["frequency [Hz]"]))


def derivative(row):
    """With respect to the parameter."""
    return complex(float(row["growth rate per unit [1/s]"]), 2 * math.pi * float(row["frequency per unit [Hz]"]))


def modal(ratios):
    return "Damping/Modal damping ratio=" + ", ".join(f"{frequency}: {ratio!r}" for frequency, ratio in ratios.items())


def override(path, value):
    """The parameter `path` with another value."""
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
# Of the scene: component, side, angle [degree]; all pins at one distance from the axis
PINS = {"pin_top_1": (1, -10), "pin_top_2": (1, 10), "pin_bottom_1": (-1, -10), "pin_bottom_2": (-1, 10)}
PIN_RADIUS = 0.2275


def centre(pin):
    angle = math.radians(PINS[pin][1])
    return PIN_RADIUS * math.cos(angle), PIN_RADIUS * math.sin(angle)


GAP = min(2 * PIN_RADIUS * math.sin(math.radians(10)) - DIAMETER, PIN_RADIUS - DIAMETER / 2 - INNER, OUTER - PIN_RADIUS - DIAMETER / 2)


def share(pin, x, y, z, component):
    """How far a node goes along with a pin: all of it, or falling to nothing at other pins, rims and the other face of the disc."""
    if component not in ("disc", pin):
        return 0.0
    if component == pin:
        return 1.0
    outside = math.dist((x, y), centre(pin)) - DIAMETER / 2
    return min(1.0, max(0.0, 1 - outside / GAP)) * min(1.0, max(0.0, 0.5 + PINS[pin][0] * z / THICKNESS))


def motion(path, pin):
    """Velocity of a node by its place and component, as include/squeal/sensitivity/mesh_motions.h has it."""
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


def move_nodes(still, path, velocity, change):
    """Writes the mesh of a run with its nodes moved."""
    mesh = MeshFile(still / "mesh.msh")
    for component in ("disc", *PINS):
        for node in mesh.nodes_of(component):
            place = mesh.nodes[node][1]
            mesh.move(node, [x + change * v for x, v in zip(place, velocity(*place, component))])
    mesh.write(path)


class Sensitivity(ProgramTest):
    def eigenvalues_at(self, *overrides):
        return [eigenvalue(row) for row in read_table(self.run_scene("single", *ITERATED, *overrides) / "complex_modes.csv")]

    def compare(self, row, around, step):
        """A derivative, and that of the growth rate by itself, beside the central difference of the nearest eigenvalues."""
        here = eigenvalue(row)
        at = {side: min(values, key=lambda other: abs(other - here)) for side, values in around.items()}
        difference = (at[1] - at[-1]) / (2 * step)
        with self.subTest(parameter=row["parameter"], pin=row["body"], mode=row["mode [-]"]):
            error, resolution = derivative(row) - difference, PRINTED * abs(here / step)
            self.assertLessEqual(abs(error), 1e-5 * abs(difference) + resolution)
            self.assertLessEqual(abs(error.real), 1e-5 * abs(difference.real) + resolution)

    def check_modes(self, scene, paths):
        """Beside complete runs; returns the names of all parameters."""
        folder = self.run_scene("rich", STUDY, NO_THRESHOLDS, NO_GEOMETRY, "Sensitivity/Tolerance=1e-7",
                                "Sensitivity/Largest number of modes=4", *scene)
        rows = [row for row in read_table(folder / "sensitivities.csv") if not row["body"]]
        self.assertGreaterEqual(len({row["mode [-]"] for row in rows}), 2)
        self.assertEqual({row["derivative of"] for row in rows}, {"lambda"})
        for path in paths:
            of_path = [row for row in rows if row["parameter"] == path]
            value = float(of_path[0]["value"])
            self.assertNotEqual(value, 0, path)
            around = {side: self.eigenvalues_at(*scene, override(path, value * (1 + side * STEP))) for side in (-1, 1)}
            for row in of_path:
                self.compare(row, around, value * STEP)
        return {row["parameter"] for row in rows}

    def test_differences(self):
        """With every kind of damping, a turning disc, and the reactions of steady sliding; tests/sensitivity has all of materials."""
        paths = [*(f"Operation/{name}" for name in ("Friction coefficient", "Friction slope", "Load per side", "Rotation speed")),
                 "Disc material/Young modulus", "Disc material/Rayleigh beta", "Pin material/Poisson ratio", "Pin material/Rayleigh alpha",
                 "Mounts/Elastic mounts: disc_bore axial"]
        self.assertEqual(len(self.check_modes([*RICH, STEADY, GAPS], paths)), 17)

    def test_modal_damping(self):
        """The modes to which the damping belongs change with the bodies, the ratios with their frequencies."""
        ratios = [f"Damping/Modal damping ratio: {frequency} Hz" for frequency in RATIOS]
        paths = ["Disc material/Density", "Operation/Friction coefficient", "Operation/Load per side",
                 "Mounts/Elastic mounts: disc_bore tangential", ratios[1]]
        names = self.check_modes([*RICH, modal(RATIOS)], paths)
        self.assertEqual({name for name in names if "ratio: " in name}, set(ratios))

    def test_orthotropic_pin(self):
        """Every constant in fixed axes."""
        self.check_orthotropic("pin_top_1", (2e9, 1.5e9, 1e9, 0.25, 0.4, 0.3, 0.8e9, 0.4e9, 0.3e9), 3070, "1, 0.2, 0, 0, 1, 0.3")

    def test_orthotropic_disc(self):
        """Cylindrical axes."""
        self.check_orthotropic("disc", (210e9, 180e9, 150e9, 0.3, 0.25, 0.2, 80e9, 70e9, 60e9), 7850, "", ("E2", "nu12", "G23"))

    def check_orthotropic(self, volume, values, density, axes, checked=()):
        """Constants compared with complete runs; with E1 all moduli change."""
        numbers = dict(zip(("E1", "E2", "E3", "nu12", "nu13", "nu23", "G12", "G13", "G23"), values))

        def scene(**changed):
            return [f"Materials/Orthotropic={volume}: " + ", ".join(map(repr, ({**numbers, **changed}).values())) + f", {density}, 10, 1e-7",
                    "Materials/Axes=" + (f"{volume}: {axes}" if axes else ""), "Pin material/Rayleigh beta=2e-8"]

        folder = self.run_scene("orthotropic", STUDY, NO_THRESHOLDS, NO_GEOMETRY, "Sensitivity/Tolerance=1e-7",
                                "Sensitivity/Largest number of modes=3", *scene())
        rows = [row for row in read_table(folder / "sensitivities.csv") if row["parameter"].startswith("Materials/Orthotropic:/")]
        self.assertEqual({row["body"] for row in rows}, {volume})
        for name in checked or numbers:
            of_path = [row for row in rows if row["parameter"].rsplit("/", 1)[1].split()[0] == name]
            self.assertGreaterEqual(len(of_path), 2)
            scaled = [key for key in numbers if name == "E1" and not key.startswith("nu")] or [name]
            around = {side: self.eigenvalues_at(*scene(**{key: numbers[key] * (1 + side * STEP) for key in scaled})) for side in (-1, 1)}
            for row in of_path:
                self.compare(row, around, numbers[name] * STEP)

    def test_identities(self):
        """The unit of force changes nothing, all pins together are the pins, and percentages are what they say."""
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
        """dmu_c/dp beside differences of the thresholds of sweeps, of lengths and places on meshes whose nodes have been moved here."""
        folder = self.run_scene("thresholds", STUDY, *THRESHOLDS, "Sensitivity/Geometry=sizes and places")
        rows = [row for row in read_table(folder / "sensitivities_thresholds.csv") if row["derivative of"] != "none"]
        self.assertEqual({row["derivative of"] for row in rows}, {"squared difference of the pair"})
        self.check_thresholds(rows, "Pin material/Poisson ratio", [])
        still = self.run_scene("still", "Band/Maximum frequency=1000")
        for path, pin in [("Disc thickness", ""), ("Bottom pin angles", "pin_bottom_1")]:
            def on_moved_mesh(value, change, velocity=motion(path, pin)):
                move_nodes(still, self.folder / "moved.msh", velocity, value * change)
                return ["Geometry/File=moved.msh"]
            # An error of 1e-4 of the largest one stands out from what the differences resolve
            self.assertGreater(self.check_thresholds(rows, "Geometry/" + path, [], pin, on_moved_mesh), RESOLUTION / (1e-4 - 1e-5))

    def test_damped_thresholds(self):
        """The same where damping, also of modes that change with the bodies, makes modes cease to decay one by one in steady sliding."""
        light = {frequency: 0.1 * ratio for frequency, ratio in RATIOS.items()}
        scene = [*RICH, modal(light), STEADY]
        folder = self.run_scene("damped", STUDY, NO_GEOMETRY, *THRESHOLDS, *scene)
        rows = [row for row in read_table(folder / "sensitivities_thresholds.csv") if not row["body"]]
        self.assertEqual({row["derivative of"] for row in rows}, {"growth rate"})
        self.check_thresholds(rows, "Operation/Load per side", scene)
        self.check_thresholds(rows, "Damping/Modal damping ratio: 2000 Hz", scene,
                              overrides=lambda value, change: [modal({**light, "2000": value * (1 + change)})])

    def check_thresholds(self, rows, path, scene, pin="", overrides=None):
        """Returns the largest difference. `overrides` are those with which the parameter has another value, by its value and the relative
        change."""
        overrides = overrides or (lambda value, change: [override(path, value * (1 + change))])
        step = 2e-5
        rows = [row for row in rows if row["parameter"] == path and row["body"] == pin]
        self.assertGreaterEqual(len(rows), 3)
        value = float(rows[0]["value"])
        found, largest = {}, 0.0
        for side in (-1, 1):
            folder = self.run_scene("shifted", "Study=sweep", "Sweep/Compare dissipation=false", *THRESHOLDS, *scene,
                                    *overrides(value, side * step))
            found[side] = [(float(row["mu [-]"]), row["event"]) for row in read_table(folder / "thresholds.csv")]
        for row in rows:
            here = float(row["mu [-]"])
            there = {side: min((mu for mu, event in others if event == row["event"]), key=lambda mu, here=here: abs(mu - here))
                     for side, others in found.items()}
            difference = (there[1] - there[-1]) / (2 * step)
            with self.subTest(parameter=path, mu=here, label=row["label"]):
                # Thresholds are known to 1e-10, that of A0-0 with its small slope of the growth rate to 4e-8
                self.assertLessEqual(abs(float(row["mu per unit [-]"]) * value - difference), 1e-5 * abs(difference) + RESOLUTION)
            largest = max(largest, abs(difference))
        return largest

    def test_geometry(self):
        """Lengths and places beside runs on meshes whose nodes have been moved here; gaps go along with their pins."""
        of_all = ("Disc thickness", "Pin height", "Disc inner radius", "Disc outer radius", "Pin diameter")
        self.check_geometry([*RICH, STEADY, GAPS], [*((path, "") for path in of_all), ("Top pin radii", "pin_top_2"),
                                                    ("Bottom pin angles", "pin_bottom_1")])

    def test_curved_elements(self):
        """The same of elements whose edges follow the circle that grows."""
        self.check_geometry([*RICH, "Discretization/Element=quadratic", "Band/Maximum frequency=4000"], [("Pin diameter", "")])

    def test_geometry_of_orthotropic_volumes(self):
        """Cylindrical axes follow the nodes, fixed ones stay."""
        materials = ("disc: 210e9, 180e9, 150e9, 0.3, 0.25, 0.2, 80e9, 70e9, 60e9, 7850; "
                     "pin_bottom_1: 2e9, 1.5e9, 1e9, 0.25, 0.4, 0.3, 0.8e9, 0.4e9, 0.3e9, 3070; "
                     "pin_top_2: 2e9, 1.5e9, 1e9, 0.25, 0.4, 0.3, 0.8e9, 0.4e9, 0.3e9, 3070")
        axes = "Materials/Axes=pin_top_2: 1, 0.2, 0, 0, 1, 0.3"
        self.check_geometry([f"Materials/Orthotropic={materials}", axes, "Operation/Friction coefficient=0.7"],
                            [("Disc thickness", ""), ("Top pin radii", "pin_top_2"), ("Bottom pin angles", "pin_bottom_1")])

    def check_geometry(self, scene, places):
        folder = self.run_scene("moving", STUDY, NO_THRESHOLDS, "Sensitivity/Geometry=sizes and places", "Sensitivity/Tolerance=1e-8",
                                "Sensitivity/Largest number of modes=3", *scene)
        rows = read_table(folder / "sensitivities.csv")
        still = self.run_scene("still", "Band/Maximum frequency=1000", *scene)
        for path, pin in places:
            of_path = [row for row in rows if row["parameter"] == "Geometry/" + path and row["body"] == pin]
            self.assertGreaterEqual(len(of_path), 2)
            step = 1e-6 if "angles" not in path else 1e-4
            around = {}
            for side in (-1, 1):
                move_nodes(still, self.folder / "moved.msh", motion(path, pin), side * step)
                around[side] = self.eigenvalues_at(*scene, "Geometry/File=moved.msh")
            for row in of_path:
                self.compare(row, around, step)
