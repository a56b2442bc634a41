#include <squeal/base/assignment.h>
#include <squeal/base/decision.h>
#include <squeal/stability/mode_links.h>

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

    /// xᴴ y. Products of std::complex look for infinities first, which costs several times as much.
    Complex product(const Complex *x, const Complex *y, const int n)
    {
      double real = 0., imag = 0.;
      for (int i = 0; i < n; ++i)
        {
          real += x[i].real() * y[i].real() + x[i].imag() * y[i].imag();
          imag += x[i].real() * y[i].imag() - x[i].imag() * y[i].real();
        }
      return {real, imag};
    }

    /// y −= c x
    void subtract(const Complex c, const Complex *x, Complex *y, const int n)
    {
      const double a = c.real(), b = c.imag();
      for (int i = 0; i < n; ++i)
        y[i] -= Complex(a * x[i].real() - b * x[i].imag(), a * x[i].imag() + b * x[i].real());
    }

    /// Orthonormal basis without directions that are rounding errors.
    ComplexDenseMatrix safe_basis(const ComplexDenseMatrix &X)
    {
      const OrthonormalBasis basis = orthonormal_basis(X);
      std::vector<int>       kept;
      for (int j = 0; j < X.n_columns(); ++j)
        if (basis.R(j, j).real() > defective)
          kept.push_back(j);
      return selected_columns(basis.Q, kept);
    }

    /// cos² of the largest angle between two subspaces; of a smaller one and its image, where vectors are parallel.
    double agreement_of(const ComplexDenseMatrix &first, const ComplexDenseMatrix &second)
    {
      const ComplexDenseMatrix C = multiply(safe_basis(first), safe_basis(second), true);
      const int                m = C.n_rows(), n = C.n_columns();
      DenseMatrix              real(2 * m, 2 * n);
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < m; ++i)
          {
            real(i, j) = real(m + i, n + j) = C(i, j).real();
            real(m + i, j)                  = C(i, j).imag();
            real(i, n + j)                  = -C(i, j).imag();
          }
      const double cosine = singular_values(real).values.back(); // of as many as the smaller subspace has
      return cosine * cosine;
    }

    /// Inverse by elimination with pivots; false if A is singular.
    bool invert(ComplexDenseMatrix A, ComplexDenseMatrix &inverse)
    {
      const int n = A.n_rows();
      inverse     = ComplexDenseMatrix(n, n);
      for (int i = 0; i < n; ++i)
        inverse(i, i) = 1.;
      for (int c = 0; c < n; ++c)
        {
          int pivot = c;
          for (int i = c + 1; i < n; ++i)
            if (std::abs(A(i, c)) > std::abs(A(pivot, c)))
              pivot = i;
          if (!(std::abs(A(pivot, c)) > 0.))
            return false;
          const Complex factor = 1. / A(pivot, c);
          for (int j = 0; j < n; ++j)
            {
              std::swap(A(pivot, j), A(c, j));
              std::swap(inverse(pivot, j), inverse(c, j));
              A(c, j) *= factor;
              inverse(c, j) *= factor;
            }
          for (int i = 0; i < n; ++i)
            if (const Complex multiple = A(i, c); i != c)
              for (int j = 0; j < n; ++j)
                {
                  A(i, j) -= multiple * A(c, j);
                  inverse(i, j) -= multiple * inverse(c, j);
                }
        }
      return std::isfinite(std::abs(std::accumulate(inverse.column(), inverse.column(n), Complex(0.))));
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
      ComplexDenseMatrix right, left; ///< padded
      std::vector<int>   cluster;

      Side(const ChartPoint &p, const int n_rows)
        : point(p)
        , right(padded(p.right, n_rows))
        , left(padded(p.left, n_rows))
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
        const int n = right.n_rows();
        return std::norm(product(right.column(i), right.column(j), n)) > parallel &&
               std::norm(product(left.column(i), left.column(j), n)) > parallel;
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
      Linker(const ChartPoint &first, const ChartPoint &second, const double largest_frequency)
        : limit(largest_frequency)
        , a(first, std::max(first.right.n_rows(), second.right.n_rows()))
        , b(second, a.right.n_rows())
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
        overlaps = DenseMatrix(a.size(), b.size());
        for (const auto vectors : {&Side::right, &Side::left})
          {
            const ComplexDenseMatrix C = multiply(a.*vectors, b.*vectors, true);
            DenseMatrix              share(a.size(), b.size());
            for (int j = 0; j < b.size(); ++j)
              for (int i = 0; i < a.size(); ++i)
                share(i, j) = std::norm(C(i, j));
            for (const std::vector<int> &cluster : members_of(b.cluster))
              if (cluster.size() > 1)
                {
                  const auto C_span = multiply(a.*vectors, orthonormal_basis(selected_columns(b.*vectors, cluster)).Q, true);
                  for (int i = 0; i < a.size(); ++i)
                    {
                      double sum = 0.;
                      for (int c = 0; c < C_span.n_columns(); ++c)
                        sum += std::norm(C_span(i, c));
                      for (const int j : cluster)
                        share(i, j) = std::max(share(i, j), sum);
                    }
                }
            for (const std::vector<int> &cluster : members_of(a.cluster))
              if (cluster.size() > 1)
                {
                  const auto C_span = multiply(orthonormal_basis(selected_columns(a.*vectors, cluster)).Q, b.*vectors, true);
                  for (int j = 0; j < b.size(); ++j)
                    {
                      double sum = 0.;
                      for (int c = 0; c < C_span.n_rows(); ++c)
                        sum += std::norm(C_span(c, j));
                      for (const int i : cluster)
                        share(i, j) = std::max(share(i, j), sum);
                    }
                }
            overlaps = add(overlaps, share, 0.5);
          }
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
          smallest = std::min(smallest, agreement_of(selected_columns(a.*vectors, first), selected_columns(b.*vectors, second)));
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

        DenseMatrix T(n, n);
        for (const auto vectors : {&Side::right, &Side::left})
          {
            const Transformation X = transformation(selected_columns(a.*vectors, first), selected_columns(b.*vectors, second));
            if (!X.exists)
              {
                links.blocks.push_back({first, second, false});
                return;
              }
            for (int j = 0; j < n; ++j)
              for (int i = 0; i < n; ++i)
                T(i, j) += 0.5 * (X.X(i, j) * X.inverse(j, i)).real();
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
          double sum = 0.;
          for (const int i : rows[g])
            for (const int j : columns[h])
              sum += T(i, j);
          return sum > negligible_part * std::min(rows[g].size(), columns[h].size());
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

  ComplexDenseMatrix padded(const ComplexDenseMatrix &X, const int n_rows)
  {
    ComplexDenseMatrix result(n_rows, X.n_columns());
    for (int j = 0; j < X.n_columns(); ++j)
      std::copy_n(X.column(j), X.n_rows(), result.column(j));
    return result;
  }

  ComplexDenseMatrix selected_columns(const ComplexDenseMatrix &X, const std::vector<int> &chosen)
  {
    ComplexDenseMatrix result(X.n_rows(), static_cast<int>(chosen.size()));
    for (std::size_t j = 0; j < chosen.size(); ++j)
      std::copy_n(X.column(chosen[j]), X.n_rows(), result.column(static_cast<int>(j)));
    return result;
  }

  OrthonormalBasis orthonormal_basis(const ComplexDenseMatrix &X)
  {
    const int        n = X.n_rows(), k = X.n_columns();
    OrthonormalBasis basis{X, ComplexDenseMatrix(k, k)};
    auto &[Q, R] = basis;
    for (int j = 0; j < k; ++j)
      {
        // Twice is enough (W. Kahan, B. Parlett)
        for (int pass = 0; pass < 2; ++pass)
          for (int i = 0; i < j; ++i)
            {
              const Complex c = product(Q.column(i), Q.column(j), n);
              R(i, j) += c;
              subtract(c, Q.column(i), Q.column(j), n);
            }
        const double norm = std::sqrt(product(Q.column(j), Q.column(j), n).real());
        R(j, j)           = norm > dependent ? norm : 0.;
        for (int row = 0; row < n; ++row)
          Q(row, j) = norm > dependent ? Q(row, j) / norm : 0.;
      }
    return basis;
  }

  ComplexDenseMatrix orthonormal_in_clusters(const ComplexDenseMatrix &vectors, const std::vector<Complex> &lambda)
  {
    ComplexDenseMatrix result = vectors;
    for (const std::vector<int> &members : members_of(mode_clusters(lambda)))
      if (members.size() > 1)
        {
          const ComplexDenseMatrix Q = orthonormal_basis(selected_columns(vectors, members)).Q;
          for (std::size_t j = 0; j < members.size(); ++j)
            std::copy_n(Q.column(static_cast<int>(j)), Q.n_rows(), result.column(members[j]));
        }
    return result;
  }

  Transformation transformation(const ComplexDenseMatrix &first, const ComplexDenseMatrix &second)
  {
    const OrthonormalBasis basis = orthonormal_basis(first);
    const int              n     = first.n_columns();
    Transformation         result{multiply(basis.Q, second, true), ComplexDenseMatrix(), false};
    ComplexDenseMatrix    &X = result.X;
    for (int i = n - 1; i >= 0; --i)
      {
        if (basis.R(i, i) == 0.)
          return result;
        for (int j = 0; j < n; ++j)
          {
            for (int c = i + 1; c < n; ++c)
              X(i, j) -= basis.R(i, c) * X(c, j);
            X(i, j) /= basis.R(i, i);
          }
      }
    result.exists = invert(X, result.inverse);
    return result;
  }

  int pair_sign(const Complex &lambda_1, const Complex &lambda_2)
  {
    const Complex square = (lambda_1 - lambda_2) * (lambda_1 - lambda_2);
    if (complex_discriminant.exceeded_by(std::abs(square.imag()) / std::abs(square)))
      return 0;
    return square.real() > 0. ? 1 : -1;
  }

  ModeLinks link_modes(const ChartPoint &first, const ChartPoint &second, const double largest_frequency)
  {
    return Linker(first, second, largest_frequency).run();
  }
} // namespace Squeal
