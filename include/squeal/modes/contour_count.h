// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/conventions.h>
#include <squeal/base/enum_table.h>
#include <squeal/base/progress.h>
#include <squeal/contact/coupled_system.h>
#include <squeal/eigen/symmetric_modes.h>

#include <vector>

namespace Squeal
{
  /// From where the determinant of the pencil is known on the contour.
  enum class ContourMethod
  {
    condensed, ///< a small matrix of the contact nodes beside the frictionless modes; see CondensedDeterminant
    sparse_lu  ///< complex LU factors of the sparse pencil for every point: small systems, one process
  };

  template <>
  inline constexpr EnumName<ContourMethod> enum_table<ContourMethod>[] = {{ContourMethod::condensed, "condensed"},
                                                                          {ContourMethod::sparse_lu, "sparse LU"}};

  /// Condensed where all terms but K_c and M_c are of low rank.
  ContourMethod contour_method(const CoupledSystem &system);

  /// Whether these processes can count the modes of the system: sparse LU takes one.
  bool is_countable(const CoupledSystem &system);

  /// The rectangle −a ≤ Re λ ≤ a, ω_low ≤ Im λ ≤ ω_high, and how its boundary is followed.
  struct ContourOptions
  {
    double largest_circular_frequency = 0.; ///< ω_high, the end of the band [rad/s]
    double lowest_frequency           = 0.; ///< ω_low > 0 [rad/s]; 0: a thousandth of ω_high
    double largest_growth             = 0.; ///< a > 0 [1/s]; 0: a tenth of ω_high

    double largest_phase_step = 1.0471975511965976; ///< of the determinant from point to point, below π [rad]
    int    maximum_points     = 20000;              ///< where the determinant is evaluated, for each friction coefficient

    ContourMethod method = ContourMethod::condensed;

    /// ω_d as a multiple of the largest |λ| of the contour, at least 1.05: real modes up to there are computed (condensed).
    double deflation = 1.4;

    /// How those are computed; shift and inverse are those of the condensed determinant, too.
    SymmetricModesOptions real_modes;
  };

  /// The rectangle of a band, from a thousandth of its end on.
  ContourOptions contour_of_band(const Band &band);

  /// How many of these eigenvalues lie in the rectangle.
  int n_in_rectangle(const std::vector<std::complex<double>> &lambda, const ContourOptions &contour);

  /// Throws SolverError unless @p n_counted of these eigenvalues lie in the rectangle.
  void check_count(int n_counted, const std::vector<std::complex<double>> &lambda, const ContourOptions &contour);

  /// Complex modes in the rectangle, and what the count rests on.
  struct ContourCount
  {
    int    n_modes            = 0;  ///< with multiplicity
    int    n_frictionless     = 0;  ///< real modes with ω_low < ω < ω_high without friction and damping, by inertia
    int    n_points           = 0;  ///< where determinants were evaluated
    double largest_phase_step = 0.; ///< of the accepted steps [rad]
    double truncation_bound = 0.; ///< bound of the largest ‖ΔN N⁻¹‖ on the contour (condensed): Rouché's theorem asks for less than 1 [-]
    int n_moments           = 0; ///< terms of the series (condensed)
  };

  /**
   * Number of complex modes of the system inside the rectangle at each of the
   * friction coefficients @p mu, without computing any of them: by the argument
   * principle it is the number of turns that det Q(λ), an entire function, makes
   * about zero along the boundary. Modes with |Re λ| > a are not counted.
   *
   * Condensed: det Q = det S det N_⊥ det W. The zeros of det S, those of the real
   * modes, are counted by inertia; the turns of det N_⊥ and det W are added. From
   * point to point, each matrix changes to A' = A (I + F) with
   *
   *   ‖F‖_F ≤ ½, so that |ln det(I + F) − tr F| ≤ −ln(1 − ‖F‖_F) − ‖F‖_F < 0.2,
   *
   * in suitably scaled coordinates, and the phase of the step is known without doubt about multiples of 2π; nor
   * is a step of W longer than half the distance to the nearest pole ±iω_j. What the
   * series leaves out of N cannot change the count while ‖ΔN N⁻¹‖ < 1 (Rouché),
   * of which a quarter is allowed at the points; otherwise terms are added.
   *
   * Sparse LU: the turns of det Q itself. A step is halved until |Δ ln det Q| of
   * both its halves is below the largest phase step: modulus and phase together,
   * so that zeros close by cannot hide.
   *
   * Without damping det Q(−λ̄) is the conjugate of det Q(λ): half of the contour
   * is followed.
   *
   * Throws SolverError, naming the place on the contour, if a zero or a real mode
   * lies on it to working precision or more points would be needed than allowed;
   * if the bodies have damping of their own (condensed) or modes have (sparse LU);
   * on several processes (sparse LU).
   */
  std::vector<ContourCount> count_by_contour(const CoupledSystem       &system,
                                             const std::vector<double> &mu,
                                             const ContourOptions      &options,
                                             Progress                  &progress);

  /// The same by sparse LU of matrices none of which need be symmetric or definite; n_frictionless stays zero.
  ContourCount count_by_sparse_lu(const SecondOrderSystem &matrices, const ContourOptions &options, Progress &progress);
} // namespace Squeal
