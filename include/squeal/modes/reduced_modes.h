// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/conventions.h>
#include <squeal/reduction/reduced_model.h>

#include <complex>
#include <optional>
#include <vector>

namespace Squeal
{
  /// Oscillating modes of a reduced model, eq. (12) of the paper, right and left, in the coordinates of its basis.
  struct ReducedModes
  {
    ParameterValues values;
    ReducedPencil   pencil;
    DenseMatrix     mass, stiffness; ///< TᵀM_cT and TᵀK_cT, for the norms

    std::vector<std::complex<double>> lambda; ///< Im λ > 0, ascending by Im, then Re [rad/s]
    ComplexDenseMatrix                right;  ///< φ_r, r × k
    ComplexDenseMatrix                left;   ///< ψ_r, r × k: ψ_rᵀ Q_r(λ) = 0 (without conjugation)

    std::vector<double> real_values; ///< real λ ≠ 0, ascending [1/s]
    int                 n_zeros = 0; ///< number of λ = 0: two for each rigid-body mode without damping
  };

  /// Treatment of modes beyond the end of the band.
  enum class BandEnd
  {
    cut,
    open ///< all reduced modes are kept, because they may be counterparts of reference modes
  };

  /// Modes of @p model at the friction coefficient @p mu. Real λ are separated from oscillating modes by thresholds relative to @p
  /// largest_circular_frequency [rad/s], the end of the band.
  ReducedModes reduced_modes(const ReducedModel &model, double mu, double largest_circular_frequency, BandEnd end = BandEnd::cut);

  /// Modes at any parameter values, on this process only; vectors of a multiple eigenvalue may differ between processes.
  ReducedModes local_reduced_modes(const ReducedModel    &model,
                                   const ParameterValues &values,
                                   double                 largest_circular_frequency,
                                   BandEnd                end = BandEnd::cut);

  /// Computes local_reduced_modes() by the QR algorithm for all modes, without separating the band first.
  ReducedModes local_reduced_modes_by_qr(const ReducedModel    &model,
                                         const ParameterValues &values,
                                         double                 largest_circular_frequency,
                                         BandEnd                end = BandEnd::cut);

  /// Modes of the band, with vectors and matrices in the coordinates of ReducedModel::modal(); no value if the band cannot be separated.
  std::optional<ReducedModes> modal_modes_of_band(const ReducedModel    &model,
                                                  const ParameterValues &values,
                                                  double                 largest_circular_frequency);

  /// Nonzero real eigenvalues of @p model in the band, with their vectors: static divergence and overdamped motions. Without damping, only
  /// λ > 0 of each pair ±λ is included.
  ReducedModes real_eigenvalue_modes(const ReducedModel &model, double mu, const Band &band);

  /// Modes without friction and damping, λ = iω and ψ = φ, from the symmetric eigenproblem of TᵀK_cT and TᵀM_cT.
  ReducedModes reduced_real_modes(const ReducedModel &model, double largest_circular_frequency, BandEnd end = BandEnd::cut);

  /// The modes with the indices @p chosen, in this order.
  ReducedModes selected(const ReducedModes &modes, const std::vector<int> &chosen);
} // namespace Squeal
