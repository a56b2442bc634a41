#pragma once

#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/system/low_rank_factor.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace Squeal
{
  /**
   * M ü + C u̇ + K u = f of the uncoupled bodies (left-hand side of eq. (4) of
   * the paper) on the free dofs; rows distributed over the processes.
   */
  struct SecondOrderSystem
  {
    std::shared_ptr<const SparseMatrix> mass;      ///< M [kg]
    std::shared_ptr<const SparseMatrix> damping;   ///< C [N s/m]; null: none
    std::shared_ptr<const SparseMatrix> stiffness; ///< K [N/m]
  };

  /// Values of named parameters: one number each, or a list with one for each contact node or mode; an empty list means zeros.
  using ParameterValues = std::map<std::string, std::vector<double>>;

  /// A number times powers of named parameters, such as −μ ρ.
  struct Monomial
  {
    double                     factor = 1.;
    std::map<std::string, int> powers;

    double at(const ParameterValues &values) const;
    bool   contains(const std::string &parameter) const;
  };

  Monomial operator*(const Monomial &a, const Monomial &b);

  /// Partial derivative with respect to a named parameter; of factor zero where the parameter does not occur.
  Monomial derivative(const Monomial &monomial, const std::string &parameter);

  enum class Symmetry
  {
    symmetric,
    skew ///< Aᵀ = −A
  };

  /**
   * One term of Q(λ; p) = Σ_k θ_k(p) λ^(p_k) A_k, with a coefficient θ_k that depends on named
   * parameters p. A_k is sparse, or of low rank, L diag(d) Rᵀ with d from a list of parameters.
   */
  struct Term
  {
    std::string                          name;
    int                                  power = 0; ///< p_k: 0, 1 or 2
    Monomial                             coefficient;
    std::shared_ptr<const SparseMatrix>  matrix;                         ///< A, n × n; null: A is of low rank
    Symmetry                             symmetry = Symmetry::symmetric; ///< of the matrix
    std::shared_ptr<const LowRankFactor> left = {}, right = {};          ///< L and R, n × m
    std::string                          weights = {};                   ///< parameter that lists d; empty: ones

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
                   Monomial                            coefficient,
                   std::shared_ptr<const SparseMatrix> matrix,
                   Symmetry                            symmetry = Symmetry::symmetric);

  Term low_rank_term(std::string                          name,
                     int                                  power,
                     Monomial                             coefficient,
                     std::shared_ptr<const LowRankFactor> left,
                     std::shared_ptr<const LowRankFactor> right,
                     std::string                          weights = "");

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

  /**
   * M, C and K of Q(λ) = λ² M + λ C + K as sparse matrices, null where there is no term. Throws SolverError
   * naming a term that has no sparse form.
   */
  SecondOrderSystem sparse_matrices(const std::vector<Term> &terms, const ParameterValues &values);

  /// Σ ‖θ A‖_∞ ≥ ‖Σ θ A‖_∞ of the terms in a power of λ, all of which have a sparse form.
  double norm_bound(const std::vector<Term> &terms, const ParameterValues &values, int power);

  /**
   * The same sum at these values with as few terms as possible: of the sparse terms, one of each power and symmetry is
   * left, with a coefficient of one. Terms that vanish are gone. Terms of low rank are not allowed.
   */
  std::vector<Term> merged(const std::vector<Term> &terms, const ParameterValues &values);
} // namespace Squeal
