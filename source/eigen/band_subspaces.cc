// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/eigen/band_subspaces.h>
#include <squeal/linear_algebra/dense_lu.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

namespace Squeal
{
  namespace
  {
    /// Separating the band saves time only if at most this fraction of all modes lies in it [-].
    constexpr double largest_part = 0.6;
    /// Smallest ratio of the squared frequencies on both sides of the gap for fast convergence [-].
    constexpr double narrowest_gap = 1.2;
    /// Target for the residual after the last step, for modes of unit norm. Errors of λ are products of the errors of both subspaces.
    constexpr double error_wanted = 1e-8;
    constexpr int    most_steps   = 80;
    /// Length of a step, relative to the first one, at which the iteration is abandoned [-].
    constexpr double hopeless_growth = 1000.;
    /// Number of previous steps that are combined.
    constexpr std::size_t most_remembered = 8;
    /// Eigenvalues of a matrix with unit diagonal above this limit are positive in spite of rounding errors [-].
    constexpr double least_definite = 1e-6;
    /// ‖Z^m‖ below this limit counts as a proof: 1 with a margin for rounding errors [-].
    constexpr double proof          = 0.9;
    constexpr int    most_squarings = 8;
    /// Lower limit of the scale σ of a mode relative to the end of the band, for rigid-body and other low-frequency modes [-].
    constexpr double smallest_part = 1e-2;

    /// Number of modes of the symmetric pencil below the widest gap at or above the end of the band; 0 if there is no gap.
    Eigen::Index modes_of_band(const std::vector<double> &squares, const double limit)
    {
      const auto   n      = static_cast<Eigen::Index>(squares.size());
      const auto   first  = std::upper_bound(squares.begin(), squares.end(), limit) - squares.begin();
      double       gap    = narrowest_gap;
      Eigen::Index result = 0;
      for (Eigen::Index k = std::max<Eigen::Index>(first, 1); k <= largest_part * n && k < n; ++k)
        if (const double ratio = squares[k] / std::max(squares[k - 1], limit); ratio > gap)
          {
            gap    = ratio;
            result = k;
          }
      return result;
    }

    /// Solves residual(X) = 0 by steps X −= divided(residual(X)), starting with X = 0; returns true on convergence. Each step is combined
    /// with the last few to minimise the residual (D. G. Anderson, Journal of the ACM 12 (1965) 547–560).
    template <typename Residual, typename Divided>
    bool solve_step_by_step(DenseMatrix &X, const Residual &residual, const Divided &divided)
    {
      std::deque<DenseMatrix> steps, changes;       // differences of successive steps, and of X without the step itself
      DenseMatrix             last_step, last_X, G; // G: Gram matrix of the differences
      const auto              inner  = [](const DenseMatrix &A, const DenseMatrix &B) { return A.cwiseProduct(B).sum(); };
      double                  before = 0., first = 0.;
      for (int i = 0; i < most_steps; ++i)
        {
          DenseMatrix  step = divided(residual(X));
          const double norm = step.norm();
          if (i == 0)
            first = norm;
          if (!(norm <= hopeless_growth * first))
            return false;
          // By extrapolation, the next step is below the target
          if (norm <= error_wanted || (i > 0 && norm < before && norm * norm <= error_wanted * (before - norm)))
            {
              X -= step;
              return true;
            }
          if (i > 0)
            {
              steps.push_back(step - last_step);
              changes.push_back(X - last_X - steps.back());
              if (steps.size() > most_remembered)
                {
                  steps.pop_front();
                  changes.pop_front();
                }
            }
          last_X = X;
          X -= step;
          if (!steps.empty())
            {
              const auto      n = static_cast<Eigen::Index>(steps.size());
              Eigen::VectorXd b(n);
              // Gram matrix of the remembered differences and the new one
              G = DenseMatrix(G.bottomRightCorner(std::min(n - 1, G.rows()), std::min(n - 1, G.rows())));
              G.conservativeResize(n, n);
              for (Eigen::Index p = 0; p < n; ++p)
                {
                  b[p]        = inner(steps[p], step);
                  G(p, n - 1) = G(n - 1, p) = inner(steps[p], steps.back());
                }
              const Eigen::VectorXd part = G.ldlt().solve(b);
              if (part.allFinite())
                for (Eigen::Index p = 0; p < n; ++p)
                  X -= part[p] * changes[p];
            }
          last_step = std::move(step);
          before    = norm;
        }
      return false;
    }

