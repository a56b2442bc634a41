// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/groups.h>
#include <squeal/linear_algebra/orthonormal_basis.h>
#include <squeal/tracking/mode_links.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// Overlaps |φ_aᴴφ_b|² below this do not connect modes [-].
    constexpr double weakest_overlap = 0.1;
    /// Smallest cos² of the largest angle between agreeing subspaces [-].
    constexpr double agreement = 0.6;
    /// Entries of T up to this limit are neglected: rotations by up to 30° [-].
    constexpr double negligible_part = 0.25;
    /// |φ_iᴴφ_j|² at one point above which two modes are about to coalesce [-].
    constexpr double parallel = 0.7;
    /// Near a coalescence, the remainder of a unit vector after Gram-Schmidt may be a rounding error: it is dropped below this limit [-].
    constexpr double defective = 1e-7;
    /// δ² of two λ counts as real if |Im δ²| / |δ²| is below this limit [-]; modes that may coalesce have a real δ².
    constexpr double real_discriminant = 1e-6;

    /// Orthonormal basis without directions due to rounding errors.
    ComplexDenseMatrix safe_basis(const ComplexDenseMatrix &X)
    {
      const auto       basis = orthonormal_basis(X);
      std::vector<int> kept;
      for (int j = 0; j < X.cols(); ++j)
        if (basis.R(j, j).real() > defective)
          kept.push_back(j);
      return basis.Q(Eigen::placeholders::all, kept);
    }

    /// cos² of the largest angle between two subspaces. If one subspace has a lower dimension because its vectors are
    /// parallel, the largest angle to its projection on the other subspace is used.
    double agreement_of(const ComplexDenseMatrix &first, const ComplexDenseMatrix &second)
    {
      const ComplexDenseMatrix C       = safe_basis(first).adjoint() * safe_basis(second);
      const ComplexDenseMatrix squares = C.cols() <= C.rows() ? ComplexDenseMatrix(C.adjoint() * C) : C * C.adjoint();
      return squares.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff();
    }

    /// |xᴴy|² of unit vectors; for several y with the same λ, the squared norm of the projection of x on their span.
    DenseMatrix shares(const ComplexDenseMatrix &X, const ComplexDenseMatrix &Y, const std::vector<int> &cluster)
    {
      DenseMatrix result = (X.adjoint() * Y).cwiseAbs2();
      for (const std::vector<int> &members : members_of(cluster))
        if (members.size() > 1)
          result(Eigen::placeholders::all, members).colwise() =
            (X.adjoint() * orthonormal_basis(Y(Eigen::placeholders::all, members)).Q).rowwise().squaredNorm().eval();
      return result;
    }

    std::vector<int> chosen_from(const std::vector<int> &list, const std::vector<int> &positions)
    {
      std::vector<int> result;
      for (const int position : positions)
        result.push_back(list[position]);
      return result;
    }

    /// One of the two points of a step.
    struct Side
    {
      const ChartPoint  &point;
      ComplexDenseMatrix right, left; ///< vectors with the same number of rows as at the other point
      std::vector<int>   cluster;

      Side(const ChartPoint &p, const int n_rows)
        : point(p)
        , right(with_rows(p.right, n_rows))
        , left(with_rows(p.left, n_rows))
        , cluster(mode_clusters(p.lambda))
      {}

      int size() const
      {
        return static_cast<int>(point.lambda.size());
      }

      /// Groups of indices in @p modes: multiple λ and, optionally, pairs about to coalesce.
      std::vector<std::vector<int>> groups(const std::vector<int> &modes, const bool join_parallel) const
      {
        return members_of(connected_groups(static_cast<int>(modes.size()), [&](const int i, const int j) {
          const int  p = modes[i], q = modes[j];
          const auto are_parallel = [p, q](const ComplexDenseMatrix &X) { return std::norm(X.col(p).dot(X.col(q))) > parallel; };
          return cluster[p] == cluster[q] || (join_parallel && are_parallel(right) && are_parallel(left));
        }));
      }

      /// True if all these modes form one cluster.
      bool indistinguishable_modes(const std::vector<int> &modes) const
      {
        return std::all_of(modes.begin(), modes.end(), [&](const int i) { return cluster[i] == cluster[modes.front()]; });
      }
    };

    /// Sorts the modes of a step into blocks.
    class Linker
    {
    public:
      Linker(const ChartPoint &first, const ChartPoint &second, const double largest_circular_frequency)
        : limit(largest_circular_frequency)
        , a(first, std::max(first.right.rows(), second.right.rows()))
        , b(second, a.right.rows())
      {}

      ModeLinks run()
      {
        overlaps = DenseMatrix::Zero(a.size(), b.size());
        for (const auto vectors : {&Side::right, &Side::left})
          overlaps += 0.5 * shares(a.*vectors, b.*vectors, b.cluster).cwiseMax(shares(b.*vectors, a.*vectors, a.cluster).transpose());
        const auto overlap = [&](const int j, const int i) {
          return i < a.size() && j >= a.size() && overlaps(i, j - a.size()) > weakest_overlap;
        };
        for (const std::vector<int> &members : members_of(connected_groups(a.size() + b.size(), overlap)))
          {
            std::vector<int> first, second;
            for (const int m : members)
              m < a.size() ? first.push_back(m) : second.push_back(m - a.size());
            trim(first, second);
            if (!first.empty())
              sort_block(first, second);
          }
        // The number of modes lost in the band minus the number of modes gained must equal the increase in real pairs
        const int lost = in_band(a, links.lost), gained = in_band(b, links.gained);
        links.resolved = 2 * (lost - gained) == b.point.n_real() - a.point.n_real() && (lost == 0 || gained == 0);
        for (const ModeBlock &block : links.blocks)
          links.resolved &= block.resolved || (in_band(a, block.first) == 0 && in_band(b, block.second) == 0);
        return links;
      }

    private:
      int in_band(const Side &side, const std::vector<int> &modes) const
      {
        return static_cast<int>(
          std::count_if(modes.begin(), modes.end(), [&](const int i) { return side.point.lambda[i].imag() <= limit; }));
      }

      /// Reduces both sides to the same number of modes by keeping the most similar modes.
      void trim(std::vector<int> &first, std::vector<int> &second)
      {
        const bool        swapped = first.size() > second.size();
        std::vector<int> &few = swapped ? second : first, &many = swapped ? first : second;
        if (few.size() == many.size())
          return;
        const std::vector<int> match = best_assignment(few.size(), many.size(), [&](const int p, const int q) {
          const int i = swapped ? many[q] : few[p], j = swapped ? few[p] : many[q];
          return overlaps(i, j) + weakest_overlap / (1. + std::abs(a.point.lambda[i] - b.point.lambda[j]) / std::abs(a.point.lambda[i]));
        });
        const std::vector<int> kept  = chosen_from(many, match);
        for (const int m : many)
          if (std::find(kept.begin(), kept.end(), m) == kept.end())
            (swapped ? links.lost : links.gained).push_back(m);
        many = kept;
      }

      void sort_block(const std::vector<int> &first, const std::vector<int> &second)
      {
        double smallest = 1.;
        for (const auto vectors : {&Side::right, &Side::left})
          smallest =
            std::min(smallest, agreement_of((a.*vectors)(Eigen::placeholders::all, first), (b.*vectors)(Eigen::placeholders::all, second)));
        if (smallest < agreement)
          links.blocks.push_back({first, second, false});
        else
          divide(first, second);
      }

      /// Divides a block with agreeing subspaces into the smallest blocks that the vectors can distinguish.
      void divide(const std::vector<int> &first, const std::vector<int> &second)
      {
        const int n = static_cast<int>(first.size());
        if (n == 1 || a.indistinguishable_modes(first) || b.indistinguishable_modes(second))
          {
            links.blocks.push_back({first, second, true});
            return;
          }

        DenseMatrix T = DenseMatrix::Zero(n, n);
        for (const auto vectors : {&Side::right, &Side::left})
          {
            const auto X = transformation((a.*vectors)(Eigen::placeholders::all, first), (b.*vectors)(Eigen::placeholders::all, second));
            if (!X)
              {
                links.blocks.push_back({first, second, false});
                return;
              }
            T += 0.5 * X->X.cwiseProduct(X->inverse.transpose()).real();
          }

        for (const bool join_parallel : {false, true})
          if (divide_by_parts(first, second, T, join_parallel))
            return;
        const bool exceptional = n == 2 && pair_sign(a.point.lambda[first[0]], a.point.lambda[first[1]]) *
                                               pair_sign(b.point.lambda[second[0]], b.point.lambda[second[1]]) <
                                             0;
        links.blocks.push_back({first, second, exceptional});
      }

      /// Divides a block according to T, summed over groups; false if it cannot be divided.
      bool divide_by_parts(const std::vector<int> &first, const std::vector<int> &second, const DenseMatrix &T, const bool join_parallel)
      {
        const auto rows = a.groups(first, join_parallel), columns = b.groups(second, join_parallel);
        const int  n           = rows.size();
        const auto share_modes = [&](const int h, const int g) {
          return g < n && h >= n && T(rows[g], columns[h - n]).sum() > negligible_part * std::min(rows[g].size(), columns[h - n].size());
        };

        std::vector<std::pair<std::vector<int>, std::vector<int>>> parts;
        for (const std::vector<int> &groups : members_of(connected_groups(n + columns.size(), share_modes)))
          {
            std::vector<int> p, q;
            for (const int g : groups)
              if (g < n)
                p.insert(p.end(), rows[g].begin(), rows[g].end());
              else
                q.insert(q.end(), columns[g - n].begin(), columns[g - n].end());
            if (p.size() != q.size())
              return false;
            parts.emplace_back(chosen_from(first, p), chosen_from(second, q));
          }
        if (parts.size() == 1)
          return false;
        for (const auto &[p, q] : parts)
          divide(p, q);
        return true;
      }

      const double limit;
      const Side   a, b;
      DenseMatrix  overlaps;
      ModeLinks    links;
    };
  } // namespace

  std::vector<int> mode_clusters(const std::vector<Complex> &lambda)
  {
    return connected_groups(static_cast<int>(lambda.size()), [&](const int i, const int j) {
      return !(std::abs(lambda[i] - lambda[j]) / std::abs(lambda[i]) > indistinguishable);
    });
  }

  ComplexDenseMatrix orthonormal_in_clusters(const ComplexDenseMatrix &vectors, const std::vector<Complex> &lambda)
  {
    ComplexDenseMatrix result = vectors;
    for (const std::vector<int> &members : members_of(mode_clusters(lambda)))
      if (members.size() > 1)
        result(Eigen::placeholders::all, members) = orthonormal_basis(vectors(Eigen::placeholders::all, members)).Q;
    return result;
  }

  std::optional<Transformation> transformation(const ComplexDenseMatrix &first, const ComplexDenseMatrix &second)
  {
    const auto         basis = orthonormal_basis(first);
    ComplexDenseMatrix X     = basis.Q.adjoint() * second;
    if ((basis.R.diagonal().array() == 0.).any() || !X.allFinite())
      return {};
    basis.R.triangularView<Eigen::Upper>().solveInPlace(X);
    const ComplexDenseMatrix inverse = X.inverse();
    return inverse.allFinite() ? std::optional(Transformation{X, inverse}) : std::nullopt;
  }

  int pair_sign(const Complex &lambda_1, const Complex &lambda_2)
  {
    const Complex square = (lambda_1 - lambda_2) * (lambda_1 - lambda_2);
    if (std::abs(square.imag()) / std::abs(square) > real_discriminant)
      return 0;
    return square.real() > 0. ? 1 : -1;
  }

  ModeLinks link_modes(const ChartPoint &first, const ChartPoint &second, const double largest_circular_frequency)
  {
    return Linker(first, second, largest_circular_frequency).run();
  }
} // namespace Squeal
