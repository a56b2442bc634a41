#include <squeal/eigen/band_subspaces.h>
#include <squeal/linear_algebra/dense_lu.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace Squeal
{
  namespace
  {
    /// Part of all modes beyond which a problem of those of the band costs as much as one of all.
    constexpr double largest_part = 0.6;
    /// Ratio of the squares of the frequencies on either side of the gap from which the steps are few.
    constexpr double narrowest_gap = 1.2;
    /// Norm, in coordinates of unit modes, of what the last step may leave.
    constexpr double error_left = 1e-12;
    constexpr int    most_steps = 24;
    /// A step has to be shorter than this part of the one before.
    constexpr double contraction = 0.7;
    /// Bound on ‖Z^m‖ that leaves rounding errors of the powers their room, and number of squarings.
    constexpr double proof          = 0.9;
    constexpr int    most_squarings = 8;
    /// Part of the band's end by which modes of lower frequencies, rigid-body motions among them, are scaled.
    constexpr double smallest_part = 1e-2;

    /// Number of modes of the reference before the widest gap at or beyond the end of the band; 0 if there is none.
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

    /// X of residual(X) = 0 by steps X −= divided(residual(X)), from X = 0; whether they converge.
    template <typename Residual, typename Divided>
    bool solve_step_by_step(DenseMatrix &X, const Residual &residual, const Divided &divided)
    {
      double before = 0.;
      for (int i = 0; i < most_steps; ++i)
        {
          const DenseMatrix step = divided(residual(X));
          const double      norm = step.norm();
          if (!(i == 0 || norm < contraction * before))
            return norm <= error_left;
          X -= step;
          // The next one would be as much smaller again
          if (norm <= error_left || (i > 0 && norm * norm <= error_left * (before - norm)))
            return true;
          before = norm;
        }
      return false;
    }

    /// Upper bound of ‖Z‖₂: √(‖Z‖₁ ‖Z‖_∞) or ‖Z‖_F.
    double norm_bound(const DenseMatrix &Z)
    {
      const DenseMatrix sizes = Z.cwiseAbs();
      return std::min(std::sqrt(sizes.colwise().sum().maxCoeff() * sizes.rowwise().sum().maxCoeff()), Z.norm());
    }

    /// Whether Re κ > limit for all eigenvalues κ of T, as far as powers of the Cayley transform show.
    bool all_beyond(const DenseMatrix &T, const double limit, const double scale)
    {
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

    /**
     * A block [0, Σ; −Σ_i⁻¹ B, −Σ_i⁻¹ D Σ_j] of the companion form in coordinates (x, λ x / σ); without Σ where rows and columns are
     * of different modes. Products cost half of those of a dense block.
     */
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

      DenseMatrix dense() const
      {
        const Eigen::Index p      = lower.rows();
        DenseMatrix        result = DenseMatrix::Zero(2 * p, lower.cols());
        if (sigma.size() > 0)
          result.topRightCorner(p, p).diagonal() = sigma;
        result.bottomRows(p) = lower;
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

    DenseMatrix dense(const CompanionBlock &A)
    {
      return A.dense();
    }

    /// Blocks of a matrix in modal coordinates, those of the band first.
    template <typename Block>
    struct Blocks
    {
      DenseMatrix band;      ///< B_11
      Block       band_rest; ///< B_12
      DenseMatrix rest_band; ///< B_21
      Block       rest;      ///< B_22
    };

    /// What separates the band: R = [I; X], Lᵀ = [I − Y X, Y] and S, in modal coordinates.
    struct Separation
    {
      DenseMatrix X, Y, first, small; ///< first = I − Y X
    };

    /**
     * @param divided_right, divided_left the inverse of the reference's operators on residuals of X and Y
     * @param is_beyond whether T has nothing of the band
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

    /**
     * X of ω_i J X_ij − ω_j X_ij J = R_ij, 2 × 2 blocks ij; and, with negative sums, of ω_j X_ij J − ω_i J X_ij = R_ij.
     */
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

  ModalCoordinates modal_coordinates(const DenseMatrix &stiffness, const DenseMatrix &mass)
  {
    auto [values, vectors] = symmetric_eigenpairs(stiffness, mass);
    DenseMatrix inverse    = vectors.transpose() * mass;
    return {std::move(values), std::move(vectors), std::move(inverse)};
  }

  std::optional<BandSubspaces> band_subspaces(const DenseMatrix      &A,
                                              const ModalCoordinates &coordinates,
                                              const double            largest_circular_frequency)
  {
    const double       limit = largest_circular_frequency * largest_circular_frequency;
    const Eigen::Index n = A.rows(), k = std::isfinite(limit) ? modes_of_band(coordinates.values, limit) : 0;
    if (k == 0)
      return {};
    const Eigen::Index m     = n - k;
    const auto         w     = as_column(coordinates.values);
    const DenseMatrix  B     = coordinates.inverse * A * coordinates.vectors;
    const DenseMatrix  D     = w.tail(m).replicate(1, k) - w.head(k).transpose().replicate(m, 1);
    const auto         apart = separated(
              Blocks<DenseMatrix>{B.topLeftCorner(k, k), B.topRightCorner(k, m), B.bottomLeftCorner(m, k), B.bottomRightCorner(m, m)},
              [&](const DenseMatrix &R) -> DenseMatrix { return R.cwiseQuotient(D); },
              [&](const DenseMatrix &R) -> DenseMatrix { return R.cwiseQuotient(D.transpose()); },
              [&](const DenseMatrix &T) { return all_beyond(T, limit, std::sqrt((w[k] - limit) * (w[n - 1] - limit))); });
    if (!apart)
      return {};

    const auto   &V = coordinates.vectors, &W = coordinates.inverse;
    BandSubspaces result;
    result.right = V.leftCols(k) + V.rightCols(m) * apart->X;
    result.left  = (apart->first * W.topRows(k) + apart->Y * W.bottomRows(m)).transpose();
    result.small = apart->small;
    return result;
  }

  std::optional<BandSubspaces> damped_band_subspaces(const DenseMatrix      &A,
                                                     const DenseMatrix      &C,
                                                     const ModalCoordinates &coordinates,
                                                     const double            largest_circular_frequency)
  {
    const double       limit = largest_circular_frequency * largest_circular_frequency;
    const Eigen::Index n = A.rows(), k = std::isfinite(limit) ? modes_of_band(coordinates.values, limit) : 0;
    if (k == 0)
      return {};
    const Eigen::Index    m     = n - k;
    const auto            w     = as_column(coordinates.values);
    const Eigen::VectorXd sigma = w.cwiseMax(smallest_part * smallest_part * limit).cwiseSqrt(), s_1 = sigma.head(k), s_2 = sigma.tail(m);
    const DenseMatrix     K = coordinates.inverse * A * coordinates.vectors, D = coordinates.inverse * C * coordinates.vectors;
    const DenseMatrix     differences = s_2.replicate(1, k) - s_1.transpose().replicate(m, 1),
                      sums            = s_2.replicate(1, k) + s_1.transpose().replicate(m, 1);
    const auto apart                  = separated(
                       Blocks<CompanionBlock>{CompanionBlock(K.topLeftCorner(k, k), D.topLeftCorner(k, k), s_1, s_1, true).dense(),
                                              CompanionBlock(K.topRightCorner(k, m), D.topRightCorner(k, m), s_1, s_2, false),
                                              CompanionBlock(K.bottomLeftCorner(m, k), D.bottomLeftCorner(m, k), s_2, s_1, false).dense(),
                                              CompanionBlock(K.bottomRightCorner(m, m), D.bottomRightCorner(m, m), s_2, s_2, true)},
                       [&](const DenseMatrix &R) { return divided_pairs(R, differences, sums); },
                       [&](const DenseMatrix &R) { return divided_pairs(R, differences.transpose(), -sums.transpose()); },
                       [&](const DenseMatrix &T) { return all_beyond(-T * T, limit, std::sqrt((w[k] - limit) * (w[n - 1] - limit))); });
    if (!apart)
      return {};

    // From coordinates (x, λ x / σ) of the band and of the rest to [φ; λ φ]
    const auto       &V = coordinates.vectors, &W = coordinates.inverse;
    const DenseMatrix scaled_V = V * sigma.asDiagonal(), scaled_W = sigma.cwiseInverse().asDiagonal() * W;
    BandSubspaces     result;
    result.right = DenseMatrix(2 * n, 2 * k);
    result.left  = DenseMatrix(2 * n, 2 * k);
    result.right << V.rightCols(m) * apart->X.topRows(m), scaled_V.rightCols(m) * apart->X.bottomRows(m);
    result.right.topLeftCorner(n, k) += V.leftCols(k);
    result.right.bottomRightCorner(n, k) += scaled_V.leftCols(k);
    result.left << (apart->first.leftCols(k) * W.topRows(k) + apart->Y.leftCols(m) * W.bottomRows(m)).transpose(),
      (apart->first.rightCols(k) * scaled_W.topRows(k) + apart->Y.rightCols(m) * scaled_W.bottomRows(m)).transpose();
    result.small = apart->small;
    return result;
  }
} // namespace Squeal
