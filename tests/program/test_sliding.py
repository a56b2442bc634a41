# SPDX-License-Identifier: GPL-3.0-or-later

"""Runs in steady sliding: the contact state, its effect on modes, and damping."""

import cmath
import importlib.util
import math
import unittest

from hex_mesh import PARAMETERS, HexMesh, angles
from program import COARSE, ProgramTest, eigenvalues, numbers, read_table, real_frequencies
from squeal.vtu_file import VtuFile

STEADY = "Steady sliding/Contact state=steady sliding"
CONSISTENT = "Operation/Radial dissipation=consistent"
SHAPES = ["Output/Mode shapes=all", "Output/Animation frames=0"]
PINS = ["pin_top_1", "pin_top_2", "pin_bottom_1", "pin_bottom_2"]

# Default parameters
FRICTION, SPEED, LOAD = 0.4, 4.0, 1000.0

# Error of fields in single precision, relative to the largest value [-]
SINGLE = 1e-6


def pins(folder):
    """Rows of sliding_pins.csv by pin, with converted numbers."""
    return {row["pin"]: {name: float(text) for name, text in row.items() if name != "pin"}
            for row in read_table(folder / "sliding_pins.csv")}


def loads(folder):
    return [row["load [N]"] for row in pins(folder).values()]


def checks(folder):
    return {row["quantity"]: float(row["value"]) for row in read_table(folder / "sliding_checks.csv")}


def growth_rates(folder):
    return [value.real for value in eigenvalues(folder)]


class ContactFaces:
    """Fields of a _contact.vtu file at the distinct nodes of each pin's face."""

    def __init__(self, path):
        file = VtuFile(path)
        self.nodes = {pin: {} for pin in PINS}
        for i, point in enumerate(file.points):
            side = "top" if point[2] > 0 else "bottom"
            pin = f"pin_{side}_{1 if point[1] < 0 else 2}"
            key = tuple(round(1e6 * x) for x in point)
            values = {name: field[i] for name, field in file.fields.items()}
            if self.nodes[pin].setdefault(key, (point, values))[1] != values:
                raise AssertionError(f"{path} has several values at {point}")

    def of_pin(self, pin):
        """(point, fields by name) of the nodes of one pin."""
        return list(self.nodes[pin].values())

    def all(self):
        return [node for pin in PINS for node in self.of_pin(pin)]


class SlidingTest(ProgramTest):
    scene = COARSE

    def assert_close(self, actual, expected, tolerance):
        """Compares lists; errors are relative to the largest expected number."""
        self.assertEqual(len(actual), len(expected))
        largest = max(map(abs, expected))
        self.assertLessEqual(max(abs(a - b) for a, b in zip(actual, expected)), tolerance * largest)

    def assert_checked(self, folder, has_load=True):
        values = checks(folder)
        self.assertLess(values["residual of the full system [-]"], 1e-10)
        self.assertLess(values["error of the prescribed loads [-]"], 1e-10)
        self.assertLessEqual(values["largest tension over load [-]"], 0)
        self.assertLess(values["largest overlap over travel [-]"], 1e-12)
        self.assertLess(values["complementarity |r_n g| over load and travel [-]"], 1e-12)
        self.assertLess(values["force balance with the supports [-]"], 1e-10)
        self.assertLess(values["moment balance with the supports [-]"], 1e-10)
        if has_load:
            for side in ("lower", "upper"):
                self.assertAlmostEqual(values[f"normal load of the {side} side [N]"], LOAD, delta=1e-10 * LOAD)


