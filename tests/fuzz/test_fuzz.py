# SPDX-License-Identifier: GPL-3.0-or-later

"""The first cases of fuzz.py."""

import unittest

from fuzz import Fuzzer


class DamagedInput(unittest.TestCase):
    def test_some_of_each_kind(self):
        fuzzer = Fuzzer(seed=1)
        outcomes = [fuzzer.run(number) for number in range(16)]
        self.assertEqual([(number, found) for number, (_, _, _, found) in enumerate(outcomes) if found], [])
        # Some cases are rejected, some pass the dry run
        self.assertEqual({"rejected", "dry run"} - {outcome for _, _, outcome, _ in outcomes}, set())


if __name__ == "__main__":
    unittest.main()
