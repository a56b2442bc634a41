// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/reduction/reduced_model.h>

#include <array>

namespace Squeal
{
  namespace
  {
    /// Extends a matrix with Aᵀ = sign A, symmetric or skew, by its new last columns, r × k.
    void border(DenseMatrix &matrix, const DenseMatrix &new_columns, const double sign)
    {
      const Eigen::Index r = new_columns.rows(), old = r - new_columns.cols();
      matrix.conservativeResize(r, r);
      for (Eigen::Index j = old; j < r; ++j)
        {
          matrix.row(j).head(j)     = sign * new_columns.col(j - old).head(j).transpose();
          matrix.col(j).head(j + 1) = new_columns.col(j - old).head(j + 1);
        }
    }

    std::shared_ptr<const SparseMatrix> as_sparse(const DenseMatrix &A, const RowMap &rows, const RowMap &columns)
    {
      return std::make_shared<SparseMatrix>(rows, columns, [&](const int i, SparseMatrix::Row &row) {
        for (Eigen::Index j = 0; j < A.cols(); ++j)
          row.emplace_back(static_cast<int>(j), A(rows.number(i), j));
      });
    }
  } // namespace

  ReducedModel::ReducedModel(const CoupledSystem &system)
    : full(&system)
    , matrices(system.terms.size())
  {}

  void ReducedModel::extend(MultiVector given)
  {
    const int old = size();
    modes.reset(); // computed for the old basis
    if (old == 0)
      T = std::make_shared<MultiVector>(std::move(given));
    else if (T.use_count() == 1)
      T->append(given);
    else
      T = std::make_shared<MultiVector>(join({&basis(), &given}));
    // Take the view after extending T, which may reallocate
    const MultiVector vectors = view(*T, old, T->n_columns() - old);

    std::map<const LowRankFactor *, bool> is_extended;
    for (std::size_t k = 0; k < matrices.size(); ++k)
      {
        const Term &term = full->terms[k];
        if (term.matrix)
          {
            border(matrices[k], weighted_gram(*T, *term.matrix, vectors), term.symmetry == Symmetry::skew ? -1. : 1.);
            continue;
          }
        for (const LowRankFactor *factor : {term.left.get(), term.right.get()})
          if (!std::exchange(is_extended[factor], true))
            factors[factor] = append_columns(factors[factor], factor->transpose_times(vectors));
        if (term.weights.empty())
          matrices[k] = motions(*term.left).transpose() * motions(*term.right);
      }
    find_norms();
  }

  void ReducedModel::find_norms()
  {
    DenseMatrix sums[2];
    for (std::size_t k = 0; k < matrices.size(); ++k)
      if (const Term &term = full->terms[k]; term.matrix && term.is_frictionless() && term.power != 1)
        {
          DenseMatrix      &sum  = sums[term.power / 2];
          const DenseMatrix part = term.coefficient.at(full->values) * matrices[k];
          sum                    = sum.size() == 0 ? part : DenseMatrix(sum + part);
        }
    stiffness_matrix = sums[0];
    mass_matrix      = sums[1];
    modes.reset();
  }

  ReducedModel ReducedModel::restricted(const DenseMatrix &Z, const bool with_basis) const
  {
    ReducedModel result(*full);
    if (with_basis)
      result.T = std::make_shared<MultiVector>(*T * Z);
    for (const auto &[factor, motions] : factors)
      result.factors[factor] = motions * Z;
    for (std::size_t k = 0; k < matrices.size(); ++k)
      if (matrices[k].size() > 0)
        result.matrices[k] = Z.transpose() * matrices[k] * Z;
    result.find_norms();
    return result;
  }

  const ReducedModel::Modal &ReducedModel::modal() const
  {
    if (!modes)
      {
        auto [squares, V] = symmetric_eigenpairs(stiffness(), mass());
        // Restore orthonormality to the last digits: V (3 I − VᵀMV) / 2
        V = 1.5 * V - 0.5 * V * (V.transpose() * mass() * V).eval();
        Modal result{std::move(squares), V, restricted(V)};
        // Set exact values, because computed values contain rounding errors
        result.model.mass_matrix      = DenseMatrix::Identity(size(), size());
        result.model.stiffness_matrix = as_column(result.squares).asDiagonal();
        modes                         = std::make_shared<const Modal>(std::move(result));
      }
    return *modes;
  }

  CoupledSystem ReducedModel::system() const
  {
    const MPI_Comm communicator = full->map().communicator();
    const RowMap   map          = RowMap::even(size(), communicator);
    CoupledSystem  result;
    result.values = full->values;
    result.varied = full->varied;
    result.kernel = as_sparse(DenseMatrix::Identity(size(), size()), map, map);
    std::map<const LowRankFactor *, std::shared_ptr<const LowRankFactor>> of_full_order;
    const auto reduced_factor = [&](const std::shared_ptr<const LowRankFactor> &factor) {
      auto &entry = of_full_order[factor.get()];
      if (!entry)
        entry = std::make_shared<LowRankFactor>(as_sparse(motions(*factor), RowMap::even(factor->rank(), communicator), map));
      return entry;
    };
    for (std::size_t k = 0; k < matrices.size(); ++k)
      {
        Term term = full->terms[k];
        if (!term.weights.empty())
          {
            term.left  = reduced_factor(term.left);
            term.right = reduced_factor(term.right);
            result.terms.push_back(term);
            continue;
          }
        term.left = term.right = nullptr;
        term.matrix            = as_sparse(matrices[k], map, map);
        for (Term &part : split_by_symmetry(term))
          result.terms.push_back(std::move(part));
      }
    return result;
  }

  ReducedPencil ReducedModel::at(const ParameterValues &values) const
  {
    std::array<DenseMatrix, 3> sums;
    for (std::size_t k = 0; k < matrices.size(); ++k)
      {
        const Term &term = full->terms[k];
        if (term.vanishes(values))
          continue;
        DenseMatrix &sum = sums[term.power];
        if (sum.size() == 0)
          sum = DenseMatrix::Zero(size(), size());
        if (term.weights.empty())
          sum += term.coefficient.at(values) * matrices[k];
        else
          sum += term.coefficient.at(values) * motions(*term.left).transpose() * term.weighted(motions(*term.right), values);
      }
    const bool has_damping = sums[1].size() > 0;
    return {std::move(sums[2]), std::move(sums[1]), std::move(sums[0]), has_damping};
  }
} // namespace Squeal
