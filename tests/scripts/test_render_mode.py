"""Tests of scripts/render_mode.py on an annulus with pins; skipped where VTK or a (virtual) screen is missing."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

try:
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    import annulus_mode
except ImportError:
    vtk = None

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "render_mode.py"


@unittest.skipIf(vtk is None, "python3-vtk9 is not installed")
@unittest.skipUnless(os.environ.get("DISPLAY") or (shutil.which("xvfb-run") and shutil.which("xauth")), "xvfb is not installed")
class RenderMode(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.directory = pathlib.Path(temporary.name)
        annulus_mode.write(self.directory / "mode.vtu", disc_cells=(4, 40, 1), pin_cells=(2, 2, 2))

    def render(self, *arguments):
        return subprocess.run([sys.executable, SCRIPT, self.directory / "mode.vtu", *arguments], capture_output=True, text=True, check=False)

    def test_draws_bodies_on_white(self):
        result = self.render("--field", "amplitude")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        reader = vtk.vtkPNGReader()
        reader.SetFileName(str(self.directory / "mode.png"))
        reader.Update()
        self.assertEqual(reader.GetOutput().GetDimensions()[:2], (1600, 1000))
        pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).astype(int)
        white = (pixels.min(axis=1) > 250).mean()
        coloured = (pixels.max(axis=1) - pixels.min(axis=1) > 40).mean()
        self.assertGreater(white, 0.3)
        self.assertGreater(coloured, 0.15)

    def test_names_the_fields_there_are(self):
        result = self.render("--field", "pressure")
        self.assertEqual(result.returncode, 1)
        self.assertIn("no point field pressure", result.stderr)
        self.assertIn("amplitude", result.stderr)


if __name__ == "__main__":
    unittest.main()
