# SPDX-License-Identifier: GPL-3.0-or-later

"""squeal.System: reading, writing and solving systems; errors name file and entry of invalid systems."""

import json
import math
import pathlib
import sys
import tempfile
import unittest

import numpy as np
import scipy.integrate
import scipy.sparse as sparse

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
from squeal import Error, Parameter, System, Term, quadratic
from squeal.expressions import Expression

try:
    import pymor
except ImportError:
    pymor = None


def flutter(**more):
    """Two dofs of mass 1, coupled by friction: K = [[1, mu k], [-mu k, 2]]."""
    return System({"mu": Parameter(0.2, 0, 1, "-", "friction coefficient"), "k": Parameter(np.float64(1.5), np.int64(1), 2)}, [
        Term("mass", 2, matrix=np.eye(2), symmetry="symmetric", kind="body"),
        Term("stiffness", 0, matrix=np.diag([1.0, 2.0]), symmetry="symmetric", kind="body"),
        Term("friction", 0, "mu*k", left=np.eye(2), right=np.array([[0.0, -1.0], [1.0, 0.0]]), kind="friction"),
        *more.pop("terms", [])], **more)


def closed_form(mu, k):
    """λ of flutter(): λ² = -(3 ± sqrt(1 - 4 mu² k²)) / 2."""
    root = np.sqrt(complex(1 - 4 * (mu * k)**2))
    squares = np.array([-(3 + root) / 2, -(3 - root) / 2])
    return np.concatenate([np.sqrt(squares), -np.sqrt(squares)])


def chain(n):
    """A chain of masses and springs with gyroscopic, damping and nonsymmetric terms."""
    random = np.random.default_rng(3)
    stiffness = sparse.diags([2 * np.ones(n), -np.ones(n - 1), -np.ones(n - 1)], [0, 1, -1]) * 1e9
    upper = sparse.random(n, n, 0.01, random_state=3)
    return System({"mu": Parameter(0.3, 0, 1), "omega": Parameter(10.0, 5.0, 20.0)}, [
        Term("mass", 2, matrix=sparse.diags(1e-3 * random.uniform(1, 2, n)), symmetry="symmetric"),
        Term("gyroscopic", 1, "omega", matrix=1e-3 * (upper - upper.T), symmetry="skew"),
        Term("damping", 1, "1/omega", matrix=sparse.diags(random.uniform(0, 50, n)), symmetry="symmetric"),
        Term("stiffness", 0, matrix=stiffness, symmetry="symmetric"),
        Term("friction", 0, "mu", matrix=1e8 * upper)])


def distances(found, expected):
    """Relative distance of each computed eigenvalue from the nearest expected value."""
    return np.array([abs(expected - value).min() / abs(value) for value in found])


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def assert_rejected(self, action, *words):
        with self.assertRaises(Error) as caught:
            action()
        for word in words:
            self.assertIn(word, str(caught.exception))
        self.assertTrue(caught.exception.where and caught.exception.change)


