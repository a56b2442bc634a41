#pragma once

#include <squeal/contact/coupled_system.h>

#include <map>
#include <memory>

namespace Squeal
{
  /// Dense matrices of a reduced quadratic pencil, r × r.
  struct ReducedPencil
  {
    DenseMatrix mass, damping, stiffness;
    bool        has_damping;
  };

  /**
   * Galerkin projection of the coupled system on a basis T, n × r (eqs. (12)
   * and (13) of the paper). The terms A of the system, TᵀAT or LᵀT and RᵀT of those of low rank, are
   * projected once and serve every value of their coefficients: friction, load and speed.
   *
   * A basis grows by extend(), which projects only what is new.
   */
  class ReducedModel
  {
  public:
    /// An empty basis; @p system must outlive the reduced model.
    explicit ReducedModel(const CoupledSystem &system);

    /// Appends the columns of @p vectors, n × k, to the basis.
    void extend(const MultiVector &vectors);

    /// r
    int size() const
    {
      return mass_matrix.rows();
    }

    /// T, n × r.
    const MultiVector &basis() const
    {
      return *T;
    }

    const CoupledSystem &full_order() const
    {
      return *system;
    }

    /// Σ θ TᵀAT by powers of λ.
    ReducedPencil at(const ParameterValues &values) const;

    /// TᵀM_cT and TᵀK_cT.
    const DenseMatrix &mass() const
    {
      return mass_matrix;
    }
    const DenseMatrix &stiffness() const
    {
      return stiffness_matrix;
    }

    /// TᵀAT of a sparse term of the system, by its number.
    const DenseMatrix &projected(const std::size_t term) const
    {
      return matrices[term];
    }

    /// FᵀT of a factor of a term of low rank, m × r.
    const DenseMatrix &motions(const LowRankFactor &factor) const
    {
      return factors.at(&factor);
    }

  private:
    const CoupledSystem                         *system;
    std::unique_ptr<MultiVector>                 T;
    std::vector<DenseMatrix>                     matrices; ///< TᵀAT of each term; empty for those with weights
    std::map<const LowRankFactor *, DenseMatrix> factors;
    DenseMatrix                                  mass_matrix, stiffness_matrix;
  };
} // namespace Squeal
