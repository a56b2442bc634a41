// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/estimates/eigenvalue_estimates.h>
#include <squeal/linear_algebra/dense_serialization.h>

#include <complex>
#include <functional>
#include <optional>
#include <vector>

namespace Squeal
{
  /**
   * Modes at one friction coefficient of a stability chart. Vectors are coordinates in an M_c-orthonormal basis that may have been extended
   * since: points from an earlier basis have fewer rows, and the missing ones are zero.
   */
  struct ChartPoint
  {
    double friction_coefficient = 0.;

    std::vector<std::complex<double>> lambda; ///< Im λ > 0, ascending by Im, then Re; including some beyond the end of the band [rad/s]
    ComplexDenseMatrix                right;  ///< φ_r, r × k, ‖φ_r‖₂ = 1
    ComplexDenseMatrix                left;   ///< ψ_r, r × k, ‖ψ_r‖₂ = 1: ψ_rᵀ Q_r(λ) = 0, no conjugate

    std::vector<double>  right_residuals; ///< ε_res of φ, eq. (16) [-]
    std::vector<double>  left_residuals;  ///< ε_res of ψ [-]
    std::vector<double>  errors;          ///< estimated |δλ| / |λ|, including the effect of close modes that may coalesce [-]
    std::vector<double>  uncertainties;   ///< of λ [rad/s]
    std::vector<Verdict> verdicts;

    /// D, k × k: D_ij = L_iᵀ K_c⁻¹ R_j / ψ_iᵀQ'(λ_i)φ_i; the eigenvalues of diag(λ) + D are more accurate than λ [rad/s].
    ComplexDenseMatrix corrections;

    std::vector<double> real_values; ///< real λ ≠ 0, ascending [1/s]
    int                 n_zeros = 0; ///< number of λ = 0

    /// Number of real λ, zeros included.
    int n_real() const
    {
      return static_cast<int>(real_values.size()) + n_zeros;
    }

    /// Serialises for Boost.
    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &friction_coefficient &lambda &right &left &right_residuals &left_residuals &errors &uncertainties &verdicts &corrections
        &real_values &n_zeros;
    }
  };

  /// A function of one or two modes.
  enum class ModeFunction
  {
    growth,       ///< Re λ of a mode
    discriminant, ///< Re (λ_1 − λ_2)² of two modes
    frequency     ///< Im λ of a mode minus a bound
  };

  /// Modes at a point of a chart.
  struct ModesAtPoint
  {
    const ChartPoint *point;
    std::vector<int>  modes;
  };

  /// A function that changes its sign between two points of a chart.
  struct ZeroSearch
  {
    ModeFunction              function;
    double                    bound;         ///< for the frequency [rad/s]
    ModesAtPoint              first, second; ///< the same one or two modes at both points
    std::vector<ModesAtPoint> beyond;        ///< and at the adjacent points on either side, if they exist
  };

  /// Predicted position of the zero between the points; nothing if there is no prediction. The same on every process.
  using PredictZero = std::function<std::optional<double>(const ZeroSearch &)>;
} // namespace Squeal
