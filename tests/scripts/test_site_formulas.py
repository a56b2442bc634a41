# SPDX-License-Identifier: GPL-3.0-or-later

"""Formulas in the documentation site: subscripts and superscripts in text and formulas, but not in code."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))

from site_formulas import on_page_content


class Formulas(unittest.TestCase):
    def test_are_rendered_in_text(self):
        for text, html in (("K_c⁻¹ A", "K<sub>c</sub>⁻¹ A"), ("e^(Rt)", "e<sup>Rt</sup>"), ("Ψ_an^D", "Ψ<sub>an</sub><sup>D</sup>"),
                           ("(u)_i", "(u)<sub>i</sub>")):
            self.assertEqual(on_page_content(f"<p>{text}</p>"), f"<p>{html}</p>")

    def test_are_rendered_in_blocks_of_formulas(self):
        self.assertEqual(on_page_content("<pre><code>r_t = μ r_n</code></pre>"), "<pre><code>r<sub>t</sub> = μ r<sub>n</sub></code></pre>")

    def test_leave_code_and_attributes(self):
        for html in ('<a href="a_b.html" title="K_c">x</a>', "<code>K_c</code>", "<pre><code>scripts/run.sh a_b μ_c</code></pre>", "<p>complex_modes</p>"):
            self.assertEqual(on_page_content(html), html)


if __name__ == "__main__":
    unittest.main()
