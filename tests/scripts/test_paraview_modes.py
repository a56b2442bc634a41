# SPDX-License-Identifier: GPL-3.0-or-later

"""scripts/paraview_modes.py without ParaView: selection of modes and rejected arguments."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "paraview_modes.py"
sys.path.insert(0, str(SCRIPT.parent))

import paraview_modes  # noqa: E402

HEADER = "label,frequency [Hz],growth rate [1/s],effective damping ratio -2R/omega [%],unstable [-]"
ROWS = ["A0-2 -,500,0,0,0", "F1,3500,-20,0.18,0", "F1,3500,20,-0.18,1", "F1,3600,40,-0.35,1"]


class ParaviewModes(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.results = pathlib.Path(self.temporary.name)
        (self.results / "complex_modes.csv").write_text("\n".join([HEADER, *ROWS]) + "\n", encoding="utf-8")
        (self.results / "modes").mkdir()
        for number, label in ((3, "F1"), (4, "F1")):
            for ending in (".vtu", "_contact.vtu"):
                (self.results / "modes" / f"complex_{number:03d}_{label}{ending}").write_text("", encoding="utf-8")

    def refused(self, *arguments):
        process = subprocess.run([sys.executable, "-B", SCRIPT, *map(str, arguments)], capture_output=True, text=True, check=False)
        self.assertNotEqual(process.returncode, 0)
        self.assertNotIn("Traceback", process.stderr)
        return process.stderr

    def test_which_mode(self):
        rows, files = paraview_modes.rows_of(self.results), paraview_modes.files_of(self.results)
        self.assertEqual({number: path.name for number, path in files.items()}, {3: "complex_003_F1.vtu", 4: "complex_004_F1.vtu"})
        self.assertEqual(paraview_modes.chosen("F1", rows, files), 4)
        self.assertEqual(paraview_modes.chosen("3", rows, files), 3)

    def test_refused(self):
        picture = ("--pictures", self.results / "pictures")
        for arguments, words in (((self.results, "--mode", "5", *picture), "rows 1 to 4"),
                                 ((self.results, "--mode", "A0-2", *picture), "Mode shapes"),
                                 ((self.results,), "--film"), ((self.results, "--film", "a.gif"), "--mode")):
            with self.subTest(words):
                self.assertIn(words, self.refused(*arguments))
        for path in (self.results / "modes").iterdir():
            path.unlink()
        self.assertIn("Mode shapes = all", self.refused(self.results, *picture))


if __name__ == "__main__":
    unittest.main()
