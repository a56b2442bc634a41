// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/mass_orthonormal.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <iterator>
#include <limits>
#include <string>

namespace Squeal
{
  namespace
  {
    /// X -= Q Qᵀ M X.
    void project_out(const SparseMatrix &M, const MultiVector &Q, MultiVector &X)
    {
      for_column_blocks(X.n_columns(), [&](const int first, const int n) {
        MultiVector some = view(X, first, n);
        multiply_add(-1., Q, gram(Q, M * some), 1., some);
      });
    }

    /// Eigenpairs of a symmetric matrix, identical on all processes.
    RealPairs common_eigenpairs(const MPI_Comm communicator, const DenseMatrix &A)
    {
      return agreed(communicator, symmetric_eigenpairs(A));
    }

    /// Eigenvectors of the @p n largest eigenvalues, each divided by the square root of its value, largest first.
    DenseMatrix largest_axes(const RealPairs &pairs, const int n)
    {
      return pairs.vectors.rightCols(n).rowwise().reverse() *
             as_column(pairs.values).tail(n).reverse().cwiseSqrt().cwiseInverse().asDiagonal();
    }

    /// V diag(1 / √values) Vᵀ.
    DenseMatrix inverse_root(const RealPairs &pairs)
    {
      return pairs.vectors * as_column(pairs.values).cwiseSqrt().cwiseInverse().asDiagonal() * pairs.vectors.transpose();
    }

    /// Scaling of the columns before principal axes are computed.
    enum class Scaling
    {
      none,
      unit_norm
    };

    /// Largest ‖WᵀMW − I‖ for which one symmetric orthonormalisation is accurate to rounding [-].
    constexpr double nearly_orthonormal = 1e-3;

    /// W ← W (WᵀMW)^(-1/2), the orthonormal vectors closest to W; true if W was close enough for one pass.
    bool orthonormalize_symmetrically(const SparseMatrix &M, MultiVector &W)
    {
      const DenseMatrix G    = weighted_gram(W, M);
      const double      away = (G - DenseMatrix::Identity(G.rows(), G.cols())).norm();
      multiply_in_place(W, inverse_root(common_eigenpairs(W.communicator(), G)));
      return away <= nearly_orthonormal;
    }

    /// Ratio of the largest to the smallest of ascending eigenvalues.
    double condition_number(const std::vector<double> &values)
    {
      return values.front() > 0. ? values.back() / values.front() : std::numeric_limits<double>::infinity();
    }

    /// Nonzero columns of X, scaled; empty if all are zero. @p pairs receives the eigenpairs of their Gram matrix.
    std::optional<MultiVector> scaled_columns(const SparseMatrix &M, MultiVector X, const Scaling scaling, RealPairs &pairs)
    {
      const DenseMatrix   G = weighted_gram(X, M);
      std::vector<double> scale;
      std::vector<int>    nonzero;
      for (int j = 0; j < X.n_columns(); ++j)
        {
          if (!std::isfinite(G(j, j)))
            throw SolverError("vector " + std::to_string(j) + " contains infinite or undefined values", "orthonormalisation",
                              "check the parameters and matrices for extreme or undefined values");
          if (G(j, j) > 0.)
            {
              nonzero.push_back(j);
              scale.push_back(scaling == Scaling::unit_norm ? 1. / std::sqrt(G(j, j)) : 1.);
            }
        }
      const int k = nonzero.size();
      if (k == 0)
        return {};
      for (int j = 0; j < k; ++j)
        X.col(nonzero[j]) *= scale[j];
      const auto scales = as_column(scale).asDiagonal();
      pairs             = common_eigenpairs(X.communicator(), scales * G(nonzero, nonzero) * scales);
      return k == X.n_columns() ? std::move(X) : selected(X, nonzero);
    }

