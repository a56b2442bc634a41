#include "libraries.h"
#include "panels.h"

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/iterative_inverse.h>

#include <Eigen/Eigenvalues>

#include <cmath>
#include <limits>
#include <optional>

namespace Squeal
{
  namespace
  {
    /// ‖b − A x‖ / ‖b‖ [-].
    constexpr double tolerance = 1e-12;

    /// Vectors that share a search space: more take fewer steps, as much more time for each, and more memory.
    constexpr int block_width = panel_width;

    constexpr int most_steps = 400, most_starts = 8;

    /// Directions of a block that are this part of the others are left to the next start.
    constexpr double least_direction = 1e-14;

    /// W = Q ξ with Qᵀ Z = I, Z the preconditioned Q.
    struct Directions
    {
      MultiVector Q, Z;
      DenseMatrix factor; ///< ξ, r × s
    };

    /// Nothing where W vanishes; W and Z = preconditioned W are used up.
    std::optional<Directions> directions(MultiVector W, MultiVector Z, const std::string &what)
    {
      DenseMatrix G = gram(W, Z);
      G             = DenseMatrix(0.5 * (G + G.transpose()));
      if (!G.allFinite() || G.diagonal().minCoeff() < 0.)
        throw_not_positive_definite("multigrid", what);
      const Eigen::VectorXd size = G.diagonal().cwiseSqrt().cwiseMax(std::numeric_limits<double>::min());
      G                          = DenseMatrix(size.cwiseInverse().asDiagonal() * G * size.cwiseInverse().asDiagonal());
      const RealPairs axes       = agreed(W.communicator(), symmetric_eigenpairs(G));
      const int       n          = static_cast<int>(axes.values.size());
      int             first      = 0; // ascending
      while (first < n && axes.values[first] <= least_direction * axes.values.back())
        ++first;
      if (first == n)
        return {};
      const DenseMatrix     U    = axes.vectors.rightCols(n - first);
      const Eigen::VectorXd root = as_column(axes.values).tail(n - first).cwiseSqrt();
      const DenseMatrix     T    = size.cwiseInverse().asDiagonal() * U * root.cwiseInverse().asDiagonal();
      return Directions{W * T, Z * T, root.asDiagonal() * U.transpose() * size.asDiagonal()};
    }

    class BlockConjugateGradients : public IterativeInverse
    {
    public:
      BlockConjugateGradients(const SparseMatrix &A, const NearNullSpace &space, const std::string &what)
        : what(what)
        , multigrid(A, space, what)
        , matrix(A)
        , norm(row_sum_norm(A))
      {}

      void apply(const MultiVector &B, MultiVector &X) const override
      {
        for (int first = 0; first < B.n_columns(); first += block_width)
          {
            const int   n = std::min(block_width, B.n_columns() - first);
            MultiVector x = view(X, first, n);
            solve(view(B, first, n), x);
          }
        vectors += B.n_columns();
      }

      void apply_transpose(const MultiVector &X, MultiVector &Y) const override
      {
        apply(X, Y);
      }

      double n_factor_entries() const override
      {
        return multigrid.n_entries();
      }

      const RowMap &map() const override
      {
        return multigrid.map();
      }

      long long n_steps() const override
      {
        return steps;
      }

      long long n_vectors() const override
      {
        return vectors;
      }

      const LinearOperator &preconditioner() const override
      {
        return multigrid;
      }

    private:
      MultiVector times(const MultiVector &X) const
      {
        MultiVector   Y(X.map(), X.n_columns(), false);
        Panel<double> x(matrix.n_columns()), y(matrix.n_rows);
        for (int first = 0; first < X.n_columns(); first += panel_width)
          {
            to_panel(X, first, x);
            matrix.update_ghosts(x);
            panel_product(matrix, x, y);
            from_panel(y, first, Y);
          }
        return Y;
      }

      MultiVector preconditioned(const MultiVector &X) const
      {
        MultiVector Y(X.map(), X.n_columns(), false);
        multigrid.apply(X, Y);
        return Y;
      }

