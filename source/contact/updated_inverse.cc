#include <squeal/contact/updated_inverse.h>
#include <squeal/linear_algebra/replicate.h>
#include <squeal/linear_algebra/sparse_matrix.h>

namespace Squeal
{
  namespace
  {
    /// S = K_c + s C_c + s² M_c of the symmetric sparse terms.
    std::shared_ptr<const SparseMatrix> frictionless_pencil(const CoupledSystem &system, const double shift)
    {
      std::vector<Term> terms;
      for (const Term &term : system.terms)
        if (term.is_sparse() && term.symmetry == Symmetry::symmetric)
          terms.push_back(term);
      return pencil_at(sparse_matrices(terms, system.values), shift);
    }
  } // namespace

  UpdatedInverse::UpdatedInverse(const CoupledSystem       &system,
                                 const double               shift,
                                 const FactorizationLibrary library,
                                 const AttachmentModes      attachment)
    : factor(factorize_positive_definite(*frictionless_pencil(system, shift), library, "stiffness of the coupled system without friction"))
    , A(system.friction_forces)
    , V(normal_reactions(system, shift))
  {
    if (attachment == AttachmentModes::at_once)
      attachment_modes();
  }

  const MultiVector &UpdatedInverse::attachment_modes() const
  {
    if (!X)
      X = std::make_unique<MultiVector>(solve_frictionless(A->columns(0, A->rank())));
    return *X;
  }

  MultiVector UpdatedInverse::attachment_modes_times(const DenseMatrix &B) const
  {
    return X ? *X * B : solve_frictionless(*A * B);
  }

  void UpdatedInverse::set_friction_coefficient(const double mu)
  {
    friction_coefficient = mu;
    const int n_c        = A->rank();
    if (!VX)
      VX = V ? replicate(*V * attachment_modes()) : DenseMatrix::Zero(n_c, n_c);
    correction = regular_lu(DenseMatrix::Identity(n_c, n_c) - mu * *VX, "stiffness with friction, condensed to the contact nodes");
  }

  void UpdatedInverse::apply(const MultiVector &B, MultiVector &Y) const
  {
    factor->apply(B, Y);
    if (friction_coefficient == 0. || !V)
      return;
    multiply_add(friction_coefficient, *X, correction->solve(replicate(*V * Y)), 1., Y);
  }

  MultiVector UpdatedInverse::solve_frictionless(const MultiVector &B) const
  {
    MultiVector            Y(B.map(), B.n_columns());
    const std::vector<int> columns = nonzero_columns(B); // imaginary parts of neutral modes are zero
    if (static_cast<int>(columns.size()) == B.n_columns())
      factor->apply(B, Y);
    else if (!columns.empty())
      {
        const MultiVector some = selected(B, columns);
        MultiVector       found(B.map(), some.n_columns());
        factor->apply(some, found);
        Y.local()(Eigen::all, columns) = found.local();
      }
    return Y;
  }

  const RowMap &UpdatedInverse::map() const
  {
    return factor->map();
  }
} // namespace Squeal
