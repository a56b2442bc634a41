// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/contact/updated_inverse.h>
#include <squeal/reduction/reduced_model.h>

#include <complex>
#include <map>
#include <optional>
#include <vector>

namespace Squeal
{
  /// Inner products of the residuals R_j = Q(λ_j) φ_j and L_i = Q(λ_i)ᵀ ψ_i of reduced modes, for error estimates.
  struct ResidualProducts
  {
    ComplexDenseMatrix  coupling;       ///< L_iᵀ S⁻¹ R_j, k × k, no conjugate; S = K_c + s² M_c
    std::vector<double> right_energies; ///< R_jᴴ S⁻¹ R_j
    std::vector<double> left_energies;  ///< L_jᴴ S⁻¹ L_j
  };

  /**
   * Computes inner products of residuals from small matrices. Residuals are sums over the terms θ A of the system,
   *
   *   Q(λ) T φ_r  = S T φ_r + W y,   Q(λ)ᵀ T ψ_r = S T ψ_r + W z,   S = K_c + s² M_c,
   *
   * with short vectors y, z. The columns of W are A T for sparse terms θ A, with rows (θ λ^p − σ) φ_r of y, where σ A is the part of the
   * term in S; terms that cancel are omitted. Low-rank terms θ L diag(d) Rᵀ contribute their factors if the weights d are parameters or if
   * a factor has fewer columns than all its terms: L with rows θ λ^p diag(d) RᵀT φ_r of y, R with rows θ λ^p diag(d) LᵀT ψ_r of z;
   * otherwise L RᵀT for y and R LᵀT for z. Residuals of reduced modes are orthogonal to T, so that S T φ_r cancels the component of W y
   * along S T, and
   *
   *   Lᵀ S⁻¹ R = zᵀ (Wᵀ S⁻¹ W − Wᵀ T (TᵀST)⁻¹ TᵀW) y.
   *
   * Terms with the same power of λ have the same rows up to their coefficients. At an operating point, y = C c and z = D d, where C and D
   * combine blocks in the same way for all modes. The bracket B is therefore reduced to Dᵀ B C first, which costs no more than reading B.
   * The cancellation error of the bracket is about 10⁻¹⁵ of φᴴKφ, so that estimates |δλ|/|λ| well below 10⁻¹² are reliable.
   */
  class ProjectedResiduals
  {
  public:
    /**
     * @param inverse factor of S; a positive @p shift s [rad/s] requires a system without damping
     * @param values  parameter values; weighted terms that vanish at these values, except friction, must also vanish in products()
     *
     * The arguments must outlive the object.
     */
    ProjectedResiduals(const CoupledSystem &system, const UpdatedInverse &inverse, double shift, const ParameterValues &values);

    /**
     * Approximates products by a random sketch of the residuals (Balabanov and Nouy, Adv. Comput. Math. 45, 2019): with s = 128 random
     * vectors V of covariance S⁻¹ / s,
     *
     *   Lᵀ S⁻¹ R ≈ (VᵀL)ᵀ (VᵀR),   VᵀR = Z y,   Z = VᵀW − VᵀST (TᵀST)⁻¹ TᵀW.
     *
     * Z has s rows in place of the columns of W, and a larger basis requires no further solves. principal_responses() uses another s
     * independent vectors. The relative standard deviation is 6 % for a norm; for a product, it is 9 % of the product of the norms. Call
     * before extend().
     *
     * @return false if the library of the factor cannot draw V; products then remain exact
     */
    bool use_sketch();

    /// Adds the vectors that were appended to the basis of @p model.
    void extend(const ReducedModel &model);

    /// Replaces the basis T by T Z, the basis of @p model; Z: r × k.
    void restrict(const ReducedModel &model, const DenseMatrix &Z);

    /// Clears the basis; the next extend() starts a new basis.
    void clear();

    /// Assembles the bracket or Z. products() calls it on demand; call it before sharing the object between threads.
    void prepare() const;

    /// Products for reduced modes λ, φ_r and ψ_r (r × k).
    ResidualProducts products(const ParameterValues                   &values,
                              const std::vector<std::complex<double>> &lambda,
                              const ComplexDenseMatrix                &right,
                              const ComplexDenseMatrix                &left) const;

    struct ModesAt
    {
      ParameterValues                   values;
      std::vector<std::complex<double>> lambda;
      ComplexDenseMatrix                right, left; ///< r × k
    };

    /**
     * S⁻¹ W C, n × p: principal axes, in the norm of S, of the right and left displacement residuals of modes with unit strain energy. Axes
     * shorter than @p tolerance times the longest axis are dropped. The axes are computed from the small matrices, so that the number of
     * solves equals the number of axes, not of residuals. The result may contain components in the span of the basis; it is empty if all
     * residuals vanish. Collective.
     */
    std::optional<MultiVector> principal_responses(const ReducedModel &model, const std::vector<ModesAt> &modes, double tolerance) const;

