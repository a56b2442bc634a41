"""Tests of scripts/render_contact.py on an annulus with pins; skipped where VTK or a (virtual) screen is missing."""

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

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "render_contact.py"


@unittest.skipIf(vtk is None, "python3-vtk9 is not installed")
@unittest.skipUnless(os.environ.get("DISPLAY") or (shutil.which("xvfb-run") and shutil.which("xauth")), "xvfb is not installed")
class RenderContact(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.directory = pathlib.Path(temporary.name)
        annulus_mode.write(self.directory / "state.vtu", disc_cells=(4, 40, 1), pin_cells=(2, 2, 2))
        annulus_mode.write_contact(self.directory / "state_contact.vtu", pin_cells=(4, 4, 2))
        self.turn("positive")

    def turn(self, rotation):
        text = f"subsection Operation\n  set Rotation = {rotation}\nend\n"
        (self.directory / "parameters.prm").write_text(text, encoding="utf-8")

    def render(self, *arguments):
        return subprocess.run([sys.executable, SCRIPT, self.directory / "state_contact.vtu", *arguments], capture_output=True, text=True,
                              check=False)

    def picture(self, *arguments):
        """Pixels as rows from the lower edge, columns, and red, green and blue."""
        result = self.render(*arguments)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        reader = vtk.vtkPNGReader()
        reader.SetFileName(str(self.directory / "state_contact.png"))
        reader.Update()
        self.assertEqual(reader.GetOutput().GetDimensions()[:2], (1600, 1000))
        return vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).astype(int).reshape(1000, 1600, 3)

    def test_draws_faces_on_the_disc(self):
        for arguments in ([], ["--view", "below"], ["--field", "gap"]):
            with self.subTest(arguments):
                pixels = self.picture(*arguments)
                grey = (abs(pixels - 240) < 3).all(axis=2).mean()
                coloured = (pixels.max(axis=2) - pixels.min(axis=2) > 20).mean()
                self.assertGreater(grey, 0.2)
                self.assertGreater(coloured, 0.1)

    def test_pressure_is_largest_where_the_disc_enters(self):
        # Seen from above the disc slides to the left at the upper edge, which is outwards.
        blue, yellow = [], []
        faces = self.picture()[200:]
        for y, x in zip(*(faces.max(axis=2) - faces.min(axis=2) > 20).nonzero()):
            red, _, b = faces[y, x]
            (blue if b > red + 60 else yellow if red > b + 20 else []).append(x)
        self.assertGreater(min(len(blue), len(yellow)), 1000)
        self.assertGreater(sum(blue) / len(blue), sum(yellow) / len(yellow) + 10)

    def test_arrow_follows_the_rotation(self):
        # Its head is dark.
        centres = []
        for rotation, view in (("positive", "above"), ("negative", "above"), ("positive", "below")):
            self.turn(rotation)
            _, columns = (self.picture("--view", view)[600:900].max(axis=2) < 60).nonzero()
            centres.append(columns.mean())
        self.assertLess(centres[0], centres[1] - 10)
        self.assertGreater(centres[2], centres[0] + 10)

    def test_names_the_fields_there_are(self):
        result = self.render("--field", "heat")
        self.assertEqual(result.returncode, 1)
        self.assertIn("no point field heat", result.stderr)
        self.assertIn("pressure", result.stderr)

    def test_needs_the_files_beside(self):
        (self.directory / "parameters.prm").unlink()
        result = self.render()
        self.assertEqual(result.returncode, 1)
        self.assertIn("parameters.prm", result.stderr)
        (self.directory / "state.vtu").unlink()
        result = self.render()
        self.assertEqual(result.returncode, 1)
        self.assertIn("no file of disc and pins", result.stderr)


if __name__ == "__main__":
    unittest.main()
