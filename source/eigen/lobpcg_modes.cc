#include "preconditioned_modes.h"

#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/mass_orthonormal.h>
#include <squeal/linear_algebra/orthonormal_basis.h>

#include <algorithm>
#include <limits>

namespace Squeal
{
  namespace
  {
    constexpr int most_lobpcg_steps = 500;

    /// Residuals that a step adds.
    constexpr int lobpcg_block = 32;

    /// Of pairs beyond the band, with which the eigenvalue is known to a millionth.
    constexpr double tolerance_beyond = 1e-3;

    /// Directions of added residuals below this part of the largest are rounding errors.
    constexpr double least_new_direction = 1e-10;

    /// The search for the lowest pairs, step by step.
    class PreconditionedSearch
    {
    public:
      PreconditionedSearch(const SparseMatrix          &K,
                           const SparseMatrix          &M,
                           const LinearOperator        &preconditioner,
                           const MultiVector           *deflated,
                           const PreconditionedRequest &request)
        : K(K)
        , M(M)
        , preconditioner(preconditioner)
        , deflated(deflated)
        , request(request)
        , n_kept(request.n_wanted + std::max(4, request.n_wanted / 8))
        , rounding(5. * std::numeric_limits<double>::epsilon() * row_sum_norm(K))
        , basis(K.rows(), 2 * (n_kept + lobpcg_block))
      {}

      std::optional<MultiVector> vectors()
      {
        add(random_vectors(K.rows(), n_kept, request.seed));
        for (int step = 0; step < most_lobpcg_steps; ++step)
          {
            ritz                                       = agreed(K.communicator(), symmetric_eigenpairs(H));
            const std::optional<MultiVector> residuals = unfinished();
            if (!residuals)
              break;
            if (n + residuals->n_columns() > basis.n_columns())
              restart(residuals->n_columns());
            previous = ritz.vectors.middleCols(n_converged, std::min(lobpcg_block, static_cast<int>(ritz.vectors.cols()) - n_converged));
            if (!add(*residuals))
              break;
          }
        if (n_converged == 0)
          return {};
        return view(basis, 0, static_cast<int>(ritz.vectors.rows())) * DenseMatrix(ritz.vectors.leftCols(n_converged));
      }

    private:
      /// Preconditions X and adds what is new of it to the basis; whether anything is.
      bool add(const MultiVector &X)
      {
        std::optional<MultiVector> W(std::in_place, X.map(), X.n_columns(), false);
        preconditioner.apply(X, *W);
        if (deflated != nullptr)
          W = orthonormalize_if_any(M, deflated, *W, least_new_direction);
        const MultiVector V = view(basis, 0, n);
        if (W)
          W = orthonormalize_if_any(M, n > 0 ? &V : nullptr, *W, least_new_direction);
        if (!W)
          return false;
        const int         n_new = W->n_columns();
        const MultiVector KW    = K * *W;
        DenseMatrix       grown(n + n_new, n + n_new);
        grown.topLeftCorner(n, n) = H;
        if (n > 0)
          {
            grown.topRightCorner(n, n_new)   = gram(V, KW);
            grown.bottomLeftCorner(n_new, n) = grown.topRightCorner(n, n_new).transpose();
          }
        grown.bottomRightCorner(n_new, n_new) = gram(*W, KW);
        H                                     = DenseMatrix(0.5 * (grown + grown.transpose()));
        basis.local().middleCols(n, n_new)    = W->local();
        n += n_new;
        return true;
      }

      /// Residuals, of norm 1, of the lowest pairs that have not converged; nothing where all wanted ones have.
      std::optional<MultiVector> unfinished()
      {
        // A new direction may have put a pair between those that had converged: the last are looked at again, at the end all.
        n_converged    = std::max(0, n_converged - lobpcg_block);
        bool all_again = n_converged > 0;
        while (true)
          {
            if (n_converged >= request.n_wanted)
              {
                if (!all_again)
                  break;
                all_again   = false;
                n_converged = 0;
              }
            const int         n_looked = std::min(lobpcg_block, n - n_converged);
            const MultiVector X        = view(basis, 0, n) * DenseMatrix(ritz.vectors.middleCols(n_converged, n_looked));
            const MultiVector KX       = K * X;
            MultiVector       R        = M * X;
            for (int j = 0; j < n_looked; ++j)
              R.col(j) = KX.col(j) - ritz.values[n_converged + j] * R.col(j);
            const std::vector<double> left = column_norms(R), image = column_norms(KX), size = column_norms(X);
            std::vector<int>          columns;
            for (int j = 0; j < n_looked; ++j)
              if (const bool beyond = ritz.values[n_converged + j] > request.limit;
                  !(left[j] <= std::max((beyond ? tolerance_beyond : request.tolerance) * image[j], rounding * size[j])))
                columns.push_back(j);
            int n_leading = columns.empty() ? n_looked : columns.front();
            agree(K.communicator(), &n_leading, 1);
            n_converged += n_leading;
            if (n_leading < n_looked)
              {
                if (n_converged >= request.n_wanted)
                  continue;
                MultiVector some = selected(R, columns);
                for (std::size_t j = 0; j < columns.size(); ++j)
                  some.col(static_cast<int>(j)) /= left[columns[j]];
                return some;
              }
          }
        n_converged = request.n_wanted;
        return {};
      }

      /// Keeps the lowest Ritz vectors, and what those of the step before add to them.
      void restart(const int n_new)
      {
        const int   n_ritz = std::min(n_kept, n), n_previous = std::min<int>(previous.cols(), basis.n_columns() - n_ritz - n_new);
        DenseMatrix Z                                   = DenseMatrix::Zero(n, n_ritz + n_previous);
        Z.leftCols(n_ritz)                              = ritz.vectors.leftCols(n_ritz);
        Z.block(0, n_ritz, previous.rows(), n_previous) = previous.leftCols(n_previous);
        const auto        independent                   = [](const double part) { return part > 1e-8; };
        const DenseMatrix Q                             = orthonormal_basis(Z, independent).Q;
        std::vector<int>  columns;
        for (int j = 0; j < Q.cols(); ++j)
          if (!Q.col(j).isZero(0.))
            columns.push_back(j);
        DenseMatrix kept = Q(Eigen::all, columns);
        agree(K.communicator(), kept);
        const MultiVector V       = view(basis, 0, n) * kept;
        H                         = DenseMatrix(kept.transpose() * H * kept);
        H                         = DenseMatrix(0.5 * (H + H.transpose()));
        n                         = static_cast<int>(columns.size());
        basis.local().leftCols(n) = V.local();
        ritz                      = agreed(K.communicator(), symmetric_eigenpairs(H));
      }

      const SparseMatrix         &K, &M;
      const LinearOperator       &preconditioner;
      const MultiVector          *deflated;
      const PreconditionedRequest request;
      const int                   n_kept;
      const double                rounding;
      MultiVector                 basis; ///< of which n columns are in use, M-orthonormal
      int                         n = 0, n_converged = 0;
      DenseMatrix                 H;        ///< VᵀKV
      RealPairs                   ritz;     ///< of H
      DenseMatrix                 previous; ///< Ritz vectors of the step before, in the basis as it was
    };
  } // namespace

  std::optional<MultiVector> lobpcg_vectors(const SparseMatrix          &K,
                                            const SparseMatrix          &M,
                                            const LinearOperator        &preconditioner,
                                            const MultiVector           *deflated,
                                            const PreconditionedRequest &request)
  {
    return PreconditionedSearch(K, M, preconditioner, deflated, request).vectors();
  }
} // namespace Squeal
