"""Decisions on rank, determinacy and multiplicity keep two orders of magnitude from their thresholds on all shipped scenes."""

import sys
import unittest

from program import EXECUTABLE, SOURCE

sys.path.insert(0, str(SOURCE / "scripts"))
import measure_margins  # noqa: E402

# The shipped scenes on a coarse mesh and a narrower band, with fewer values and modes: seconds instead of minutes.
COARSE = ["Geometry/Nodes per pin face=7", "Geometry/Pin layers=2", "Geometry/Disc layers=2", "Band/Maximum frequency=2000",
          "Output/Mode shapes=none", "Sweep/Number of friction coefficients=10", "Sweep/Map friction coefficients=3",
          "Sweep/Number of map values=3", "Reduction/Component modes=20, 24, 24"]

# 18 pins need a finer mesh; curved quadratic elements too, unless pins are farther from each other
ELEMENT_SIZE = "Geometry/Element size=0.04"
# The corners of the grid of designs: fifty meshes take minutes
OWN = {"designs": [ELEMENT_SIZE, "Designs/Variables=Geometry/Pin height = 0.0286, 0.0350; Geometry/Pin diameter = 0.046, 0.054; "
                                 "Geometry/Disc thickness = 0.0440, 0.0463"],
       "accuracy": [ELEMENT_SIZE, "Accuracy study/Elements=trilinear, incompatible modes"],
       # Full order only: bases grown on one pin each side are looked at in doc/decisions.md
       "accuracy_one_pin": [ELEMENT_SIZE, "Accuracy study/Bases="],
       "disc_pins_18": ["Geometry/Element size=0.03"],
       "sliding_ring": ["Band/Maximum frequency=46000"],
       "quadratic": [ELEMENT_SIZE, *(f"Geometry/{side} pin {name}" for side in ("Top", "Bottom")
                                     for name in ("radii=0.2275, 0.2275", "angles=-10, 10"))]}


class MarginsTest(unittest.TestCase):
    def test_shipped_scenes(self):
        margins = {}
        for file in measure_margins.shipped():
            found = measure_margins.decisions(EXECUTABLE, str(file), [*COARSE, *OWN.get(file.stem, [ELEMENT_SIZE])])
            self.assertGreater(len(found), 4, file)
            measure_margins.add_margins(margins, found, file.stem)
        # The scenes reach both sides of what matters most
        elastic = margins["eigenvalue of the symmetric problem / what rounding hides"]
        self.assertLess(elastic.below, 15)
        self.assertLess(elastic.above, 15)
        self.assertEqual(measure_margins.small_margins(margins), [], margins)


if __name__ == "__main__":
    unittest.main()