  private:
    /// Coefficients y, or z of the transposed problem, with zeros for columns that do not contribute; real parts, then imaginary parts.
    DenseMatrix coefficients(const ParameterValues                   &values,
                             const std::vector<std::complex<double>> &lambda,
                             const ComplexDenseMatrix                &vectors,
                             bool                                     transposed) const;

    /// Coefficients of right, then of left residuals, each for a mode of unit strain energy, without zero columns.
    DenseMatrix coordinates(const ModesAt &modes) const;

    /// Products of the factors with a block of vectors.
    DenseMatrix factor_products(const MultiVector &X) const;

    /// A T of a sparse term.
    struct Sparse
    {
      const Term              *term;
      std::size_t              number;          ///< index among the terms of the system
      double                   sign;            ///< Aᵀ = sign A
      double                   sigma;           ///< σ, the coefficient in S; zero for the difference between K_c and S
      DenseMatrix              projected;       ///< TᵀA T
      DenseMatrix              factor_products; ///< products of the factors with S⁻¹ A T
      std::vector<DenseMatrix> products;        ///< (A' T)ᵀ S⁻¹ A T with each sparse term A'
      DenseMatrix              sketched;        ///< VᵀA T
    };

    struct Factor
    {
      const LowRankFactor *factor;
      int                  first; ///< first column among the columns of all factors
    };

    /// Columns of W with a common coefficient rule.
    struct Block
    {
      int         sparse;            ///< index of the sparse term, or -1
      int         factor;            ///< index of the factor, or -1
      const Term *term;              ///< columns are L RᵀT of this term, or R LᵀT in left residuals; null: columns are the factor
      bool        in_left, in_right; ///< contributes to left or right residuals
      int         n;
      int         first = 0; ///< first column in W
    };

    /// Columns of W C, combinations of blocks of W, and the corresponding rows of c or d.
    struct Group
    {
      /// Contribution scale λ^power φ_r, or scale λ^power FᵀT φ_r, times weights of a term.
      struct Share
      {
        double               scale;
        int                  power;
        const LowRankFactor *motions;  ///< F; null: no factor
        const Term          *weighted; ///< term with the weights; null: no weights
      };

      std::vector<std::pair<const Block *, double>> blocks; ///< blocks and their factors
      std::vector<Share>                            shares;
    };

    std::vector<Group> groups(const ParameterValues &values, bool transposed) const;

    /// Rows of c or d for some vectors, group by group.
    std::vector<ComplexDenseMatrix> group_rows(const std::vector<Group>                &groups,
                                               const ParameterValues                   &values,
                                               const std::vector<std::complex<double>> &lambda,
                                               const ComplexDenseMatrix                &vectors) const;

    /// Z y or Z z; real parts, then imaginary parts.
    DenseMatrix sketches(const ParameterValues                   &values,
                         const std::vector<std::complex<double>> &lambda,
                         const ComplexDenseMatrix                &vectors,
                         bool                                     transposed) const;

    /// Takes the size of the basis, TᵀST, TᵀAT and FᵀT from the model.
    void set_projections(const ReducedModel &model);

    int number_of(const LowRankFactor &factor) const;

    /// True if W contains L RᵀT or R LᵀT of the terms of a factor instead of the factor itself.
    bool has_columns(const LowRankFactor &factor) const;

    void find_blocks() const;

    const CoupledSystem                         &system;
    const UpdatedInverse                        &inverse;
    double                                       shift = 0.;
    std::vector<Sparse>                          sparse;
    std::vector<const Term *>                    low_rank;
    std::vector<Factor>                          factors;
    int                                          n_factor_columns = 0;
    DenseMatrix                                  factor_gram; ///< Fᵀ S⁻¹ F of all factors
    std::map<const LowRankFactor *, DenseMatrix> motions;     ///< FᵀT of each factor
    int                                          r = 0;       ///< size of the basis
    DenseMatrix                                  pencil;      ///< TᵀST
    mutable std::vector<Block>                   blocks;
    mutable int                                  n_columns   = 0; ///< number of columns of W
    mutable bool                                 is_prepared = false;
    mutable DenseMatrix                          bracket;         ///< B; empty with a sketch
    std::optional<MultiVector>                   sketch;          ///< V, n × 2 s: s columns for products, s for principal_responses()
    DenseMatrix                                  sketched_pencil; ///< VᵀS T
    mutable DenseMatrix                          Z;               ///< 2 s × n_columns
  };
} // namespace Squeal
