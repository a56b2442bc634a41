# SPDX-License-Identifier: GPL-3.0-or-later

"""Source files include headers only from their own folder and from folders above it in the table of doc/structure.md."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def rooms():
    """Folders in the order of the rows of the table."""
    table = (ROOT / "doc" / "structure.md").read_text(encoding="utf-8")
    return re.findall(r"^\| `(\w+)/` \|", table, flags=re.MULTILINE)


class Layout(unittest.TestCase):
    def test_every_room_is_in_the_table(self):
        for base in (ROOT / "source", ROOT / "include" / "squeal"):
            found = {path.name for path in base.iterdir() if path.is_dir() and any(path.iterdir())}
            self.assertEqual(found - set(rooms()), set())

    def test_includes_go_one_way(self):
        order = {room: row for row, room in enumerate(rooms())}
        n_includes = 0
        for base in (ROOT / "source", ROOT / "include" / "squeal"):
            for path in base.rglob("*/*.*"):
                room = path.relative_to(base).parts[0]
                for other in re.findall(r"#include <squeal/(\w+)/", path.read_text(encoding="utf-8")):
                    n_includes += 1
                    self.assertLessEqual(order[other], order[room], f"{path} includes from {other}/, whose row is below {room}/ in doc/structure.md")
        self.assertGreater(n_includes, 100)


if __name__ == "__main__":
    unittest.main()