class State(SlidingTest):
    """The contact state of a run with consistent radial dissipation."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.results = cls.run_scene("results", STEADY, CONSISTENT, "Output/Mode shapes=unstable")
        cls.pins = pins(cls.results)

    def test_tables(self):
        self.assertEqual(list(self.pins), PINS)
        for name in ("sliding_pins.csv", "sliding_checks.csv"):
            self.assertTrue(all(math.isfinite(number) for number in numbers(self.results / name)), name)
        self.assert_checked(self.results)

    def test_pins(self):
        height = 0.0318
        for side in (1, -1):
            of_side = [pin for pin in self.pins.values() if pin["side [-]"] == side]
            self.assertEqual(len(of_side), 2)
            self.assertAlmostEqual(sum(pin["load [N]"] for pin in of_side), LOAD, delta=1e-10 * LOAD)
            self.assertEqual(len({pin["backplate travel [m]"] for pin in of_side}), 1)
        for name, pin in self.pins.items():
            with self.subTest(name):
                self.assertEqual([pin[column] for column in ("nodes [-]", "open nodes [-]", "largest gap [m]", "c_t [N s/m]")], [7, 0, 0, 0])
                # Clamp and disc keep the ends of a softer pin parallel, and each end carries half of the moment mu N h: the
                # centre of pressure moves by mu times half the height
                self.assertAlmostEqual(pin["pressure offset along t [m]"], -FRICTION * height / 2, delta=0.05 * FRICTION * height / 2)
                self.assertGreater(pin["backplate travel [m]"], 0)
                self.assertGreater(pin["largest pressure [Pa]"], pin["load [N]"] / (math.pi * 0.026**2))
                self.assertAlmostEqual(pin["w_0 [m/s]"], SPEED * (0.2275 + pin["pressure offset outwards [m]"]), delta=1e-6)

    def test_fields(self):
        faces = ContactFaces(self.results / "sliding_state_contact.vtu")
        for name, pin in self.pins.items():
            nodes = faces.of_pin(name)
            self.assertEqual(len(nodes), 7)
            reactions = [fields["normal_reaction"] for _, fields in nodes]
            damping = [FRICTION * abs(fields["normal_reaction"]) / (SPEED * math.hypot(x, y)) for (x, y, _), fields in nodes]
            self.assertAlmostEqual(-sum(reactions), pin["load [N]"], delta=SINGLE * LOAD)
            self.assert_close([fields["c_b"] for _, fields in nodes], damping, SINGLE)
            self.assertAlmostEqual(sum(damping), pin["c_b [N s/m]"], delta=SINGLE * sum(damping))
            self.assertAlmostEqual(max(fields["pressure"] for _, fields in nodes), pin["largest pressure [Pa]"],
                                   delta=SINGLE * pin["largest pressure [Pa]"])
            for _, fields in nodes:
                self.assertLess(fields["normal_reaction"], 0)
                self.assertEqual((fields["gap"], fields["closed"], fields["c_t"]), (0, 1, 0))

    def test_displacements(self):
        state = VtuFile(self.results / "sliding_state.vtu")
        ends = [(point, u) for point, u in zip(state.points, state.fields["displacement"]) if abs(abs(point[2]) - 0.05495) < 1e-6]
        self.assertGreater(len(ends), 0)
        # The clamped end of a pin moves with its backplate
        way = self.pins["pin_top_1"]["backplate travel [m]"]
        for (_, _, z), u in ends:
            self.assert_close(u, (0, 0, -math.copysign(way, z)), SINGLE)

    def test_state_does_not_matter_without_dissipation(self):
        # If all nodes are closed, reactions affect only the dissipation
        self.assert_same_eigenvalues(eigenvalues(self.run_scene("steady", STEADY)), eigenvalues(self.run_scene("plain")))


class Gaps(SlidingTest):
    """Pins without contact or in partial contact."""

    def assert_open_nodes(self, folder):
        """Checks that fields and table agree on open nodes; returns the numbers of open nodes."""
        faces = ContactFaces(folder / "sliding_state_contact.vtu")
        modes = sorted((folder / "modes").glob("*_contact.vtu"))
        self.assertGreater(len(modes), 0)
        for name, pin in pins(folder).items():
            nodes = faces.of_pin(name)
            self.assertEqual(sum(fields["closed"] == 0 for _, fields in nodes), pin["open nodes [-]"])
            largest = -min(fields["gap"] for _, fields in nodes)
            self.assertAlmostEqual(largest, pin["largest gap [m]"], delta=SINGLE * largest)
            for _, fields in nodes:
                self.assertIn(fields["closed"], (0, 1))
                self.assertEqual(fields["gap"] < 0, fields["closed"] == 0)
                self.assertEqual(fields["normal_reaction"] < 0, fields["closed"] == 1)
            for mode in modes:
                for (_, state), (_, fields) in zip(nodes, ContactFaces(mode).of_pin(name)):
                    self.assertEqual(fields["closed"], state["closed"])
                    if fields["closed"] == 0:
                        self.assertEqual((fields["normal_reaction_real"], fields["normal_reaction_imag"]), (0, 0))
        return [int(pin["open nodes [-]"]) for pin in pins(folder).values()]

    def test_short_and_worn_pins(self):
        # pin_bottom_2 is worn at its trailing edge, where friction reduces the pressure
        results = self.run_scene("results", STEADY, CONSISTENT, "Steady sliding/Gaps=pin_top_1: 2e-5; pin_bottom_2: 0, 4e-4, 0", *SHAPES)
        n_open = self.assert_open_nodes(results)
        self.assertEqual(n_open[:3], [7, 0, 0])
        self.assertTrue(0 < n_open[3] < 7, n_open)
        table = pins(results)
        offsets = [pin["pressure offset along t [m]"] for pin in table.values()]
        self.assertLess(offsets[3], min(offsets[1:3]))
        self.assertEqual([table["pin_top_1"][name] for name in ("load [N]", "largest pressure [Pa]", "c_b [N s/m]")], [0, 0, 0])
        # The lowest bending modes of the open pin agree with a clamped-free pin
        free = [float(row["frequency [Hz]"]) for row in read_table(results / "component_modes.csv")
                if row["component"] == "pins" and row["contact"] == "free" and row["label"] == "F1"]
        lowest = [frequency for frequency in real_frequencies(results) if abs(frequency - free[0]) < 1e-6 * free[0]]
        self.assertEqual(len(lowest), 2)


@unittest.skipUnless(importlib.util.find_spec("scipy"), "needs SciPy")
class Independent(SlidingTest):
    """The contact state, computed independently from the exported matrices."""

    CASES = {"even": (0.4, {}), "strong friction": (1.0, {}), "hardly touching": (0.4, {"pin_top_1": (1e-5, 0, 0)}),
             "short": (0.4, {"pin_top_1": (2e-5, 0, 0)}), "worn": (0.4, {"pin_bottom_2": (0, 4e-4, 0), "pin_top_1": (-1e-6, 0, -1e-4)}),
             "uneven": (0.8, {"pin_top_1": (2e-6, 1e-4, -2e-4), "pin_top_2": (0, -2e-4, 1e-4), "pin_bottom_1": (3e-6, 0, 2e-4)})}

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        # With equal load, the matrices contain all contact nodes; all runs have the same mesh
        cls.matrices = cls.run_scene("matrices", "Output/Write matrices=true")

    def run_case(self, friction, gaps, *overrides):
        text = "; ".join(f"{pin}: {gap!r}, {along!r}, {outwards!r}" for pin, (gap, along, outwards) in gaps.items())
        return self.run_scene("case", STEADY, CONSISTENT, f"Operation/Friction coefficient={friction}", f"Steady sliding/Gaps={text}",
                              "Output/Write matrices=true", *overrides)

    def assert_same_state(self, results, contact, friction, compressions, ways):
        """Compares loads, travel and open nodes with the table, and reactions with C_b, which is proportional to them."""
        import scipy.io
        table = pins(results)
        compression = {name: [p for p, pin in zip(compressions, contact.pins) if pin == name] for name in PINS}
        self.assert_close(loads(results), [sum(compression[name]) for name in PINS], 1e-8)
        self.assert_close([pin["backplate travel [m]"] for pin in table.values()], ways, 1e-8)
        self.assertEqual([pin["open nodes [-]"] for pin in table.values()], [compression[name].count(0) for name in PINS])
        for name, pin in table.items():
            pressures = [p / area for p, area, of_pin in zip(compressions, contact.areas, contact.pins) if of_pin == name]
            self.assertAlmostEqual(pin["largest pressure [Pa]"], max(pressures), delta=1e-8 * LOAD / 0.002)
        P_b, C_b = (scipy.io.mmread(folder / "matrices" / f"{name}.mtx").tocsr() for folder, name in ((self.matrices, "P_b"), (results, "C_b")))
        damping = (P_b @ C_b @ P_b.T).diagonal() / 4
        self.assert_close(damping * SPEED * contact.axis_distances / friction, compressions, 1e-8)

    def test_state(self):
        from lemke import SlidingContact
        for name, (friction, gaps) in self.CASES.items():
            with self.subTest(name):
                contact = SlidingContact(self.matrices, friction)
                plates = [0 if side > 0 else 1 for side in contact.sides]
                compressions, ways = contact.solve(contact.gaps(gaps), plates, [LOAD, LOAD])
                results = self.run_case(friction, gaps)
                self.assert_checked(results)
                self.assert_same_state(results, contact, friction, compressions, [ways[0], ways[0], ways[1], ways[1]])

    def test_load_per_pin(self):
        from lemke import SlidingContact
        friction, gaps = self.CASES["uneven"]
        contact = SlidingContact(self.matrices, friction)
        plates = [PINS.index(pin) for pin in contact.pins]
        compressions, ways = contact.solve(contact.gaps(gaps), plates, [700, 500, 500, 200])
        results = self.run_case(friction, gaps, "Steady sliding/Control=load per pin",
                                "Steady sliding/Loads=pin_top_1: 700; pin_bottom_2: 200")
        self.assert_same_state(results, contact, friction, compressions, ways)

    def test_displacement(self):
        from lemke import SlidingContact, lemke
        friction, gaps = self.CASES["uneven"]
        contact = SlidingContact(self.matrices, friction)
        way, unit = 4e-6, contact.flexibility.max()
        compressions = lemke(contact.flexibility / unit, (contact.gaps(gaps) - way) / unit)
        results = self.run_case(friction, gaps, "Steady sliding/Control=displacement", f"Steady sliding/Displacement={way}")
        self.assert_checked(results, has_load=False)
        self.assert_same_state(results, contact, friction, compressions, 4 * [way])


class Damping(SlidingTest):
    """Material damping, modal damping, and damping by the friction slope."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.results = cls.run_scene("results")
        cls.values = eigenvalues(cls.results)

    def test_damping_of_the_mass(self):
        # Damping proportional to mass replaces lambda^2 by lambda^2 + alpha lambda, also with friction
        alpha = 20.0
        expected = []
        for value in self.values:
            root = cmath.sqrt(alpha**2 / 4 + value**2)
            expected.append(-alpha / 2 + (root if root.imag > 0 else -root))
        damped = self.run_scene("damped", f"Disc material/Rayleigh alpha={alpha}", f"Pin material/Rayleigh alpha={alpha}")
        self.assert_same_eigenvalues(eigenvalues(damped), expected)

    def test_damping_of_the_pins(self):
        beta = 1e-8
        # Without friction, the growth rate is -beta omega^2 / 2 if only the pins move, and closer to zero otherwise
        still = self.run_scene("still", "Operation/Friction coefficient=0", f"Pin material/Rayleigh beta={beta}")
        for value in eigenvalues(still):
            self.assertLessEqual(value.real, 1e-9)
            self.assertGreaterEqual(value.real, -1.001 * beta * abs(value) ** 2 / 2)
        twisting = [value for value, row in zip(eigenvalues(still), read_table(still / "complex_modes.csv")) if row["label"] == "T1"]
        self.assertEqual(len(twisting), 4)
        for value in twisting:
            self.assertAlmostEqual(value.real, -beta * abs(value) ** 2 / 2, delta=1e-3 * beta * abs(value) ** 2 / 2)

    def test_friction_slope(self):
        # Friction that increases with speed stabilises; friction that decreases with speed destabilises
        for state in ([], [STEADY]):
            without = self.run_scene("without", *state) if state else self.results
            sums = {}
            for slope in (-0.01, 0.01):
                results = self.run_scene("slope", f"Operation/Friction slope={slope}", *state)
                sums[slope] = sum(growth_rates(results)) - sum(growth_rates(without))
                self.assertLess(slope * (max(growth_rates(results)) - max(growth_rates(without))), 0)
                self.assertLess(slope * sums[slope], 0)
                if state:
                    for pin in pins(results).values():
                        self.assertAlmostEqual(pin["c_t [N s/m]"], slope * pin["load [N]"], delta=1e-9 * LOAD * abs(slope))
            self.assertAlmostEqual(sums[-0.01], -sums[0.01], delta=1e-3 * sums[-0.01])

    def test_modal_damping(self):
        # Without friction, modes are uncoupled; the ratio is 0.01 at 0 Hz and 0.03 at 5000 Hz
        damped = self.run_scene("damped", "Operation/Friction coefficient=0", "Damping/Modal damping ratio=0: 0.01, 5000: 0.03")
        expected = []
        for frequency in real_frequencies(damped):
            ratio, omega = 0.01 + 0.02 * frequency / 5000, 2 * math.pi * frequency
            expected.append(omega * complex(-ratio, math.sqrt(1 - ratio**2)))
        self.assert_same_eigenvalues(eigenvalues(damped), expected)


