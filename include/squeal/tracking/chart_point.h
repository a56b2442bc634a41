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
   * What a stability chart keeps of the modes at one friction coefficient. The
   * vectors are coordinates in an M_c-orthonormal basis that may have grown
   * since: points of an earlier basis have fewer rows, and zeros stand for the
   * missing ones.
   */
  struct ChartPoint
  {
    double friction_coefficient = 0.;

    std::vector<std::complex<double>> lambda; ///< Im λ > 0, ascending by Im, then Re; some beyond the end of the band [rad/s]
    ComplexDenseMatrix                right;  ///< φ_r, r × k, ‖φ_r‖₂ = 1
    ComplexDenseMatrix                left;   ///< ψ_r, r × k, ‖ψ_r‖₂ = 1: ψ_rᵀ Q_r(λ) = 0, no conjugate

    std::vector<double>  right_residuals; ///< ε_res of φ, eq. (16) [-]
    std::vector<double>  left_residuals;  ///< ε_res of ψ [-]
    std::vector<double>  errors;          ///< estimated |δλ| / |λ|, with what close modes add where they may coalesce [-]
    std::vector<double>  uncertainties;   ///< of λ [rad/s]
    std::vector<Verdict> verdicts;

    /// D, k × k: D_ij = L_iᵀ K_c⁻¹ R_j / ψ_iᵀQ'(λ_i)φ_i; the eigenvalues of diag(λ) + D are better than λ [rad/s].
    ComplexDenseMatrix corrections;

    std::vector<double> real_values; ///< real λ but zero, ascending [1/s]
    int                 n_zeros = 0; ///< λ = 0

    /// Real λ, zeros included.
    int n_real() const
    {
      return static_cast<int>(real_values.size()) + n_zeros;
    }

    /// For boost's archives.
    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &friction_coefficient &lambda &right &left &right_residuals &left_residuals &errors &uncertainties &verdicts &corrections
        &real_values &n_zeros;
    }
  };

  /// A function of one mode or two.
  enum class ModeFunction
  {
    growth,       ///< Re λ of a mode
    discriminant, ///< Re (λ_1 − λ_2)² of two modes
    frequency     ///< Im λ of a mode, less a bound
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
    double                    bound;         ///< of the frequency [rad/s]
    ModesAtPoint              first, second; ///< the same one or two modes at both points
    std::vector<ModesAtPoint> beyond;        ///< and at the points before and behind them, where there are such
  };

  /// Where between the points the zero is likely to lie; nothing where that cannot be told. The same on every process.
  using PredictZero = std::function<std::optional<double>(const ZeroSearch &)>;
} // namespace Squeal
