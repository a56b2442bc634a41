# SPDX-License-Identifier: GPL-3.0-or-later

"""Options that only print, and the parameter files supplied with the program."""

from program import SOURCE, ProgramTest, contents


class Options(ProgramTest):
    def printed(self, *arguments):
        """Output of a call that must succeed and write no files."""
        before = contents(self.folder)
        process = self.call(*arguments)
        self.assertEqual((process.returncode, process.stderr), (0, ""))
        self.assertEqual(contents(self.folder), before)
        return process.stdout

    def test_dry_run_version_and_help(self):
        text = self.printed("scene.prm", "--dry-run", "--output", "results")
        self.assertIn("28 contact nodes", text)
        self.assertRegex(text, r"\d+ hexahedra, 4 pins")
        self.assertIn("dry run", text)
        self.assertRegex(self.printed("--version"), r"^squeal \d+\.\d+\.\d+ \(\S+\)")
        for option in ("--set", "--output", "--dry-run", "--print-parameters", "--version", "--help"):
            self.assertIn(option, self.printed("-h"))

    def test_parameter_files(self):
        files = sorted((SOURCE / "prm").glob("*.prm"))
        self.assertTrue(files)
        for file in files:
            with self.subTest(file.name):
                self.assertIn("dry run", self.printed(str(file), "--dry-run"))
