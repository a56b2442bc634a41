# SPDX-License-Identifier: GPL-3.0-or-later

"""squeal.Results and squeal.run(), with a small program instead of squeal."""

import json
import math
import os
import pathlib
import stat
import subprocess
import sys
import tempfile
import textwrap
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))
import squeal
from squeal import program
from squeal.vtu_file import VtuFile

MODES = """# first line
label,share [-],frequency [Hz],growth rate [1/s],unstable [-],rate [%],rate [-],verdict
# a comment
F1,0.5,100.25,2.5,1,1,0.01,unstable
A0-2 +,1,250,-1,0,,,stable
"""
# Program that writes results, or fails as squeal does
PROGRAM = f'''#!{sys.executable}
import pathlib, sys
words = sys.argv[1:]
settings = [words[i + 1] for i, word in enumerate(words) if word == "--set"]
if "Study=none" in settings:
    sys.exit("error: there is no study `none`\\n  where:  x.prm, line 1\\n  change: name another\\nbye")
if "Study=crash" in settings:
    sys.exit("out of memory")
folder = pathlib.Path(words[words.index("--output") + 1])
folder.mkdir(parents=True)
(folder / "parameters.prm").write_text("".join(f"set {{setting.replace('=', ' = ')}}\\n" for setting in settings))
(folder / "run.json").write_text('{{"files [byte]": {{}}, "command": "squeal"}}')
'''


