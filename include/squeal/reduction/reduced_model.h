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
    int size() const;

    /// T, n × r.
    const MultiVector &basis() const;

    const CoupledSystem &full_order() const;

    /// Σ θ TᵀAT by powers of λ.
    ReducedPencil at(const ParameterValues &values) const;

    /// TᵀM_cT and TᵀK_cT.
    const DenseMatrix &mass() const;
    const DenseMatrix &stiffness() const;

    /// TᵀAT of a sparse term of the system, by its number.
    const DenseMatrix &projected(std::size_t term) const;

    /// FᵀT of a factor of a term of low rank, m × r.
    const DenseMatrix &motions(const LowRankFactor &factor) const;

  private:
    const CoupledSystem                         *system;
    std::unique_ptr<MultiVector>                 T;
    std::vector<DenseMatrix>                     matrices; ///< TᵀAT of each term; empty for those with weights
    std::map<const LowRankFactor *, DenseMatrix> factors;
    DenseMatrix                                  mass_matrix, stiffness_matrix;
  };
} // namespace Squeal