class Expressions(unittest.TestCase):
    NAMES = ("mu", "omega", "lambda")

    def value(self, text, **values):
        return Expression(text, self.NAMES, "test")(values)

    def test_values_are_those_of_muparser(self):
        for text, expected in (("-mu^2", -0.09), ("2^3^2", 512.0), ("1/omega", 0.25), ("sin(_pi/6) + 1e1*mu", 3.5), ("mu*omega^-1", 0.075), ("abs(-mu)", 0.3),
                               ("log(exp(2))", 2.0), ("ln(omega)", math.log(4.0)), ("sqrt(omega)-lambda", -1.0), ("2*-mu", -0.6), ("tan(0)+cos(0)", 1.0)):
            self.assertAlmostEqual(self.value(text, mu=0.3, omega=4.0, **{"lambda": 3.0}), expected, places=14, msg=text)

    def test_anything_else_is_rejected(self):
        for text in ("mu**2", "__import__('os')", "mu.real", "f(mu)", "sin(mu, omega)", "mu if mu else 1", "", "mu omega", "1_000", "0x10", "(mu", "[mu]", "1j*1j", "mu;mu",
                     "lambda: 1", "mu < 1", "1e400"):
            with self.assertRaises(Error, msg=text):
                self.value(text, mu=1.0, omega=1.0)
        for text in ("kappa", "sin", "2*Mu"):
            with self.assertRaisesRegex(Error, "unknown", msg=text):
                self.value(text)

    def test_divisions_by_zero_in_a_range(self):
        ranges = {"mu": (0.0, 1.0), "omega": (0.0, 5.0), "lambda": (1.0, 2.0)}
        for text in ("1/mu", "1/(mu-0.3)", "1/(mu-0.3)^2", "mu^-2", "1/cos(omega)", "1/(mu-omega)", "mu^(1-2*mu)", "1/(lambda-lambda)", "1/0"):
            with self.assertRaisesRegex(Error, "divides by zero", msg=text):
                Expression(text, self.NAMES, "test").check_range(ranges)
        for text in ("1/lambda", "1/(mu^2-mu+1)", "1/(sin(omega)+2)", "mu^2/(1+mu)", "lambda^-mu", "1/(exp(mu)-mu)", "1/(2+mu-mu)", "1/sqrt(lambda)", "1/2^mu",
                     "2^(mu-0.5)"):
            Expression(text, self.NAMES, "test").check_range(ranges)


