// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/contact/coupled_system.h>
#include <squeal/linear_algebra/dense_lu.h>
#include <squeal/linear_algebra/factorization.h>

#include <functional>
#include <memory>
#include <optional>

namespace Squeal
{
  /// Storage of the attachment modes X, a dense n × n_c matrix that usually takes longer to compute than the factor.
  enum class AttachmentModes
  {
    at_once,     ///< computed with the factor
    when_needed, ///< computed on first use; residual iteration does not need X
    not_kept     ///< computed for each product with X, by solves with the factor
  };

  /// True if there are contact nodes and a dense n × n_c matrix fits into an eighth of the available memory.
  bool may_keep_attachment_modes(const CoupledSystem &system);

  /**
   * Inverse of the pencil with friction at a real shift s ≥ 0,
   *
   *   Q(s) = S − μ A V,   S = K_c + s C_c + s² M_c,   V = V_K + s V_C + s² V_M,
   *
   * from one Cholesky factor of the frictionless S (the Sherman-Morrison-
   * Woodbury formula with the coupled tangential attachment modes X = S⁻¹ A):
   *
   *   Q(s)⁻¹ = S⁻¹ + μ X (I − μ V X)⁻¹ V S⁻¹
   *
   * The factor and X are reused for every μ; only the n_c × n_c matrix is refactorised. If X is not kept, its columns are solved for in
   * blocks to compute V X, and Q(s)⁻¹ B = S⁻¹ (B + μ A (I − μ V X)⁻¹ V S⁻¹ B).
   */
  class UpdatedInverse : public LinearOperator
  {
  public:
    /// Factorises S; throws SolverError if S is not positive definite.
    UpdatedInverse(const CoupledSystem &system,
                   double               shift,
                   FactorizationLibrary library,
                   AttachmentModes      attachment = AttachmentModes::at_once);

    /// Sets the friction coefficient for apply(); throws SolverError if Q(s) is singular at this value.
    void set_friction_coefficient(double mu);

    /// Y = Q(s)⁻¹ X.
    void apply(const MultiVector &X, MultiVector &Y) const override;

    /// S⁻¹ X: the frictionless inverse.
    MultiVector solve_frictionless(const MultiVector &X) const;

    const RowMap &map() const override;

    /// S⁻¹ A, n × n_c: the coupled tangential attachment modes (for s = 0). Kept once computed.
    const MultiVector &attachment_modes() const;

    /// Calls f(first, X_b) for blocks X_b of columns of S⁻¹ F, starting at column `first`.
    void for_responses(const LowRankFactor &F, const std::function<void(int first, const MultiVector &X_b)> &f) const;

    /// X B for a replicated matrix B, n_c × k; takes k solves if X has not been computed.
    MultiVector attachment_modes_times(const DenseMatrix &B) const;

    /// Factor of S. Several threads may use this factor and apply() without friction concurrently.
    const Factorization &frictionless() const;

  private:
    void find_attachment_modes() const;

    const AttachmentModes                attachment;
    const RowMap                         rows;
    std::shared_ptr<const LowRankFactor> A;
    std::shared_ptr<const SparseMatrix>  V;
    mutable std::unique_ptr<MultiVector> X;      ///< computed on first use
    std::unique_ptr<const Factorization> factor; ///< Cholesky factor of S
    std::optional<DenseMatrix>           VX;     ///< n_c × n_c, on every process
    double                               friction_coefficient = 0.;
    std::optional<RealLU>                correction;
  };
} // namespace Squeal
