# SPDX-License-Identifier: GPL-3.0-or-later

"""Systems of matrices without a mesh: comparison with dense eigenvalues and closed forms; writing and reading."""

import csv
import importlib.util
import json
import math
import unittest

from program import SAME, ProgramTest

import squeal
from squeal.vtu_file import VtuFile

HAS_NUMPY = importlib.util.find_spec("numpy") is not None
if HAS_NUMPY:
    import numpy as np

BAND = 3.  # end of the band [Hz]
STUDY = "set System = system\nset Study = {study}\nsubsection Band\n  set Maximum frequency = {band}\nend\n"

# k_11, k_22, k_12 and the contact stiffness of a system with two degrees of freedom and friction (Hoffmann et al. 2002)
FLUTTER = (100., 80., -30., 60.)


def matrix_text(A):
    rows = [f"{i + 1} {j + 1} {A[i][j]!r}" for i in range(len(A)) for j in range(len(A[0])) if A[i][j] != 0.]
    return f"%%MatrixMarket matrix coordinate real general\n{len(A)} {len(A[0])} {len(rows)}\n" + "\n".join(rows) + "\n"


class SystemTest(ProgramTest):
    def write_system(self, parameters, terms, folder="system", **more):
        """Writes a system. Terms are (power, coefficient, matrix, symmetry); parameters are name: (value, lower,
        upper)."""
        for number, (_, _, A, _) in enumerate(terms):
            self.write(f"{folder}/A{number}.mtx", matrix_text([[float(x) for x in row] for row in A]))
        description = {"format": "squeal system", "version": 1,
                       "parameters": {name: dict(zip(("value", "lower", "upper"), values)) for name, values in parameters.items()},
                       "terms": [{"name": f"A{number}", "power": power, "coefficient": coefficient, "matrix": f"A{number}.mtx", "symmetry": symmetry}
                                 for number, (power, coefficient, _, symmetry) in enumerate(terms)], **more}
        self.write(f"{folder}/system.json", json.dumps(description))
        return description

    def study(self, name, *overrides, band=BAND):
        self.write("study.prm", STUDY.format(study=name, band=band))
        return self.run_scene("results", *overrides, file="study.prm")

    @staticmethod
    def rows(folder, table):
        with open(folder / f"{table}.csv", newline="", encoding="utf-8") as file:
            return [{name: float(cell) if is_number(cell) else cell for name, cell in row.items()} for row in csv.DictReader(file)]

    def lambdas(self, folder):
        return [complex(row["growth rate [1/s]"], 2. * math.pi * row["frequency [Hz]"]) for row in self.rows(folder, "complex_modes")]


def is_number(cell):
    try:
        float(cell)
        return True
    except ValueError:
        return False


def flutter_terms():
    k11, k22, k12, k_c = FLUTTER
    return [(2, "1", [[1., 0.], [0., 1.]], "symmetric"), (0, "1", [[k11, k12], [k12, k22]], "symmetric"),
            (0, "mu*kappa", [[0., k_c], [0., 0.]], "none")]


def flutter_squares(mu):
    """λ² of the two modes of the flutter system."""
    k11, k22, k12, k_c = FLUTTER
    discriminant = ((k11 - k22) / 2.) ** 2 + k12 * (k12 + mu * k_c)
    root = complex(discriminant) ** 0.5
    return [-((k11 + k22) / 2. + sign * root) for sign in (-1., 1.)]