class Files(InFolder):
    def test_round_trip(self):
        system = flutter(groups={"disc": [[1, 1]], "pads": [[2, 2]]}, description="two dofs", positions=[[0.1, 1 / 3, 0.0], [0.0, 0.0, 1e-9]],
            displacements=sparse.csr_matrix(([1.0, 0.6], ([2, 3], [0, 1])), (6, 2)),
            terms=[Term("rotation", 1, "1e-3*mu", matrix=np.array([[0.0, 1 / 3], [-1 / 3, 0.0]]), symmetry="skew")],
            reduction={"basis": np.arange(6.0).reshape(3, 2) / 7, "tolerance": 1e-6, "points": [{"mu": 0.1, "error": 1e-9}]})
        system.write(self.folder / "s")
        for path in (self.folder / "s", self.folder / "s" / "system.json"):
            again = System.read(path)
            self.assertEqual((again.parameters, again.groups, again.description), (system.parameters, system.groups, "two dofs"))
            np.testing.assert_array_equal(again.positions, system.positions)
            np.testing.assert_array_equal(again.displacements.toarray(), system.displacements.toarray())
            for name in ("name", "power", "coefficient", "symmetry", "kind"):
                self.assertEqual([getattr(term, name) for term in again.terms], [getattr(term, name) for term in system.terms])
            for matrix, other in zip(again.matrices({"mu": 0.7}), system.matrices({"mu": 0.7})):
                np.testing.assert_array_equal(matrix.toarray(), other.toarray())
            np.testing.assert_array_equal(again.reduction["basis"], system.reduction["basis"])
            self.assertEqual(again.reduction["points"], system.reduction["points"])

    def test_points_without_a_speed(self):
        """An undefined speed (NaN) is written as an empty cell and read back as NaN."""
        flutter(reduction={"points": [{"mu": 0.1, "speed": math.nan}]}).write(self.folder)
        self.assertEqual((self.folder / "points.csv").read_text(encoding="utf-8"), "mu,speed\n0.1,\n")
        self.assertTrue(math.isnan(System.read(self.folder).reduction["points"][0]["speed"]))

    def test_random_matrices_come_back_to_the_last_bit(self):
        system = chain(40)
        system.write(self.folder)
        for matrix, other in zip(System.read(self.folder).matrices(), system.matrices()):
            self.assertEqual(abs(matrix - other).max(), 0.0)

    def test_bad_files(self):
        def damaged(change=None, file=None, text=None):
            flutter().write(self.folder)
            path = self.folder / "system.json"
            data = json.loads(path.read_text(encoding="utf-8"))
            if change:
                change(data)
                path.write_text(json.dumps(data), encoding="utf-8")
            if text is not None:
                (self.folder / file).write_text(text, encoding="utf-8")
            elif file:
                (self.folder / file).unlink()
            return lambda: System.read(self.folder)

        array = "%%MatrixMarket matrix array real general\n"
        self.assert_rejected(damaged(file="stiffness.mtx"), "stiffness.mtx is missing", "term `stiffness`, matrix")
        self.assert_rejected(damaged(file="stiffness.mtx", text="no matrix\n"), "stiffness.mtx cannot be read", "term `stiffness`")
        self.assert_rejected(damaged(file="stiffness.mtx", text=array + "3 3\n" + "1\n" * 9), "3 x 3, expected 2 x 2", "term `stiffness`, matrix")
        self.assert_rejected(damaged(file="stiffness.mtx", text=array + "2 2\n1\nnan\n0\n1\n"), "entry (2, 1) is nan", "term `stiffness`, matrix")
        self.assert_rejected(damaged(file="mass.mtx", text=array + "2 2\n1\n0\ninf\n1\n"), "entry (1, 2) is inf", "term `mass`")
        self.assert_rejected(damaged(file="stiffness.mtx", text=array + "2 2\n4\n1\n0\n4\n"), "not symmetric", "2.5e-01")
        self.assert_rejected(damaged(file="friction_weights.mtx", text=array + "3 1\n1\n1\n1\n"), "3 weights", "term `friction`")
        self.assert_rejected(damaged(lambda data: data["terms"][0].update(symmetry="skew")), "not skew", "term `mass`")
        self.assert_rejected(damaged(lambda data: data["terms"][0].update(symmetry="even")), "`even`", "symmetric, skew")
        self.assert_rejected(damaged(lambda data: data["terms"][2].update(coefficient="mu*(k")), "`mu*(k` is not an expression", "term `friction`, coefficient")
        self.assert_rejected(damaged(lambda data: data["terms"][2].update(coefficient="nu*k")), "`nu`, which is unknown", "system.json, term `friction`")
        self.assert_rejected(damaged(lambda data: data["terms"][2].update(coefficient="k/mu")), "divides by zero near mu = 0, within", "term `friction`")
        self.assert_rejected(damaged(lambda data: data["terms"][2].update(power=3)), "power 3 is invalid", "term `friction`")
        self.assert_rejected(damaged(lambda data: data["terms"][2].pop("right")), "both factors", "term `friction`")
        self.assert_rejected(damaged(lambda data: data["terms"][2].update(colour="red")), "`colour` is unknown", "term `friction`")
        self.assert_rejected(damaged(lambda data: data["parameters"]["mu"].update(value=2)), "outside the range", "parameter `mu`")
        self.assert_rejected(damaged(lambda data: data["parameters"]["mu"].update(value="x")), "not a finite number", "parameter `mu`")
        self.assert_rejected(damaged(lambda data: data.update(groups={"disc": [[1, 3]]})), "`disc`", "1 to 2")
        self.assert_rejected(damaged(lambda data: data.update(groups={"disc": [["1", "2"]]})), "`disc`", "1 to 2")
        self.assert_rejected(damaged(lambda data: data["terms"][2].update(power=1.0)), "power 1.0 is invalid", "term `friction`")
        self.assert_rejected(damaged(lambda data: data["terms"][2].pop("power")), "`power` is missing", "term `friction`")
        self.assert_rejected(damaged(lambda data: data.update(terms={})), "write a list", "terms")
        self.assert_rejected(damaged(lambda data: data.update(terms=[])), "no terms", "system.json")
        self.assert_rejected(damaged(lambda data: data.update(version=2)), "version 1", "system.json")
        self.assert_rejected(damaged(lambda data: data.update(positions="p.mtx")), "p.mtx is missing")
        self.assert_rejected(damaged(lambda data: data.update(positions="p.mtx"), "p.mtx", array + "1 2\n1\n2\n"), "not an n x 3 matrix", "positions")
        self.assert_rejected(damaged(lambda data: data.update(positions="p.mtx"), "p.mtx", array + "1 3\n1\n2\n3\n"), "expected 3 x 2", "displacements")
        self.assert_rejected(damaged(lambda data: data.update(displacements="mass.mtx")), "without `positions`", "displacements")
        self.assert_rejected(damaged(file="system.json", text='{"format": 1, "format": 2}'), "`format` appears twice")
        self.assert_rejected(damaged(file="system.json"), "missing", "system.json")


