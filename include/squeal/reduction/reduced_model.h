#pragma once

#include <squeal/contact/coupled_system.h>

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
   * and (13) of the paper). Friction being affine in μ, blocks projected once
   * serve every friction coefficient:
   *
   *   Tᵀ M_c T,  Tᵀ (C_c + C_m) T,  Tᵀ K_c T,  (Tᵀ A)(V_M T),  (Tᵀ A)(V_C T),  (Tᵀ A)(V_K T)
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

    /// M_r − μ A_r V_Mr, C_r − μ A_r V_Cr, K_r − μ A_r V_Kr.
    ReducedPencil at(double friction_coefficient) const;

  private:
    const CoupledSystem         &system;
    std::unique_ptr<MultiVector> T;
    DenseMatrix                  M, C, K;       ///< r × r
    DenseMatrix                  friction_K, friction_C, friction_M; ///< (Tᵀ A)(V T), r × r
    DenseMatrix                  A;             ///< Aᵀ T, n_c × r
    DenseMatrix                  V_K, V_C, V_M; ///< V T, n_c × r
  };
} // namespace Squeal