    /// Upper bound of ‖Z‖₂: √(‖Z‖₁ ‖Z‖_∞) or ‖Z‖_F.
    double norm_bound(const DenseMatrix &Z)
    {
      const DenseMatrix sizes = Z.cwiseAbs();
      return std::min(std::sqrt(sizes.colwise().sum().maxCoeff() * sizes.rowwise().sum().maxCoeff()), Z.norm());
    }

    /// True if P (T − limit) + (T − limit)ᵀ P is positive definite for P = diag(T): then Re κ > limit for all eigenvalues κ of T.
    bool all_beyond_in_norm(const DenseMatrix &T, const double limit)
    {
      const Eigen::VectorXd d = T.diagonal();
      if (!(d.minCoeff() > limit))
        return false;
      // Scale to ½ P⁻¹ (...) P⁻¹, because friction couples a mode in proportion to the square of its frequency
      const DenseMatrix scaled = T * d.cwiseInverse().asDiagonal();
      DenseMatrix       S      = 0.5 * (scaled + scaled.transpose());
      S.diagonal() -= Eigen::VectorXd(limit * d.cwiseInverse().array() + least_definite);
      return S.llt().info() == Eigen::Success;
    }

    /// True if all_beyond_in_norm() or powers of the Cayley transform prove that Re κ > limit for all eigenvalues κ of T.
    bool all_beyond(const DenseMatrix &T, const double limit, const double scale)
    {
      if (all_beyond_in_norm(T, limit))
        return true;
      const Eigen::Index n    = T.rows();
      const DenseMatrix  unit = DenseMatrix::Identity(n, n);
      const RealLU       lu(T + (scale - limit) * unit);
      if (!(lu.reciprocal_condition() > 0.))
        return false;
      DenseMatrix Z = unit - 2. * scale * lu.solve(unit);
      for (int i = 0; i <= most_squarings; ++i)
        {
          if (norm_bound(Z) < proof)
            return true;
          Z = Z * Z;
        }
      return false;
    }

    /// A block [0, Σ; −Σ_i⁻¹ B, −Σ_i⁻¹ D Σ_j] of the companion form in coordinates (x, λ x / σ); Σ is zero in off-diagonal blocks. Products
    /// cost half as much as with a dense block.
    class CompanionBlock
    {
    public:
      CompanionBlock(const DenseMatrix     &stiffness,
                     const DenseMatrix     &damping,
                     const Eigen::VectorXd &rows,
                     const Eigen::VectorXd &columns,
                     const bool             is_diagonal)
        : lower(stiffness.rows(), 2 * stiffness.cols())
        , sigma(is_diagonal ? columns : Eigen::VectorXd())
      {
        const auto inverse = rows.cwiseInverse().asDiagonal();
        lower << -(inverse * stiffness), -(inverse * damping * columns.asDiagonal());
      }

      friend DenseMatrix dense(const CompanionBlock &A)
      {
        const Eigen::Index p      = A.lower.rows();
        DenseMatrix        result = DenseMatrix::Zero(2 * p, A.lower.cols());
        if (A.sigma.size() > 0)
          result.topRightCorner(p, p).diagonal() = A.sigma;
        result.bottomRows(p) = A.lower;
        return result;
      }

      friend DenseMatrix operator*(const CompanionBlock &A, const DenseMatrix &X)
      {
        const Eigen::Index p      = A.lower.rows();
        DenseMatrix        result = DenseMatrix::Zero(2 * p, X.cols());
        if (A.sigma.size() > 0)
          result.topRows(p) = A.sigma.asDiagonal() * X.bottomRows(p);
        result.bottomRows(p).noalias() = A.lower * X;
        return result;
      }

