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
  /// Method for the determinant of the pencil on the contour.
  enum class ContourMethod
  {
    condensed, ///< small matrices for the contact nodes and the frictionless modes; see CondensedDeterminant
    sparse_lu  ///< complex LU factors of the sparse pencil at every point; for small systems on one process
  };

  template <>
  inline constexpr EnumName<ContourMethod> enum_table<ContourMethod>[] = {{ContourMethod::condensed, "condensed"},
                                                                          {ContourMethod::sparse_lu, "sparse LU"}};

  /// Method for a system; condensed if all terms except K_c and M_c have low rank.
  ContourMethod contour_method(const CoupledSystem &system);

  /// True if the modes of the system can be counted with the current number of processes; sparse LU requires a single process.
  bool is_countable(const CoupledSystem &system);

  /// The rectangle −a ≤ Re λ ≤ a, ω_low ≤ Im λ ≤ ω_high, and options for its boundary.
  struct ContourOptions
  {
    double largest_circular_frequency = 0.; ///< ω_high, the end of the band [rad/s]
    double lowest_frequency           = 0.; ///< ω_low > 0 [rad/s]; 0: a thousandth of ω_high
    double largest_growth             = 0.; ///< a > 0 [1/s]; 0: a tenth of ω_high

    double largest_phase_step = 1.0471975511965976; ///< largest change of the determinant's phase between points, below π [rad]
    int    maximum_points     = 20000;              ///< maximum number of evaluations of the determinant for each friction coefficient

    ContourMethod method = ContourMethod::condensed;

    /// ω_d as a multiple of the largest |λ| of the contour, at least 1.05. The condensed method uses the real modes up to ω_d.
    double deflation = 1.4;

    /// Options for the real modes up to ω_d; shift and inverse are also used for the condensed determinant.
    SymmetricModesOptions real_modes;
  };

  /// Rectangle of a band; its lower edge is at 0.001 of the band's end.
  ContourOptions contour_of_band(const Band &band);

  int n_in_rectangle(const std::vector<std::complex<double>> &lambda, const ContourOptions &contour);

  /// Throws SolverError unless exactly @p n_counted of the given eigenvalues are in the rectangle.
  void check_count(int n_counted, const std::vector<std::complex<double>> &lambda, const ContourOptions &contour);

  /// Number of complex modes in the rectangle, and evidence for the count.
  struct ContourCount
  {
    int    n_modes            = 0;  ///< number of modes, with multiplicity
    int    n_frictionless     = 0;  ///< number of real modes with ω_low < ω < ω_high without friction and damping, by inertia
    int    n_points           = 0;  ///< number of evaluations of the determinant
    double largest_phase_step = 0.; ///< largest phase of the accepted steps [rad]
    double truncation_bound   = 0.; ///< bound of ‖ΔN N⁻¹‖ on the contour (condensed); must be below 1 by Rouché's theorem [-]
    int    n_moments          = 0;  ///< number of terms of the series (condensed)
  };

  /**
   * Counts the complex modes of the system inside the rectangle at each friction coefficient in @p mu without computing the modes. By the
   * argument principle, their number is the winding number of the entire function det Q(λ) about zero along the boundary. Modes with |Re λ|
   * > a are not counted.
   *
   * Condensed: det Q = det S det N_⊥ det W. The zeros of det S are the real modes, counted by inertia; the winding numbers of det N_⊥ and
   * det W are added. Between points, each matrix changes to A' = A (I + F) with
   *
   *   ‖F‖_F ≤ ½, so that |ln det(I + F) − tr F| ≤ −ln(1 − ‖F‖_F) − ‖F‖_F < 0.2,
   *
   * in suitably scaled coordinates, so that the phase of the step is unique, without multiples of 2π. Steps of W are at most half the
   * distance to the nearest pole ±iω_j. The truncation error of N cannot change the count if ‖ΔN N⁻¹‖ < 1 (Rouché); at most 0.25 is
   * accepted at the points, otherwise terms are added.
   *
   * Sparse LU: the winding number of det Q is computed directly. A step is reduced until |Δ ln det Q| of both halves (modulus and phase) is
   * below the largest phase step, so that zeros close to the contour are detected.
   *
   * Without damping, det Q(−λ̄) is the conjugate of det Q(λ), and only half of the contour is followed.
   *
   * Throws a SolverError with the point if a zero or a real mode lies on the contour to working precision, or if more points are needed
   * than allowed. Also throws SolverError if the bodies are damped (condensed), if there is modal damping (sparse LU), and with several
   * processes (sparse LU).
   */
  std::vector<ContourCount> count_by_contour(const CoupledSystem       &system,
                                             const std::vector<double> &mu,
                                             const ContourOptions      &options,
                                             Progress                  &progress);

  /// Counts by sparse LU for matrices that need not be symmetric or definite; n_frictionless is zero.
  ContourCount count_by_sparse_lu(const SecondOrderSystem &matrices, const ContourOptions &options, Progress &progress);
} // namespace Squeal
