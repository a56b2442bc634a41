# SPDX-License-Identifier: GPL-3.0-or-later

"""Growing waves of a sliding pad, compared with a Chebyshev solution of the continuum (doc/well_posedness.md)."""

import math
import os
import sys
import unittest

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from program import SOURCE, ProgramTest, read_table

sys.path.insert(0, str(SOURCE / "scripts"))
try:
    import numpy as np
    from reproduction.sliding_layer import Layer
except ImportError:
    raise unittest.SkipTest("NumPy or SciPy is missing") from None

PAD, RADIUS = Layer(0.012, 1.9e9, 0.25, 3070), 0.01935
# Im c / Re c of the half-space at mu = 2 and Poisson's ratio 1/2: c^2 = c_s^2 (1 - s^2), s = (mu - i)^2 / (mu^2 + 1)
INCOMPRESSIBLE = np.sqrt(1 - ((2 - 1j) / (2 + 1j))**2)


class Continuum(unittest.TestCase):
    def test_half_space_flutters_above_one(self):
        self.assertEqual(PAD.half_space(0.99), 0)
        self.assertGreater(PAD.half_space(1.01), 1e-3)
        # Plane stress with ratio nu is plane strain with nu / (1 + nu); nu = 1 gives an incompressible half-space
        exact = INCOMPRESSIBLE.imag / INCOMPRESSIBLE.real
        self.assertAlmostEqual(Layer(1.0, 1.0, 0.9999999, 1.0).half_space(2.0), exact, delta=1e-5)


class Ring(ProgramTest):
    def test_growth_rates_converge_to_those_of_the_layer(self):
        """Growth rates of the three fastest-growing waves; with several waves around the ring, curvature has little effect."""
        exact = np.sort([max(values.real[abs(values.imag) < 2 * math.pi * 46e3])
                         for values in (PAD.eigenvalues(n / RADIUS, 1.5, 50) for n in (5, 6, 7))])[::-1]
        errors = []
        for layers, size in ((5, 0.0024), (8, 0.0016)):
            results = self.run_scene(f"ring_{layers}", "Geometry/Disc inner radius=0.0186", "Geometry/Disc outer radius=0.0196",
                                     f"Geometry/Pin layers={layers}", f"Geometry/Element size={size}",
                                     file=str(SOURCE / "prm" / "studies" / "sliding_ring.prm"))
            rates = sorted((float(mode["growth rate [1/s]"]) for mode in read_table(results / "complex_modes.csv")), reverse=True)
            errors.append(max(abs(rates[:3] / exact - 1)))
        self.assertLess(errors[0], 0.06)
        self.assertLess(errors[1], 0.6 * errors[0])


if __name__ == "__main__":
    unittest.main()
