#pragma once

#include <squeal/contact/updated_inverse.h>
#include <squeal/reduction/reduced_model.h>

#include <complex>
#include <vector>

namespace Squeal
{
  /// What error estimates need to know about the residuals R_j = Q(λ_j) φ_j and L_i = Q(λ_i)ᵀ ψ_i of reduced modes.
  struct ResidualProducts
  {
    ComplexDenseMatrix  coupling;       ///< L_iᵀ K_c⁻¹ R_j, k × k, no conjugate
    std::vector<double> right_energies; ///< R_jᴴ K_c⁻¹ R_j
    std::vector<double> left_energies;  ///< L_jᴴ K_c⁻¹ L_j
  };

  /**
   * The products of residuals from small matrices: residuals are affine in μ, λ,
   * λ² and the coefficients of contact damping,
   *
   *   Q(λ) T φ_r  = S T φ_r + W y,   W = [V_Kᵀ, V_Mᵀ, V_Cᵀ, M_c T, C T, Rᵀ, A]
   *   Q(λ)ᵀ T ψ_r = S T ψ_r + W z,   C = T_cᵀ C T_c + C_m
   *
   * with S = K_c + s² M_c and short y, z (the first three parts of y are zero,
   * and the last one of z without damping along t). Reduced modes make residuals orthogonal to T, so that the
   * part along S T is known to cancel that of W y along it, and
   *
   *   Lᵀ S⁻¹ R = zᵀ (Wᵀ S⁻¹ W − Wᵀ T (TᵀST)⁻¹ TᵀW) y.
   *
   * What is left of cancellation is that of the bracket, about 10⁻¹⁵ of φᴴKφ:
   * errors |δλ|/|λ| are reliable well below 10⁻¹². Each product costs
   * (2 r + 5 n_c)² operations instead of block solves at full order.
   */
  class ProjectedResiduals
  {
  public:
    /**
     * @param inverse factor of S, of a system without damping if the @p shift s [rad/s] is positive
     * @param damping of the contact where there is most of it: what vanishes there must vanish in products(), too
     *
     * The arguments must outlive it.
     */
    ProjectedResiduals(const CoupledSystem &system, const UpdatedInverse &inverse, double shift, const ContactDamping &damping);

    /// Takes over the vectors by which the basis of @p model has grown.
    void extend(const ReducedModel &model);

    /// Forgets the basis; the next extend() begins another one.
    void clear();

    /// Products for reduced modes λ, φ_r and ψ_r (r × k) at a friction coefficient and contact damping.
    ResidualProducts products(double                                   friction_coefficient,
                              const ContactDamping                    &damping,
                              const std::vector<std::complex<double>> &lambda,
                              const ComplexDenseMatrix                &right,
                              const ComplexDenseMatrix                &left) const;

  private:
    /// Coefficients y or z of the residuals, real and imaginary halves.
    DenseMatrix coefficients(double                                   mu,
                             const ContactDamping                    &damping,
                             const std::vector<std::complex<double>> &lambda,
                             const ComplexDenseMatrix                &vectors,
                             bool                                     left) const;

    /// Products of the fixed columns of W with a block of vectors.
    DenseMatrix fixed_products(const MultiVector &X) const;

    /// One sparse part of W: n × n_c, or n_c × n of which the transpose is meant.
    struct FixedPart
    {
      const SparseMatrix *matrix;
      bool                transposed;
    };

    const CoupledSystem   &system;
    const UpdatedInverse  &inverse;
    double                 shift;
    bool                   has_body_damping, has_radial_damping, has_sliding_damping;
    int                    n_c;
    std::vector<FixedPart> fixed;           ///< V_Kᵀ, V_Mᵀ, V_Cᵀ, Rᵀ, A
    int                    n_reactions = 0; ///< columns V_Kᵀ, V_Mᵀ, V_Cᵀ, which only left residuals have
    ReducedModel::Blocks   blocks;          ///< of the model as far as it is known
    DenseMatrix            fixed_gram;      ///< of the fixed columns among themselves
    DenseMatrix            fixed_mass, fixed_damping; ///< of the fixed columns with M T and C T
    DenseMatrix            mass_mass, mass_damping, damping_damping;
    DenseMatrix            left_columns, right_block; ///< of the bracket: what left and right residuals need
  };
} // namespace Squeal
