# SPDX-License-Identifier: GPL-3.0-or-later

"""The installed program, moved to another folder."""

import os
import pathlib
import shutil
import subprocess
import sys

from program import EXECUTABLE, ProgramTest, eigenvalues

BUILD = pathlib.Path(EXECUTABLE).resolve().parent


class Installed(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        first, cls.prefix = cls.folder / "installed", cls.folder / "moved" / "elsewhere"
        subprocess.run(["cmake", "--install", BUILD, "--prefix", first], check=True, capture_output=True)
        cls.prefix.parent.mkdir()
        first.rename(cls.prefix)

    def squeal(self, *arguments):
        return subprocess.run([self.prefix / "bin" / "squeal", *arguments], cwd=self.folder, text=True, capture_output=True, timeout=300)

    def test_runs_from_another_place(self):
        for file in ("squeal/prm/disc_pins.prm", "doc/squeal/README.md", "doc/squeal/doc/install.md"):
            self.assertTrue((self.prefix / "share" / file).is_file(), file)
        process = self.squeal("scene.prm", "--output", "results")
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assert_same_eigenvalues(eigenvalues(self.folder / "results"), eigenvalues(self.run_scene("built")))

    def test_takes_its_own_geometries(self):
        """The installed program uses its own geometries instead of the source folder."""
        geometries = self.prefix / "share" / "squeal" / "geometry"
        shutil.copy(geometries / "disc_pins.geo", geometries / "of_the_house.geo")
        process = self.squeal("scene.prm", "--dry-run", "--set", "Geometry/File=of_the_house.geo")
        self.assertEqual(process.returncode, 0, process.stderr)
        (geometries / "disc_pad.geo").rename(self.folder / "disc_pad.hidden")
        process = self.squeal("scene.prm", "--dry-run", "--set", "Geometry/File=disc_pad.geo")
        self.assertEqual(process.returncode, 1)
        self.assertIn(str(geometries), process.stderr)

    def test_python_module(self):
        """The Python module finds the installed program, and the scripts find the module."""
        share = self.prefix / "share" / "squeal"
        code = 'import squeal; results = squeal.run("scene.prm", output="by_module"); print(len(results.table("complex_modes")), squeal.__file__)'
        environment = {name: value for name, value in os.environ.items() if name != "SQUEAL"}
        process = subprocess.run([sys.executable, "-B", "-c", code], cwd=self.folder, text=True, capture_output=True,
                                 env={**environment, "PYTHONPATH": str(share / "python")})
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertEqual(process.stdout.split(), [str(len(eigenvalues(self.folder / "by_module"))), str(share / "python" / "squeal" / "__init__.py")])
        process = subprocess.run([share / "scripts" / "plot_results.py", self.folder / "none"], text=True, capture_output=True)
        self.assertIn("there is no folder", process.stderr)
        for name, values in (("M", "1\n0\n0\n1"), ("K", "100\n-30\n-30\n80")):
            self.write(f"{name}.mtx", f"%%MatrixMarket matrix array real general\n2 2\n{values}\n")
        self.write("two.json", '{"terms": [{"file": "M.mtx", "power": 2}, {"file": "K.mtx", "power": 0}]}')
        process = subprocess.run([share / "scripts" / "import_matrices.py", "two.json", "--output", "two"], cwd=self.folder, text=True, capture_output=True)
        self.assertEqual(process.returncode, 0, process.stderr)
        self.write("two.prm", "set System = two\nsubsection Band\n  set Maximum frequency = 3\nend\n")
        process = self.squeal("two.prm", "--output", "of_matrices")
        self.assertEqual((process.returncode, len(eigenvalues(self.folder / "of_matrices"))), (0, 2), process.stderr)

    def test_takes_its_own_mesher(self):
        """Gmsh runs in the installed squeal_mesher."""
        mesher = self.prefix / "libexec" / "squeal" / "squeal_mesher"
        mesher.chmod(0o644)
        self.addCleanup(mesher.chmod, 0o755)
        process = self.squeal("scene.prm", "--dry-run")
        self.assertEqual(process.returncode, 1)
        self.assertIn(str(mesher), process.stderr)
