#include <squeal/base/assignment.h>
#include <squeal/base/decision.h>
#include <squeal/tracking/mode_links.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// Overlaps |φ_aᴴφ_b|² below this do not connect modes.
    constexpr double weakest_overlap = 0.1;
    /// cos² of the largest angle between subspaces that agree.
    constexpr double agreement = 0.6;
    /// Parts T of a mode that may be missed: rotations by up to 30°.
    constexpr double negligible_part = 0.25;
    /// |φ_iᴴφ_j|² at one point from which two modes are about to coalesce.
    constexpr double parallel = 0.7;
    /// Norm of what Gram and Schmidt leave of a dependent unit vector.
    constexpr double dependent = 1e-13;
    /// The same of vectors so close to a coalescence that rounding decides on the rest.
    constexpr double defective = 1e-7;
    const Decision   complex_discriminant("Im / modulus of the square of a difference of two eigenvalues", 1e-6);
    const Decision   distinguishable("difference of two eigenvalues / their modulus", indistinguishable);

    /// Orthonormal basis without directions that are rounding errors.
    ComplexDenseMatrix safe_basis(const ComplexDenseMatrix &X)
    {
      const auto       basis = orthonormal_basis(X);
      std::vector<int> kept;
      for (int j = 0; j < X.cols(); ++j)
        if (basis.R(j, j).real() > defective)
          kept.push_back(j);
      return basis.Q(Eigen::all, kept);
    }

    /// cos² of the largest angle between two subspaces; of a smaller one and its image, where vectors are parallel.
    double agreement_of(const ComplexDenseMatrix &first, const ComplexDenseMatrix &second)
    {
      const ComplexDenseMatrix C       = safe_basis(first).adjoint() * safe_basis(second);
      const ComplexDenseMatrix squares = C.cols() <= C.rows() ? ComplexDenseMatrix(C.adjoint() * C) : C * C.adjoint();
      return squares.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff();
    }

    /// Gives two groups the same number.
    void join(std::vector<int> &group, const int x, const int y)
    {
      std::replace(group.begin(), group.end(), std::max(x, y), std::min(x, y));
    }

    /// Connected components of a graph of n nodes on the left and m on the right: number of the component of each.
    std::vector<int> components(const int n, const int m, const std::function<bool(int, int)> &connected)
    {
      std::vector<int> component(n + m);
      std::iota(component.begin(), component.end(), 0);
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j)
          if (component[i] != component[n + j] && connected(i, j))
            join(component, component[i], component[n + j]);
      return component;
    }

    /// Lists of the members of each group.
    std::vector<std::vector<int>> members_of(const std::vector<int> &group)
    {
      std::vector<std::vector<int>> members(group.size());
      for (std::size_t i = 0; i < group.size(); ++i)
        members[group[i]].push_back(static_cast<int>(i));
      members.erase(std::remove_if(members.begin(), members.end(), [](const auto &list) { return list.empty(); }), members.end());
      return members;
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
      ComplexDenseMatrix right, left; ///< of as many rows as those of the other point
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

      /// Positions in @p modes that belong together: multiple λ and, where asked, pairs about to coalesce.
      std::vector<std::vector<int>> groups(const std::vector<int> &modes, const bool join_parallel) const
      {
        std::vector<int> group(modes.size());
        std::iota(group.begin(), group.end(), 0);
        for (std::size_t i = 0; i < modes.size(); ++i)
          for (std::size_t j = 0; j < i; ++j)
            if (group[i] != group[j] && (cluster[modes[i]] == cluster[modes[j]] || (join_parallel && are_parallel(modes[i], modes[j]))))
              join(group, group[i], group[j]);
        return members_of(group);
      }

      bool are_parallel(const int i, const int j) const
      {
        return std::norm(right.col(i).dot(right.col(j))) > parallel && std::norm(left.col(i).dot(left.col(j))) > parallel;
      }

      /// Whether all these modes are one cluster.
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
        overlap_modes();
        const auto component = components(a.size(), b.size(), [&](const int i, const int j) { return overlaps(i, j) > weakest_overlap; });
        for (const std::vector<int> &members : members_of(component))
          {
            std::vector<int> first, second;
            for (const int m : members)
              m < a.size() ? first.push_back(m) : second.push_back(m - a.size());
            trim(first, second);
            if (!first.empty())
              sort_block(first, second);
          }
        links.resolved = std::all_of(links.blocks.begin(), links.blocks.end(),
                                     [&](const ModeBlock &block) {
                                       return block.resolved || (in_band(a, block.first) == 0 && in_band(b, block.second) == 0);
                                     }) &&
                         real_values_account_for_the_rest();
        return links;
      }

    private:
      /// Mean of right and left overlaps; for multiple λ the share in their span, from either side.
      void overlap_modes()
      {
        overlaps = DenseMatrix::Zero(a.size(), b.size());
        for (const auto vectors : {&Side::right, &Side::left})
          {
            const ComplexDenseMatrix &X = a.*vectors, &Y = b.*vectors;
            DenseMatrix               share = (X.adjoint() * Y).cwiseAbs2();
            for (const std::vector<int> &cluster : members_of(b.cluster))
              if (cluster.size() > 1)
                {
                  const Eigen::VectorXd in_span = (X.adjoint() * span(Y, cluster)).rowwise().squaredNorm();
                  for (const int j : cluster)
                    share.col(j) = share.col(j).cwiseMax(in_span);
                }
            for (const std::vector<int> &cluster : members_of(a.cluster))
              if (cluster.size() > 1)
                {
                  const Eigen::RowVectorXd in_span = (span(X, cluster).adjoint() * Y).colwise().squaredNorm();
                  for (const int i : cluster)
                    share.row(i) = share.row(i).cwiseMax(in_span);
                }
            overlaps += 0.5 * share;
          }
      }

      /// Orthonormal basis of some columns.
      static ComplexDenseMatrix span(const ComplexDenseMatrix &X, const std::vector<int> &chosen)
      {
        return orthonormal_basis(X(Eigen::all, chosen)).Q;
      }

      int in_band(const Side &side, const std::vector<int> &modes) const
      {
        return static_cast<int>(
          std::count_if(modes.begin(), modes.end(), [&](const int i) { return side.point.lambda[i].imag() <= limit; }));
      }

      /// 1 for equal λ, falls to 0 with their distance.
      double closeness(const int i, const int j) const
      {
        const Complex x = a.point.lambda[i], y = b.point.lambda[j];
        return 1. / (1. + std::abs(x - y) / std::abs(x));
      }

      /// Leaves as many modes on either side, those most alike.
      void trim(std::vector<int> &first, std::vector<int> &second)
      {
        const bool        swapped = first.size() > second.size();
        std::vector<int> &few = swapped ? second : first, &many = swapped ? first : second;
        if (few.size() == many.size())
          return;
        const std::vector<int> match = best_assignment(few.size(), many.size(), [&](const int p, const int q) {
          const int i = swapped ? many[q] : few[p], j = swapped ? few[p] : many[q];
          return overlaps(i, j) + weakest_overlap * closeness(i, j);
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
          smallest = std::min(smallest, agreement_of((a.*vectors)(Eigen::all, first), (b.*vectors)(Eigen::all, second)));
        if (smallest < agreement)
          links.blocks.push_back({first, second, false});
        else
          divide(first, second);
      }

      /// Divides a block whose subspaces agree as far as the vectors allow.
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
            const Transformation X = transformation((a.*vectors)(Eigen::all, first), (b.*vectors)(Eigen::all, second));
            if (!X.exists)
              {
                links.blocks.push_back({first, second, false});
                return;
              }
            T += 0.5 * X.X.cwiseProduct(X.inverse.transpose()).real();
          }

        for (const bool join_parallel : {false, true})
          if (divide_by_parts(first, second, T, join_parallel))
            return;
        const bool exceptional = n == 2 && pair_sign(a.point.lambda[first[0]], a.point.lambda[first[1]]) *
                                               pair_sign(b.point.lambda[second[0]], b.point.lambda[second[1]]) <
                                             0;
        links.blocks.push_back({first, second, exceptional});
      }

      /// Divides a block by T, summed over groups; false if nothing can be divided.
      bool divide_by_parts(const std::vector<int> &first, const std::vector<int> &second, const DenseMatrix &T, const bool join_parallel)
      {
        const auto rows = a.groups(first, join_parallel), columns = b.groups(second, join_parallel);
        const auto component = components(rows.size(), columns.size(), [&](const int g, const int h) {
          return T(rows[g], columns[h]).sum() > negligible_part * std::min(rows[g].size(), columns[h].size());
        });

        std::vector<std::pair<std::vector<int>, std::vector<int>>> parts;
        for (const std::vector<int> &groups : members_of(component))
          {
            std::vector<int> p, q;
            for (const int g : groups)
              if (g < static_cast<int>(rows.size()))
                p.insert(p.end(), rows[g].begin(), rows[g].end());
              else
                q.insert(q.end(), columns[g - rows.size()].begin(), columns[g - rows.size()].end());
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

      /// Whether modes of the band without counterpart are as many as pairs of real values came and went.
      bool real_values_account_for_the_rest() const
      {
        const auto n_real = [](const ChartPoint &p) { return static_cast<int>(p.real_values.size()) + p.n_zeros; };
        const int  lost = in_band(a, links.lost), gained = in_band(b, links.gained);
        return 2 * (lost - gained) == n_real(b.point) - n_real(a.point) && (lost == 0 || gained == 0);
      }

      const double limit;
      const Side   a, b;
      DenseMatrix  overlaps;
      ModeLinks    links;
    };
  } // namespace

  std::vector<int> mode_clusters(const std::vector<Complex> &lambda)
  {
    std::vector<int> cluster(lambda.size());
    std::iota(cluster.begin(), cluster.end(), 0);
    for (std::size_t i = 0; i < lambda.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (cluster[i] != cluster[j] && !distinguishable.exceeded_by(std::abs(lambda[i] - lambda[j]) / std::abs(lambda[i])))
          join(cluster, cluster[i], cluster[j]);
    return cluster;
  }

  OrthonormalBasis<ComplexDenseMatrix> orthonormal_basis(const ComplexDenseMatrix &X)
  {
    return orthonormal_basis(X, [](const double rest) { return rest > dependent; });
  }

  ComplexDenseMatrix orthonormal_in_clusters(const ComplexDenseMatrix &vectors, const std::vector<Complex> &lambda)
  {
    ComplexDenseMatrix result = vectors;
    for (const std::vector<int> &members : members_of(mode_clusters(lambda)))
      if (members.size() > 1)
        result(Eigen::all, members) = orthonormal_basis(vectors(Eigen::all, members)).Q;
    return result;
  }

  Transformation transformation(const ComplexDenseMatrix &first, const ComplexDenseMatrix &second)
  {
    const auto     basis = orthonormal_basis(first);
    Transformation result{basis.Q.adjoint() * second, {}, false};
    if ((basis.R.diagonal().array() == 0.).any() || !result.X.allFinite())
      return result;
    basis.R.triangularView<Eigen::Upper>().solveInPlace(result.X);
    result.inverse = result.X.inverse();
    result.exists  = result.inverse.allFinite();
    return result;
  }

  int pair_sign(const Complex &lambda_1, const Complex &lambda_2)
  {
    const Complex square = (lambda_1 - lambda_2) * (lambda_1 - lambda_2);
    if (complex_discriminant.exceeded_by(std::abs(square.imag()) / std::abs(square)))
      return 0;
    return square.real() > 0. ? 1 : -1;
  }

  ModeLinks link_modes(const ChartPoint &first, const ChartPoint &second, const double largest_circular_frequency)
  {
    return Linker(first, second, largest_circular_frequency).run();
  }
} // namespace Squeal
