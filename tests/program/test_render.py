# SPDX-License-Identifier: GPL-3.0-or-later

"""Pictures by scripts/render_mode.py, which requires VTK and a (virtual) display, and scripts/render_contact.py."""

import importlib.util
import os
import shutil
import subprocess
import sys
import unittest

from program import SOURCE, ProgramTest

try:
    import matplotlib.image
except ImportError:
    matplotlib = None


def coloured(pixels):
    """True for pixels that are neither white, grey nor black."""
    return pixels.max(axis=-1) - pixels.min(axis=-1) > 20


@unittest.skipIf(matplotlib is None, "python3-matplotlib is not installed")
class RenderTest(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.results = cls.run_scene("results", "Steady sliding/Contact state=steady sliding", "Output/Mode shapes=all")
        cls.modes = sorted(path for path in (cls.results / "modes").glob("complex_*.vtu") if "contact" not in path.name)

    def render(self, *arguments):
        return subprocess.run([sys.executable, SOURCE / "scripts" / self.SCRIPT, *arguments], capture_output=True, text=True, check=False)

    def picture(self, size, *arguments):
        """Pixels of a picture: rows from below, columns, and RGB values from 0 to 255."""
        file = self.folder / "picture.png"
        result = self.render(*arguments, "-o", file)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        pixels = matplotlib.image.imread(file)
        self.assertEqual(pixels.shape[1::-1], size)
        return (255 * pixels[::-1, :, :3]).round().astype(int)

    def refused(self, mentions, *arguments):
        result = self.render(*arguments)
        self.assertEqual(result.returncode, 1)
        for word in mentions:
            self.assertIn(word, result.stderr)


@unittest.skipUnless(importlib.util.find_spec("vtk"), "python3-vtk9 is not installed")
@unittest.skipUnless(os.environ.get("DISPLAY") or (shutil.which("xvfb-run") and shutil.which("xauth")), "xvfb is not installed")
class Mode(RenderTest):
    SCRIPT = "render_mode.py"

    def test_draws_several_side_by_side(self):
        pixels = self.picture((800, 565), *self.modes[:3], "--width", "800")
        # The colour bar is below two rows of two panels; with three modes, the lower right panel is empty
        for row, column, is_there in ((1, 0, True), (1, 1, True), (0, 0, True), (0, 1, False)):
            place = pixels[70 + 250 * row:300 + 250 * row, 400 * column:400 * (column + 1)]
            self.assertEqual(coloured(place).mean() > 0.1, is_there, (row, column))

    def test_bodies_at_rest_are_left_out(self):
        """The disc, which hardly moves in a bending mode of the pins, is omitted."""
        mode = [path for path in self.modes if "_F1" in path.name][-1]
        shares = [(self.picture((1600, 1000), mode, "--bodies", bodies).min(axis=-1) < 250).mean() for bodies in ("all", "moving")]
        self.assertLess(shares[1], 0.8 * shares[0])

    def test_points_without_cells(self):
        """Points of a system are drawn as coloured spheres."""
        self.run_scene("mesh", "Output/Write system=full")
        modes = self.run_scene("points", "System=mesh/system", "Output/Mode shapes=all") / "modes"
        pixels = self.picture((800, 500), sorted(modes.glob("complex_*.vtu"))[3], "--width", "800", "--view", "top")
        self.assertGreater(coloured(pixels[80:]).mean(), 0.05)

    def test_names_the_fields_there_are(self):
        self.refused(["no point field pressure", "amplitude"], self.modes[0], "--field", "pressure")


class Contact(RenderTest):
    SCRIPT = "render_contact.py"

    def faces(self, *arguments):
        return self.picture((1600, 1000), self.results / "sliding_state_contact.vtu", *arguments)

    def test_pressure_is_largest_where_the_disc_enters(self):
        # Outwards is up and the disc slides to the left: the largest pressures (blue) are on the right
        blue, yellow = [], []
        faces = self.faces()[200:]
        for y, x in zip(*coloured(faces).nonzero()):
            red, _, b = faces[y, x]
            (blue if b > red + 60 else yellow if red > b + 20 else []).append(x)
        self.assertGreater(min(len(blue), len(yellow)), 1000)
        self.assertGreater(sum(blue) / len(blue), sum(yellow) / len(yellow) + 10)

    def test_arrow_follows_the_rotation(self):
        parameters = self.results / "parameters.prm"
        text = parameters.read_text(encoding="utf-8")
        # Dark pixels belong to the arrow head
        centres = []
        for rotation, view in (("positive", "above"), ("negative", "above"), ("positive", "below")):
            parameters.write_text(text + f"subsection Operation\n  set Rotation = {rotation}\nend\n", encoding="utf-8")
            pixels = self.faces("--view", view)
            self.assertGreater((abs(pixels - 240) < 3).all(axis=2).mean(), 0.2)
            _, columns = (pixels[600:900].max(axis=2) < 60).nonzero()
            centres.append(columns.mean())
        parameters.write_text(text, encoding="utf-8")
        self.assertLess(centres[0], centres[1] - 10)
        self.assertGreater(centres[2], centres[0] + 10)

    def test_needs_the_files_beside(self):
        alone = self.folder / "alone_contact.vtu"
        shutil.copy(self.results / "sliding_state_contact.vtu", alone)
        self.refused(["no file of disc and pins"], alone)


if __name__ == "__main__":
    unittest.main()
