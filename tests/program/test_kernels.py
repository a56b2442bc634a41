# SPDX-License-Identifier: GPL-3.0-or-later

"""A sweep with twelve pins refines at the same friction coefficients with BLAS kernels for other processors."""

import os
import pathlib
import re
import unittest.mock

from program import SOURCE, read_table
from test_sweep import THRESHOLD_TOLERANCE, SweepTest


class OtherProcessors(SweepTest):
    """Twelve pins with close modes on a coarse mesh: refinement must not depend on the rounding errors of a kernel."""

    # Kernels and the processor flags that they require
    KERNELS = {"Prescott": {"pni"}, "Haswell": {"avx2", "fma"}, "SkylakeX": {"avx512f", "avx512dq", "avx512bw", "avx512vl", "avx512cd"}}

    def refinements(self, kernels):
        """Friction coefficients added by refinement, for each of the two charts."""
        with unittest.mock.patch.dict(os.environ, OPENBLAS_CORETYPE=kernels):
            folder = self.run_scene(kernels, "Geometry/Nodes per pin face=7", "Geometry/Pin layers=2", "Geometry/Disc layers=2",
                                    "Geometry/Element size=0.04", "Sweep/Number of friction coefficients=20",
                                    "Band/Maximum frequency=4000", file=str(SOURCE / "prm/sweep_damped.prm"))
        return [sorted({float(row["mu [-]"]) for row in read_table(folder / table) if row["refinement [-]"] == "1"})
                for table in ("branches.csv", "branches_without_dissipation.csv")]

    def test_refinements(self):
        flags = set(re.search(r"^flags\s*:(.*)$", pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8"), re.MULTILINE)[1].split())
        found = [self.refinements(kernels) for kernels, needs in self.KERNELS.items() if needs <= flags]
        if len(found) < 2:
            self.skipTest("this processor supports fewer than two of the kernels")
        for charts in found:
            for one, other in zip(found[0], charts):
                self.assertGreater(len(one), 20)
                self.assertEqual(len(one), len(other))
                self.assertLess(max(abs(a - b) for a, b in zip(one, other)), 2 * THRESHOLD_TOLERANCE)
