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
   * and (13) of the paper). Friction being affine in μ and contact damping in its
   * coefficients, blocks projected once serve every friction coefficient, load
   * and speed:
   *
   *   Tᵀ M_c T,  Tᵀ (T_cᵀ C T_c + C_m) T,  Tᵀ K_c T,  Aᵀ T,  R T,  V_M T,  V_C T,  V_K T
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

    /// M_r − μ A_r V_Mr, C_r − μ A_r V_Cr, K_r − μ A_r V_Kr with the system's contact damping.
    ReducedPencil at(double friction_coefficient) const;

    /// Contact damping of the system.
    const ContactDamping &contact_damping() const;

    /// The same with other contact damping: C_r = Tᵀ (T_cᵀ C T_c + C_m) T + (R T)ᵀ diag(c_b) R T + TᵀA diag(c_t) AᵀT.
    ReducedPencil at(double friction_coefficient, const ContactDamping &damping) const;

    /// The parts of the projection, each with r columns. Empty where the system has no such part.
    struct Blocks
    {
      DenseMatrix mass, body_damping, stiffness;                    ///< TᵀM_cT, Tᵀ(T_cᵀCT_c + C_m)T, TᵀK_cT
      DenseMatrix friction_forces, radial_motion;                   ///< AᵀT and R T, n_c × r
      DenseMatrix normal_stiffness, normal_damping, normal_mass;    ///< V T, n_c × r
    };
    const Blocks &blocks() const;

  private:
    const CoupledSystem         *system;
    std::unique_ptr<MultiVector> T;
    Blocks                       parts;
    DenseMatrix                  friction_K, friction_C, friction_M; ///< (Tᵀ A)(V T), r × r
  };
} // namespace Squeal
