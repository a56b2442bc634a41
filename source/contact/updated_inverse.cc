// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/memory.h>
#include <squeal/contact/updated_inverse.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <algorithm>

namespace Squeal
{
  namespace
  {
    /// S = K_c + s C_c + s² M_c from the symmetric sparse terms.
    std::shared_ptr<const SparseMatrix> frictionless_pencil(const CoupledSystem &system, const double shift)
    {
      std::vector<Term> terms;
      for (const Term &term : system.terms)
        if (term.is_sparse() && term.is_frictionless())
          terms.push_back(term);
      return pencil_at(sparse_matrices(terms, system.values), shift);
    }
  } // namespace

  bool may_keep_attachment_modes(const CoupledSystem &system)
  {
    if (system.n_contact() == 0)
      return false;
    const double bytes = double(sizeof(double)) * system.map().n_local() * system.n_contact();
    return largest_of_processes(system.map().communicator(), bytes / available_memory()) <= largest_part_of_attachment_modes;
  }

  UpdatedInverse::UpdatedInverse(const CoupledSystem       &system,
                                 const double               shift,
                                 const FactorizationLibrary library,
                                 const AttachmentModes      attachment)
    : attachment(attachment)
    , rows(system.map())
    , A(system.friction_forces)
    , V(normal_reactions(system, shift))
    , factor(factorize_positive_definite(*frictionless_pencil(system, shift), library, "stiffness of the coupled system without friction"))
  {
    if (attachment == AttachmentModes::at_once)
      find_attachment_modes();
  }

  const Factorization &UpdatedInverse::frictionless() const
  {
    return *factor;
  }

  void UpdatedInverse::find_attachment_modes() const
  {
    X = std::make_unique<MultiVector>(rows, A->rank(), false);
    for_column_blocks(A->rank(), [&](const int first, const int n) {
      MultiVector place = view(*X, first, n);
      factor->apply(A->columns(first, n), place);
    });
  }

  const MultiVector &UpdatedInverse::attachment_modes() const
  {
    if (!X)
      find_attachment_modes();
    return *X;
  }

  MultiVector UpdatedInverse::attachment_modes_times(const DenseMatrix &B) const
  {
    return X ? *X * B : solve_frictionless(*A * B);
  }

  void UpdatedInverse::for_responses(const LowRankFactor &F, const std::function<void(int first, const MultiVector &X_b)> &f) const
  {
    if (&F == A.get() && (X || attachment != AttachmentModes::not_kept))
      {
        f(0, attachment_modes());
        return;
      }
    for_column_blocks(F.rank(), [&](const int first, const int n) { f(first, solve_frictionless(F.columns(first, n))); });
  }

  void UpdatedInverse::set_friction_coefficient(const double mu)
  {
    friction_coefficient = mu;
    if (!V)
      return;
    const int n_c = A->rank();
    if (!VX)
      {
        VX = DenseMatrix::Zero(n_c, n_c);
        for_responses(*A,
                      [this](const int first, const MultiVector &X_b) { VX->middleCols(first, X_b.n_columns()) = replicate(*V * X_b); });
      }
    correction = regular_lu(DenseMatrix::Identity(n_c, n_c) - mu * *VX, "stiffness with friction, condensed to the contact nodes");
  }

  void UpdatedInverse::apply(const MultiVector &B, MultiVector &Y) const
  {
    frictionless().apply(B, Y);
    if (friction_coefficient == 0. || !V)
      return;
    const DenseMatrix forces = correction->solve(replicate(*V * Y));
    if (X)
      multiply_add(friction_coefficient, *X, forces, 1., Y);
    else
      frictionless().apply(B + friction_coefficient * (*A * forces), Y);
  }

  MultiVector UpdatedInverse::solve_frictionless(const MultiVector &B) const
  {
    MultiVector            Y(B.map(), B.n_columns());
    const std::vector<int> columns = nonzero_columns(B); // skip zero columns, for example the imaginary parts of neutral modes
    if (static_cast<int>(columns.size()) == B.n_columns())
      frictionless().apply(B, Y);
    else if (!columns.empty())
      {
        const MultiVector some = selected(B, columns);
        MultiVector       found(B.map(), some.n_columns());
        frictionless().apply(some, found);
        Y.local()(Eigen::placeholders::all, columns) = found.local();
      }
    return Y;
  }

  const RowMap &UpdatedInverse::map() const
  {
    return rows;
  }
} // namespace Squeal
