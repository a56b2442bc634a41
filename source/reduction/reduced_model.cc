#include <squeal/reduction/reduced_model.h>

#include <array>

namespace Squeal
{
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
            const DenseMatrix columns = gram(*T, *term.matrix * vectors);
            border(matrices[k], columns, term.symmetry == Symmetry::skew ? -1. : 1.);
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
          matrices[k] = multiply(motions(*term.left), motions(*term.right), true);
      }
  }

  int ReducedModel::size() const
  {
    return mass_matrix.n_rows();
  }

  const MultiVector &ReducedModel::basis() const
  {
    return *T;
  }

  const CoupledSystem &ReducedModel::full_order() const
  {
    return *system;
  }

  const DenseMatrix &ReducedModel::mass() const
  {
    return mass_matrix;
  }

  const DenseMatrix &ReducedModel::stiffness() const
  {
    return stiffness_matrix;
  }

  const DenseMatrix &ReducedModel::projected(const std::size_t term) const
  {
    return matrices[term];
  }

  const DenseMatrix &ReducedModel::motions(const LowRankFactor &factor) const
  {
    return factors.at(&factor);
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
        if (sum.n_rows() == 0)
          sum = DenseMatrix(size(), size());
        if (term.weights.empty())
          sum = add(sum, matrices[k], term.coefficient.at(values));
        else
          sum = add(sum, multiply(motions(*term.left), term.weighted(motions(*term.right), values), true), term.coefficient.at(values));
      }
    const bool has_damping = sums[1].n_rows() > 0;
    return {std::move(sums[2]), std::move(sums[1]), std::move(sums[0]), has_damping};
  }
} // namespace Squeal