    std::optional<MultiVector> orthonormal_axes(const SparseMatrix   &M,
                                                const MultiVector    *Q,
                                                MultiVector           X,
                                                const double          tolerance,
                                                const Scaling         scaling,
                                                const FirstProjection projection,
                                                PrincipalAxes        *axes)
    {
      // A Gram matrix resolves directions down to the square root of the machine precision. Directions above this ratio of squared norms
      // are accurate
      const double   resolved     = 1e-10;
      const MPI_Comm communicator = X.communicator(); // before X is moved

      std::deque<MultiVector> kept; // a deque does not copy elements when it grows
      const auto              project = [&](MultiVector &Y) {
        if (Q != nullptr)
          project_out(M, *Q, Y);
        for (const MultiVector &W : kept)
          project_out(M, W, Y);
      };

      // Tolerances are relative to the largest direction of the scaled columns
      RealPairs                  pairs; // eigenpairs of the Gram matrix of the remaining columns
      std::optional<MultiVector> remaining = scaled_columns(M, std::move(X), scaling, pairs);
      if (!remaining)
        return {};
      const double largest = pairs.values.back();
      if (axes != nullptr)
        *axes = {{}, condition_number(pairs.values)};
      const double smallest = tolerance * tolerance * largest;

      // Project twice: the second projection removes rounding errors of the first
      const auto project_remaining = [&] {
        project(*remaining);
        project(*remaining);
        pairs = common_eigenpairs(communicator, weighted_gram(*remaining, M));
      };
      if (Q != nullptr && projection == FirstProjection::wanted)
        project_remaining();

      while (remaining)
        {
          const std::vector<double> &values = pairs.values;
          const int                  k      = values.size();

          const double threshold = std::max(resolved * values.back(), smallest);
          int          n_rest    = std::lower_bound(values.begin(), values.end(), threshold) - values.begin();
          if (!(values.back() > smallest) || n_rest == k)
            break;

          // Save memory: if no pass follows, the axes overwrite the columns
          const DenseMatrix S = largest_axes(pairs, k - n_rest);
          MultiVector       W = n_rest > 0 ? *remaining * S : std::move(*remaining);
          if (n_rest == 0)
            multiply_in_place(W, S);
          if (axes != nullptr)
            std::transform(values.rbegin(), values.rend() - n_rest, std::back_inserter(axes->norms),
                           [](const double x) { return std::sqrt(x); });
          for (int pass = 0; pass < 2; ++pass)
            {
              project(W);
              if (orthonormalize_symmetrically(M, W))
                break;
            }
          kept.push_back(std::move(W));

          // Rounding errors of the eigenvectors leave components of the kept directions in the others: project them out
          if (n_rest > 0)
            {
              remaining.emplace(*remaining * pairs.vectors.leftCols(n_rest));
              project_remaining();
            }
          else
            remaining.reset();
        }

      if (kept.empty())
        return {};
      if (kept.size() == 1)
        return std::move(kept.front());
      std::vector<const MultiVector *> parts;
      std::transform(kept.begin(), kept.end(), std::back_inserter(parts), [](const MultiVector &W) { return &W; });
      return join(parts);
    }
  } // namespace

  std::optional<MultiVector> orthonormalize_if_any(const SparseMatrix   &M,
                                                   const MultiVector    *Q,
                                                   MultiVector           X,
                                                   const double          tolerance,
                                                   PrincipalAxes        *axes,
                                                   const FirstProjection projection)
  {
    return orthonormal_axes(M, Q, std::move(X), tolerance, Scaling::unit_norm, projection, axes);
  }

  MultiVector orthonormalize(const SparseMatrix &M, const MultiVector *Q, MultiVector X, const double tolerance, PrincipalAxes *axes)
  {
    const int                  n = X.n_columns();
    std::optional<MultiVector> W = orthonormalize_if_any(M, Q, std::move(X), tolerance, axes);
    if (!W)
      throw SolverError("all vectors (number: " + std::to_string(n) + ") are zero or linearly dependent on existing vectors",
                        "orthonormalisation", "use other vectors, or a smaller tolerance");
    return std::move(*W);
  }

  MultiVector principal_axes(const SparseMatrix &M, const MultiVector &X, const double tolerance, const int maximum, PrincipalAxes *axes)
  {
    const std::optional<MultiVector> W = orthonormal_axes(M, nullptr, X, tolerance, Scaling::none, FirstProjection::wanted, axes);
    if (!W)
      throw SolverError("all vectors (number: " + std::to_string(X.n_columns()) + ") are zero", "proper orthogonal decomposition",
                        "use nonzero vectors");
    if (maximum < 1)
      throw SolverError("a basis of " + std::to_string(maximum) + " vectors was requested", "proper orthogonal decomposition",
                        "request at least one vector");
    if (W->n_columns() <= maximum)
      return *W;
    if (axes != nullptr)
      axes->norms.resize(maximum);
    // Copy: a returned view would dangle
    const MultiVector largest = view(*W, 0, maximum);
    return largest;
  }

  double orthonormality_defect(const SparseMatrix &M, const MultiVector &X)
  {
    return max_norm(weighted_gram(X, M) - DenseMatrix::Identity(X.n_columns(), X.n_columns()));
  }
} // namespace Squeal