class Flutter(SystemTest):
    """System with two degrees of freedom and closed-form eigenvalues."""

    MU_C = (((FLUTTER[0] - FLUTTER[1]) / 2.) ** 2 + FLUTTER[2] ** 2) / (-FLUTTER[2] * FLUTTER[3])

    def setUp(self):
        self.write_system({"mu": (0.6, 0., 1.), "kappa": (1., 0.5, 2.)}, flutter_terms())

    def test_stability(self):
        for mu, n_unstable in ((0.3, 0), (0.8, 1)):
            found = self.lambdas(self.study("stability", f"System values=mu = {mu}"))
            expected = [root for square in flutter_squares(mu) for root in (square ** 0.5, -square ** 0.5) if root.imag > 0.]
            self.assertEqual(len(found), 2)
            for value in expected:
                self.assertLess(min(abs(value - other) for other in found), SAME * abs(value))
            self.assertEqual(sum(value.real > 1e-9 for value in found), n_unstable)

    def test_threshold_and_map(self):
        results = self.study("sweep", "Sweep/Parameter=mu, 0, 1, 21", "Sweep/Second parameter=kappa, 0.5, 2, 7",
                             "Sweep/Threshold tolerance=1e-12", "Sweep/Count modes at=0.3, 0.8")
        thresholds = self.rows(results, "thresholds")
        self.assertEqual([row["mechanism"] for row in thresholds], ["coalescence"])
        self.assertAlmostEqual(thresholds[0]["mu [-]"], self.MU_C, delta=1e-10)
        cells = self.rows(results, "map")
        self.assertEqual(len(cells), 7 * 21)
        for cell in cells:
            self.assertEqual(cell["unstable modes [-]"], cell["mu [-]"] * cell["kappa [-]"] > self.MU_C, cell)
            leading = max((root for square in flutter_squares(cell["mu [-]"] * cell["kappa [-]"]) for root in (square ** 0.5, -square ** 0.5)
                           if root.imag > 0.), key=lambda root: round(root.real, 6))
            self.assertAlmostEqual(cell["growth rate [1/s]"], leading.real, delta=1e-6)
        for row in self.rows(results, "argument_counts"):
            self.assertEqual(row["modes of the sweep [-]"], row["modes counted [-]"])

    def test_derivatives(self):
        rows = self.rows(self.study("sensitivity", "System values=mu = 0.3, kappa = 1.2"), "sensitivities")
        self.assertEqual(len(rows), 4)
        product, h = 0.36, 1e-6
        for row in rows:
            value = 2j * math.pi * row["frequency [Hz]"]
            branch = min((0, 1), key=lambda k: abs(value * value - flutter_squares(product)[k]))
            by_product = (flutter_squares(product + h)[branch] - flutter_squares(product - h)[branch]) / (2. * h) / (2. * value)
            expected = by_product * (1.2 if row["parameter"] == "mu" else 0.3)
            self.assertAlmostEqual(2. * math.pi * row["frequency per unit [Hz]"], expected.imag, delta=1e-5 * abs(expected))

    def test_refusals(self):
        """Each mistake stops the run with one message that names its location."""
        singular = [(2, "1", [[1., 0.], [0., 0.]], "symmetric"), (0, "1", [[1., 0.], [0., 0.]], "symmetric")]
        mass, stiffness, friction = flutter_terms()
        cases = [([mass, stiffness, (0, "1", [[1.]], "none")], ["1 and 2", "A2.mtx", "terms[3].matrix"]),
                 ([mass, stiffness, (0, "1", [[1., 2., 3.], [1., 2., 3.]], "none")], ["2 x 3", "terms[3].matrix"]),
                 ([mass, (0, "1", [[1., math.nan], [0., 1.]], "none")], ["row 1 and column 2", "A1.mtx"]),
                 ([mass, stiffness, (0, "1", friction[2], "symmetric")], ["terms[3].symmetry", "skew part reach 30"]),
                 ([mass, stiffness, (0, "mu*", friction[2], "none")], ["terms[3].coefficient", "`mu*`"]),
                 ([mass, stiffness, (0, "nu", friction[2], "none")], ["terms[3].coefficient", "nu"]),
                 ([mass, stiffness, (0, "1/mu", friction[2], "none")], ["not finite at mu = 0"]),
                 ([mass, stiffness, (3, "1", friction[2], "none")], ["terms[3].power"]),
                 (singular, ["dof 2", "det Q"]),
                 ([(power, "1", [[1., 1.], [1., 1.]], "symmetric") for power in (2, 0)], ["Q(lambda) is singular", "system.json"]),
                 ([(power, "1", [[1., 2., 0.], [0., 0., 1.], [0., 0., power]], "none") for power in (2, 0)], ["Q(lambda) is singular", "system.json"]), ([stiffness], ["no mass"]), ([(2, "1", [[0., 0.], [0., 0.]], "symmetric"), stiffness], ["no mass"])]
        for terms, mentions in cases:
            with self.subTest(mentions):
                self.write_system({"mu": (0.6, 0., 1.)}, terms)
                self.write("study.prm", STUDY.format(study="stability", band=BAND))
                process = self.call("study.prm", "--output", "refused")
                self.assert_message(process, mentions)
                self.assertFalse((self.folder / "refused").exists())
        for part, powers in (("mass", (2, 0)), ("stiffness", (0, 2))):
            self.write_system({"mu": (0.6, 0., 1.)}, [(power, coefficient, [[1., 0.], [0., 1.]], "symmetric") for power, coefficient in zip(powers, ("mu", "1"))])
            self.assert_message(self.call("study.prm", "--output", "refused", "--set", "System values=mu = 0"), [f"all {part} terms are missing or zero", "system.json"])
        self.write_system({"mu": (0.6, 0., 1.), "kappa": (1., 0.5, 2.)}, flutter_terms())
        for study, override, mentions in (("stability", "System values=nu = 1", ["`nu`", "mu, kappa"]), ("stability", "System values=mu = 2", ["range"]),
                                          ("sweep", "Sweep/Parameter=mu, 0, 2, 5", ["range"]), ("stability", "System=nothing", ["nothing"]),
                                          ("reduction", "Reduction/Bases=real, free", ["`free`", "contact nodes"]),
                                          ("reduction", "Reduction/Bases=real + 1st-ord. two-sided + damping", ["needs damping"]),
                                          ("ingredients", "System=system", ["requires a mesh"]), ("sweep", "Sweep/Parameter=mu", ["range of a parameter"])):
            self.write("study.prm", STUDY.format(study=study, band=BAND))
            self.assert_message(self.call("study.prm", "--output", "refused", "--set", override), mentions)

    def test_maximum_rate(self):
        """Modes with |Re lambda| below the maximum rate and their count agree with the QZ algorithm, with and without a
        definite part."""
        n, end = 16, 2. * math.pi * BAND
        chain = 200. * np.eye(n) - 90. * (np.eye(n, k=1) + np.eye(n, k=-1))
        damping = np.diag(np.where(np.arange(n) % 4 == 1, 24., 0.06 + 0.02 * np.arange(n)))
        follower = 12. * (np.eye(n, k=2) - np.eye(n, k=-2))
        for stiffness in (chain, chain - 30. * np.eye(n)):
            self.write_system({}, [(2, "1", np.eye(n), "symmetric"), (1, "1", damping, "symmetric"), (0, "1", stiffness, "symmetric"),
                                   (0, "1", follower, "skew")])
            every = [value for value in squeal.System.read(self.folder / "system").solve().eigenvalues if 1e-6 < value.imag < end]
            for rate in (0.5, 1.2, 5.):
                expected = [value for value in every if abs(value.real) < rate]
                self.assertLess(len(expected), len(every))
                for solver in ("Krylov", "residual iteration"):
                    results = self.study("stability", f"Band/Maximum rate={rate}", f"Complex modes/Solver={solver}", "Complex modes/Iteration tolerance=1e-10")
                    self.assert_same_eigenvalues(self.lambdas(results), expected, 1e-8)
                    counts = json.loads((results / "run.json").read_text(encoding="utf-8"))["counts"]
                    self.assertEqual(counts["complex modes counted by the argument principle"], len(expected))

    def test_growth_beyond_the_maximum_rate(self):
        """Modes that grow faster than the maximum rate are listed; a contour through an eigenvalue stops the run."""
        identity = np.eye(3)
        self.write_system({}, [(2, "1", identity, "symmetric"), (1, "1", np.diag([-3., 0.5, 1.]), "symmetric"), (0, "1", np.diag([90., 100., 110.]), "symmetric")])
        found = self.lambdas(self.study("stability", "Band/Maximum rate=0.3"))
        self.assert_same_eigenvalues(found, [complex(0.5 * c, (k - 0.25 * c * c) ** 0.5) for c, k in ((3., 90.), (-0.5, 100.))])
        self.assert_message(self.call("study.prm", "--output", "refused", "--set", "Band/Maximum rate=0.5"), ["on the contour", "0.5 1/s", "change Band/Maximum rate"])

    def test_no_definite_part(self):
        """Lagrange multipliers, follower forces and an indefinite stiffness, compared with the QZ algorithm."""
        n, rng = 12, np.random.default_rng(1)
        stiffness = 200. * np.eye(n) - 100. * (np.eye(n, k=1) + np.eye(n, k=-1))
        follower = 20. * np.triu(rng.uniform(-1., 1., (n, n)), 1)
        mass, damping, constraint = np.eye(n), 0.002 * stiffness, np.zeros((1, n))
        constraint[0, [3, 8]] = 1., -0.5
        multipliers = [np.pad(A, (0, 1)) for A in (mass, damping, stiffness + follower)]
        multipliers[2][n, :n], multipliers[2][:n, n] = constraint, constraint[0]
        for name, (M, C, K) in (("multipliers", multipliers), ("negative", (mass, damping, stiffness - 50. * np.eye(n)))):
            with self.subTest(name):
                self.write_system({"p": (1., 0.5, 2.)}, [(2, "1", M, "none"), (1, "1", C, "none"), (0, "p", K, "none")],
                                  groups={"all": [[1, len(M)]]})
                found = self.study("stability", "Band/Maximum frequency=3")
                system = squeal.System.read(self.folder / "system")
                expected = [value for value in system.solve().eigenvalues
                            if 1e-6 < value.imag < 6. * math.pi and abs(value.real) < 0.6 * math.pi]
                rows = self.rows(found, "complex_modes")
                self.assertEqual(len(rows), len(expected))
                self.assertGreater(len(rows), 5)
                for row, value in zip(rows, self.lambdas(found)):
                    self.assertLess(min(abs(value - other) for other in expected), 1e-10 * abs(value))
                    self.assertLess(row["backward error [-]"], 1e-12)
                    self.assertLess(row["error of lambda [-]"], 1e-10)
                    self.assertAlmostEqual(row["kinetic energy of all [%]"], 100., places=6)
                step, rates = 1e-4, self.rows(self.study("sensitivity", "Band/Maximum frequency=3"), "sensitivities")
                ends = [self.lambdas(self.study("stability", "Band/Maximum frequency=3", f"System values=p = {1. + sign * step!r}"))
                        for sign in (-1., 1.)]
                for row, below, above in zip(rates, *ends):
                    rate = complex(row["growth rate per unit [1/s]"], 2. * math.pi * row["frequency per unit [Hz]"])
                    self.assertLess(abs(rate - (above - below) / (2. * step)), 1e-5 * abs(rate))
                self.check_reduction(n)
        self.write("study.prm", STUDY.format(study="reduction", band=BAND))
        self.assert_message(self.call("study.prm", "--output", "refused", "--set", "Reduction/Bases=real"), ["no definite part", "POD"])

    def check_reduction(self, n):
        """Compares POD and a written reduced model with full order, for a system without a definite part."""
        results = self.study("reduction", "Band/Maximum frequency=1.5", "Reduction/Snapshots=0.6, 1.5", "Reduction/POD tolerance=1e-9")
        for row in self.rows(results, "reduction_modes"):
            self.assertLess(row["error of lambda [-]"], 1e-5)
            if row["error of lambda [-]"] > 1e-10:
                self.assertLess(abs(math.log(row["estimated error of lambda [-]"] / row["error of lambda [-]"])), math.log(3.))
        band, sweep = "Band/Maximum frequency=1.5", ("Sweep/Parameter=p, 0.5, 2, 7", "Output/Write system=reduced", "Sweep/Tolerance=1e-8")
        results = self.study("sweep", band, *sweep)
        reduced = squeal.System.read(results / "system")
        self.assertLessEqual(reduced.size, n + 1)
        points = self.rows(results / "system", "points")
        self.assertGreaterEqual(len(points), 7)
        full, omega = squeal.System.read(self.folder / "system"), 3. * math.pi
        for point in points:
            self.assertLessEqual(point["largest error of lambda [-]"], 1e-8)
            found, expected = ([value for value in system.solve({"p": point["p [-]"]}).eigenvalues
                                if 1e-6 < value.imag < omega and abs(value) < 10. * omega] for system in (reduced, full))
            self.assertEqual(len(found), len(expected))
            for value in found:
                self.assertLess(min(abs(value - other) for other in expected), 2e-8 * abs(value))

    def test_flutter_with_multiplier(self):
        """A third dof fixed by a Lagrange multiplier does not change the flutter of the other dofs: threshold, map and
        samples at full order."""
        padded = [(power, coefficient, [[*row, 0., 0.] for row in A] + [[0.] * 4] * 2, symmetry) for power, coefficient, A, symmetry in flutter_terms()]
        mass, stiffness, friction = ([list(row) for row in term[2]] for term in padded)
        mass[2][2] = 1.
        stiffness[2][2], stiffness[2][3], stiffness[3][2] = 50., 1., 1.
        self.write_system({"mu": (0.6, 0., 1.), "kappa": (1., 0.5, 2.)}, [
            (power, coefficient, A, symmetry) for (power, coefficient, _, symmetry), A in zip(padded, (mass, stiffness, friction))])
        results = self.study("sweep", "Sweep/Parameter=mu, 0, 1, 21", "Sweep/Second parameter=kappa, 0.5, 2, 4", "Sweep/Threshold tolerance=1e-10",
                             "Sweep/Count modes at=0.3, 0.8", "Sweep/Complex plane at=0.8")
        thresholds = self.rows(results, "thresholds")
        self.assertEqual([row["mechanism"] for row in thresholds], ["coalescence"])
        self.assertAlmostEqual(thresholds[0]["mu [-]"], self.MU_C, delta=1e-8)
        self.assertLess(abs(thresholds[0]["mu [-]"] - self.MU_C), thresholds[0]["uncertainty [-]"] + 1e-12)
        for row in self.rows(results, "argument_counts"):
            self.assertEqual((row["modes of the sweep [-]"], row["modes counted [-]"]), (2., 2.))
        for cell in self.rows(results, "map"):
            self.assertEqual(cell["unstable modes [-]"], cell["mu [-]"] * cell["kappa [-]"] > self.MU_C, cell)
        for row in self.rows(results, "branches"):
            value = complex(row["growth rate [1/s]"], 2. * math.pi * row["frequency [Hz]"])
            self.assertLess(min(abs(value * value - square) for square in flutter_squares(row["mu [-]"])), 1e-5 * abs(value) ** 2)
            self.assertLess(max(row["eps_res right [-]"], row["eps_res left [-]"]), 1e-12)
        results = self.study("geometry", "Designs/Variables=mu = 0.2, 0.9; kappa = 0.5, 1, 2")
        for row in self.rows(results, "samples"):
            self.assertEqual(row["unstable modes [-]"], float(row["mu"] * row["kappa"] > self.MU_C), row)
        results = self.study("robustness", "Robustness/Distributions=mu = uniform 0 to 1", "Robustness/Number of samples=64", "Robustness/Sobol indices=false")
        squeal_probability = self.rows(results, "probabilities")[0]["probability of squeal [%]"]
        self.assertAlmostEqual(squeal_probability, 100. * (1. - self.MU_C), delta=5.)

    def test_derivatives_of_expressions(self):
        """The difference step adapts to expressions with rapidly varying, huge or tiny values."""
        for expression, value, theta, rate in (("exp(-t/1e-3)", 1e-3, 1. / math.e, -1e3 / math.e), ("sqrt(t)", 1e12, 1e6, 0.5e-6),
                                               ("1e-6/(t+1e-6)", 1e-6, 0.5, -0.25e6), ("t^1.5", 1e-5, 1e-5 ** 1.5, 1.5 * 1e-5 ** 0.5)):
            self.write_system({"t": (value, 0.5 * value, 2. * value)},
                              [(2, "1", [[1.]], "symmetric"), (0, "1", [[100.]], "symmetric"), (0, expression, [[1. / theta]], "symmetric")])
            row = self.rows(self.study("sensitivity", band=1e3), "sensitivities")[0]
            omega = 2. * math.pi * row["frequency [Hz]"]
            expected = rate / theta / (2. * omega)
            self.assertAlmostEqual(2. * math.pi * row["frequency per unit [Hz]"], expected, delta=1e-6 * abs(expected))

    def test_complete_basis(self):
        """If all modes are in the band, the basis of a sweep spans the whole space."""
        n = 6
        K = [[200. if i == j else -90. if abs(i - j) == 1 else 0. for j in range(n)] for i in range(n)]
        F = [[40. if j == i + 1 else -25. if j == i - 2 else 0. for j in range(n)] for i in range(n)]
        self.write_system({"d": (0.5, 0., 1.)}, [(2, "1", [[float(i == j) for j in range(n)] for i in range(n)], "symmetric"), (0, "1", K, "symmetric"),
                                                (0, "d", F, "none")])
        results = self.study("sweep", "Sweep/Parameter=d, 0, 1, 21", band=5.)
        self.assertEqual({row["modes [-]"] for row in self.rows(results, "counts")}, {float(n)})

    def test_no_parameters(self):
        self.write_system({}, flutter_terms()[:2])
        self.write("study.prm", STUDY.format(study="sensitivity", band=BAND))
        self.assert_message(self.call("study.prm", "--output", "refused"), ["parameters", "system.json"])

    def test_strict_files(self):
        """Matrix files with entries that a lenient reader would misread are rejected."""
        self.write("study.prm", STUDY.format(study="stability", band=BAND))
        head = "%%MatrixMarket matrix coordinate real "
        for text, mentions in ((head + "general\n2 2 2\n1 1 1.5D2\n2 2 1\n", ["line 3", "1.5D2"]), (head + "general\n2 2 1\n1 1 3,5\n", ["3,5"]),
                               (head + "general\n2 2 1\n1.5 1 3\n", ["1.5"]), (head + "general\n2 2 1\n1 1 3 4\n", ["value"]),
                               (head + "general\n2 2 1\n1 1 3\n2 2 1\n", ["exceeds 1"]), (head + "general\n2 2 3\n1 1 3\n2 2 1\n", ["contains only 2 of 3 entries"]),
                               (head + "symmetric\n2 2 1\n1 2 3\n", ["above the diagonal"]), (head + "general\n2 2 1\n0 1 3\n", ["row 0"]),
                               (head + "general\n2 2 -1\n", ["-1"]), (head + "general\n2000000000 2000000000 1\n1 1 3\n", ["2000000000"]),
                               (head.replace("real", "pattern") + "general\n2 2 1\n1 1\n", ["pattern"])):
            self.write("system/A0.mtx", text)
            self.assert_message(self.call("study.prm", "--output", "refused"), ["A0.mtx", *mentions])

    def test_broken_description(self):
        self.write("study.prm", STUDY.format(study="stability", band=BAND))
        good = self.write_system({"mu": (0.6, 0., 1.)}, flutter_terms()[:2])
        for change, mentions in (({"terms": None}, ["terms"]), ({"format": "other"}, ["version"]), ({"Terms": []}, ["`Terms`"]),
                                 ({"groups": {"all": [[1, 3]]}}, ["groups.all"]),
                                 ({"parameters": {"mu": {"value": 2, "lower": 0, "upper": 1}}}, ["parameters.mu"]),
                                 ({"parameters": {"2mu": {"value": 2}}}, ["2mu"]), ({"version": 1.5}, ["version"]),
                                 *(({"terms": [{**good["terms"][1], **entry}]}, mentions) for entry, mentions in (
                                     ({"power": 1.5}, ["terms[1].power"]), ({"coefficient": "0,5"}, ["terms[1].coefficient"]),
                                     ({"coefficient": "mu=0.5"}, ["assigns"]), ({"coefficient": "10^400"}, ["not finite"]), ({"left": "A0.mtx"}, ["terms[1].left"])))):
            self.write("system/system.json", json.dumps({**good, **change}))
            self.assert_message(self.call("study.prm", "--output", "refused"), mentions)
        self.write("system/points.mtx", matrix_text([[1., 2.]]))
        self.write("system/no_motion.mtx", matrix_text([[0., 0.]] * 3))
        self.write("system/one_point.mtx", matrix_text([[1., 2., 3.]]))
        self.write("system/infinite.mtx", matrix_text([[1., math.inf, 3.]]))
        for change, mentions in (({"positions": "points.mtx"}, ["positions", "1 x 2"]), ({"positions": "one_point.mtx"}, ["3 displacements", "number of dofs is 2"]),
                                 ({"positions": "infinite.mtx"}, ["infinite.mtx", "row 1 and column 2"]), ({"positions": 1}, ["entry positions"]),
                                 ({"positions": "one_point.mtx", "displacements": "A0.mtx"}, ["displacements", "2 x 2, not 3 x 2"]),
                                 ({"positions": "one_point.mtx", "displacements": "no_motion.mtx"}, ["displacements", "zero"]),
                                 ({"positions": "missing.mtx"}, ["missing.mtx"]), ({"displacements": "A0.mtx"}, ["add `positions`"])):
            self.write("system/system.json", json.dumps({**good, **change}))
            self.assert_message(self.call("study.prm", "--output", "refused"), mentions)
        self.write("system/system.json", json.dumps(good).replace('"power"', '"power": 1, "power"', 1))
        self.assert_message(self.call("study.prm", "--output", "refused"), ["`power`", "twice"])
        self.write("system/system.json", "{")
        self.assert_message(self.call("study.prm", "--output", "refused"), ["JSON"])
        self.write("system/system.json", json.dumps(good))
        self.write("system/A0.mtx", "2 2\n")
        self.assert_message(self.call("study.prm", "--output", "refused"), ["A0.mtx", "header"])


