#include <squeal/base/decision.h>
#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/multivector.h>

#include <Epetra_Comm.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string>

namespace Squeal
{
  namespace
  {
    void require(const bool condition, const char *operation)
    {
      if (!condition)
        throw SolverError("the shapes of two sets of vectors do not fit together", operation,
                          "this is a mistake in the program: please report it");
    }

    using Rows = Eigen::Map<const DenseMatrix, 0, Eigen::OuterStride<>>;

    /// Local rows of a multivector of contiguous columns.
    Rows local_rows(const MultiVector &X)
    {
      return {X.Values(), X.MyLength(), X.NumVectors(), Eigen::OuterStride<>(std::max(1, X.Stride()))};
    }

    /// Calls @p f with the local rows of X, copied only if its columns are scattered.
    template <typename Function>
    auto with_local_rows(const MultiVector &X, const Function &f)
    {
      return X.ConstantStride() ? f(local_rows(X)) : f(local_rows(MultiVector(X)));
    }

    /// Mixes 64 bits (the finaliser of SplitMix64).
    std::uint64_t mix(std::uint64_t z)
    {
      z += 0x9e3779b97f4a7c15ull;
      z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
      z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
      return z ^ (z >> 31);
    }

    /// X -= Q Qᵀ M X.
    void project_out(const SparseMatrix &M, const MultiVector &Q, MultiVector &X)
    {
      multiply_add(-1., Q, gram(Q, M * X), 1., X);
    }

    /// Eigenpairs of a symmetric matrix, the same on all processes.
    RealPairs common_eigenpairs(const Epetra_Comm &comm, const DenseMatrix &A)
    {
      return agreed(comm, symmetric_eigenpairs(A));
    }

    /// Eigenvectors of the @p n largest eigenvalues, each divided by the root of its value, largest first.
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
  } // namespace



  DenseMatrix gram(const MultiVector &X, const MultiVector &Y)
  {
    require(X.MyLength() == Y.MyLength(), "inner products");
    DenseMatrix local = with_local_rows(
      X, [&Y](const Rows &x) { return with_local_rows(Y, [&x](const Rows &y) -> DenseMatrix { return x.transpose() * y; }); });
    if (X.Comm().NumProc() == 1)
      return local;

    DenseMatrix sum(local.rows(), local.cols());
    X.Comm().SumAll(local.data(), sum.data(), local.size());
    // Decisions are taken on these numbers: the last bit must agree everywhere.
    X.Comm().Broadcast(sum.data(), sum.size(), 0);
    return sum;
  }



  RealPairs agreed(const Epetra_Comm &comm, RealPairs pairs)
  {
    if (comm.NumProc() > 1)
      {
        comm.Broadcast(pairs.vectors.data(), pairs.vectors.size(), 0);
        comm.Broadcast(pairs.values.data(), pairs.values.size(), 0);
      }
    return pairs;
  }



  void multiply_add(const double alpha, const MultiVector &X, const DenseMatrix &S, const double beta, MultiVector &Y)
  {
    require(X.MyLength() == Y.MyLength() && X.NumVectors() == S.rows() && Y.NumVectors() == S.cols(), "linear combination of vectors");
    if (Y.MyLength() == 0)
      return;
    if (!Y.ConstantStride())
      {
        MultiVector contiguous(Y);
        multiply_add(alpha, X, S, beta, contiguous);
        Y = contiguous;
        return;
      }
    Eigen::Map<DenseMatrix, 0, Eigen::OuterStride<>> y(Y.Values(), Y.MyLength(), Y.NumVectors(),
                                                       Eigen::OuterStride<>(std::max(1, Y.Stride())));
    with_local_rows(X, [&](const Rows &x) {
      if (beta == 0.)
        y.noalias() = alpha * x * S;
      else
        {
          if (beta != 1.)
            y *= beta;
          y.noalias() += alpha * x * S;
        }
    });
  }



  MultiVector operator*(const MultiVector &X, const DenseMatrix &S)
  {
    MultiVector Y(X.Map(), S.cols(), false);
    multiply_add(1., X, S, 0., Y);
    return Y;
  }



  MultiVector operator*(const SparseMatrix &A, const MultiVector &X)
  {
    MultiVector Y(A.RangeMap(), X.NumVectors(), false);
    if (A.Multiply(false, X, Y) != 0)
      require(false, "product of a sparse matrix and vectors");
    return Y;
  }