      /// Of columns that do not fulfil the tolerance.
      std::vector<int> unfinished(const MultiVector &R, const MultiVector &X, const std::vector<double> &norms) const
      {
        const std::vector<double> residual = column_norms(R), size = column_norms(X);
        std::vector<int>          result;
        for (std::size_t j = 0; j < residual.size(); ++j)
          if (!(residual[j] <= std::max(tolerance * norms[j], std::numeric_limits<double>::epsilon() * norm * size[j])))
            result.push_back(static_cast<int>(j));
        return result;
      }

      /// From zero, and again from the true residual until it is small enough.
      void solve(const MultiVector &B, MultiVector &X) const
      {
        const std::vector<double> norms = column_norms(B);
        X.local().setZero();
        MultiVector      R(B);
        std::vector<int> columns = unfinished(R, X, norms);
        for (int start = 0; !columns.empty() && start < most_starts; ++start)
          {
            MultiVector               some = selected(R, columns);
            const std::vector<double> size = column_norms(some);
            std::vector<double>       goal;
            for (std::size_t j = 0; j < columns.size(); ++j)
              {
                some.col(static_cast<int>(j)) /= size[j];
                goal.push_back(0.3 * tolerance * norms[columns[j]] / size[j]);
              }
            const MultiVector D = iterate(std::move(some), goal);
            for (std::size_t j = 0; j < columns.size(); ++j)
              X.col(columns[j]) += size[j] * D.col(static_cast<int>(j));
            R       = B - times(X);
            columns = unfinished(R, X, norms);
          }
        if (!columns.empty())
          {
            const std::vector<double> left  = column_norms(R);
            double                    worst = 0.;
            for (const int j : columns)
              worst = std::max(worst, left[j] / norms[j]);
            throw SolverError(text("conjugate gradients with multigrid leave a relative residual of ", worst), what,
                              "choose a factorisation instead of multigrid");
          }
      }

      /// A⁻¹ R for columns of norm 1, until the norms of the recurrent residuals reach their goals.
      MultiVector iterate(MultiVector R, const std::vector<double> &goal) const
      {
        MultiVector X(R.map(), R.n_columns());
        MultiVector Z     = preconditioned(R);
        auto        block = directions(std::move(R), std::move(Z), what);
        if (!block)
          return X;
        MultiVector P   = block->Z;
        DenseMatrix rho = block->factor;
        for (int step = 0; step < most_steps; ++step)
          {
            ++steps;
            const MultiVector AP = times(P);
            DenseMatrix       G  = gram(P, AP);
            G                    = DenseMatrix(0.5 * (G + G.transpose()));
            agree(X.communicator(), G);
            const Eigen::LLT<DenseMatrix> cholesky(G);
            if (cholesky.info() != Eigen::Success)
              return X; // Directions that depend on each other: from the true residual anew
            multiply_add(1., P, cholesky.solve(rho), 1., X);
            MultiVector W(std::move(block->Q));
            block.reset();
            multiply_add(-1., AP, cholesky.solve(DenseMatrix::Identity(G.rows(), G.rows())), 1., W);

            const DenseMatrix WW   = gram(W, W);
            bool              done = true;
            for (std::size_t j = 0; j < goal.size(); ++j)
              {
                const auto   r      = rho.col(static_cast<int>(j));
                const double square = r.dot(WW * r);
                done                = done && square <= goal[j] * goal[j];
              }
            int stop = done;
            agree(X.communicator(), &stop, 1);
            if (stop != 0)
              return X;
            MultiVector new_Z = preconditioned(W);
            block             = directions(std::move(W), std::move(new_Z), what);
            if (!block)
              return X;
            rho              = DenseMatrix(block->factor * rho);
            MultiVector next = block->Z;
            multiply_add(1., P, DenseMatrix(block->factor.transpose()), 1., next);
            P = std::move(next);
          }
        return X;
      }

      const std::string         what;
      const Multigrid           multigrid;
      const PanelMatrix<double> matrix;
      const double              norm;
      mutable long long         steps = 0, vectors = 0;
    };
  } // namespace

  std::unique_ptr<IterativeInverse> iterative_inverse(const SparseMatrix &A, const NearNullSpace &space, const std::string &what)
  {
    return std::make_unique<BlockConjugateGradients>(A, space, what);
  }
} // namespace Squeal
