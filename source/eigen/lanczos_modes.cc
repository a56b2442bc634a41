// SPDX-License-Identifier: GPL-3.0-or-later

#include "shift_invert.h"

#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    /// Components below this fraction of the norm of a vector are rounding errors [-].
    constexpr double rounding_of_whole = 1e-15;
    /// A unit vector whose norm is smaller than this after a second projection consists of rounding errors [-].
    constexpr double rounding_of_unit = 1e-3;

    /**
     * W = Q R by Gram–Schmidt in the inner product of M, updating B = M W; columns are dropped if at most the fraction @p smallest of their
     * norm remains. Q and M Q replace the first columns of W and B; returns R, k × b.
     */
    DenseMatrix mass_qr(MultiVector &W, MultiVector &B, const double smallest)
    {
      const int   b = W.n_columns();
      DenseMatrix R = DenseMatrix::Zero(b, b);
      int         k = 0;
      for (int j = 0; j < b; ++j)
        {
          MultiVector  w = view(W, j, 1), image = view(B, j, 1);
          const double before = std::sqrt(std::max(0., gram(w, image)(0, 0)));
          if (k > 0)
            {
              R.col(j).head(k) = gram(view(B, 0, k), w);
              multiply_add(-1., view(W, 0, k), R.col(j).head(k), 1., w);
              multiply_add(-1., view(B, 0, k), R.col(j).head(k), 1., image);
            }
          const double norm = std::sqrt(std::max(0., gram(w, image)(0, 0)));
          if (!(norm > smallest * before))
            continue;
          R(k, j)       = norm;
          MultiVector q = view(W, k, 1), image_of_q = view(B, k, 1);
          q.local()          = w.local() / norm;
          image_of_q.local() = image.local() / norm;
          ++k;
        }
      return R.topRows(k);
    }

    /**
     * Block Lanczos process for A = (K + s M)⁻¹ M, which is self-adjoint in the inner product of M, with full orthogonalisation:
     *
     *   A V = V T + Q R Eᵀ,   [V Q] M-orthonormal,
     *
     * where T is block tridiagonal and E contains the last columns of the identity (R. G. Grimes, J. G. Lewis, H. D. Simon, SIAM J. Matrix
     * Anal. Appl. 15 (1994) 228).
     */
    class BlockLanczos
    {
    public:
      /// Overwrites @p start; its linearly dependent columns are dropped.
      BlockLanczos(const ShiftInvert &A, MultiVector start, const int n_reserved)
        : A(A)
        , basis(std::make_unique<MultiVector>(A.map(), std::max(n_reserved, 1), false))
        , image(A.map(), 0)
      {
        append(start);
      }

      /// Appends Q to V.
      void expand()
      {
        const int   first = m, width = b;
        MultiVector W(A.map(), width, false);
        A.apply_to_image(image, W);
        m += width;
        const auto [H, next] = append(W);
        T.conservativeResizeLike(DenseMatrix::Zero(m, m));
        const DenseMatrix diagonal          = H.middleRows(first, width);
        T.block(first, first, width, width) = 0.5 * (diagonal + diagonal.transpose());
        if (first > 0)
          {
            T.block(first, first - R.cols(), width, R.cols()) = R;
            T.block(first - R.cols(), first, R.cols(), width) = R.transpose();
          }
        R = next;
      }

      /// Eigenpairs of T, largest first, and the residuals ‖A x − ν x‖ of their Ritz vectors in the M-norm.
      struct RitzPairs
      {
        std::vector<double> values, errors;
        DenseMatrix         vectors;
      };

      RitzPairs ritz_pairs() const
      {
        RealPairs         pairs = agreed(A.map().communicator(), symmetric_eigenpairs(T));
        const DenseMatrix left  = R * pairs.vectors.bottomRows(R.cols());
        RitzPairs         result;
        result.vectors = pairs.vectors.rowwise().reverse();
        result.values.assign(pairs.values.rbegin(), pairs.values.rend());
        for (int i = m - 1; i >= 0; --i)
          result.errors.push_back(left.col(i).norm());
        return result;
      }

      /// A x / ν for the first @p n Ritz vectors: an additional step of inverse iteration without a solve.
      MultiVector ritz_vectors(const RitzPairs &ritz, const int n) const
      {
        const DenseMatrix Y = ritz.vectors.leftCols(n);
        DenseMatrix       coordinates(m + b, n);
        coordinates << Y, R * Y.bottomRows(R.cols()) * as_column(ritz.values).head(n).cwiseInverse().asDiagonal();
        return view(*basis, 0, m + b) * coordinates;
      }

      int m = 0; ///< number of vectors in V
      int b = 0; ///< number of vectors in Q; 0 if V spans an invariant subspace

    private:
      struct Coefficients
      {
        DenseMatrix H, R;
      };

      /// Orthonormalises W = V H + Q R and appends Q as the active block; overwrites W.
      Coefficients append(MultiVector &W)
      {
        const MultiVector V = view(*basis, 0, m);
        MultiVector       B = A.mass * W;
        DenseMatrix       H = DenseMatrix::Zero(m, W.n_columns()), all = DenseMatrix::Identity(W.n_columns(), W.n_columns());
        // Normalise between the two passes, so that two passes are sufficient for remainders of any size
        for (const double smallest : {rounding_of_whole, rounding_of_unit})
          {
            MultiVector rest = view(W, 0, static_cast<int>(all.rows())), its_image = view(B, 0, static_cast<int>(all.rows()));
            if (m > 0 && all.rows() > 0)
              {
                const DenseMatrix removed = gram(V, its_image);
                multiply_add(-1., V, removed, 1., rest);
                H += removed * all;
              }
            A.mass.apply(rest, its_image);
            all = mass_qr(rest, its_image, smallest) * all;
          }
        b = static_cast<int>(all.rows());
        if (m + b > basis->n_columns())
          throw SolverError("the basis of Lanczos vectors is full", "symmetric eigenproblem",
                            "this is an error in the program: please report it");
        if (b > 0)
          {
            MultiVector place = view(*basis, m, b);
            place             = view(W, 0, b);
          }
        image = MultiVector(view(B, 0, b));
        return {H, all};
      }

      const ShiftInvert           &A;
      std::unique_ptr<MultiVector> basis; ///< [V Q]
      MultiVector                  image; ///< M Q
      DenseMatrix                  T, R;
    };

    /// Number of Ritz values, in descending order, before the first value that has not converged.
    int n_converged(const BlockLanczos::RitzPairs &ritz, const double tolerance)
    {
      int n = 0;
      while (n < static_cast<int>(ritz.values.size()) && ritz.errors[n] <= tolerance * ritz.values[n])
        ++n;
      return n;
    }
  } // namespace

  std::optional<MultiVector> lanczos_vectors(const ShiftInvert &A, const KrylovRequest &request)
  {
    // Limit the block size: the basis and one more block must be linearly independent
    const int n = A.n_free(), width = std::max(1, std::min(request.block_size, n / 4));
    const int largest = std::min(n - width, 4 * request.n_wanted + (20 + 10 * request.attempt) * width);

    // Apply A once to damp high frequencies in the random start vectors
    MultiVector random = random_vectors(A.map(), width, request.seed), start(A.map(), width, false);
    A.apply(random, start);
    // Reserve the largest size: unused space takes no physical memory, and growing later would require a copy
    BlockLanczos process(A, std::move(start), largest + 2 * width);

    // Check convergence early: the final basis has about two vectors per mode
    BlockLanczos::RitzPairs ritz;
    int                     n_found = 0;
    for (int size = std::min(largest, 3 * request.n_wanted / 2 + 2 * width); n_found < request.n_wanted;)
      {
        while (process.m < size && process.b > 0)
          process.expand();
        ritz    = process.ritz_pairs();
        n_found = std::min(n_converged(ritz, request.tolerance), request.n_wanted);
        if (process.b == 0 || process.m >= largest)
          break;
        size = std::min(largest, process.m + std::max(width, (request.n_wanted - n_found) / 4));
      }
    if (n_found == 0)
      return {};
    return process.ritz_vectors(ritz, n_found);
  }
} // namespace Squeal