class Shoes(SlidingTest):
    """Shoes pressed on the rim of a ring, with radial contact normals."""

    @classmethod
    def write_shoes(cls, name, *parts, n_parts=24):
        """Writes a ring with shoes as NAME.msh and NAME.prm. `parts`: first and last sector of each shoe."""
        mesh, levels = HexMesh(), [-0.02, 0, 0.02]
        disc = mesh.block("disc", [0.15, 0.2, 0.25, 0.3], angles(n_parts), levels, is_ring=True)
        mesh.name(disc["-a"].values(), "disc_bore")
        for number, (first, last) in enumerate(parts, 1):
            shoe = mesh.block(f"pin_shoe_{number}", [0.3, 0.315, 0.33], angles(n_parts, first, last), levels,
                              is_ring=last - first == n_parts)
            mesh.name([nodes for (_, part, _), nodes in disc["+a"].items() if first <= part < last], "disc_contact")
            mesh.name(shoe["-a"].values(), "pin_contact")
            mesh.name(shoe["+a"].values(), "pin_clamp")
        mesh.write_2(cls.folder / f"{name}.msh")
        (cls.folder / f"{name}.prm").write_text(PARAMETERS.format(file=f"{name}.msh", mount="disc_bore"), encoding="utf-8")

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.write_shoes("shoes", (0, 4), (12, 14))
        cls.write_shoes("band", (0, 24))

    def test_every_shoe_bears_the_load(self):
        results = self.run_scene("results", STEADY, "Output/Write matrices=true", file="shoes.prm")
        self.assert_checked(results, has_load=False)
        self.assertEqual([pin["open nodes [-]"] for pin in pins(results).values()], [0, 0])
        if not importlib.util.find_spec("scipy"):
            self.skipTest("needs SciPy")
        from lemke import SlidingContact

        normal_loads, ways = SlidingContact(results, FRICTION).pressed_along_normals(LOAD)
        self.assert_close(loads(results), normal_loads, 1e-9)
        self.assert_close([pin["backplate travel [m]"] for pin in pins(results).values()], ways, 1e-9)

    def test_a_band_around_the_rim_has_no_travel(self):
        for setting in (STEADY, CONSISTENT, "Operation/Friction slope=-0.01"):
            process = self.call("band.prm", "--dry-run", "--set", setting)
            self.assertEqual(process.returncode, 1, process.stdout)
            self.assertIn("pin_shoe_1", process.stderr)
            self.assertIn("Steady sliding/Contact state = equal load", process.stderr)
        results = self.run_scene("band", file="band.prm")
        self.assertTrue(all(math.isfinite(number) for number in numbers(results / "complex_modes.csv")))
