"""Calls that are refused: one message that says what, where and what to change."""

from program import ProgramTest


def settings(overrides):
    """Words of the command line that give parameters other values."""
    return [word for override in overrides for word in ("--set", override)]


class RefusalTest(ProgramTest):
    def write(self, name, content):
        """A file for the time of one test."""
        path = self.folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        self.addCleanup(path.unlink, missing_ok=True)
        return name

    def dry_run(self, *overrides, file="scene.prm"):
        return self.call(file, "--dry-run", *settings(overrides))

    def dry_run_refused(self, mentions, *overrides, file="scene.prm"):
        process = self.dry_run(*overrides, file=file)
        self.assertEqual(process.returncode, 1)
        self.assert_message(process, mentions)