  MultiVector transpose_times(const SparseMatrix &A, const MultiVector &X)
  {
    MultiVector Y(A.DomainMap(), X.NumVectors(), false);
    if (A.Multiply(true, X, Y) != 0)
      require(false, "product of a transposed sparse matrix and vectors");
    return Y;
  }



  MultiVector view(const MultiVector &X, const int first, const int n)
  {
    require(first >= 0 && n >= 1 && first + n <= X.NumVectors(), "columns of a set of vectors");
    return MultiVector(View, X, first, n);
  }



  MultiVector join(const std::vector<const MultiVector *> &parts)
  {
    int n_columns = 0;
    for (const MultiVector *part : parts)
      n_columns += part->NumVectors();
    require(n_columns > 0, "union of sets of vectors");

    MultiVector all(parts.front()->Map(), n_columns, false);
    int         column = 0;
    for (const MultiVector *part : parts)
      {
        require(part->MyLength() == all.MyLength(), "union of sets of vectors");
        for (int j = 0; j < part->NumVectors(); ++j, ++column)
          std::copy((*part)[j], (*part)[j] + all.MyLength(), all[column]);
      }
    return all;
  }



  std::vector<double> column_norms(const MultiVector &X)
  {
    std::vector<double> norms(X.NumVectors());
    X.Norm2(norms.data());
    return norms;
  }



  MultiVector unit_vectors(const Epetra_Map &map)
  {
    MultiVector result(map, map.NumGlobalElements());
    for (int i = 0; i < map.NumMyElements(); ++i)
      result.ReplaceMyValue(i, map.GID(i), 1.);
    return result;
  }



  MultiVector random_vectors(const Epetra_Map &map, const int n_vectors, const unsigned int seed)
  {
    MultiVector X(map, n_vectors, false);
    for (int j = 0; j < n_vectors; ++j)
      {
        const std::uint64_t stream = mix(mix(seed) + static_cast<std::uint64_t>(j));
        for (int i = 0; i < X.MyLength(); ++i)
          {
            const std::uint64_t bits = mix(stream ^ mix(static_cast<std::uint64_t>(map.GID64(i))));
            // The upper 53 bits make a double in [0, 1).
            X[j][i] = 2. * static_cast<double>(bits >> 11) / 9007199254740992. - 1.;
          }
      }
    return X;
  }



  namespace
  {
    const Decision independent("norm of a direction among unit vectors / tolerance of their rank", 1.);

    /// Whether directions are looked for among the columns as they are or scaled to unit norm.
    enum class Scaling
    {
      none,
      unit_norm
    };

    /// Largest over smallest of ascending eigenvalues.
    double condition_number(const std::vector<double> &values)
    {
      return values.front() > 0. ? values.back() / values.front() : std::numeric_limits<double>::infinity();
    }