class Values(InFolder):
    def test_values_and_coefficients(self):
        system = flutter()
        self.assertEqual(system.values({"mu": 0.5}), {"mu": 0.5, "k": 1.5})
        self.assertEqual(system.coefficient("friction", {"mu": 0.5}), 0.75)
        self.assertEqual(system.coefficient(system.terms[2]), 0.2 * 1.5)
        np.testing.assert_allclose(system.K({"mu": 0.5, "k": 2.0}), [[1.0, 1.0], [-1.0, 2.0]])
        np.testing.assert_allclose(system.Q(2j, {"mu": 0.0}).toarray(), [[-3.0, 0.0], [0.0, -2.0]])
        self.assert_rejected(lambda: system.values({"nu": 1.0}), "no parameter `nu`", "mu, k")
        self.assertEqual(system.values({"mu": np.float32(0.5), "k": np.int64(2)}), {"mu": 0.5, "k": 2.0})
        self.assert_rejected(lambda: system.values({"mu": "0.5"}), "mu = '0.5'", "not a number")
        self.assert_rejected(lambda: system.K({"mu": 1.5}), "mu = 1.5", "outside the range 0 to 1")
        self.assert_rejected(lambda: system.coefficient("mount"), "no term `mount`", "friction")


class Solutions(InFolder):
    def test_closed_form(self):
        for mu in (0.0, 0.2, 0.5, 1.0):
            found = flutter().solve({"mu": mu})
            expected = closed_form(mu, 1.5)
            self.assertEqual(len(found), 4)
            self.assertLess(distances(found.eigenvalues, expected).max(), 1e-14)
            self.assertLess(distances(expected, found.eigenvalues).max(), 1e-14)
            self.assertLess(found.backward_errors.max(), 1e-14)
            for value, vector in zip(found.eigenvalues, found.vectors.T):
                self.assertLess(np.linalg.norm(flutter().Q(value, {"mu": mu}) @ vector), 1e-13)

    def test_linearised_pencil(self):
        system = flutter()
        A, B = (matrix.toarray() for matrix in system.linearise({"mu": 0.6}))
        self.assertLess(distances(np.linalg.eigvals(np.linalg.solve(B, A)), closed_form(0.6, 1.5)).max(), 1e-14)

    def test_large_system_agrees_with_dense_companion(self):
        system = chain(quadratic.DENSE_SIZE + 50)
        A, B = (matrix.toarray() for matrix in system.linearise())
        n = system.size
        scale = 1e6  # scale of λ that balances both halves of the state vector
        A[:n, n:], A[n:, :n] = A[:n, n:] * scale, A[n:, :n] / scale
        expected = np.linalg.eigvals(np.linalg.solve(B, A))
        bounds = {"number": 12, "largest": 4e5, "region": ((-1500.0, 100.0), (2e5, 6e5))}
        (a, b), (c, d) = bounds["region"]
        counts = {"number": 12, "largest": int((abs(expected) <= 4e5).sum()),
                  "region": int(((expected.real >= a) & (expected.real <= b) & (expected.imag >= c) & (expected.imag <= d)).sum())}
        for name, bound in bounds.items():
            found = system.solve(**{name: bound})
            self.assertEqual(len(found), counts[name], name)
            self.assertGreater(len(found), 5, name)
            self.assertLess(distances(found.eigenvalues, expected).max(), 1e-9, name)
            self.assertLess(found.backward_errors.max(), 1e-12, name)
        found = system.solve(number=4, shift=3e5j)
        np.testing.assert_allclose(np.sort_complex(found.eigenvalues), np.sort_complex(expected[np.argsort(abs(expected - 3e5j))[:4]]), rtol=1e-9)

    def test_double_eigenvalues(self):
        n = quadratic.DENSE_SIZE + 1
        values = np.repeat(np.arange(1.0, n), 2)[:n]
        system = System({}, [Term("M", 2, matrix=sparse.identity(n)), Term("K", 0, matrix=sparse.diags(values**2))])
        found = system.solve(region=((-1.0, 1.0), (0.5, 5.5)))
        np.testing.assert_allclose(found.eigenvalues.imag, np.repeat(np.arange(1.0, 6.0), 2), rtol=1e-10)
        self.assertEqual(np.linalg.matrix_rank(found.vectors, tol=1e-6), 10)

    def test_singular_mass(self):
        """A massless dof is condensed: K = [[2, -1], [-1, 1]] and mass 1 at the first dof give ω² = 1."""
        system = System({}, [Term("M", 2, matrix=np.diag([1.0, 0.0])), Term("K", 0, matrix=np.array([[2.0, -1.0], [-1.0, 1.0]]))])
        np.testing.assert_allclose(np.sort_complex(system.solve().eigenvalues), [-1j, 1j], atol=1e-14)

    def test_systems_without_answer(self):
        def pencil(M, K):
            return System({}, [Term("M", 2, matrix=M), Term("K", 0, matrix=K)]).solve

        one, zero = np.eye(2), np.zeros((2, 2))
        self.assert_rejected(pencil(zero, one), "mass is zero")
        self.assert_rejected(pencil(np.diag([1.0, 0.0]), np.diag([1.0, 0.0])), "row 2", "det Q")
        self.assert_rejected(pencil(np.ones((2, 2)), np.ones((2, 2))), "singular")
        self.assert_rejected(chain(quadratic.DENSE_SIZE + 1).solve, "only up to", "region")
        n = quadratic.DENSE_SIZE + 1
        column = sparse.csc_matrix(np.sin(np.arange(n) + 1.0).reshape(-1, 1))
        other = sparse.identity(n) - column @ column.T / (column.T @ column)[0, 0]
        large = System({}, [Term("M", 2, matrix=other), Term("K", 0, matrix=3.0 * other)])
        self.assert_rejected(lambda: large.solve(number=3), "singular")
        self.assert_rejected(lambda: flutter().solve(number=1, largest=2.0), "mutually exclusive")

    def test_time_integration_shows_the_growth_rate(self):
        """In a time integration of M, C and K by SciPy, the amplitude grows with the rate Re λ."""
        system, p = flutter(), {"mu": 0.4}
        M, C, K = system.M(p), system.C(p), system.K(p)
        rate = closed_form(0.4, 1.5).real.max()
        found = scipy.integrate.solve_ivp(lambda t, z: np.concatenate([z[2:], -np.linalg.solve(M, C @ z[2:] + K @ z[:2])]), (0, 80), [1.0, 0, 0, 0],
                                          rtol=1e-9, atol=1e-12, t_eval=[60.0, 80.0])
        size = np.linalg.norm(found.y[:, 1]) / np.linalg.norm(found.y[:, 0])
        self.assertAlmostEqual(math.log(size) / 20, rate, delta=0.05 * rate)

    def test_pymor(self):
        if pymor is None:
            self.assert_rejected(flutter().to_pymor, "pyMOR cannot be imported", "install pyMOR")
            return
        model = flutter().to_pymor()
        matrix = model.K.assemble(model.parameters.parse({"mu": 0.6, "k": 1.5})).matrix
        np.testing.assert_allclose(matrix.toarray() if sparse.issparse(matrix) else matrix, flutter().K({"mu": 0.6}))
        self.assertLess(distances(model.poles(mu={"mu": 0.6, "k": 1.5}), closed_form(0.6, 1.5)).max(), 1e-12)


if __name__ == "__main__":
    unittest.main()
