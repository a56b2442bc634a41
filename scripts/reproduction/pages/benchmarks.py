# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/benchmarks.md, except times"""

import math
import statistics

from reproduction.numbers import Number, entry
from squeal import quadratic


@entry("benchmarks", "Residual iteration compared with the Krylov reference: largest difference of lambda, estimated and true errors")
def residual_iteration(runs):
    for name, parameter_file, quoted in (("without", "disc_pins.prm", "1e-7"), ("consistent", "dissipation.prm", "3e-7")):
        exact = runs(f"krylov_{name}", parameter_file, "Output/Mode shapes=none", "Complex modes/Tolerance=1e-11")
        found = runs(f"residual_iteration_{name}", parameter_file, "Output/Mode shapes=none", "Complex modes/Solver=residual iteration")
        yield Number(f"{name}: modes", "66", len(found.complex_modes()))
        _, _, differences = quadratic.match(found.eigenvalues(), exact.eigenvalues())
        yield Number(f"{name}: largest relative difference", quoted, max(differences), bound=True)
        estimates = [mode["estimated error of lambda [-]"] for mode in found.complex_modes()]
        ratios = [estimate / difference for estimate, difference in zip(estimates, differences) if difference > 1e-10]
        yield Number(f"{name}: median of estimated / true error, logarithm", "0.1", abs(math.log10(statistics.median(ratios))), bound=True)
