// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/contact/coupled_system.h>
#include <squeal/linear_algebra/multivector.h>

#include <map>
#include <memory>
#include <optional>

namespace Squeal
{
  /// Dense matrices of a reduced quadratic pencil, r × r.
  struct ReducedPencil
  {
    DenseMatrix mass, damping, stiffness;
    bool        has_damping;
  };

  /**
   * Galerkin projection of the coupled system on a basis T, n × r (eqs. (12) and (13) of the paper). The terms A of the system are
   * projected once, as TᵀAT, or as LᵀT and RᵀT for low rank, and reused for all values of their coefficients: friction, load and speed.
   *
   * extend() appends vectors to the basis and projects only these vectors.
   */
  class ReducedModel
  {
  public:
    /// An empty basis; @p system must outlive the reduced model.
    explicit ReducedModel(const CoupledSystem &system);

    /// Appends the columns of @p vectors, n × k, to the basis.
    void extend(MultiVector vectors);

    /// The model on the basis T Z with Z, r × k; its basis() is available only if @p with_basis.
    ReducedModel restricted(const DenseMatrix &Z, bool with_basis = false) const;

    /// Size r of the basis.
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
      return *full;
    }

    /// Σ θ TᵀAT, grouped by powers of λ.
    ReducedPencil at(const ParameterValues &values) const;

    /// The model as a system of r dofs with terms TᵀAT. Low-rank terms with weights keep their factors, as FᵀT; other low-rank terms are
    /// multiplied out.
    CoupledSystem system() const;

    /// TᵀM_cT and TᵀK_cT.
    const DenseMatrix &mass() const
    {
      return mass_matrix;
    }
    const DenseMatrix &stiffness() const
    {
      return stiffness_matrix;
    }

    /// The model in the coordinates of its undamped, frictionless modes V, with basis T V; computed on demand and kept until the basis
    /// changes.
    struct Modal;
    const Modal &modal() const;

    /// TᵀAT of the sparse term with this index.
    const DenseMatrix &projected(const std::size_t term) const
    {
      return matrices[term];
    }

    /// FᵀT of a factor of a low-rank term, m × r.
    const DenseMatrix &motions(const LowRankFactor &factor) const
    {
      return factors.at(&factor);
    }

  private:
    /// Computes TᵀM_cT and TᵀK_cT from the terms.
    void find_norms();

    const CoupledSystem                         *full;
    std::shared_ptr<MultiVector>                 T;        ///< null in a restricted model without basis
    std::vector<DenseMatrix>                     matrices; ///< TᵀAT of each term; empty for low-rank terms with weights
    std::map<const LowRankFactor *, DenseMatrix> factors;
    DenseMatrix                                  mass_matrix, stiffness_matrix;
    mutable std::shared_ptr<const Modal>         modes; ///< null until requested
  };

  struct ReducedModel::Modal
  {
    std::vector<double> squares; ///< ω² of (TᵀK_cT, TᵀM_cT), ascending
    DenseMatrix         vectors; ///< V, r × r, VᵀTᵀM_cTV = I
    ReducedModel        model;   ///< the model on the basis T V
  };
} // namespace Squeal