class ModuleResults(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "results").mkdir()
        (self.folder / "results" / "run.json").write_text(json.dumps({"files [byte]": {}}), encoding="utf-8")
        (self.folder / "results" / "parameters.prm").write_text("set Study = stability\n", encoding="utf-8")
        (self.folder / "results" / "complex_modes.csv").write_text(MODES, encoding="utf-8")
        (self.folder / "squeal").write_text(PROGRAM, encoding="utf-8")
        (self.folder / "squeal").chmod(stat.S_IRWXU)

    def assert_rejected(self, action, *words):
        with self.assertRaises(squeal.Error) as caught:
            action()
        for word in words:
            self.assertIn(word, str(caught.exception))

    def test_data_frames(self):
        results = squeal.Results(self.folder / "results")
        modes = results.modes
        self.assertEqual(list(modes.columns), ["label", "share", "frequency", "growth rate", "unstable", "rate [%]", "rate [-]", "verdict"])
        self.assertEqual(modes.attrs["units"], {"share": "-", "frequency": "Hz", "growth rate": "1/s", "unstable": "-", "rate [%]": "%", "rate [-]": "-"})
        self.assertEqual(modes["frequency"].tolist(), [100.25, 250.0])
        self.assertEqual(modes["label"].tolist(), ["F1", "A0-2 +"])
        self.assertEqual(modes["unstable"].dtype.kind, "i")
        self.assertTrue(math.isnan(modes["rate [%]"][1]))
        self.assertEqual(results.table("complex_modes").eigenvalues()[0], complex(2.5, 2 * math.pi * 100.25))
        self.assertEqual(results.record, {"files [byte]": {}})
        self.assertEqual(results.parameters, {"Study": "stability"})

    def test_what_is_not_there(self):
        results = squeal.Results(self.folder / "results")
        self.assert_rejected(lambda: results.branches, "no table `branches`", "complex_modes")
        self.assert_rejected(lambda: results.fields("modes/none"), "no field file `modes/none`")
        self.assertEqual(results.field_names(), [])
        self.assert_rejected(results.system, "system.json", "Write system")
        self.assert_rejected(lambda: squeal.Results(self.folder / "none"), "no folder")
        self.assert_rejected(lambda: squeal.Results(self.folder), "run.json is missing")

    def test_damaged_files(self):
        path = self.folder / "results" / "complex_modes.csv"
        path.write_text(MODES + "F2,x,,1,,1,0.01,stable\n", encoding="utf-8")
        table = squeal.Results(self.folder / "results").table("complex_modes")
        self.assert_rejected(lambda: table.numbers("share [-]"), "`x` is not a number", "line 6, column `share [-]`")
        self.assert_rejected(lambda: table.rows[0]["none"], "no column `none`", "complex_modes.csv")
        self.assertEqual(table.flags("unstable [-]"), [True, False, False])
        path.write_text(MODES[:-3], encoding="utf-8")
        record = {"files [byte]": {path.name: len(MODES)}}
        (self.folder / "results" / "run.json").write_text(json.dumps(record), encoding="utf-8")
        self.assert_rejected(lambda: squeal.Results(self.folder / "results").table("complex_modes"), "truncated", "complex_modes.csv")
        path.write_text(MODES + "F2\n", encoding="utf-8")
        self.assert_rejected(lambda: squeal.Results(self.folder / "results").table("complex_modes"), "one cell for each column", "line 6")
        for content in ("", "<VTKFile>", '<VTKFile><AppendedData encoding="raw">\n_'):
            path.with_suffix(".vtu").write_text(content, encoding="utf-8")
            self.assert_rejected(lambda: VtuFile(path.with_suffix(".vtu")), "field file cannot be read", "complex_modes.vtu", "run squeal again")

    def test_system(self):
        squeal.System({}, [squeal.Term("M", 2, matrix=[[1.0]]), squeal.Term("K", 0, matrix=[[4.0]])]).write(self.folder / "results" / "system")
        self.assertEqual(squeal.Results(self.folder / "results").system().solve().eigenvalues.tolist(), [-2j, 2j])

    def run_small(self, *arguments, **more):
        with mock.patch.dict(os.environ, {"SQUEAL": str(self.folder / "squeal")}):
            return squeal.run(*arguments, **more)

    def test_run(self):
        results = self.run_small("x.prm", {"Operation/Friction coefficient": 0.3, "Output/Write matrices": True, "Sweep/Values": [0.1, 2]},
                                 output=self.folder / "run")
        self.assertEqual(results.parameters, {"Operation/Friction coefficient": "0.3", "Output/Write matrices": "true", "Sweep/Values": "0.1, 2"})
        self.assert_rejected(lambda: self.run_small("x.prm", {"Study": "none"}, output=self.folder / "run"),
                             "there is no study `none`", "where:  x.prm, line 1", "change: name another")
        self.assert_rejected(lambda: self.run_small("x.prm", {"Study": "crash"}, output=self.folder / "run"), "exit status 1", "out of memory")

    def test_program_is_found(self):
        with mock.patch.dict(os.environ, {"PATH": str(self.folder)}), mock.patch.object(program, "PLACES", (self.folder / "none",) * 2):
            os.environ.pop("SQUEAL", None)
            self.assertEqual(program.find_program(), self.folder / "squeal")
            os.environ["PATH"] = ""
            self.assert_rejected(program.find_program, "no program", "SQUEAL")
            os.environ["SQUEAL"] = str(self.folder / "other")
            self.assert_rejected(program.find_program, "other", "SQUEAL")
        with mock.patch.object(program, "PLACES", (self.folder / "none", self.folder / "squeal")), mock.patch.dict(os.environ):
            os.environ.pop("SQUEAL", None)
            self.assertEqual(program.find_program(), self.folder / "squeal")

    def test_import_needs_nothing_else(self):
        """Reading tables and parameters requires only the standard library."""
        code = textwrap.dedent(f"""
            import sys
            for name in ("numpy", "scipy", "pandas", "matplotlib", "meshio"):
                sys.modules[name] = None
            sys.path.insert(0, {str(pathlib.Path(squeal.__file__).parents[1])!r})
            import squeal
            print(len(squeal.Results({str(self.folder / "results")!r}).table("complex_modes")))
        """)
        process = subprocess.run([sys.executable, "-B", "-c", code], capture_output=True, text=True)
        self.assertEqual((process.stdout, process.stderr), ("2\n", ""))


if __name__ == "__main__":
    unittest.main()
