"""The code of doc/python.md runs, and prints what the page says; the section on runs is left to tests/program/test_python_module.py."""

import contextlib
import io
import os
import pathlib
import re
import sys
import tempfile
import unittest

import numpy as np
import scipy.io
import scipy.sparse

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
from squeal.importing.system_import import import_system


def blocks(is_of_runs):
    """Pairs of code and what the page says that it prints, or None."""
    before, runs = (ROOT / "doc" / "python.md").read_text(encoding="utf-8").split("\n## Runs\n")
    return re.findall(r"```python\n(.*?)```\n(?:\n```text\n(.*?)```)?", runs if is_of_runs else before, flags=re.DOTALL)


class PythonPage(unittest.TestCase):
    def test_code(self):
        names, found = {}, blocks(False)
        self.assertEqual(len(found), 4)
        with tempfile.TemporaryDirectory() as folder:
            before = os.getcwd()
            os.chdir(folder)
            try:
                for code, printed in found:
                    with contextlib.redirect_stdout(io.StringIO()) as output:
                        exec(compile(code, "doc/python.md", "exec"), names)
                    self.assertEqual(output.getvalue(), printed)
            finally:
                os.chdir(before)

    def test_configuration(self):
        """The configuration of the page imports matrices of four dofs."""
        text, = re.findall(r"```yaml\n(.*?)```", (ROOT / "doc" / "python.md").read_text(encoding="utf-8"), flags=re.DOTALL)
        upper = np.triu(np.ones((4, 4)), 1)
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            scipy.io.savemat(folder / "matrices.mat", {"M": np.eye(4), "G": upper - upper.T, "D": upper})
            scipy.sparse.save_npz(folder / "stiffness.npz", scipy.sparse.csr_matrix(np.diag([1.0, 2.0, 3.0, 4.0])))
            (folder / "brake.yaml").write_text(text.replace("300", "3"), encoding="utf-8")
            system, remarks, _ = import_system(folder / "brake.yaml")
        self.assertEqual((remarks, system.groups), ([], {"disc": [[1, 3]]}))
        np.testing.assert_allclose(system.C({"omega": 10.0}), 10.0 * (upper - upper.T) + upper / 10.0)
        np.testing.assert_allclose(system.K(), np.diag([1e3, 2e3, 3e3, 4e3]))


if __name__ == "__main__":
    unittest.main()
