"""Options that print and compute nothing, and the parameter files that come with the program."""

import re

from program import SOURCE, ProgramTest, contents


class Options(ProgramTest):
    def printed(self, *arguments):
        """What a call prints that succeeds and writes nothing."""
        before = contents(self.folder)
        process = self.call(*arguments)
        self.assertEqual((process.returncode, process.stderr), (0, ""))
        self.assertEqual(contents(self.folder), before)
        return process.stdout

    def test_dry_run(self):
        text = self.printed("scene.prm", "--dry-run", "--output", "results")
        self.assertIn("28 contact nodes", text)
        self.assertRegex(text, r"\d+ hexahedra, 4 pins")
        self.assertIn("dry run", text)

    def test_version_and_help(self):
        self.assertRegex(self.printed("--version"), r"^squeal \d+\.\d+\.\d+ \(\S+\)\n$")
        text = self.printed("--help")
        for option in ("--set", "--output", "--dry-run", "--print-parameters", "--version", "--help"):
            self.assertIn(option, text)

    def test_printed_parameters_are_a_parameter_file(self):
        text = self.printed("--print-parameters")
        # Every parameter says its unit, enumerations and switches apart.
        for name in ("Friction coefficient", "Disc thickness", "Elastic mounts", "Maximum frequency"):
            self.assertIn(f"set {name}", re.sub(" +", " ", text))
        self.assertGreater(text.count("Units:"), 30)
        printed = self.folder / "printed.prm"
        self.addCleanup(printed.unlink)
        printed.write_text(text, encoding="utf-8")
        self.assertIn("12 pins", self.printed("printed.prm", "--dry-run"))
        self.assertEqual(self.printed("printed.prm", "--print-parameters"), text)

    def test_overrides_are_printed(self):
        text = self.printed("scene.prm", "--print-parameters", "--set", "Operation/Friction coefficient=0.25")
        self.assertRegex(text, r"set Friction coefficient += 0.25\n")
        self.assertRegex(text, r"set Element size += 0.04\n")

    def test_parameter_files(self):
        files = sorted((SOURCE / "prm").glob("*.prm"))
        self.assertTrue(files)
        for file in files:
            with self.subTest(file.name):
                self.assertIn("dry run", self.printed(str(file), "--dry-run"))
