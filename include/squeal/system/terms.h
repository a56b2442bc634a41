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
  /// An n × m matrix F with few columns, stored as its sparse transpose or as dense columns.
  class LowRankFactor
  {
  public:
    /// @param transpose Fᵀ, m × n
    explicit LowRankFactor(std::shared_ptr<const SparseMatrix> transpose);

    /// @param columns F, n × m
    explicit LowRankFactor(MultiVector columns);

    /// Number of columns m.
    int rank() const;

    /// Fᵀ X, m × k, the same on every process.
    DenseMatrix transpose_times(const MultiVector &X) const;

    /// F Y for an m × k matrix Y that is the same on every process.
    MultiVector operator*(const DenseMatrix &Y) const;

    /// Columns [first, first + n) of F.
    MultiVector columns(int first, int n) const;

    /// Fᵀ; null if F is stored as columns.
    const std::shared_ptr<const SparseMatrix> &sparse_transpose() const;

  private:
    std::shared_ptr<const SparseMatrix> rows;
    std::shared_ptr<const MultiVector>  full;
  };

  /// M ü + C u̇ + K u = f for the uncoupled bodies (left-hand side of eq. (4) of the paper) on the free dofs; rows are distributed over the
  /// processes.
  struct SecondOrderSystem
  {
    std::shared_ptr<const SparseMatrix> mass;      ///< M [kg]
    std::shared_ptr<const SparseMatrix> damping;   ///< C [N s/m]; null: none
    std::shared_ptr<const SparseMatrix> stiffness; ///< K [N/m]
  };

  /// Values of named parameters: a number, or a list with one value for each contact node or mode; an empty list means zeros.
  using ParameterValues = std::map<std::string, std::vector<double>>;

  /// A function of named parameters with its partial derivatives.
  class ParameterFunction
  {
  public:
    virtual ~ParameterFunction() = default;

    virtual double at(const ParameterValues &values) const = 0;

    /// Partial derivative with respect to @p parameter at these values; zero if the function does not depend on it.
    virtual double derivative(const std::string &parameter, const ParameterValues &values) const = 0;

    virtual bool contains(const std::string &parameter) const = 0;
    virtual bool is_constant() const                          = 0;

    /// Expression in the syntax of parsed_coefficient().
    virtual std::string text() const = 0;
  };

  /// θ(p) of a term: a monomial of named parameters such as −μ ρ, another function of named parameters, or a product of such functions.
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

  /// Physical origin of a term.
  enum class TermKind
  {
    body,  ///< elasticity, inertia and material damping
    mount, ///< springs and dashpots to the ground, and added masses
    rotation,
    friction,        ///< forces μ r_n along t
    circulatory,     ///< skew parts of unsymmetric matrices
    contact_damping, ///< forces at the contact nodes, proportional to relative velocities
    modal_damping
  };

  enum class Symmetry
  {
    symmetric,
    skew ///< Aᵀ = −A
  };

  /// A term of Q(λ; p) = Σ_k θ_k(p) λ^(p_k) A_k, with a coefficient θ_k that depends on named parameters p. A_k is a sparse matrix or the
  /// low-rank matrix L diag(d) Rᵀ, where d is a list parameter.
  struct Term
  {
    std::string                          name;      ///< name in messages and files
    int                                  power = 0; ///< p_k: 0, 1 or 2
    Coefficient                          coefficient;
    std::shared_ptr<const SparseMatrix>  matrix; ///< A, n × n; null if A has low rank
    Symmetry                             symmetry = Symmetry::symmetric;
    std::shared_ptr<const LowRankFactor> left = {}, right = {}; ///< L and R, n × m
    std::string                          weights = {};          ///< list parameter with d; empty: ones
    TermKind                             kind    = TermKind::body;

    /// θ(p) λ^p_k
    template <typename Number>
    Number factor(const Number lambda, const ParameterValues &values) const
    {
      return coefficient.at(values) * (power == 0 ? Number(1.) : power == 1 ? lambda : lambda * lambda);
    }

    bool vanishes(const ParameterValues &values) const;

    /// True if A can be written as a sparse matrix.
    bool is_sparse() const;

    /// True if A belongs to the mass, damping or stiffness without friction, that is, if A is symmetric and not a friction term.
    bool is_frictionless() const
    {
      return symmetry == Symmetry::symmetric && kind != TermKind::friction;
    }

    /// diag(d) Y; Y itself without weights.
    template <typename Matrix>
    Matrix weighted(Matrix Y, const ParameterValues &values) const;

    /// A (or Aᵀ) = target() diag(d) source()ᵀ.
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

  /// Symmetric and skew part of the matrix of a term, as terms with its coefficient. A part within the rounding errors of the other part is
  /// dropped.
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

  /// Σ θ_k A_k X, or Σ θ_k A_kᵀ X, over the terms with this power of λ.
  MultiVector times(const std::vector<Term> &terms,
                    const ParameterValues   &values,
                    int                      power,
                    const MultiVector       &X,
                    bool                     transposed = false);

  /// Σ θ A of matrices; null if there are none.
  std::shared_ptr<const SparseMatrix> sum(const std::vector<std::pair<double, std::shared_ptr<const SparseMatrix>>> &summands);

  /// Nonzero terms with this power of λ.
  std::vector<const Term *> terms_of(const std::vector<Term> &terms, const ParameterValues &values, int power);

  /// M, C and K of Q(λ) = λ² M + λ C + K as sparse matrices; a matrix without terms is null. Throws a SolverError that names a term without
  /// sparse form.
  SecondOrderSystem sparse_matrices(const std::vector<Term> &terms, const ParameterValues &values);

  /// Σ ‖θ A‖_∞ ≥ ‖Σ θ A‖_∞ over the terms with a power of λ; all these terms must have a sparse form.
  double norm_bound(const std::vector<Term> &terms, const ParameterValues &values, int power);

  /// The same Q at these values with as few terms as possible: one sparse term with a coefficient of one for each power and symmetry;
  /// powers without nonzero terms are omitted. Low-rank terms are not allowed.
  std::vector<Term> merged(const std::vector<Term> &terms, const ParameterValues &values);

  /// Common terms of several systems, the members of a family, which differ only in coefficients.
  struct TermFamily
  {
    std::vector<Term>            terms;   ///< terms with coefficient one, or with a scale parameter if members differ
    ParameterValues              values;  ///< scales of the averaged system: ones
    std::vector<ParameterValues> members; ///< values of the scales for each member
  };

  /**
   * Terms Σ θ_k A_k of a family with as few matrices as possible. Terms of the same power and symmetry whose coefficients θ_k have the same
   * ratio in all members are summed, with the means of |θ_k| over the members. All terms must be sparse.
   *
   * @param members values of the parameters of the terms for each member, at least one
   */
  TermFamily term_family(const std::vector<Term> &terms, const std::vector<ParameterValues> &members);
} // namespace Squeal
