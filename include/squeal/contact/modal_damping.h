#pragma once

#include <squeal/linear_algebra/multivector.h>

#include <memory>
#include <vector>

namespace Squeal
{
  /**
   * Damping of the real coupled modes Φ (n × k, M_c-orthonormal), each by its
   * own ratio ζ_j of the critical one,
   *
   *   C_m = M_c Φ diag(2 ζ_j ω_j) Φᵀ M_c     n × n, symmetric, of rank k, never formed
   *
   * so that Φᵀ C_m Φ = diag(2 ζ_j ω_j) and, without friction and other damping,
   * λ_j = −ζ_j ω_j ± i ω_j √(1 − ζ_j²).
   */
  struct ModalDamping
  {
    MultiVector         mass_times_modes; ///< M_c Φ, n × k
    std::vector<double> coefficients;     ///< 2 ζ_j ω_j [1/s]

    /// C_m X.
    MultiVector operator*(const MultiVector &X) const;
  };

  /**
   * C_m from modes with the @p eigenvalues ω² [rad²/s²] and the @p ratios ζ [-],
   * one of each for every column of @p modes. A mode with ω = 0 gets no damping; null
   * if none gets any.
   */
  std::shared_ptr<const ModalDamping> modal_damping(const SparseMatrix        &mass,
                                                    const MultiVector         &modes,
                                                    const std::vector<double> &eigenvalues,
                                                    const std::vector<double> &ratios);
} // namespace Squeal
