#include "tracked_modes.h"

#include <squeal/base/assignment.h>
#include <squeal/base/groups.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// |Re λ| / Im λ of modes of nearly the same λ, up to which it is a rounding error.
    constexpr double neutral_rate = 1e-11;
    /// Weight of closeness of λ beside overlaps of vectors.
    constexpr double closeness_weight = 0.01;

    /// −1: decays, 0: neutral, 1: grows.
    int growth_class(const Complex &lambda)
    {
      return !(std::abs(lambda.real()) / lambda.imag() > neutral_rate) ? 0 : lambda.real() > 0. ? 1 : -1;
    }

    /// Right or left vectors of the modes at a point, but within a multiple λ those nearest to the vectors of the branches before.
    class CarriedVectors
    {
    public:
      explicit CarriedVectors(const ComplexDenseMatrix &own)
        : own(&own)
      {}

      void replace(const int mode, const Eigen::VectorXcd &vector)
      {
        others[mode] = vector;
      }

      ComplexDenseMatrix columns(const std::vector<int> &modes) const
      {
        ComplexDenseMatrix result = (*own)(Eigen::all, modes);
        for (std::size_t j = 0; j < modes.size(); ++j)
          if (const auto other = others.find(modes[j]); other != others.end())
            result.col(static_cast<Eigen::Index>(j)) = other->second;
        return result;
      }

    private:
      const ComplexDenseMatrix       *own;
      std::map<int, Eigen::VectorXcd> others;
    };

    struct Carried
    {
      explicit Carried(const ChartPoint &point)
        : right(point.right)
        , left(point.left)
        , lambda(point.lambda)
      {}

      CarriedVectors       right, left;
      std::vector<Complex> lambda; ///< at the last point where it was not multiple
    };

    void begin_branch(TrackedModes &modes, const int k, const int mode)
    {
      modes.branch_of[k].resize(modes.points[k].lambda.size(), -1);
      modes.branch_of[k][mode] = static_cast<int>(modes.branches.size());
      modes.branches.push_back({std::vector<int>(modes.points.size(), -1)});
      modes.branches.back().modes[k] = mode;
    }

    /// λ at point k + 1 from the points before.
    Complex extrapolated(const TrackedModes &modes, const int k, const int mode)
    {
      const Complex here   = modes.points[k].lambda[mode];
      const int     before = k > 0 ? modes.branches[modes.branch_of[k][mode]].modes[k - 1] : -1;
      // The slope of a much shorter step says nothing about this one
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

      // Vectors where they tell modes apart, else λ that would lie on a smooth curve
      const int            r        = std::max(modes.points[k].right.rows(), modes.points[k + 1].right.rows());
      DenseMatrix          overlaps = DenseMatrix::Zero(n, n);
      std::vector<Complex> predicted;
      double               farthest = 0.;
      for (const int i : block.first)
        predicted.push_back(extrapolated(modes, k, i));
      for (const Complex &x : predicted)
        for (const int j : block.second)
          farthest = std::max(farthest, std::abs(x - lambda[j]));
      const auto add_overlaps = [&](const CarriedVectors &before, const ComplexDenseMatrix &after) {
        overlaps += 0.5 * (with_rows(before.columns(block.first), r).adjoint() * with_rows(after(Eigen::all, block.second), r)).cwiseAbs2();
      };
      add_overlaps(carried.right, modes.points[k + 1].right);
      add_overlaps(carried.left, modes.points[k + 1].left);
      // Among modes that nothing else tells apart the growing ones stay growing, however slowly they do
      const auto   grow_alike = [](const Complex &x, const Complex &y) { return growth_class(x) == growth_class(y); };
      const double weight     = block.resolved ? closeness_weight : 1.;
      return best_assignment(n, n, [&](const int i, const int j) {
        const Complex before = modes.points[k].lambda[block.first[i]], after = lambda[block.second[j]];
        const double  distance = std::abs(predicted[i] - after);
        return overlaps(i, j) - (farthest > 0. ? weight * distance / farthest : 0.) + (grow_alike(before, after) ? n : 0.);
      });
    }

    /// The vectors @p to of Y become the parts of the columns of X in the span of the orthonormal columns of Q, normalised.
    void project(const ComplexDenseMatrix &Q, const ComplexDenseMatrix &X, CarriedVectors &Y, const std::vector<int> &to)
    {
      // Vectors of a smaller basis have zeros beyond it
      const Eigen::Index       r = std::min(Q.rows(), X.rows());
      const ComplexDenseMatrix P = Q * (Q.topRows(r).adjoint() * X.topRows(r));
      for (std::size_t j = 0; j < to.size(); ++j)
        if (const double norm = P.col(j).norm(); norm > 0.)
          Y.replace(to[j], P.col(j) / norm);
    }

    /// Carries vectors from point k to the next.
    void carry(const TrackedModes &modes, const int k, const std::vector<int> &image, Carried &carried)
    {
      const ChartPoint &next = modes.points[k + 1];
      std::vector<int>  origin(next.lambda.size(), -1);
      for (std::size_t i = 0; i < image.size(); ++i)
        if (image[i] >= 0)
          origin[image[i]] = static_cast<int>(i);

      Carried result(next);
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
              project(multiple.right, carried.right.columns(from), result.right, to);
              project(multiple.left, carried.left.columns(from), result.left, to);
            }
        }
      carried = std::move(result);
    }
  } // namespace

  std::vector<MultipleModes> multiple_modes(const ChartPoint &point)
  {
    std::vector<MultipleModes> result;
    for (std::vector<int> &modes : members_of(mode_clusters(point.lambda)))
      if (modes.size() > 1)
        {
          const ComplexDenseMatrix right = point.right(Eigen::all, modes), left = point.left(Eigen::all, modes);
          result.push_back({std::move(modes), orthonormal_basis(right).Q, orthonormal_basis(left).Q});
        }
    return result;
  }

  void follow_branches(TrackedModes &modes)
  {
    modes.branches.clear();
    modes.branch_of.assign(modes.points.size(), {});
    if (modes.points.empty())
      return;
    Carried carried(modes.points[0]);
    for (std::size_t j = 0; j < modes.points[0].lambda.size(); ++j)
      begin_branch(modes, 0, static_cast<int>(j));
    for (int k = 0; k + 1 < modes.n_points(); ++k)
      {
        std::vector<int> image(modes.points[k].lambda.size(), -1); // the mode at point k + 1 of each mode at point k
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
} // namespace Squeal