      friend DenseMatrix operator*(const DenseMatrix &X, const CompanionBlock &A)
      {
        const Eigen::Index p      = A.lower.rows();
        DenseMatrix        result = X.rightCols(p) * A.lower;
        if (A.sigma.size() > 0)
          result.rightCols(p) += X.leftCols(p) * A.sigma.asDiagonal();
        return result;
      }

    private:
      DenseMatrix     lower;
      Eigen::VectorXd sigma;
    };

    const DenseMatrix &dense(const DenseMatrix &A)
    {
      return A;
    }

    /// Blocks of a matrix in modal coordinates; the modes of the band come first.
    template <typename Block>
    struct Blocks
    {
      DenseMatrix band;      ///< B_11
      Block       band_rest; ///< B_12
      DenseMatrix rest_band; ///< B_21
      Block       rest;      ///< B_22
    };

    /// Subspaces of the band in modal coordinates: R = [I; X], Lᵀ = [first, Y] with first = I − Y X, so that Lᵀ R = I; small = Lᵀ B R.
    struct Separation
    {
      DenseMatrix X, Y, first, small;
    };

    /**
     * @param divided_right, divided_left inverse operators of the symmetric pencil, applied to residuals of X and Y
     * @param is_beyond returns true if T has no eigenvalue in the band
     */
    template <typename Block, typename Right, typename Left, typename Proof>
    std::optional<Separation> separated(const Blocks<Block> &B,
                                        const Right         &divided_right,
                                        const Left          &divided_left,
                                        const Proof         &is_beyond)
    {
      const Eigen::Index k = B.band.rows(), m = B.rest_band.rows();
      Separation         result;
      DenseMatrix       &X = result.X = DenseMatrix::Zero(m, k), &Y = result.Y = DenseMatrix::Zero(k, m);
      if (!solve_step_by_step(
            X, [&](const DenseMatrix &of) -> DenseMatrix { return B.rest_band + B.rest * of - of * (B.band + B.band_rest * of); },
            divided_right))
        return {};
      const DenseMatrix S_1 = B.band + B.band_rest * X, T = dense(B.rest) - X * B.band_rest;
      if (!is_beyond(T))
        return {};
      if (!solve_step_by_step(
            Y, [&, B_12 = DenseMatrix(dense(B.band_rest))](const DenseMatrix &of) -> DenseMatrix { return of * T - S_1 * of + B_12; },
            divided_left))
        return {};
      result.first = DenseMatrix::Identity(k, k) - Y * X;
      result.small = result.first * S_1 + Y * (B.rest_band + B.rest * X);
      return result;
    }

    /// Solves ω_i J X_ij − ω_j X_ij J = R_ij for 2 × 2 blocks ij; with negative sums, ω_j X_ij J − ω_i J X_ij = R_ij.
    DenseMatrix divided_pairs(const DenseMatrix &R, const DenseMatrix &differences, const DenseMatrix &sums)
    {
      const Eigen::Index p = differences.rows(), q = differences.cols();
      const auto         a = R.topLeftCorner(p, q), b = R.topRightCorner(p, q), c = R.bottomLeftCorner(p, q), d = R.bottomRightCorner(p, q);
      // Commuting part [s t; −t s], anticommuting part [u v; v −u]; −J [a b; c d] = [−c −d; a b]
      const DenseMatrix s = 0.5 * (a + d).cwiseQuotient(differences), t = 0.5 * (b - c).cwiseQuotient(differences),
                        u = 0.5 * (a - d).cwiseQuotient(sums), v = 0.5 * (b + c).cwiseQuotient(sums);
      DenseMatrix result(2 * p, 2 * q);
      result << t - v, u - s, s + u, t + v;
      return result;
    }
  } // namespace

