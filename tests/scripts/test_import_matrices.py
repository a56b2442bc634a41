# SPDX-License-Identifier: GPL-3.0-or-later

"""scripts/import_matrices.py: matrices in all formats give the same system; ambiguous input is rejected."""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import scipy.io
import scipy.sparse as sparse

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "scripts" / "import_matrices.py"
sys.path.insert(0, str(ROOT / "python"))
from squeal import System
from squeal.importing.system_import import import_system

try:
    import h5py
except ImportError:
    h5py = None
try:
    import pyNastran
except ImportError:
    pyNastran = None

NODES = (11, 12, 20)
LABELS = [(node, dof) for node in NODES for dof in (1, 2, 3)]


def matrices():
    """M and K symmetric, G skew, R nonsymmetric: 9 x 9, for three nodes with three dofs."""
    random = np.random.default_rng(1)
    sparse_part = random.random((9, 9)) * (random.random((9, 9)) < 0.4)
    return {"M": np.diag(random.uniform(1, 2, 9)) + 0.01 * (sparse_part + sparse_part.T), "K": 1e6 * (np.diag(np.arange(1.0, 10)) + sparse_part + sparse_part.T),
            "G": sparse_part - sparse_part.T, "R": 1e3 * sparse_part}


TERMS = {"M": {"power": 2, "symmetry": "symmetric"}, "G": {"power": 1, "coefficient": "omega", "symmetry": "skew"},
         "K": {"power": 0, "symmetry": "symmetric"}, "R": {"power": 0, "coefficient": "mu/omega"}}


def abaqus(matrix, half, of=lambda row: f"{LABELS[row][0]},{LABELS[row][1]}"):
    """Text of *MATRIX OUTPUT; `half`: only one triangle of a symmetric matrix."""
    return "".join(f"{of(i)}, {of(j)}, {matrix[i, j]:.17e}\n" for i in range(9) for j in range(9) if matrix[i, j] and (j <= i or not half))


def nastran(name, matrix, form, large):
    """DMIG cards in double precision; form 6 is symmetric and contains one triangle."""
    star, width = ("*", 16) if large else ("", 8)
    lines = [f"{'DMIG':8}{name:8}{0:8}{form:8}{2:8}{0:8}{'':8}{'':8}{9 if form != 6 else '':8}"]
    for j, (node, dof) in enumerate(LABELS):
        rows = [i for i in range(9) if matrix[i, j] and (i >= j or form != 6)]
        for count, i in enumerate(rows):
            number = f"{matrix[i, j]:.9E}".replace("E", "D") if large else f"{matrix[i, j]:.7g}"[:8]
            if count == 0:
                first = [f"DMIG{star}".ljust(8), name.ljust(width), f"{node:{width}}", f"{dof:{width}}", " " * width]
                lines.append("".join(first) + ("\n*       " if large else "") + f"{LABELS[i][0]:{width}}{LABELS[i][1]:{width}}{number:>{width}}")
            else:
                lines.append(star.ljust(8) + f"{LABELS[i][0]:{width}}{LABELS[i][1]:{width}}{number:>{width}}")
    return "\n".join(lines) + "\n"


