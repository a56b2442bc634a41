#pragma once

#include <squeal/base/choices.h>

#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/full_matrix.h>

#include <vector>

namespace Squeal
{
  /**
   * Stiffness of one cell at Young's modulus 1, K_ij = ∫ 2 G ε(φ_i):ε(φ_j) + Λ div φ_i div φ_j dV.
   *
   * Elements with incompatible modes (E. L. Wilson, R. L. Taylor et al. 1973; R. L. Taylor, P. J. Beresford, E. L. Wilson 1976)
   * have in each cell nine displacements more, (1 − ξ_a²) e_b with ξ in [−1, 1]³, which neighbours do not share:
   *
   *   K = K_uu − K_uα K_αα⁻¹ K_αu,
   *
   * so that bending of a cell costs no shear. With the Jacobian J₀ of the cell's centre in their gradients,
   * ∇(1 − ξ_a²) := (det J₀ / det J) J₀⁻ᵀ ∇_ξ (1 − ξ_a²), their mean over the cell vanishes: states of constant strain are exact in
   * cells of any shape. They have no mass.
   */
  class CellStiffness
  {
  public:
    CellStiffness(Element element, double poisson_ratio);

    /**
     * @param values    with gradients, JxW and Jacobians, reinitialised on the cell
     * @param stiffness filled; as large as the cell has dofs
     */
    void integrate(const dealii::FEValues<3> &values, dealii::FullMatrix<double> &stiffness);

    /// What integrate() needs.
    static dealii::UpdateFlags update_flags(Element element);

  private:
    /// A displacement with one component.
    struct Displacement
    {
      unsigned int         component;
      dealii::Tensor<1, 3> gradient;
    };

    void add_incompatible_modes(const dealii::FEValues<3> &values, unsigned int quadrature_point);

    Element                    element;
    double                     shear_modulus, lame; ///< of the material with E = 1
    std::vector<Displacement>  displacements;
    dealii::FullMatrix<double> with_modes;
    dealii::Tensor<2, 3>       centre_gradients; ///< det J₀ J₀⁻ᵀ
  };
} // namespace Squeal
