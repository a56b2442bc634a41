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
  /// When the n_c columns of X are solved for, which takes longer than the factor, and whether they are kept, a dense n × n_c matrix.
  enum class AttachmentModes
  {
    at_once,     ///< with the factor
    when_needed, ///< by a friction coefficient or by who asks for them: never, for a solver that works on a basis
    not_kept     ///< each product with X is another solve with the factor
  };

  /// Whether a dense n × n_c matrix has room in the memory that is left: an eighth of it is what this process may take for one.
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
   * The factor and X serve every μ; the n_c × n_c matrix is factorised for each. Without X, whose columns are then solved for a
   * few at a time to make V X, Q(s)⁻¹ B = S⁻¹ (B + μ A (I − μ V X)⁻¹ V S⁻¹ B).
   */
  class UpdatedInverse : public LinearOperator
  {
  public:
    /// Factorises S; throws SolverError if S is not positive definite.
    UpdatedInverse(const CoupledSystem &system,
                   double               shift,
                   FactorizationLibrary library,
                   AttachmentModes      attachment = AttachmentModes::at_once);

    /// Friction coefficient of the following apply(); throws SolverError if Q(s) is singular there.
    void set_friction_coefficient(double mu);

    /// Y = Q(s)⁻¹ X.
    void apply(const MultiVector &X, MultiVector &Y) const override;

    /// S⁻¹ X: the frictionless inverse.
    MultiVector solve_frictionless(const MultiVector &X) const;

    const RowMap &map() const override;

    /// S⁻¹ A, n × n_c: the coupled tangential attachment modes (for s = 0), kept from now on.
    const MultiVector &attachment_modes() const;

    /// f(first, X_b) for blocks X_b of columns of S⁻¹ F that begin with column `first`.
    void for_responses(const LowRankFactor &F, const std::function<void(int first, const MultiVector &X_b)> &f) const;

    /// X B for B, n_c × k, the same on every process: k solves if X is not there yet.
    MultiVector attachment_modes_times(const DenseMatrix &B) const;

    /// S⁻¹ by itself. Several threads may ask for it, and for apply() without friction.
    const Factorization &frictionless() const;

  private:
    void find_attachment_modes() const;

    const AttachmentModes                attachment;
    const RowMap                         rows;
    std::shared_ptr<const LowRankFactor> A;
    std::shared_ptr<const SparseMatrix>  V;
    mutable std::unique_ptr<MultiVector> X;      ///< once it has been needed
    std::unique_ptr<const Factorization> factor; ///< of S
    std::optional<DenseMatrix>           VX;     ///< n_c × n_c, on every process
    double                               friction_coefficient = 0.;
    std::optional<RealLU>                correction;
  };
} // namespace Squeal