class ImportMatrices(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder, self.matrices = pathlib.Path(folder.name), matrices()

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")

    def call(self, files, more=None, **of_terms):
        """Finished process of an import; `of_terms`: additional entries of the terms."""
        terms = [{"name": name, **TERMS[name], **source, **of_terms.get(name, {})} for name, source in files.items()]
        config = {"parameters": {"omega": {"value": "4*_pi", "lower": "2*_pi", "upper": "8*_pi", "unit": "rad/s"}, "mu": {"value": 0.5}}, "terms": terms,
                  **(more or {})}
        self.write("config.json", json.dumps(config))
        return subprocess.run([sys.executable, "-B", SCRIPT, self.folder / "config.json", "--output", self.folder / "system"], capture_output=True, text=True)

    def assert_imported(self, files, tolerance=0.0, more=None, **of_terms):
        process = self.call(files, more, **of_terms)
        self.assertEqual(process.returncode, 0, process.stdout + process.stderr)
        system = System.read(self.folder / "system")
        for term in system.terms:
            expected = self.matrices[term.name]
            self.assertLessEqual(abs(term.matrix.toarray() - expected).max(), tolerance * abs(expected).max(), term.name)
        return system, process.stdout

    def assert_rejected(self, files, *words, **of_terms):
        process = self.call(files, **of_terms)
        self.assertEqual(process.returncode, 1, process.stdout)
        for word in (*words, "where:", "change:"):
            self.assertIn(word, process.stderr)
        self.assertFalse((self.folder / "system").exists())

    def test_matlab(self):
        scipy.io.savemat(self.folder / "all.mat", {name: sparse.csc_matrix(matrix) if name != "K" else matrix for name, matrix in self.matrices.items()})
        files = {name: {"file": "all.mat", "variable": name} for name in TERMS}
        system, said = self.assert_imported(files)
        self.assertIn("9 dofs, 4 terms", said)
        self.assertEqual(system.values(), {"omega": 4 * np.pi, "mu": 0.5})
        self.assertEqual(system.coefficient("R"), 0.5 / (4 * np.pi))
        self.assertNotIn("note", said)
        _, said = self.assert_imported(files, M={"symmetry": "none"}, G={"symmetry": "none"})
        self.assertIn("term `M` is symmetric", said)
        self.assertIn("term `G` is skew", said)
        self.assert_rejected_again({**files, "K": {"file": "all.mat"}}, "several matrices", "G, K, M, R")
        self.assert_rejected_again({**files, "K": {"file": "all.mat", "variable": "KK"}}, "no matrix `KK`")
        self.assert_rejected_again({**files, "K": {"file": "none.mat"}}, "none.mat", "missing")
        self.assert_rejected_again(files, "not symmetric", "term `R`", R={"symmetry": "symmetric"})
        self.assert_rejected_again(files, "`omga`, which is unknown", G={"coefficient": "omga"})
        self.assert_rejected_again(files, "`powr` is unknown", "term 2", G={"powr": 1})

    def assert_rejected_again(self, files, *words, **of_terms):
        """assert_rejected() after removing the output folder of a previous success."""
        subprocess.run(["rm", "-rf", self.folder / "system"], check=True)
        self.assert_rejected(files, *words, **of_terms)

    def test_matlab_7_3(self):
        """Version 7.3 stores dense matrices by columns, and sparse matrices by columns in a group."""
        if h5py is None:
            self.write("all.mat", "MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + "\0\2IM" + 400 * " ")
            self.assert_rejected({"M": {"file": "all.mat"}}, "version 7.3", "h5py")
            return
        with h5py.File(self.folder / "all.h5", "w") as file:
            file["M"] = self.matrices["M"].T
            columns = sparse.csc_matrix(self.matrices["R"])
            group = file.create_group("R")
            group["data"], group["ir"], group["jc"] = columns.data, columns.indices.astype("u8"), columns.indptr.astype("u8")
            group.attrs["MATLAB_sparse"] = np.uint64(9)
        head = b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\0\2IM"
        # HDF5 data begin after a block of 512 bytes
        (self.folder / "all.mat").write_bytes(head.ljust(512, b"\0") + (self.folder / "all.h5").read_bytes())
        self.assert_imported({name: {"file": "all.mat", "variable": name} for name in ("M", "R")})

    def test_numpy_matrix_market_harwell_boeing(self):
        np.save(self.folder / "M.npy", self.matrices["M"])
        sparse.save_npz(self.folder / "K.npz", sparse.csr_matrix(self.matrices["K"]))
        np.savez(self.folder / "more.npz", G=self.matrices["G"], other=np.eye(2))
        scipy.io.mmwrite(self.folder / "R.mtx", sparse.coo_matrix(self.matrices["R"]), precision=17)
        files = {"M": {"file": "M.npy"}, "K": {"file": "K.npz"}, "G": {"file": "more.npz", "variable": "G"}, "R": {"file": "R.mtx"}}
        self.assert_imported(files)
        scipy.io.hb_write(self.folder / "R.rua", sparse.csc_matrix(self.matrices["R"]))
        self.assert_imported({**files, "R": {"file": "R.rua"}}, 1e-12)
        self.assert_imported({**files, "R": {"file": "R.rua", "scale": "1/2"}, "M": {"file": "M.npy"}, "K": {"file": "K.npz"}}, 1.0)
        np.testing.assert_allclose(System.read(self.folder / "system").term("R").matrix.toarray(), self.matrices["R"] / 2, rtol=1e-12)
        self.assert_rejected_again({**files, "G": {"file": "more.npz", "variable": "other"}}, "2 x 2", "term `G`")
        self.write("R.what", "?")
        self.assert_rejected_again({**files, "R": {"file": "R.what"}}, "format", "harwell-boeing")
        self.write("R.rua", "?")
        self.assert_rejected_again({**files, "R": {"file": "R.rua"}}, "cannot be read", "R.rua")

    def test_abaqus(self):
        """Files with one triangle of symmetric matrices and rows given by node and dof; fixed dofs are removed."""
        for name, matrix in self.matrices.items():
            self.write(f"{name}.mtx", "** a comment\n" + abaqus(matrix, half=name in ("M", "K")))
        files = {name: {"file": f"{name}.mtx"} for name in self.matrices}
        system, _ = self.assert_imported(files, more={"groups": {"disc": {"nodes": [[10, 15]]}, "pad": [[7, 9]]}})
        self.assertEqual(system.groups, {"disc": [[1, 6]], "pad": [[7, 9]]})
        rows = (self.folder / "system" / "rows.csv").read_text(encoding="utf-8").splitlines()
        self.assertEqual(rows[:3] + rows[-1:], ["row,node,dof", "1,11,1", "2,11,2", "9,20,3"])
        self.assert_rejected_again(files, "one triangle", "K.mtx", K={"symmetry": "none"})
        # A fixed dof has the stiffness 1e36
        self.write("K.mtx", abaqus(self.matrices["K"], half=True) + "11,2,11,2,1e36\n")
        process = self.call({**files, "K": {"file": "K.mtx", "scale": 1e-3}})
        self.assertIn("on the diagonal) are omitted: 1\n", process.stdout)
        kept = [0, *range(2, 9)]
        np.testing.assert_array_equal(System.read(self.folder / "system").term("R").matrix.toarray(), self.matrices["R"][np.ix_(kept, kept)])
        self.write("K.mtx", abaqus(self.matrices["K"], half=True) + "11,2,11,2\n")
        self.assert_rejected_again(files, "K.mtx, line", "`11 2 11 2`")
        np.save(self.folder / "M.npy", self.matrices["M"])
        self.assert_rejected(dict(files, M={"file": "M.npy"}, K={"file": "G.mtx"}), "nodes and dofs", "same form")

    def test_places_of_nodes(self):
        for name in ("M", "K"):
            self.write(f"{name}.mtx", abaqus(self.matrices[name], half=True))
        self.write("model.inp", "*NODE\n" + "".join(f"{node}, {node}., 2., -3.\n" for node in NODES))
        system, _ = self.assert_imported({name: {"file": f"{name}.mtx"} for name in ("M", "K")}, more={"nodes": "model.inp", "unit": "mm"})
        self.assertEqual(list(system.positions[1]), [0.012, 0.002, -0.003])
        np.testing.assert_array_equal(system.displacements.toarray(), np.eye(9))

    def test_abaqus_coordinates(self):
        for name, matrix in self.matrices.items():
            self.write(f"{name}.mtx", abaqus(matrix, half=name == "M", of=lambda row: str(row + 1)).replace(",", " "))
        self.assert_imported({name: {"file": f"{name}.mtx"} for name in self.matrices})

    def test_nastran(self):
        cards = ["$ punched", nastran("MAAX", self.matrices["M"], 6, True), nastran("KAAX", self.matrices["K"], 6, True),
                 nastran("BAAX", self.matrices["G"], 1, True), nastran("RAAX", self.matrices["R"], 1, False)]
        self.write("model.pch", "\n".join(cards))
        names = {"M": "MAAX", "K": "KAAX", "G": "BAAX", "R": "RAAX"}
        files = {name: {"file": "model.pch", "variable": card} for name, card in names.items()}
        self.assert_imported(files, 1e-5)
        self.assert_imported({name: files[name] for name in ("M", "K", "G")}, 1e-9)
        self.write("model.pch", "\n".join(cards).replace(f"{'RAAX':8}{0:8}{1:8}{2:8}", f"{'RAAX':8}{0:8}{1:8}{4:8}"))
        self.assert_rejected_again(files, "type 4", "real matrix")

    def test_output4(self):
        if pyNastran is None:
            self.write("model.op4", "")
            self.assert_rejected({"M": {"file": "model.op4"}}, "pyNastran", "DMIG")
            return
        from pyNastran.op4.op4 import OP4
        OP4(debug=False).write_op4(str(self.folder / "model.op4"), {"MAA": (6, self.matrices["M"]), "RAA": (1, self.matrices["R"])}, is_binary=False)
        self.assert_imported({"M": {"file": "model.op4", "variable": "MAA"}, "R": {"file": "model.op4", "variable": "RAA"}}, 1e-12)

    def test_configuration_of_the_page(self):
        """The configuration in doc/python.md imports matrices of four dofs."""
        text, = re.findall(r"```yaml\n(.*?)```", (ROOT / "doc" / "python.md").read_text(encoding="utf-8"), flags=re.DOTALL)
        upper = np.triu(np.ones((4, 4)), 1)
        scipy.io.savemat(self.folder / "matrices.mat", {"M": np.eye(4), "G": upper - upper.T, "D": upper})
        sparse.save_npz(self.folder / "stiffness.npz", sparse.csr_matrix(np.diag([1.0, 2.0, 3.0, 4.0])))
        self.write("brake.yaml", text.replace("300", "3"))
        system, remarks, _ = import_system(self.folder / "brake.yaml")
        self.assertEqual((remarks, system.groups), ([], {"disc": [[1, 3]]}))
        np.testing.assert_allclose(system.C({"omega": 10.0}), 10.0 * (upper - upper.T) + upper / 10.0)
        np.testing.assert_allclose(system.K(), np.diag([1e3, 2e3, 3e3, 4e3]))

    def test_yaml(self):
        np.save(self.folder / "M.npy", self.matrices["M"])
        self.write("config.yaml", "# the mass\nterms:\n  - {file: M.npy, power: 2}\n")
        process = subprocess.run([sys.executable, "-B", SCRIPT, self.folder / "config.yaml", "--output", self.folder / "system"], capture_output=True, text=True)
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertEqual(System.read(self.folder / "system").terms[0].name, "M")


if __name__ == "__main__":
    unittest.main()
