// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/multivector.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace Squeal
{
  /// An n × m matrix F of few columns, kept either by its sparse transpose or in full.
  class LowRankFactor
  {
  public:
    /// @param transpose Fᵀ, m × n
    explicit LowRankFactor(std::shared_ptr<const SparseMatrix> transpose);

    /// @param columns F, n × m
    explicit LowRankFactor(MultiVector columns);

    /// m
    int rank() const;

    /// Fᵀ X, m × k, the same on every process.
    DenseMatrix transpose_times(const MultiVector &X) const;

    /// F Y for Y, m × k, the same on every process.
    MultiVector operator*(const DenseMatrix &Y) const;

    /// Columns [first, first + n) of F.
    MultiVector columns(int first, int n) const;

    /// Fᵀ; null if F is kept in full.
    const std::shared_ptr<const SparseMatrix> &sparse_transpose() const;

  private:
    std::shared_ptr<const SparseMatrix> rows;
    std::shared_ptr<const MultiVector>  full;
  };

  /// M ü + C u̇ + K u = f of the uncoupled bodies (left-hand side of eq. (4) of the paper) on the free dofs; rows distributed over the
  /// processes.
  struct SecondOrderSystem
  {
    std::shared_ptr<const SparseMatrix> mass;      ///< M [kg]
    std::shared_ptr<const SparseMatrix> damping;   ///< C [N s/m]; null: none
    std::shared_ptr<const SparseMatrix> stiffness; ///< K [N/m]
  };

  /// Values of named parameters: one number each, or a list with one for each contact node or mode; an empty list means zeros.
  using ParameterValues = std::map<std::string, std::vector<double>>;

  /// A function of named parameters with its partial derivatives.
  class ParameterFunction
  {
  public:
    virtual ~ParameterFunction() = default;

    virtual double at(const ParameterValues &values) const = 0;

    /// ∂/∂p at the values of all parameters; zero where @p parameter does not occur.
    virtual double derivative(const std::string &parameter, const ParameterValues &values) const = 0;

    virtual bool contains(const std::string &parameter) const = 0;
    virtual bool is_constant() const                          = 0;

    /// An expression that parsed_coefficient() reads back.
    virtual std::string text() const = 0;
  };

  /// θ(p) of a term: a monomial of named parameters such as −μ ρ, a function of them of any other kind, or a product of such.
  class Coefficient
  {
  public:
    /// @p factor times @p powers of parameters.
    Coefficient(double factor = 1., std::map<std::string, int> powers = {});
    explicit Coefficient(std::shared_ptr<const ParameterFunction> function);

    double at(const ParameterValues &values) const;
    double derivative(const std::string &parameter, const ParameterValues &values) const;
    bool   contains(const std::string &parameter) const;
    bool   is_constant() const;

    std::string text() const;

    friend Coefficient operator*(const Coefficient &a, const Coefficient &b);

  private:
    std::shared_ptr<const ParameterFunction> function;
  };

  /// What a term describes.
  enum class TermKind
  {
    body,            ///< elasticity, inertia and material damping
    mount,           ///< springs and dashpots between bodies and the ground
    rotation,        ///< forces of a turning disc
    friction,        ///< forces μ r_n along t
    circulatory,     ///< other parts of unsymmetric matrices
    contact_damping, ///< forces on the contact nodes in proportion to relative velocities
    modal_damping
  };

  enum class Symmetry
  {
    symmetric,
    skew ///< Aᵀ = −A
  };

  /// One term of Q(λ; p) = Σ_k θ_k(p) λ^(p_k) A_k, with a coefficient θ_k that depends on named parameters p. A_k is sparse, or of low
  /// rank, L diag(d) Rᵀ with d from a list of parameters.
  struct Term
  {
    std::string                          name;      ///< for messages
    int                                  power = 0; ///< p_k: 0, 1 or 2
    Coefficient                          coefficient;
    std::shared_ptr<const SparseMatrix>  matrix;                         ///< A, n × n; null: A is of low rank
    Symmetry                             symmetry = Symmetry::symmetric; ///< of the matrix
    std::shared_ptr<const LowRankFactor> left = {}, right = {};          ///< L and R, n × m
    std::string                          weights = {};                   ///< parameter that lists d; empty: ones
    TermKind                             kind    = TermKind::body;

    /// θ(p) λ^p_k
    template <typename Number>
    Number factor(const Number lambda, const ParameterValues &values) const
    {
      return coefficient.at(values) * (power == 0 ? Number(1.) : power == 1 ? lambda : lambda * lambda);
    }

    /// Whether nothing of the term is left at these values.
    bool vanishes(const ParameterValues &values) const;

    /// Whether A could be written as a sparse matrix.
    bool is_sparse() const;

    /// Whether A is a part of the mass, damping and stiffness without friction: symmetric, and not of friction itself.
    bool is_frictionless() const
    {
      return symmetry == Symmetry::symmetric && kind != TermKind::friction;
    }

    /// diag(d) Y; all of Y where there are no weights.
    template <typename Matrix>
    Matrix weighted(Matrix Y, const ParameterValues &values) const;

    /// Factor onto which A (or Aᵀ) maps, and the one with which it reads.
    const LowRankFactor &target(const bool transposed) const
    {
      return transposed ? *right : *left;
    }
    const LowRankFactor &source(const bool transposed) const
    {
      return transposed ? *left : *right;
    }
  };

  Term sparse_term(std::string                         name,
                   int                                 power,
                   Coefficient                         coefficient,
                   std::shared_ptr<const SparseMatrix> matrix,
                   Symmetry                            symmetry = Symmetry::symmetric,
                   TermKind                            kind     = TermKind::body);

  Term low_rank_term(std::string                          name,
                     int                                  power,
                     Coefficient                          coefficient,
                     std::shared_ptr<const LowRankFactor> left,
                     std::shared_ptr<const LowRankFactor> right,
                     std::string                          weights = "",
                     TermKind                             kind    = TermKind::body);

  /// The symmetric and the skew part of the matrix of a term, as terms with its coefficient. Parts that are rounding errors of the other
  /// one are left out.
  std::vector<Term> split_by_symmetry(const Term &term);

  template <typename Matrix>
  Matrix Term::weighted(Matrix Y, const ParameterValues &values) const
  {
    if (weights.empty())
      return Y;
    const std::vector<double> &d = values.at(weights);
    if (d.empty())
      return Matrix::Zero(Y.rows(), Y.cols());
    return as_column(d).asDiagonal() * Y;
  }

  /// Σ θ_k A_k X, or Σ θ_k A_kᵀ X, of the terms with λ to this power.
  MultiVector times(const std::vector<Term> &terms,
                    const ParameterValues   &values,
                    int                      power,
                    const MultiVector       &X,
                    bool                     transposed = false);

  /// Σ θ A of matrices; null where there is none.
  std::shared_ptr<const SparseMatrix> sum(const std::vector<std::pair<double, std::shared_ptr<const SparseMatrix>>> &summands);

  /// Terms that do not vanish and have λ to this power.
  std::vector<const Term *> terms_of(const std::vector<Term> &terms, const ParameterValues &values, int power);

  /// M, C and K of Q(λ) = λ² M + λ C + K as sparse matrices, null where there is no term. Throws SolverError naming a term that has no
  /// sparse form.
  SecondOrderSystem sparse_matrices(const std::vector<Term> &terms, const ParameterValues &values);

  /// Σ ‖θ A‖_∞ ≥ ‖Σ θ A‖_∞ of the terms in a power of λ, all of which have a sparse form.
  double norm_bound(const std::vector<Term> &terms, const ParameterValues &values, int power);

  /// The same sum at these values with as few terms as possible: of the sparse terms, one of each power and symmetry is left, with a
  /// coefficient of one. Terms that vanish are gone. Terms of low rank are not allowed.
  std::vector<Term> merged(const std::vector<Term> &terms, const ParameterValues &values);

  /// Terms that several systems have in common, the members of a family: they differ in coefficients only.
  struct TermFamily
  {
    std::vector<Term>            terms;   ///< with coefficients of one, or a scale where members differ
    ParameterValues              values;  ///< of the scales in the middle of the family: ones
    std::vector<ParameterValues> members; ///< of the scales, for each member
  };

  /**
   * The terms Σ θ_k A_k of a family with as few matrices as possible: those whose coefficients θ_k keep their ratios from member to
   * member are summed, with the means of θ_k over the members. All terms must be sparse.
   *
   * @param members values of the parameters of the terms for each member, of one at least
   */
  TermFamily term_family(const std::vector<Term> &terms, const std::vector<ParameterValues> &members);
} // namespace Squeal