@unittest.skipUnless(HAS_NUMPY, "needs NumPy")
class Brake(SystemTest):
    """A system with the terms of a brake: M, D1, D_R / omega, omega D_G, K1, K_R, omega^2 K_geo."""

    N = 60

    def setUp(self):
        rng = np.random.default_rng(1)
        n = self.N
        band = np.abs(np.subtract.outer(np.arange(n), np.arange(n))) <= 4

        def random(scale):
            return scale * band * rng.standard_normal((n, n))

        G, K_R, K_geo = random(0.02), random(2.), random(0.02)
        self.K1 = np.diag(30. + 10. * np.arange(n)) - 4. * (np.eye(n, k=1) + np.eye(n, k=-1))
        self.M = np.eye(n) + 0.1 * (np.eye(n, k=1) + np.eye(n, k=-1))
        self.terms = [(2, "1", self.M, "symmetric"), (1, "1", 1e-4 * self.K1, "symmetric"), (1, "1/omega", 0.05 * np.eye(n), "symmetric"),
                      (1, "omega", G - G.T, "skew"), (0, "1", self.K1, "symmetric"), (0, "1", K_R, "none"),
                      (0, "omega^2", K_geo + K_geo.T, "symmetric")]

    def eigenvalues(self, omega, scale=None, band=BAND):
        """λ in the band with Im λ > 0, from the dense companion form."""
        matrices = [np.zeros((self.N, self.N)) for _ in range(3)]
        for power, coefficient, A, _ in self.terms:
            matrices[power] += eval(coefficient.replace("^", "**"), {"omega": omega}) * A  # trusted input from setUp()
        K, C, M = matrices
        companion = np.block([[np.zeros_like(K), np.eye(self.N)], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])
        values = np.linalg.eigvals(companion)
        return sorted((value for value in values if 1e-6 < value.imag <= 2. * math.pi * band), key=lambda value: value.imag)

    def assert_same(self, found, expected, tolerance):
        self.assertEqual(len(found), len(expected))
        for value in expected:
            self.assertLess(min(abs(value - other) for other in found), tolerance * abs(value))

    def test_eigenvalues(self):
        self.write_system({"omega": (2., 1., 4.)}, self.terms)
        for omega in (1., 2., 4.):
            for solver in ("Krylov", "residual iteration"):
                found = self.lambdas(self.study("stability", f"System values=omega = {omega}", f"Complex modes/Solver={solver}",
                                                "Complex modes/Iteration tolerance=1e-10"))
                self.assert_same(found, self.eigenvalues(omega), 1e-8)

    def test_accuracy(self):
        """Tables of definite systems contain backward errors, condition numbers and error estimates of λ, which are at most 10
        times too small."""
        self.write_system({"omega": (2., 1., 4.)}, self.terms)
        results, exact = self.study("stability"), self.eigenvalues(2.)
        for row, value in zip(self.rows(results, "complex_modes"), self.lambdas(results)):
            self.assertLess(row["backward error [-]"], 1e-12)
            self.assertGreater(row["condition number [-]"], 1. - 1e-9)
            self.assertLess(row["error of lambda [-]"], 1e-9)
            self.assertLess(min(abs(value - other) for other in exact), (10. * row["error of lambda [-]"] + 1e-10) * abs(value))

    def test_reduction(self):
        """First-order responses and responses to damping each reduce the error of a basis by a factor of at least 1000."""
        self.write_system({"omega": (2., 1., 4.)}, self.terms)
        results = self.study("reduction", "Reduction/Snapshots=1, 2.5, 4", "Reduction/Grown tolerances=1e-4, 1e-7")
        bases = {row["basis"]: row for row in self.rows(results, "reduction_bases")}
        order = ["real", "real + 1st-ord.", "real + 1st-ord. two-sided", "real + 1st-ord. two-sided + damping"]
        self.assertEqual(list(bases), [*order, "POD", "residual-grown 0.0001", "residual-grown 1e-07"])
        errors = {basis: max(row["lambda [-]"] for row in self.rows(results, "reduction_errors") if row["basis"] == basis) for basis in bases}
        for worse, better, factor in zip(order, order[1:], (1e-3, 1.1, 1e-3)):
            self.assertLess(errors[better], factor * errors[worse])
            self.assertGreaterEqual(bases[better]["n_r [-]"], bases[worse]["n_r [-]"])
        self.assertLess(errors["POD"], 1e-6)
        self.assertLess(errors["residual-grown 0.0001"], 1e-3)
        self.assertLess(errors["residual-grown 1e-07"], 1e-6)
        exact = self.eigenvalues(2.)
        for row in self.rows(results, "reduction_modes"):
            reference = complex(0.02 * math.pi * row["reference divergence rate [%]"] * row["reference frequency [Hz]"],
                                2. * math.pi * row["reference frequency [Hz]"])
            self.assertLess(min(abs(reference - value) for value in exact), 1e-8 * abs(reference))
        self.assert_message(self.call("study.prm", "--output", "refused", "--set", "Reduction/Bases=POD"), ["range of omega", "Snapshots"])

    def test_sweep(self):
        self.write_system({"omega": (2., 1., 4.)}, self.terms)
        results = self.study("sweep", "Sweep/Parameter=omega, 1, 4, 13", "Sweep/Complex plane at=1, 2.5, 4", "Sweep/Count modes at=1, 2.5")
        self.assertTrue(all(row["estimated error of lambda [-]"] <= 1e-6 for row in self.rows(results, "branches")))
        plane = self.rows(results, "complex_plane")
        for omega in (1., 2.5, 4.):
            found = [complex(row["growth rate [1/s]"], 2. * math.pi * row["frequency [Hz]"]) for row in plane if row["omega [-]"] == omega]
            self.assert_same(found, self.eigenvalues(omega), 1e-6)
        for row in self.rows(results, "argument_counts"):
            self.assertEqual(row["modes of the sweep [-]"], row["modes counted [-]"])

    def test_derivatives(self):
        self.write_system({"omega": (2., 1., 4.)}, self.terms)
        h = 1e-4
        rows = self.rows(self.study("sensitivity"), "sensitivities")
        before, at, after = (np.array(self.eigenvalues(omega)) for omega in (2. - h, 2., 2. + h))
        self.assertEqual(len(rows), len(at))
        for row in rows:
            j = np.argmin(abs(at - complex(row["growth rate [1/s]"], 2. * math.pi * row["frequency [Hz]"])))
            expected = (after[j] - before[j]) / (2. * h)
            found = complex(row["growth rate per unit [1/s]"], 2. * math.pi * row["frequency per unit [Hz]"])
            self.assertLess(abs(found - expected), 1e-5 * max(abs(expected), 1e-2 * abs(at[j])))

    def test_units(self):
        """Eigenvalues depend neither on the units of dofs, over 14 decades, nor on a massless dof on a spring."""
        reference = self.eigenvalues(2.)
        d = 10. ** np.linspace(-7., 7., self.N)
        scaled = [(power, coefficient, d[:, None] * A * d, symmetry) for power, coefficient, A, symmetry in self.terms]
        with_massless = [(power, coefficient, np.block([[A, np.zeros((self.N, 1))], [np.zeros((1, self.N)), np.full((1, 1), 7. if k == 4 else 0.)]]), symmetry)
                         for k, (power, coefficient, A, symmetry) in enumerate(self.terms)]
        for terms in (scaled, with_massless):
            self.write_system({"omega": (2., 1., 4.)}, terms)
            self.assert_same(self.lambdas(self.study("stability")), reference, 1e-8)


