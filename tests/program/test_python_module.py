# SPDX-License-Identifier: GPL-3.0-or-later

"""The Python module applied to a run of the program: tables, fields, plots and the code in doc/python.md."""

import contextlib
import io
import os
import re
import unittest
from unittest import mock

from program import EXECUTABLE, SOURCE, ProgramTest, read_table

import squeal
from squeal.vtu_file import VtuFile

try:
    import meshio
except ImportError:
    meshio = None


class PythonModule(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        with mock.patch.dict(os.environ, {"SQUEAL": EXECUTABLE}):
            cls.results = squeal.run(cls.folder / "scene.prm", {"Operation/Friction coefficient": 0.3, "Output/Mode shapes": "all"},
                                     output=cls.folder / "results")

    def test_tables(self):
        rows = read_table(self.folder / "results" / "complex_modes.csv")
        modes = self.results.modes
        self.assertEqual(modes["label"].tolist(), [row["label"] for row in rows])
        self.assertEqual(modes["frequency"].tolist(), [float(row["frequency [Hz]"]) for row in rows])
        self.assertEqual(modes.attrs["units"]["growth rate"], "1/s")
        self.assertEqual(float(self.results.parameter("Operation/Friction coefficient")), 0.3)
        self.assertEqual(self.results.record["counts"]["complex modes"], len(modes))

    def test_fields(self):
        name = next(name for name in self.results.field_names() if name.startswith("modes/complex") and not name.endswith("_contact"))
        if meshio is None:
            with self.assertRaises(ModuleNotFoundError):
                self.results.fields(name)
            return
        mesh, file = self.results.fields(name), VtuFile(self.folder / "results" / f"{name}.vtu")
        self.assertEqual(mesh.points.shape, (len(file.points), 3))
        self.assertEqual(sum(len(block.data) for block in mesh.cells), len(file.cells))
        self.assertEqual(mesh.point_data["displacement_real"].shape, (len(file.points), 3))
        self.assertEqual(len(mesh.cell_data["component"]), len(mesh.cells))

    def test_errors_are_those_of_the_program(self):
        with mock.patch.dict(os.environ, {"SQUEAL": EXECUTABLE}), self.assertRaises(squeal.Error) as caught:
            squeal.run(self.folder / "scene.prm", {"Operation/Friction coeficient": 0.3}, output=self.folder / "other")
        self.assertIn("Friction coefficient", str(caught.exception))
        self.assertNotIn("exit status", str(caught.exception))

    def test_plots(self):
        files, remarks = self.results.plot()
        self.assertEqual(([path.name for path in files], remarks), (["complex_plane.svg"], []))
        self.assertIn("plots/complex_plane.svg", squeal.Results(self.folder / "results").record["files [byte]"])

    def test_page(self):
        """The code in doc/python.md prints the output shown on the page; numbers are compared for Gmsh 4.8 only."""
        text = (SOURCE / "doc" / "python.md").read_text(encoding="utf-8")
        blocks = re.findall(r"```python\n(.*?)```\n\n```text\n(.*?)```", text, flags=re.DOTALL)
        self.assertEqual(len(blocks), text.count("```python"))
        (self.folder / "prm").symlink_to(SOURCE / "prm")
        names, before = {}, os.getcwd()
        self.addCleanup(os.chdir, before)
        os.chdir(self.folder)
        with mock.patch.dict(os.environ, {"SQUEAL": EXECUTABLE}):
            for code, printed in blocks:
                with contextlib.redirect_stdout(io.StringIO()) as output:
                    exec(compile(code, "doc/python.md", "exec"), names)
                texts = output.getvalue(), printed
                if not self.results.record["versions"]["Gmsh"].startswith("4.8"):
                    texts = tuple(re.sub(r" *[-+]?\d[\d.]*(?:e[-+]\d+)?", "#", text) for text in texts)
                self.assertEqual(*texts)


if __name__ == "__main__":
    unittest.main()
