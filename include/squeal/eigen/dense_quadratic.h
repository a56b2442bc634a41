// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/eigen/band_subspaces.h>

#include <complex>
#include <limits>
#include <vector>

namespace Squeal
{
  /// Selects whether eigenvectors of real eigenvalues are computed.
  enum class RealVectors
  {
    none,
    wanted
  };

  /// Eigenvalues of a small quadratic pencil, with right and left vectors.
  struct DenseQuadraticModes
  {
    /// λ with vectors, ascending by Im, then Re: 0 < Im λ ≤ largest_circular_frequency and, if requested, real λ (without damping only λ ≥
    /// 0 of each pair ±λ).
    std::vector<std::complex<double>> values;

    ComplexDenseMatrix right; ///< φ, r × k: Q(λ) φ = 0, ‖φ‖₂ = 1, the entry of largest modulus real and positive
    ComplexDenseMatrix left;  ///< ψ, r × k: ψᵀ Q(λ) = 0 (plain transpose), normalised like φ

    std::vector<double> real_values; ///< all real λ, ascending: overdamped, divergent or zero
  };

  /**
   * All eigenvalues of Q(λ) = λ² M + λ C + K, small dense real r × r matrices,
   * with 0 < Im λ ≤ @p largest_circular_frequency [rad/s], by the companion form
   *
   *     [ 0        I      ]
   *     [ -M⁻¹ K   -M⁻¹ C ]  [φ; λ φ] = λ [φ; λ φ],
   *
   * or, without damping (null), -M⁻¹ K φ = λ² φ, for which λ → -λ holds exactly. λ is measured in units of √(‖K‖/‖M‖) (Fan, Lin, Van Dooren
   * 2004); φ is the larger half of the right vector, ψ = M⁻ᵀ times the second half of the left vector. Each well-conditioned λ receives one
   * two-sided Rayleigh correction -ψᵀQ(λ)φ / ψᵀQ'(λ)φ. Throws SolverError if M is singular or the QR algorithm fails.
   */
  DenseQuadraticModes dense_quadratic_modes(const DenseMatrix &mass,
                                            const DenseMatrix *damping,
                                            const DenseMatrix &stiffness,
                                            double             largest_circular_frequency = std::numeric_limits<double>::infinity(),
                                            RealVectors        real_vectors               = RealVectors::none);

  /**
   * Computes the modes of dense_quadratic_modes() with the QR algorithm restricted to the modes of the band, which band_subspaces() or
   * damped_band_subspaces() separate. Empty if the band cannot be separated. Otherwise the modes outside the band have no real λ.
   *
   * @param mass,damping,stiffness matrices in modal coordinates of a nearby symmetric pencil
   * @param squares                ω² of these modes, ascending
   */
  std::optional<DenseQuadraticModes> dense_modes_of_band(const DenseMatrix         &mass,
                                                         const DenseMatrix         *damping,
                                                         const DenseMatrix         &stiffness,
                                                         const std::vector<double> &squares,
                                                         double                     largest_circular_frequency);

  /// Scales every column to ‖x‖₂ = 1 with its entry of largest modulus real and positive.
  void normalize_columns(ComplexDenseMatrix &X);
} // namespace Squeal
