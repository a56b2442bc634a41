"""Damaged input that once was not refused as it must be, and a little of what fuzz.py makes up."""

import unittest

from fuzz import Fuzzer, cases_kept, try_case


class DamagedInput(unittest.TestCase):
    def test_what_once_failed(self):
        for name, case in cases_kept():
            with self.subTest(name):
                self.assertEqual(try_case(case, is_whole=True)[1], [])

    def test_some_of_each_kind(self):
        fuzzer = Fuzzer(seed=1, kinds=[])
        outcomes = [fuzzer.run(number) for number in range(48)]
        self.assertEqual([(number, found) for number, _, _, _, found in outcomes if found], [])
        # Neither is all of it refused, nor nothing
        self.assertEqual({"refused", "dry run"} - {outcome for _, _, _, outcome, _ in outcomes}, set())


if __name__ == "__main__":
    unittest.main()
