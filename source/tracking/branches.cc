// SPDX-License-Identifier: GPL-3.0-or-later

#include "tracked_modes.h"

#include <squeal/base/exceptions.h>
#include <squeal/base/groups.h>
#include <squeal/base/tasks.h>
#include <squeal/base/text.h>
#include <squeal/linear_algebra/orthonormal_basis.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// |Re λ| / Im λ up to this limit is a rounding error [-].
    constexpr double neutral_rate = 1e-11;
    /// Weight of the distance of λ relative to overlaps of vectors [-].
    constexpr double closeness_weight = 0.01;

    /// −1: decays, 0: neutral, 1: grows.
    int growth_class(const Complex &lambda)
    {
      return !(std::abs(lambda.real()) / lambda.imag() > neutral_rate) ? 0 : lambda.real() > 0. ? 1 : -1;
    }

    /// Vectors of the modes at a point; for a multiple λ, the vectors closest to the previous vectors of the branches.
    struct Carried
    {
      ComplexDenseMatrix   right, left;
      std::vector<Complex> lambda; ///< λ at the last point at which it was simple
    };

    void begin_branch(TrackedModes &modes, const int k, const int mode)
    {
      modes.branch_of[k].resize(modes.points[k].lambda.size(), -1);
      modes.branch_of[k][mode] = static_cast<int>(modes.branches.size());
      modes.branches.push_back({std::vector<int>(modes.points.size(), -1)});
      modes.branches.back().modes[k] = mode;
    }

    /// λ at point k + 1, extrapolated from previous points.
    Complex extrapolated(const TrackedModes &modes, const int k, const int mode)
    {
      const Complex here   = modes.points[k].lambda[mode];
      const int     before = k > 0 ? modes.branches[modes.branch_of[k][mode]].modes[k - 1] : -1;
      // Do not use the slope of a much shorter step, which is not representative
      if (before < 0 || modes.width(k - 1) < 0.1 * modes.width(k))
        return here;
      return here + (here - modes.points[k - 1].lambda[before]) * (modes.width(k) / modes.width(k - 1));
    }

    std::vector<int> match_in_block(const TrackedModes &modes, const int k, const ModeBlock &block, const Carried &carried)
    {
      const std::vector<Complex> &lambda = modes.points[k + 1].lambda;
      const int                   n      = static_cast<int>(block.first.size());
      if (n == 1)
        return {0};
      if (n == 2)
        {
          const Complex a1 = carried.lambda[block.first[0]], a2 = carried.lambda[block.first[1]];
          const Complex b1 = lambda[block.second[0]], b2 = lambda[block.second[1]];
          if (const int before = pair_sign(a1, a2), after = pair_sign(b1, b2); before * after < 0)
            {
              const auto first_comes_first = [](const Complex &x, const Complex &y, const int sign) {
                return sign < 0 ? x.imag() < y.imag() : x.real() > y.real();
              };
              return first_comes_first(a1, a2, before) == first_comes_first(b1, b2, after) ? std::vector<int>{0, 1} :
                                                                                             std::vector<int>{1, 0};
            }
        }

      // Link modes mainly by their vectors if these distinguish the modes; otherwise, extrapolated λ have the same weight
      const int            r        = std::max(modes.points[k].right.rows(), modes.points[k + 1].right.rows());
      DenseMatrix          overlaps = DenseMatrix::Zero(n, n);
      std::vector<Complex> predicted;
      double               farthest = 0.;
      for (const int i : block.first)
        predicted.push_back(extrapolated(modes, k, i));
      for (const Complex &x : predicted)
        for (const int j : block.second)
          farthest = std::max(farthest, std::abs(x - lambda[j]));
      const auto add_overlaps = [&](const ComplexDenseMatrix &before, const ComplexDenseMatrix &after) {
        overlaps += 0.5 * (with_rows(before(Eigen::placeholders::all, block.first), r).adjoint() *
                           with_rows(after(Eigen::placeholders::all, block.second), r))
                            .cwiseAbs2();
      };
      add_overlaps(carried.right, modes.points[k + 1].right);
      add_overlaps(carried.left, modes.points[k + 1].left);
      // Prefer modes with the same sign of growth, which may be the only distinction
      const auto   grow_alike = [](const Complex &x, const Complex &y) { return growth_class(x) == growth_class(y); };
      const double weight     = block.resolved ? closeness_weight : 1.;
      return best_assignment(n, n, [&](const int i, const int j) {
        const Complex before = modes.points[k].lambda[block.first[i]], after = lambda[block.second[j]];
        const double  distance = std::abs(predicted[i] - after);
        return overlaps(i, j) - (farthest > 0. ? weight * distance / farthest : 0.) + (grow_alike(before, after) ? n : 0.);
      });
    }

    /// Projects the columns @p from of X on the span of the orthonormal columns of Q, normalises them and stores them as the columns @p to
    /// of Y.
    void project(const ComplexDenseMatrix &Q,
                 const ComplexDenseMatrix &X,
                 const std::vector<int>   &from,
                 ComplexDenseMatrix       &Y,
                 const std::vector<int>   &to)
    {
      // Vectors from an earlier, smaller basis are extended by zeros
      const Eigen::Index       r = std::min(Q.rows(), X.rows());
      const ComplexDenseMatrix P = Q * (Q.topRows(r).adjoint() * X.topRows(r)(Eigen::placeholders::all, from));
      for (std::size_t j = 0; j < to.size(); ++j)
        if (const double norm = P.col(j).norm(); norm > 0.)
          Y.col(to[j]) = P.col(j) / norm;
    }

    /// Carries vectors from point k to the next point.
    void carry(const TrackedModes &modes, const int k, const std::vector<int> &image, Carried &carried)
    {
      const ChartPoint &next = modes.points[k + 1];
      std::vector<int>  origin(next.lambda.size(), -1);
      for (std::size_t i = 0; i < image.size(); ++i)
        if (image[i] >= 0)
          origin[image[i]] = static_cast<int>(i);

      Carried result{next.right, next.left, next.lambda};
      for (const MultipleModes &multiple : modes.multiple[k + 1])
        {
          std::vector<int> from, to;
          for (const int j : multiple.modes)
            if (origin[j] >= 0)
              {
                from.push_back(origin[j]);
                to.push_back(j);
                result.lambda[j] = carried.lambda[origin[j]];
              }
          if (!to.empty())
            {
              project(multiple.right, carried.right, from, result.right, to);
              project(multiple.left, carried.left, from, result.left, to);
            }
        }
      carried = std::move(result);
    }

    /// All multiple λ of a point with their vectors.
    std::vector<MultipleModes> multiple_modes(const ChartPoint &point)
    {
      std::vector<MultipleModes> result;
      for (std::vector<int> &modes : members_of(mode_clusters(point.lambda)))
        if (modes.size() > 1)
          {
            const ComplexDenseMatrix right = point.right(Eigen::placeholders::all, modes),
                                     left  = point.left(Eigen::placeholders::all, modes);
            result.push_back({std::move(modes), orthonormal_basis(right).Q, orthonormal_basis(left).Q});
          }
      return result;
    }

    /// A step counts as half of another step up to this fraction, which allows for rounding [-].
    constexpr double half_width = 0.5 + 1e-6;

    void insert(TrackedModes &modes, const EvaluateChart &evaluate, const std::vector<double> &values, const bool refines)
    {
      if (values.empty())
        return;
      std::vector<ChartPoint>                 found = evaluate(values);
      std::vector<std::vector<MultipleModes>> multiple(found.size());
      run_tasks(static_cast<int>(found.size()), [&](const int i) { multiple[i] = multiple_modes(found[i]); });
      for (std::size_t i = 0; i < values.size(); ++i)
        {
          found[i].friction_coefficient = values[i];
          const int k                   = std::lower_bound(modes.points.begin(), modes.points.end(), values[i],
                                                           [](const ChartPoint &p, const double value) { return p.friction_coefficient < value; }) -
                        modes.points.begin();
          modes.points.insert(modes.points.begin() + k, std::move(found[i]));
          modes.multiple.insert(modes.multiple.begin() + k, std::move(multiple[i]));
          modes.is_refinement.insert(modes.is_refinement.begin() + k, refines);
          if (k > 0 && k + 1 < modes.n_points())
            {
              const int    stalls    = modes.intervals[k - 1].stalls + 1;
              const double half      = half_width * (modes.width(k - 1) + modes.width(k));
              modes.intervals[k - 1] = {std::nullopt, modes.width(k - 1) <= half ? 0 : stalls};
              modes.intervals.insert(modes.intervals.begin() + k, {std::nullopt, modes.width(k) <= half ? 0 : stalls});
            }
          else if (modes.n_points() > 1)
            modes.intervals.emplace_back();
        }
      if (refines)
        modes.n_refinements += static_cast<int>(values.size());
      std::vector<int> unlinked;
      for (std::size_t k = 0; k < modes.intervals.size(); ++k)
        if (!modes.intervals[k].links)
          unlinked.push_back(static_cast<int>(k));
      run_tasks(static_cast<int>(unlinked.size()), [&](const int i) {
        const int k              = unlinked[i];
        modes.intervals[k].links = link_modes(modes.points[k], modes.points[k + 1], modes.options.largest_circular_frequency);
      });
    }
  } // namespace

  void follow_branches(TrackedModes &modes)
  {
    modes.branches.clear();
    modes.branch_of.assign(modes.points.size(), {});
    if (modes.points.empty())
      return;
    Carried carried{modes.points[0].right, modes.points[0].left, modes.points[0].lambda};
    for (std::size_t j = 0; j < modes.points[0].lambda.size(); ++j)
      begin_branch(modes, 0, static_cast<int>(j));
    for (int k = 0; k + 1 < modes.n_points(); ++k)
      {
        std::vector<int> image(modes.points[k].lambda.size(), -1); // for each mode at point k, its index at point k + 1
        for (const ModeBlock &block : modes.intervals[k].links->blocks)
          {
            const std::vector<int> match = match_in_block(modes, k, block, carried);
            for (std::size_t i = 0; i < match.size(); ++i)
              image[block.first[i]] = block.second[match[i]];
          }
        modes.branch_of[k + 1].assign(modes.points[k + 1].lambda.size(), -1);
        for (std::size_t i = 0; i < image.size(); ++i)
          if (image[i] >= 0)
            {
              modes.branches[modes.branch_of[k][i]].modes[k + 1] = image[i];
              modes.branch_of[k + 1][image[i]]                   = modes.branch_of[k][i];
            }
        for (std::size_t j = 0; j < modes.branch_of[k + 1].size(); ++j)
          if (modes.branch_of[k + 1][j] < 0)
            begin_branch(modes, k + 1, static_cast<int>(j));
        carry(modes, k, image, carried);
      }
  }

  StabilityChart stability_chart(const std::vector<double> &grid,
                                 const EvaluateChart       &evaluate,
                                 const ChartOptions        &options,
                                 const PredictZero         &predict)
  {
    for (std::size_t i = 1; i < grid.size(); ++i)
      if (!(grid[i] > grid[i - 1]))
        throw Error("friction coefficient " + exact_text(grid[i]) + " is not larger than the previous one, " + exact_text(grid[i - 1]),
                    "tracking of modes", "give friction coefficients in ascending order, each only once");
    for (const auto &[quantity, name] : {std::make_pair(options.largest_circular_frequency, "end of the band"),
                                         {options.threshold_tolerance, "tolerance of thresholds"},
                                         {options.smallest_step, "smallest step"}})
      if (!(quantity > 0.))
        throw Error(text("the ", name, " is ", quantity, ", but must be positive"), "tracking of modes", "give a positive value");

    TrackedModes tracked{options, {}, {}, {}, {}, {}, {}};
    insert(tracked, evaluate, grid, false);
    for (;;)
      {
        follow_branches(tracked);
        const std::vector<EventSearch> searches = find_events(tracked);
        const std::vector<double>      wanted   = refinement_requests(tracked, searches, predict);
        if (wanted.empty())
          return finished_chart(std::move(tracked), searches);
        insert(tracked, evaluate, wanted, true);
      }
  }
} // namespace Squeal
