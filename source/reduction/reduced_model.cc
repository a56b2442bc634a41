#include <squeal/reduction/reduced_model.h>

#include <array>

namespace Squeal
{
  namespace
  {
    /// Extends a matrix with Aᵀ = sign A, symmetric or skew, to the size of its new last columns, r × k.
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
  } // namespace

  ReducedModel::ReducedModel(const CoupledSystem &system)
    : system(&system)
    , matrices(system.terms.size())
  {}

  void ReducedModel::extend(const MultiVector &vectors)
  {
    T = std::make_unique<MultiVector>(T ? join({T.get(), &vectors}) : vectors);

    std::map<const LowRankFactor *, bool> is_extended;
    for (std::size_t k = 0; k < matrices.size(); ++k)
      {
        const Term &term = system->terms[k];
        if (term.matrix)
          {
            border(matrices[k], gram(*T, *term.matrix * vectors), term.symmetry == Symmetry::skew ? -1. : 1.);
            if (term.matrix == system->mass)
              mass_matrix = matrices[k];
            if (term.matrix == system->stiffness)
              stiffness_matrix = matrices[k];
            continue;
          }
        for (const LowRankFactor *factor : {term.left.get(), term.right.get()})
          if (!std::exchange(is_extended[factor], true))
            factors[factor] = append_columns(factors[factor], factor->transpose_times(vectors));
        if (term.weights.empty())
          matrices[k] = motions(*term.left).transpose() * motions(*term.right);
      }
  }

  ReducedPencil ReducedModel::at(const ParameterValues &values) const
  {
    std::array<DenseMatrix, 3> sums;
    for (std::size_t k = 0; k < matrices.size(); ++k)
      {
        const Term &term = system->terms[k];
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
