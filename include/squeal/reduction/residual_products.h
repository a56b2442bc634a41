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
  /// What error estimates need to know about the residuals R_j = Q(λ_j) φ_j and L_i = Q(λ_i)ᵀ ψ_i of reduced modes.
  struct ResidualProducts
  {
    ComplexDenseMatrix  coupling;       ///< L_iᵀ K_c⁻¹ R_j, k × k, no conjugate
    std::vector<double> right_energies; ///< R_jᴴ K_c⁻¹ R_j
    std::vector<double> left_energies;  ///< L_jᴴ K_c⁻¹ L_j
  };

  /**
   * The products of residuals from small matrices: residuals are sums over the terms θ A of the system,
   *
   *   Q(λ) T φ_r  = S T φ_r + W y,   Q(λ)ᵀ T ψ_r = S T ψ_r + W z,   S = K_c + s² M_c,
   *
   * with short y, z. The columns of W are A T of the terms θ A, with the rows (θ λ^p − σ) φ_r of y, σ A being the part of the term in S,
   * but those of which nothing is left. Of terms θ L diag(d) Rᵀ they are a factor where the weights d are parameters or
   * it has fewer columns than all its terms: L with the rows θ λ^p diag(d) RᵀT φ_r of y, R with θ λ^p diag(d) LᵀT ψ_r of z; else they are
   * L RᵀT for y and R LᵀT for z. Reduced modes make residuals orthogonal to T, so that the part along S T is known to cancel that of
   * W y along it, and
   *
   *   Lᵀ S⁻¹ R = zᵀ (Wᵀ S⁻¹ W − Wᵀ T (TᵀST)⁻¹ TᵀW) y.
   *
   * Terms with the same power of λ have the same rows but for their coefficients: at an operating point y = C c and z = D d with sums C, D
   * of blocks that all modes share, and the bracket B shrinks to Dᵀ B C before it meets the modes, which costs no more than reading it.
   * What is left of cancellation is that of the bracket, about 10⁻¹⁵ of φᴴKφ: errors |δλ|/|λ| are reliable well below 10⁻¹².
   */
  class ProjectedResiduals
  {
  public:
    /**
     * @param inverse factor of S, of a system without damping if the @p shift s [rad/s] is positive
     * @param values  of the parameters: terms that vanish there, friction apart, must vanish in products(), too
     *
     * The arguments must outlive it.
     */
    ProjectedResiduals(const CoupledSystem &system, const UpdatedInverse &inverse, double shift, const ParameterValues &values);

    /// Errors of the bracket up to 10⁻⁷ of its size will do: products cost half as much. Of the modes of a model in whose span they nearly lie
    /// the parts of a residual cancel by some powers of ten, so that estimates of 10⁻⁶ and more are right.
    void use_single_precision()
    {
      in_single_precision = true;
      is_prepared         = false;
    }

    /// Takes over the vectors by which the basis of @p model has grown.
    void extend(const ReducedModel &model);

    /// Forgets the basis; the next extend() begins another one.
    void clear();

    /// Puts the bracket together from its parts, which products() needs; it does so itself, but not for several threads that call it.
    void prepare() const;

    /// Products for reduced modes λ, φ_r and ψ_r (r × k).
    ResidualProducts products(const ParameterValues                   &values,
                              const std::vector<std::complex<double>> &lambda,
                              const ComplexDenseMatrix                &right,
                              const ComplexDenseMatrix                &left) const;

    /// Modes of a reduced model at an operating point.
    struct ModesAt
    {
      ParameterValues                   values;
      std::vector<std::complex<double>> lambda;
      ComplexDenseMatrix                right, left; ///< r × k
    };

    /**
     * S⁻¹ W C, n × p: what right and left displacement residuals of modes have outside of the basis, by principal axes in the norm of
     * S, those below @p tolerance times the largest left out. Of unit strain energy each mode counts by the error of its λ. The axes
     * are found from the small matrices, so that block solves are as many as axes, not as residuals; the span of the basis may come
     * along. Nothing if all residuals vanish; not for a member of a family. All processes must call.
     */
    std::optional<MultiVector> principal_responses(const ReducedModel &model, const std::vector<ModesAt> &modes, double tolerance) const;

  private:
    /// Coefficients y, or z of the transposed problem, with zeros for columns that are not theirs; real and imaginary halves.
    DenseMatrix coefficients(const ParameterValues                   &values,
                             const std::vector<std::complex<double>> &lambda,
                             const ComplexDenseMatrix                &vectors,
                             bool                                     transposed) const;

    /// Those of right and left residuals side by side, each of a mode of unit strain energy, those of zeros left out.
    DenseMatrix coordinates(const ModesAt &modes) const;

    /// Products of the factors with a block of vectors.
    DenseMatrix factor_products(const MultiVector &X) const;

    /// A T of a sparse term.
    struct Sparse
    {
      const Term              *term;
      std::size_t              number;          ///< among the terms of the system
      double                   sign;            ///< Aᵀ = sign A
      double                   sigma;           ///< part of the term in S; of the difference of K_c from S, zero
      DenseMatrix              projected;       ///< TᵀA T
      DenseMatrix              factor_products; ///< of the factors with S⁻¹ A T
      std::vector<DenseMatrix> products;        ///< (A' T)ᵀ S⁻¹ A T with each sparse term A'
    };

    /// A factor of terms of low rank.
    struct Factor
    {
      const LowRankFactor *factor;
      int                  first; ///< among the columns of all factors
    };

    /// Columns of W with coefficients of their own.
    struct Block
    {
      int         sparse;            ///< number of the sparse term, or -1
      int         factor;            ///< number of the factor, or -1
      const Term *term;              ///< of which they are L RᵀT, or R LᵀT in left residuals; null: they are the factor
      bool        in_left, in_right; ///< whether left or right residuals have them
      int         n;
      int         first = 0; ///< in W
    };

    /// Columns of W C, a sum of blocks of W, and the rows of c or d that belong to them.
    struct Group
    {
      /// scale λ^power φ_r, or scale λ^power FᵀT φ_r, times weights of a term.
      struct Share
      {
        double               scale;
        int                  power;
        const LowRankFactor *motions;  ///< F; null: none
        const Term          *weighted; ///< null: none
      };

      std::vector<std::pair<const Block *, double>> blocks; ///< and their factors
      std::vector<Share>                            shares;
    };

    std::vector<Group> groups(const ParameterValues &values, bool transposed) const;

    /// Rows of c or d for some vectors, those of each group in turn.
    std::vector<ComplexDenseMatrix> group_rows(const std::vector<Group>                &groups,
                                               const ParameterValues                   &values,
                                               const std::vector<std::complex<double>> &lambda,
                                               const ComplexDenseMatrix                &vectors) const;

    template <typename Number>
    using Matrix = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic>;

    /// products() with the bracket in some precision.
    template <typename Number>
    ResidualProducts products_by(const Matrix<Number>                    &bracket,
                                 const ParameterValues                   &values,
                                 const std::vector<std::complex<double>> &lambda,
                                 const ComplexDenseMatrix                &right,
                                 const ComplexDenseMatrix                &left) const;

    int number_of(const LowRankFactor &factor) const;

    /// Whether W has products of a factor with those of its terms instead of the factor.
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
    std::map<const LowRankFactor *, DenseMatrix> motions;     ///< FᵀT
    int                                          r = 0;       ///< size of the basis
    DenseMatrix                                  pencil;      ///< TᵀST
    mutable std::vector<Block>                   blocks;
    mutable int                                  n_columns           = 0; ///< of W
    bool                                         in_single_precision = false;
    mutable bool                                 is_prepared         = false;
    mutable DenseMatrix                          bracket;
    mutable Eigen::MatrixXf                      bracket_in_single_precision;
  };
} // namespace Squeal