  std::optional<BandSubspaces> band_subspaces(const DenseMatrix         &A,
                                              const std::vector<double> &squares,
                                              const double               largest_circular_frequency)
  {
    const double       limit = largest_circular_frequency * largest_circular_frequency;
    const Eigen::Index n = A.rows(), k = std::isfinite(limit) ? modes_of_band(squares, limit) : 0;
    if (k == 0)
      return {};
    const Eigen::Index m     = n - k;
    const auto         w     = as_column(squares);
    const DenseMatrix  D     = w.tail(m).replicate(1, k) - w.head(k).transpose().replicate(m, 1);
    const auto         apart = separated(
              Blocks<DenseMatrix>{A.topLeftCorner(k, k), A.topRightCorner(k, m), A.bottomLeftCorner(m, k), A.bottomRightCorner(m, m)},
              [&](const DenseMatrix &R) -> DenseMatrix { return R.cwiseQuotient(D); },
              [&](const DenseMatrix &R) -> DenseMatrix { return R.cwiseQuotient(D.transpose()); },
              [&](const DenseMatrix &T) { return all_beyond(T, limit, std::sqrt((w[k] - limit) * (w[n - 1] - limit))); });
    if (!apart)
      return {};

    BandSubspaces result{DenseMatrix(n, k), DenseMatrix(n, k), apart->small};
    result.right << DenseMatrix::Identity(k, k), apart->X;
    result.left << apart->first.transpose(), apart->Y.transpose();
    return result;
  }

  std::optional<BandSubspaces> damped_band_subspaces(const DenseMatrix         &A,
                                                     const DenseMatrix         &C,
                                                     const std::vector<double> &squares,
                                                     const double               largest_circular_frequency)
  {
    const double       limit = largest_circular_frequency * largest_circular_frequency;
    const Eigen::Index n = A.rows(), k = std::isfinite(limit) ? modes_of_band(squares, limit) : 0;
    if (k == 0)
      return {};
    const Eigen::Index    m     = n - k;
    const auto            w     = as_column(squares);
    const Eigen::VectorXd sigma = w.cwiseMax(smallest_part * smallest_part * limit).cwiseSqrt(), s_1 = sigma.head(k), s_2 = sigma.tail(m);
    const DenseMatrix     differences = s_2.replicate(1, k) - s_1.transpose().replicate(m, 1),
                      sums            = s_2.replicate(1, k) + s_1.transpose().replicate(m, 1);
    const auto apart                  = separated(
                       Blocks<CompanionBlock>{dense(CompanionBlock(A.topLeftCorner(k, k), C.topLeftCorner(k, k), s_1, s_1, true)),
                                              CompanionBlock(A.topRightCorner(k, m), C.topRightCorner(k, m), s_1, s_2, false),
                                              dense(CompanionBlock(A.bottomLeftCorner(m, k), C.bottomLeftCorner(m, k), s_2, s_1, false)),
                                              CompanionBlock(A.bottomRightCorner(m, m), C.bottomRightCorner(m, m), s_2, s_2, true)},
                       [&](const DenseMatrix &R) { return divided_pairs(R, differences, sums); },
                       [&](const DenseMatrix &R) { return divided_pairs(R, differences.transpose(), -sums.transpose()); },
                       [&](const DenseMatrix &T) { return all_beyond(-T * T, limit, std::sqrt((w[k] - limit) * (w[n - 1] - limit))); });
    if (!apart)
      return {};

    // Transform the coordinates (x, λ x / σ) of both parts to [φ; λ φ]
    const DenseMatrix &X = apart->X, &Y = apart->Y, &first = apart->first;
    BandSubspaces      result{DenseMatrix::Zero(2 * n, 2 * k), DenseMatrix(2 * n, 2 * k), apart->small};
    result.right.topLeftCorner(k, k).setIdentity();
    result.right.middleRows(k, m)             = X.topRows(m);
    result.right.block(n, k, k, k).diagonal() = s_1;
    result.right.bottomRows(m)                = s_2.asDiagonal() * X.bottomRows(m);
    result.left << first.leftCols(k).transpose(), Y.leftCols(m).transpose(),
      s_1.cwiseInverse().asDiagonal() * first.rightCols(k).transpose(), s_2.cwiseInverse().asDiagonal() * Y.rightCols(m).transpose();
    return result;
  }
} // namespace Squeal