class RoundTrip(SystemTest):
    """A system written by a run on a mesh gives the same results as the mesh."""

    def system_of(self, folder):
        self.write("again.prm", STUDY.format(study="stability", band=5000).replace("= system\n", f"= {folder}/system\n"))
        return self.run_scene("again", file="again.prm")

    def assert_read_back(self, folder, expected, tolerance=SAME):
        """Checks the eigenvalues of a stability run of the system in a result folder."""
        again = self.lambdas(self.system_of(folder))
        self.assertEqual(len(again), len(expected))
        for value, other in zip(again, expected):
            self.assertLess(abs(value - other), tolerance * abs(other))

    def test_full(self):
        for name, overrides in (("plain", []), ("damped", ["Operation/Radial dissipation=consistent", "Operation/Friction slope=-0.02"]),
                                ("modal", ["Damping/Modal damping ratio=1: 0.001, 10000: 0.001"]),
                                ("turning", ["Operation/Gyroscopic forces=true", "Pin material/Rayleigh beta=1e-7"])):
            with self.subTest(name):
                results = self.run_scene("mesh", "Output/Write system=full", *overrides)
                self.assert_read_back("mesh", self.lambdas(results))

    def test_shapes(self):
        """Free nodes become points with displacements, and bodies become groups."""
        results = self.run_scene("mesh", "Output/Write system=full", "Output/Mode shapes=all", "Output/Real mode shapes=true")
        again = self.run_scene("again", "Output/Mode shapes=all", "Output/Real mode shapes=true", "System=mesh/system")
        for name, field in (("complex_*", "displacement_real"), ("complex_*", "amplitude"), ("real_*", "amplitude")):
            of_mesh = [path for path in sorted((results / "modes").glob(name + ".vtu")) if not path.stem.endswith("_contact")]
            of_points = sorted((again / "modes").glob(name + ".vtu"))
            self.assertEqual(len(of_points), len(of_mesh))
            mesh, points = VtuFile(of_mesh[3]), VtuFile(of_points[3])
            self.assertEqual(set(points.cell_types), {1})
            values, places = np.array(mesh.fields[field]), {}
            body = {vertex: component for cell, component in zip(mesh.cells, mesh.cell_fields["component"]) for vertex in cell}
            for vertex, place in enumerate(mesh.points):
                places[(*np.round(place, 7), body[vertex])] = values[vertex]
            self.assertGreater(len(points.points), 0.9 * len(mesh.points))
            found = np.array(points.fields[field])
            expected = np.array([places[(*np.round(place, 7), component)] for place, component in zip(points.points, points.cell_fields["component"])])
            sign = np.sign(np.sum(found * expected))
            if name == "real_*" or field == "amplitude":
                self.assertLess(abs(found - expected).max(), 1e-3)
            else:
                self.assertLess(abs(sign * found - expected).max(), 1e-3)
        self.assertTrue((again / "modes.pvd").is_file() and (again / "real_modes.pvd").is_file())
        rows = self.rows(again, "complex_modes")
        bodies = [column for column in rows[0] if column.startswith("kinetic energy of ")]
        self.assertEqual(len(bodies), 5)
        for row in rows:
            self.assertAlmostEqual(sum(row[column] for column in bodies), 100., places=3)

    def test_processes(self):
        """Two processes write and read the same points and groups as one process."""
        self.run_scene("mesh", "Output/Write system=full")
        self.run_scene("mesh_2", "Output/Write system=full", n_processes=2)
        found = [self.run_scene(f"again_{n}", "Output/Mode shapes=all", f"System={mesh}/system", n_processes=n) for n, mesh in ((1, "mesh"), (2, "mesh_2"))]
        for row, other in zip(*(self.rows(results, "complex_modes") for results in found)):
            self.assertLess(abs(row["frequency [Hz]"] - other["frequency [Hz]"]), 1e-7 * row["frequency [Hz]"])
            self.assertAlmostEqual(row["kinetic energy of disc [%]"], other["kinetic energy of disc [%]"], places=4)
        points, others = ({tuple(np.round(place, 7)): amplitude for place, amplitude in zip(mode.points, mode.fields["amplitude"])}
                          for mode in (VtuFile(sorted((results / "modes").glob("complex_*.vtu"))[3]) for results in found))
        self.assertEqual(set(points), set(others))

    def test_derivatives(self):
        """Derivatives agree between a run on the mesh and a run on the system written from it."""
        damping = ["Pin material/Rayleigh beta=1e-7", "Disc material/Rayleigh alpha=2", "Materials/Volumes=pin_top_1: 2e9, 0.25, 3000",
                   "Operation/Gyroscopic forces=true", "Mounts/Dashpots=disc_bore: 0, 1e4, 1e4"]
        study = ["Study=sensitivity", "Sensitivity/Thresholds=false", "Sensitivity/Geometry=none", "Sensitivity/Tolerance=1e-10", "Sensitivity/Largest number of modes=3"]
        mesh = self.rows(self.run_scene("mesh_derivatives", *study, *damping), "sensitivities")
        self.run_scene("mesh", "Output/Write system=full", *damping)
        description = json.loads((self.folder / "mesh" / "system" / "system.json").read_text(encoding="utf-8"))
        self.write("again.prm", STUDY.format(study="sensitivity", band=5000).replace("= system\n", "= mesh/system\n"))
        again = self.rows(self.run_scene("again", file="again.prm"), "sensitivities")
        names = {"Pin material/Young modulus": "pin_young_modulus", "Disc material/Density": "disc_density", "Pin material/Density": "pin_density",
                 "Disc material/Young modulus": "disc_young_modulus", "Pin material/Rayleigh beta": "pin_rayleigh_beta",
                 "Disc material/Rayleigh alpha": "disc_rayleigh_alpha", "Operation/Friction coefficient": "mu",
                 "Operation/Rotation speed": "angular_velocity_of_the_disc", "Mounts/Elastic mounts: disc_bore axial": "axial_stiffness_disc_bore",
                 "Mounts/Dashpots: disc_bore tangential": "tangential_dashpots_disc_bore", "Materials/Volumes:/Density": "pin_top_1_density"}
        self.assertLessEqual(set(names.values()), set(description["parameters"]))
        compared = 0
        for row in mesh:
            name = names.get(row["parameter"])
            if name is None or row["body"] not in ("", "pin_top_1") or row["body"] and "Volumes" not in row["parameter"]:
                continue
            value, scale = (complex(row["growth rate [1/s]"], 2. * math.pi * row["frequency [Hz]"]), abs(row["value"]))
            rate = complex(row["growth rate per unit [1/s]"], 2. * math.pi * row["frequency per unit [Hz]"])
            others = [other for other in again if other["parameter"] == name]
            other = min(others, key=lambda other: abs(complex(other["growth rate [1/s]"], 2. * math.pi * other["frequency [Hz]"]) - value))
            found = complex(other["growth rate per unit [1/s]"], 2. * math.pi * other["frequency per unit [Hz]"])
            self.assertEqual(other["value"], row["value"])
            self.assertLess(abs(found - rate) * scale, 1e-8 * abs(value), (name, found, rate))
            compared += 1
        self.assertEqual(compared, 3 * len(names))

    def test_sweep(self):
        grid = ["Sweep/Number of friction coefficients=10"]
        mesh = self.run_scene("mesh", "Study=sweep", "Output/Write system=full", *grid)
        self.write("again.prm", STUDY.format(study="sweep", band=5000).replace("= system\n", "= mesh/system\n"))
        again = self.run_scene("again", *grid, file="again.prm")
        expected, found = self.rows(mesh, "thresholds"), self.rows(again, "thresholds")
        self.assertEqual(len(found), len(expected))
        for row, other in zip(found, expected):
            self.assertEqual((row["event"], row["mechanism"]), (other["event"], other["mechanism"]))
            self.assertLess(abs(row["mu [-]"] - other["mu [-]"]), row["uncertainty [-]"] + other["uncertainty [-]"])

    def test_other_studies(self):
        expected = self.lambdas(self.run_scene("mesh"))
        for study in (["reduction", "Reduction/Bases=free"], ["sensitivity", "Sensitivity/Geometry=none"],
                      ["robustness", "Robustness/Distributions=Pin material/Density = uniform 90 % to 110 %", "Robustness/Number of samples=10"]):
            self.run_scene("written", f"Study={study[0]}", *study[1:], "Output/Write system=full")
            self.assert_read_back("written", expected)

    def test_reduced_bases(self):
        """The reduced model written for each basis has the modes in the table of the study."""
        results = self.run_scene("bases", "Study=reduction", "Reduction/Bases=free, real, residual-grown", "Output/Write system=reduced")
        modes = self.rows(results, "reduction_modes")
        for number, basis in enumerate(self.rows(results, "reduction_bases"), 1):
            self.write("again.prm", STUDY.format(study="stability", band=5000).replace("= system\n", f"= bases/system_{number}\n"))
            again = self.rows(self.run_scene("again", file="again.prm"), "complex_modes")
            for row in modes:
                if row["basis"] == basis["basis"] and row["frequency [Hz]"] < 4900.:
                    differences = [max(abs(other["frequency [Hz]"] / row["frequency [Hz]"] - 1.), 0.01 * abs(other["divergence rate [%]"] - row["divergence rate [%]"]))
                                   for other in again]
                    self.assertLess(min(differences), 1e-10)

    @unittest.skipUnless(importlib.util.find_spec("scipy"), "needs SciPy")
    def test_independent_solver(self):
        """SciPy finds the eigenvalues of the run in the system read by the Python module."""
        results = self.run_scene("mesh", "Output/Write system=full", "Operation/Radial dissipation=consistent")
        system = squeal.System.read(results / "system")
        for value in self.lambdas(results)[::9]:
            found = system.solve(number=1, shift=1.0001 * value).eigenvalues
            self.assertLess(min(abs(value - other) for other in found), SAME * abs(value))

    def test_reduced(self):
        mesh = self.run_scene("mesh", "Study=sweep", "Output/Write system=reduced", "Sweep/Number of friction coefficients=10",
                              "Sweep/Last friction coefficient=0.5", "Sweep/Complex plane at=0.5")
        expected = [complex(row["growth rate [1/s]"], 2. * math.pi * row["frequency [Hz]"]) for row in self.rows(mesh, "complex_plane")]
        self.assert_read_back("mesh", expected, 1e-10)
        self.assertTrue((mesh / "system" / "basis.mtx").is_file())
