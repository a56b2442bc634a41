#include "blas.h"

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

    /// Local values of a multivector, one column after the other; copied only if the columns are scattered.
    class LocalValues
    {
    public:
      explicit LocalValues(const MultiVector &X)
        : values(X.Values())
        , stride(std::max(1, X.Stride()))
      {
        if (!X.ConstantStride())
          {
            copy   = std::make_unique<MultiVector>(X);
            values = copy->Values();
            stride = std::max(1, copy->Stride());
          }
      }

      const double *values;
      int           stride;

    private:
      std::unique_ptr<MultiVector> copy;
    };

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

    /// Eigenvalues of a symmetric matrix, which is replaced by its eigenvectors, the same on all processes.
    std::vector<double> common_eigenvalues(const Epetra_Comm &comm, DenseMatrix &A)
    {
      std::vector<double> values = symmetric_eigenvalues(A);
      agree(comm, A, values);
      return values;
    }

    /// Columns of @p V that belong to the @p n largest of the ascending @p values, each divided by its root, largest first.
    DenseMatrix largest_axes(const DenseMatrix &V, const std::vector<double> &values, const int n)
    {
      DenseMatrix S(V.n_rows(), n);
      for (int j = 0; j < n; ++j)
        {
          const int column = V.n_columns() - 1 - j;
          for (int i = 0; i < S.n_rows(); ++i)
            S(i, j) = V(i, column) / std::sqrt(values[column]);
        }
      return S;
    }

    /// V diag(1 / √values) Vᵀ.
    DenseMatrix inverse_root(const DenseMatrix &V, const std::vector<double> &values)
    {
      DenseMatrix S = V;
      for (int j = 0; j < S.n_columns(); ++j)
        for (int i = 0; i < S.n_rows(); ++i)
          S(i, j) /= std::sqrt(values[j]);
      return multiply(S, V, false, true);
    }
  } // namespace



  DenseMatrix gram(const MultiVector &X, const MultiVector &Y)
  {
    require(X.MyLength() == Y.MyLength(), "inner products");
    const int   m = X.NumVectors(), n = Y.NumVectors();
    DenseMatrix local(m, n), sum(m, n);
    if (X.MyLength() > 0)
      {
        const LocalValues x(X), y(Y);
        gemm(true, false, m, n, X.MyLength(), 1., x.values, x.stride, y.values, y.stride, 0., local.column(), m);
      }
    if (X.Comm().NumProc() == 1)
      return local;

    X.Comm().SumAll(local.column(), sum.column(), m * n);
    // Decisions are taken on these numbers: the last bit must agree everywhere.
    X.Comm().Broadcast(sum.column(), m * n, 0);
    return sum;
  }



  void agree(const Epetra_Comm &comm, DenseMatrix &A, std::vector<double> &values)
  {
    if (comm.NumProc() == 1)
      return;
    comm.Broadcast(A.column(), A.n_rows() * A.n_columns(), 0);
    comm.Broadcast(values.data(), values.size(), 0);
  }



  void multiply_add(const double alpha, const MultiVector &X, const DenseMatrix &S, const double beta, MultiVector &Y)
  {
    require(X.MyLength() == Y.MyLength() && X.NumVectors() == S.n_rows() && Y.NumVectors() == S.n_columns(),
            "linear combination of vectors");
    if (Y.MyLength() == 0)
      return;
    if (!Y.ConstantStride())
      {
        MultiVector contiguous(Y);
        multiply_add(alpha, X, S, beta, contiguous);
        Y = contiguous;
        return;
      }
    const LocalValues x(X);
    gemm(false, false, Y.MyLength(), Y.NumVectors(), X.NumVectors(), alpha, x.values, x.stride, S.column(), S.n_rows(), beta, Y.Values(),
         Y.Stride());
  }



  MultiVector operator*(const MultiVector &X, const DenseMatrix &S)
  {
    MultiVector Y(X.Map(), S.n_columns(), false);
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
        DenseMatrix         G = gram(X, M * X);
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
        DenseMatrix S(X.NumVectors(), k), unit(k, k);
        for (int j = 0; j < k; ++j)
          {
            S(nonzero[j], j) = scale[j];
            for (int i = 0; i < k; ++i)
              unit(i, j) = scale[i] * scale[j] * G(nonzero[i], nonzero[j]);
          }
        remaining.emplace(X * S);
        const std::vector<double> squares = common_eigenvalues(X.Comm(), unit);
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
          DenseMatrix               V      = gram(*remaining, M * *remaining);
          const std::vector<double> values = common_eigenvalues(X.Comm(), V);
          const int                 k      = values.size();

          const double threshold = std::max(resolved * values.back(), smallest);
          int          n_rest    = std::lower_bound(values.begin(), values.end(), threshold) - values.begin();
          // Directions between wait for the next pass
          if (scaling == Scaling::unit_norm)
            for (const double value : values)
              if (value <= smallest || value >= threshold)
                independent.exceeded_by(std::sqrt(std::max(value, 0.) / smallest));
          if (!(values.back() > smallest) || n_rest == k)
            break;

          MultiVector W = *remaining * largest_axes(V, values, k - n_rest);
          if (axes != nullptr)
            std::transform(values.rbegin(), values.rend() - n_rest, std::back_inserter(axes->norms),
                           [](const double x) { return std::sqrt(x); });
          for (int pass = 0; pass < 2; ++pass)
            {
              project(W);
              // Symmetric orthonormalisation W ← W (WᵀMW)^(-1/2): the vectors change least.
              DenseMatrix               U       = gram(W, M * W);
              const std::vector<double> squares = common_eigenvalues(X.Comm(), U);
              W                                 = W * inverse_root(U, squares);
            }
          kept.push_back(std::move(W));

          // Rounding in V leaves a trace of the kept directions in the others, which the projection removes.
          if (n_rest > 0)
            {
              remaining.emplace(*remaining * columns(V, 0, n_rest));
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
    return max_norm(add(gram(X, M * X), identity(X.NumVectors()), -1.));
  }
} // namespace Squeal
