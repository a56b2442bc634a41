# SPDX-License-Identifier: GPL-3.0-or-later

"""The revision that a build compiles into the program."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "cmake" / "write_revision.cmake"


@unittest.skipUnless(shutil.which("git") and shutil.which("cmake"), "git or cmake is missing")
class WriteRevision(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.sources = pathlib.Path(folder.name) / "sources"
        self.sources.mkdir()
        self.file = pathlib.Path(folder.name) / "revision.cc"

    def git(self, *words):
        name = {f"GIT_{role}_{what}": "nobody" for role in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}
        process = subprocess.run(["git", "-C", self.sources, *words], check=True, capture_output=True, text=True, env={**os.environ, **name})
        return process.stdout.strip()

    def revision(self):
        subprocess.run(["cmake", "-D", f"SOURCE_DIRECTORY={self.sources}", "-D", f"FILE={self.file}", "-P", SCRIPT], check=True)
        return self.file.read_text(encoding="utf-8").split('revision = "')[1].split('"')[0]

    def test_outside_of_a_repository_and_within_one_of_others(self):
        self.assertEqual(self.revision(), "unknown")
        (self.sources.parent / "theirs").touch()
        self.git("init", self.sources.parent)
        self.git("add", "../theirs")
        self.git("commit", "-m", "theirs")
        self.assertEqual(self.revision(), "unknown")

    def test_follows_the_sources(self):
        self.git("init")
        (self.sources / "a.cc").write_text("1\n", encoding="utf-8")
        self.git("add", "a.cc")
        self.git("commit", "-m", "first")
        first = self.revision()
        self.assertTrue(self.git("rev-parse", "HEAD").startswith(first))
        # An unchanged file is not rewritten, to avoid recompilation
        time = self.file.stat().st_mtime_ns
        self.assertEqual(self.revision(), first)
        self.assertEqual(self.file.stat().st_mtime_ns, time)
        (self.sources / "a.cc").write_text("2\n", encoding="utf-8")
        self.assertEqual(self.revision(), first + "-dirty")
        self.git("commit", "-a", "-m", "second")
        self.assertNotEqual(self.revision(), first)


if __name__ == "__main__":
    unittest.main()
