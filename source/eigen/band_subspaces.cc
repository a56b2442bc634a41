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
    /// Norm of a step, in coordinates of unit modes, that is the last.
    constexpr double last_step  = 1e-12;
    constexpr int    most_steps = 24;
    /// A step has to be shorter than this part of the one before.
    constexpr double contraction = 0.7;
    /// Bound on ‖Z^m‖ that leaves rounding errors of the powers their room, and number of squarings.
    constexpr double proof          = 0.1;
    constexpr int    most_squarings = 8;

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

    /// X of residual(X) = 0 by steps X −= residual(X) / D, entry by entry; whether they converge.
    template <typename Residual>
    bool solve_step_by_step(DenseMatrix &X, const DenseMatrix &D, const Residual &residual)
    {
      double before = 0.;
      for (int i = 0; i < most_steps; ++i)
        {
          const DenseMatrix step = residual(X).cwiseQuotient(D);
          const double      norm = step.norm();
          if (!(i == 0 || norm < contraction * before))
            return norm <= last_step;
          X -= step;
          if (norm <= last_step)
            return true;
          before = norm;
        }
      return false;
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
          if (Z.norm() < proof)
            return true;
          Z = Z * Z;
        }
      return false;
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
    const Eigen::Index m    = n - k;
    const auto         w    = as_column(coordinates.values);
    const DenseMatrix  B    = coordinates.inverse * A * coordinates.vectors;
    const auto         B_11 = B.topLeftCorner(k, k), B_12 = B.topRightCorner(k, m), B_21 = B.bottomLeftCorner(m, k),
               B_22     = B.bottomRightCorner(m, m);
    const DenseMatrix D = w.tail(m).replicate(1, k) - w.head(k).transpose().replicate(m, 1);

    DenseMatrix X = DenseMatrix::Zero(m, k);
    if (!solve_step_by_step(X, D, [&](const DenseMatrix &of) -> DenseMatrix { return B_21 + B_22 * of - of * (B_11 + B_12 * of); }))
      return {};
    const DenseMatrix S_1 = B_11 + B_12 * X, T = B_22 - X * B_12;
    if (!all_beyond(T, limit, std::sqrt((w[k] - limit) * (w[n - 1] - limit))))
      return {};
    DenseMatrix Y = DenseMatrix::Zero(k, m);
    if (!solve_step_by_step(Y, DenseMatrix(D.transpose()), [&](const DenseMatrix &of) -> DenseMatrix { return of * T - S_1 * of + B_12; }))
      return {};

    const auto       &V = coordinates.vectors, &W = coordinates.inverse;
    const DenseMatrix first = DenseMatrix::Identity(k, k) - Y * X;
    BandSubspaces     result;
    result.right = V.leftCols(k) + V.rightCols(m) * X;
    result.left  = (first * W.topRows(k) + Y * W.bottomRows(m)).transpose();
    result.small = first * S_1 + Y * (B_21 + B_22 * X);
    return result;
  }
} // namespace Squeal
