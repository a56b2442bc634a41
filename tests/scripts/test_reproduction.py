# SPDX-License-Identifier: GPL-3.0-or-later

"""scripts/reproduce.sh: list of pages, comparison of numbers, and quoted numbers that must occur in the pages."""

import importlib
import pathlib
import pkgutil
import re
import subprocess
import sys
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "scripts"))

import reproduction.pages
from reproduction.numbers import ENTRIES, Number


def text_of(page):
    """Text of a page with powers of ten in the form 1e-6."""
    path = SOURCE / "README.md" if page == "README" else SOURCE / "doc" / f"{page}.md"
    text = path.read_text(encoding="utf-8").replace("−", "-")
    for power, digits in ((power, str(power).translate(str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹"))) for power in range(1, 20)):
        text = re.sub(rf"([0-9.]+)·10⁻{digits}(?![⁰¹²³⁴⁵⁶⁷⁸⁹])", rf"\1e-{power}", text)
        text = re.sub(rf"10⁻{digits}(?![⁰¹²³⁴⁵⁶⁷⁸⁹])", f"1e-{power}", text)
    return text


class Numbers(unittest.TestCase):
    def test_agree_to_the_printed_digits(self):
        for quoted, found, differs in (("0.680", 0.67961, 0.6806), ("-1.36", -1.3571, 1.36), ("6.2e-7", 6.18e-7, 6.3e-7), ("24", 24, 23)):
            self.assertTrue(Number("", quoted, found).agrees(), quoted)
            self.assertFalse(Number("", quoted, differs).agrees(), quoted)
            self.assertIn("<- differs", str(Number("", quoted, differs)))
        self.assertTrue(Number("", "1e-6", 6e-7, bound=True).agrees())
        self.assertFalse(Number("", "1e-6", 1.1e-6, bound=True).agrees())


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        for module in pkgutil.iter_modules(reproduction.pages.__path__):
            importlib.import_module(f"reproduction.pages.{module.name}")

    def test_say_what_is_quoted_from_them(self):
        for module in pkgutil.iter_modules(reproduction.pages.__path__):
            source = (SOURCE / "scripts" / "reproduction" / "pages" / f"{module.name}.py").read_text(encoding="utf-8")
            text = text_of(module.name)
            quoted = set(re.findall(r'"-?(\d+(?:\.\d+)?(?:e-\d+)?)"', source))
            self.assertTrue(quoted)
            for number in sorted(quoted):
                with self.subTest(page=module.name, number=number):
                    self.assertTrue(re.search(rf"(?<![\d.]){re.escape(number)}(?!\d)", text), f"doc/{module.name}.md does not contain {number}")

    def test_are_listed_without_running(self):
        listed = subprocess.run([SOURCE / "scripts" / "reproduce.sh", "--list"], text=True, capture_output=True, check=True).stdout
        for page, sentences in ENTRIES.items():
            self.assertRegex(listed, rf"(?m)^{page}$")
            self.assertTrue(sentences)

    def test_are_refused_where_unknown(self):
        refused = subprocess.run([SOURCE / "scripts" / "reproduce.sh", "tabel1"], text=True, capture_output=True, check=False)
        self.assertEqual(refused.returncode, 1)
        self.assertIn("table1", refused.stderr)


if __name__ == "__main__":
    unittest.main()
