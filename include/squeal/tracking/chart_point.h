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
   * Modes at one friction coefficient of a stability chart. Vectors are coordinates in an M_c-orthonormal basis, which may be extended
   * later: vectors of points from an earlier basis have fewer rows, and the missing rows are zero.
   */
  struct ChartPoint
  {
    double friction_coefficient = 0.;

    std::vector<std::complex<double>> lambda; ///< λ with Im λ > 0, ascending by Im, then Re, to slightly beyond the end of the band [rad/s]
    ComplexDenseMatrix                right; ///< φ_r, r × k, ‖φ_r‖₂ = 1
    ComplexDenseMatrix                left;  ///< ψ_r, r × k, ‖ψ_r‖₂ = 1: ψ_rᵀ Q_r(λ) = 0 (without conjugation)

    std::vector<double>  right_residuals; ///< ε_res of φ, eq. (16) [-]
    std::vector<double>  left_residuals;  ///< ε_res of ψ [-]
    std::vector<double>  errors;          ///< estimated |δλ| / |λ|, including the effect of close modes that may coalesce [-]
    std::vector<double>  uncertainties;   ///< uncertainty of each λ [rad/s]
    std::vector<Verdict> verdicts;

    /// D, k × k: D_ij = L_iᵀ K_c⁻¹ R_j / ψ_iᵀQ'(λ_i)φ_i; the eigenvalues of diag(λ) + D are more accurate than λ [rad/s].
    ComplexDenseMatrix corrections;

    std::vector<double> real_values; ///< real λ ≠ 0, ascending [1/s]
    int                 n_zeros = 0; ///< number of λ = 0

    /// Number of real λ, including zeros.
    int n_real() const
    {
      return static_cast<int>(real_values.size()) + n_zeros;
    }

    /// Serialisation by Boost, for sending points to other processes.
    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &friction_coefficient &lambda &right &left &right_residuals &left_residuals &errors &uncertainties &verdicts &corrections
        &real_values &n_zeros;
    }
  };

  /// Function of one or two modes whose zero is searched for.
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

  /// Search for the zero of a function that changes its sign between two points of a chart.
  struct ZeroSearch
  {
    ModeFunction              function;
    double                    bound;         ///< bound of the frequency [rad/s]
    ModesAtPoint              first, second; ///< the same one or two modes at both points
    std::vector<ModesAtPoint> beyond;        ///< the same modes at the adjacent points where all these modes exist
  };

  /// Function that predicts the zero between the points; empty if there is no prediction. The result is identical on every process.
  using PredictZero = std::function<std::optional<double>(const ZeroSearch &)>;
} // namespace Squeal
