# SPDX-License-Identifier: GPL-3.0-or-later

"""Waves in an elastic layer that slides with friction on a rigid plane: a continuum solution for comparison with meshes.

The layer 0 <= y <= H is fixed at y = H. At y = 0 it slides without lift-off: u_y = 0, sigma_xy = mu sigma_yy. Displacements
u(y) exp(i k x + lambda t) give an ordinary differential equation in y, which is solved by Chebyshev collocation.
In the half-space H -> infinity, waves travel at the complex speed c from

    q_p w = -i mu (2 - w - 2 q_s q_p),    w = (c / c_s)^2,  q_s^2 = 1 - w,  q_p^2 = 1 - w (c_s / c_p)^2,  Re q > 0
"""

import dataclasses
import math

import numpy as np
import scipy.linalg
import scipy.optimize

# For waves longer than a quarter of the thickness, eigenvalues are accurate to 1e-6
N_POLYNOMIALS = 80


@dataclasses.dataclass
class Layer:
    """A layer with thickness H [m], Young's modulus [Pa], Poisson's ratio and density [kg/m^3] in plane stress, as in a
    narrow ring."""

    thickness: float
    modulus: float
    ratio: float
    density: float

    @property
    def shear_modulus(self):
        return self.modulus / 2 / (1 + self.ratio)

    @property
    def lame(self):
        return self.modulus * self.ratio / (1 - self.ratio**2)

    @property
    def speed_ratio(self):
        """The ratio (c_s / c_p)^2 of wave speeds."""
        return self.shear_modulus / (self.lame + 2 * self.shear_modulus)

    def eigenvalues(self, wave_number, friction_coefficient, n=N_POLYNOMIALS):
        """All lambda [1/s] with Re lambda >= 0 of waves along the contact with wave number k [1/m]; the largest ones
        are not converged."""
        shear, lame = self.shear_modulus, self.lame
        points = np.arange(n + 1)
        x = np.cos(math.pi * points / n)
        weights = np.hstack([2, np.ones(n - 1), 2]) * (-1.0) ** points
        differences = x[:, None] - x[None, :]
        D = np.outer(weights, 1 / weights) / (differences + np.eye(n + 1))
        D -= np.diag(D.sum(axis=1))
        D *= 2 / self.thickness  # y = H (1 + x) / 2: the first point is fixed, the last point slides
        one, ik, m = np.eye(n + 1), 1j * wave_number, n + 1
        A = np.zeros((2 * m, 2 * m), dtype=complex)
        A[:m, :m] = (lame + 2 * shear) * ik**2 * one + shear * D @ D
        A[:m, m:] = A[m:, :m] = (lame + shear) * ik * D
        A[m:, m:] = shear * ik**2 * one + (lame + 2 * shear) * D @ D
        B = self.density * np.eye(2 * m)
        for row in (0, n, m, m + n):
            A[row] = B[row] = 0
        A[0, 0] = A[m, m] = A[m + n, m + n] = 1
        A[n, :m] = shear * D[n] - friction_coefficient * lame * ik * one[n]
        A[n, m:] = shear * ik * one[n] - friction_coefficient * (lame + 2 * shear) * D[n]
        squares = scipy.linalg.eigvals(A, B)
        squares = squares[np.isfinite(squares)]
        roots = np.sqrt(squares)
        return np.where(roots.real < 0, -roots, roots)

    def largest_growth(self, wave_numbers, friction_coefficient, frequency):
        """Largest Re lambda [1/s] of waves with |Im lambda| up to 2 pi times a frequency [Hz]."""
        return max(np.max(values.real[abs(values.imag) <= 2 * math.pi * frequency], initial=0.0)
                   for values in (self.eigenvalues(k, friction_coefficient) for k in wave_numbers))

    def half_space(self, friction_coefficient):
        """Im c / Re c, the divergence rate, of the growing wave in the half-space; 0 if no wave grows."""
        def defect(parts):
            w = complex(*parts) ** 2
            q_s, q_p = np.sqrt(1 - w), np.sqrt(1 - w * self.speed_ratio)
            value = (q_p * w + 1j * friction_coefficient * (2 - w - 2 * q_s * q_p)) / w
            return [value.real, value.imag]

        parts, _, found, _ = scipy.optimize.fsolve(defect, [math.sqrt(2), 0.3], full_output=True)
        return parts[1] / abs(parts[0]) if found == 1 and parts[1] > 1e-6 and np.hypot(*defect(parts)) < 1e-9 else 0.0
