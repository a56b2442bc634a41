#pragma once

#include <squeal/contact/coupled_system.h>
#include <squeal/linear_algebra/dense_lu.h>
#include <squeal/linear_algebra/factorization.h>

#include <memory>
#include <optional>

namespace Squeal
{
  /// When the n_c columns of X are solved for, which takes longer than the factor and memory for a dense n × n_c matrix.
  enum class AttachmentModes
  {
    at_once,
    when_needed ///< by a friction coefficient or by who asks for them: never, for a solver that works on a basis
  };

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
   * The factor and X serve every μ; the n_c × n_c matrix is factorised for each.
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

    /// S⁻¹ A, n × n_c: the coupled tangential attachment modes (for s = 0).
    const MultiVector &attachment_modes() const;

    /// X B for B, n_c × k, the same on every process: k solves if X is not there yet.
    MultiVector attachment_modes_times(const DenseMatrix &B) const;

    /// S⁻¹ by itself.
    const Factorization &frictionless() const
    {
      return *factor;
    }

  private:
    std::unique_ptr<Factorization>       factor;
    std::shared_ptr<const LowRankFactor> A;
    std::shared_ptr<const SparseMatrix>  V;
    mutable std::unique_ptr<MultiVector> X;  ///< once it has been needed
    std::optional<DenseMatrix>           VX; ///< the same, n_c × n_c, on every process
    double                               friction_coefficient = 0.;
    std::optional<RealLU>                correction;
  };
} // namespace Squeal
