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

    def pixels(self, name, size):
        reader = vtk.vtkPNGReader()
        reader.SetFileName(str(self.directory / name))
        reader.Update()
        self.assertEqual(reader.GetOutput().GetDimensions()[:2], size)
        return vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).astype(int).reshape(size[1], size[0], -1)

    @staticmethod
    def coloured(pixels):
        """Share of the pixels that are neither white, grey nor black."""
        return (pixels.max(axis=-1) - pixels.min(axis=-1) > 40).mean()

    def test_draws_bodies_on_white(self):
        result = self.render("--field", "amplitude")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        pixels = self.pixels("mode.png", (1600, 1000))
        self.assertGreater((pixels.min(axis=-1) > 250).mean(), 0.3)
        self.assertGreater(self.coloured(pixels), 0.15)

    def test_draws_several_side_by_side(self):
        annulus_mode.write(self.directory / "other.vtu", n_diameters=2, disc_cells=(4, 40, 1), pin_cells=(2, 2, 2))
        files = [self.directory / "other.vtu", self.directory / "mode.vtu"]
        result = self.render(*files, "-o", self.directory / "three.png", "--width", "800")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        pixels = self.pixels("three.png", (800, 565))
        # Rows count from below: two rows of modes above the colour bar, the last of the four places empty
        for row, column, is_there in ((1, 0, True), (1, 1, True), (0, 0, True), (0, 1, False)):
            place = pixels[70 + 250 * row:300 + 250 * row, 400 * column:400 * (column + 1)]
            self.assertEqual(self.coloured(place) > 0.1, is_there, (row, column))

    def test_bodies_at_rest_are_left_out(self):
        """Of a real mode in which the disc alone moves."""
        annulus_mode.write_real(self.directory / "real.vtu")
        pictures = []
        for bodies in ("all", "moving"):
            picture = self.directory / f"{bodies}.png"
            result = self.render(self.directory / "real.vtu", "--bodies", bodies, "-o", picture, "--width", "800")
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            pictures.append(self.pixels(f"{bodies}.png", (800, 315))[:, 400:])
        # The pins hide part of the disc
        self.assertGreater(self.coloured(pictures[1]), 1.02 * self.coloured(pictures[0]))

    def test_names_the_fields_there_are(self):
        result = self.render("--field", "pressure")
        self.assertEqual(result.returncode, 1)
        self.assertIn("no point field pressure", result.stderr)
        self.assertIn("amplitude", result.stderr)


if __name__ == "__main__":
    unittest.main()