    std::optional<MultiVector> orthonormal_axes(const SparseMatrix &M,
                                                const MultiVector  *Q,
                                                const MultiVector  &X,
                                                const double        tolerance,
                                                const Scaling       scaling,
                                                PrincipalAxes      *axes)
    {
      // A Gram matrix resolves directions down to the square root of the
      // rounding unit; with this ratio per pass they still come out accurate.
      const double resolved = 1e-10;

      std::vector<MultiVector> kept;
      const auto               project = [&](MultiVector &Y) {
        if (Q != nullptr)
          project_out(M, *Q, Y);
        for (const MultiVector &W : kept)
          project_out(M, W, Y);
      };

      // Scale to unit norm; the largest direction of the scaled columns is the yardstick.
      std::optional<MultiVector> remaining;
      double                     largest = 0.;
      {
        const DenseMatrix   G = gram(X, M * X);
        std::vector<double> scale;
        std::vector<int>    nonzero;
        for (int j = 0; j < X.NumVectors(); ++j)
          {
            if (!std::isfinite(G(j, j)))
              throw SolverError("vector " + std::to_string(j) + " contains infinite or undefined values", "orthonormalisation",
                                "check the step that computed the vectors");
            if (G(j, j) > 0.)
              {
                nonzero.push_back(j);
                scale.push_back(scaling == Scaling::unit_norm ? 1. / std::sqrt(G(j, j)) : 1.);
              }
          }
        const int k = nonzero.size();
        if (k == 0)
          return {};
        DenseMatrix S = DenseMatrix::Zero(X.NumVectors(), k);
        for (int j = 0; j < k; ++j)
          S(nonzero[j], j) = scale[j];
        remaining.emplace(X * S);
        const auto                scales  = as_column(scale).asDiagonal();
        const std::vector<double> squares = common_eigenpairs(X.Comm(), scales * G(nonzero, nonzero) * scales).values;
        largest                           = squares.back();
        if (axes != nullptr)
          *axes = {{}, condition_number(squares)};
      }
      const double smallest = tolerance * tolerance * largest;

      // One projection leaves components of the size of the rounding error, the second none.
      project(*remaining);
      project(*remaining);

      while (remaining)
        {
          const RealPairs            pairs  = common_eigenpairs(X.Comm(), gram(*remaining, M * *remaining));
          const std::vector<double> &values = pairs.values;
          const int                  k      = values.size();

          const double threshold = std::max(resolved * values.back(), smallest);
          int          n_rest    = std::lower_bound(values.begin(), values.end(), threshold) - values.begin();
          // Directions between wait for the next pass
          if (scaling == Scaling::unit_norm)
            for (const double value : values)
              if (value <= smallest || value >= threshold)
                independent.exceeded_by(std::sqrt(std::max(value, 0.) / smallest));
          if (!(values.back() > smallest) || n_rest == k)
            break;

          MultiVector W = *remaining * largest_axes(pairs, k - n_rest);
          if (axes != nullptr)
            std::transform(values.rbegin(), values.rend() - n_rest, std::back_inserter(axes->norms),
                           [](const double x) { return std::sqrt(x); });
          for (int pass = 0; pass < 2; ++pass)
            {
              project(W);
              // Symmetric orthonormalisation W ← W (WᵀMW)^(-1/2): the vectors change least.
              W = W * inverse_root(common_eigenpairs(X.Comm(), gram(W, M * W)));
            }
          kept.push_back(std::move(W));

          // Rounding in V leaves a trace of the kept directions in the others, which the projection removes.
          if (n_rest > 0)
            {
              remaining.emplace(*remaining * pairs.vectors.leftCols(n_rest));
              project(*remaining);
              project(*remaining);
            }
          else
            remaining.reset();
        }

      if (kept.empty())
        return {};
      if (kept.size() == 1)
        return std::move(kept.front());
      std::vector<const MultiVector *> parts;
      for (const MultiVector &W : kept)
        parts.push_back(&W);
      return join(parts);
    }
  } // namespace



  std::optional<MultiVector> orthonormalize_if_any(const SparseMatrix &M,
                                                   const MultiVector  *Q,
                                                   const MultiVector  &X,
                                                   const double        tolerance,
                                                   PrincipalAxes      *axes)
  {
    return orthonormal_axes(M, Q, X, tolerance, Scaling::unit_norm, axes);
  }



  MultiVector orthonormalize(const SparseMatrix &M, const MultiVector *Q, const MultiVector &X, const double tolerance, PrincipalAxes *axes)
  {
    std::optional<MultiVector> W = orthonormalize_if_any(M, Q, X, tolerance, axes);
    if (!W)
      throw SolverError("all " + std::to_string(X.NumVectors()) + " vectors are zero or depend linearly on those already there",
                        "orthonormalisation", "give other vectors, or a smaller tolerance");
    return *W;
  }



  MultiVector principal_axes(const SparseMatrix &M, const MultiVector &X, const double tolerance, const int maximum, PrincipalAxes *axes)
  {
    const std::optional<MultiVector> W = orthonormal_axes(M, nullptr, X, tolerance, Scaling::none, axes);
    if (!W)
      throw SolverError("all " + std::to_string(X.NumVectors()) + " vectors are zero", "proper orthogonal decomposition",
                        "give other vectors");
    if (maximum < 1)
      throw SolverError("a basis of " + std::to_string(maximum) + " vectors was asked for", "proper orthogonal decomposition",
                        "ask for one vector at least");
    if (W->NumVectors() <= maximum)
      return *W;
    if (axes != nullptr)
      axes->norms.resize(maximum);
    // Returned as it is the view would outlive W; its copy does not refer to it.
    const MultiVector largest = view(*W, 0, maximum);
    return MultiVector(largest);
  }



  double orthonormality_defect(const SparseMatrix &M, const MultiVector &X)
  {
    return max_norm(gram(X, M * X) - DenseMatrix::Identity(X.NumVectors(), X.NumVectors()));
  }
} // namespace Squeal
