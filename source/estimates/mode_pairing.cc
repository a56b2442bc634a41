// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/groups.h>
#include <squeal/estimates/mode_pairing.h>
#include <squeal/estimates/mode_groups.h>
#include <squeal/linear_algebra/communication.h>

#include <Eigen/QR>

#include <algorithm>
#include <complex>
#include <numeric>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// Fraction of a mode's energy that its connections cover, and smallest share of a connection relative to the largest share [-].
    constexpr double connecting = 0.75, side = 0.25;

    /// A mode has a counterpart if at least this fraction of its energy lies in the span of the modes of the other mesh [-].
    constexpr double least_represented = 0.5;

    /// Directions of smaller relative size are linearly dependent up to rounding [-].
    constexpr double dependent = 1e-10;

    /// Products of all normalised modes of two meshes.
    struct Products
    {
      ComplexDenseMatrix coarse, fine; ///< Gram matrices
      ComplexDenseMatrix mixed;        ///< products of fine with coarse modes, k_fine × k_coarse
    };

    Products products(const ModesAtPoints &coarse, const ModesAtPoints &fine)
    {
      const MultiVector     X      = join({&coarse.real_part, &coarse.imaginary_part});
      const MultiVector     Y      = join({&fine.real_part, &fine.imaginary_part});
      Products              result = {hermitian_products(gram(X, X)), hermitian_products(gram(Y, Y)), hermitian_products(gram(Y, X))};
      const Eigen::VectorXd s      = result.coarse.diagonal().real().cwiseSqrt().cwiseInverse();
      const Eigen::VectorXd t      = result.fine.diagonal().real().cwiseSqrt().cwiseInverse();
      result.coarse                = (s.asDiagonal() * result.coarse * s.asDiagonal()).eval();
      result.fine                  = (t.asDiagonal() * result.fine * t.asDiagonal()).eval();
      result.mixed                 = (t.asDiagonal() * result.mixed * s.asDiagonal()).eval();
      return result;
    }

    /// |c|² of the combinations of modes with Gram matrix G that are closest to given vectors; C: products of the modes with the vectors.
    DenseMatrix shares(const ComplexDenseMatrix &G, const ComplexDenseMatrix &C)
    {
      if (C.size() == 0) // Eigen would access a first entry that does not exist
        return DenseMatrix(C.rows(), C.cols());
      Eigen::CompleteOrthogonalDecomposition<ComplexDenseMatrix> factors;
      factors.setThreshold(dependent);
      factors.compute(G);
      return factors.solve(C).cwiseAbs2();
    }

    /**
     * Connections of each mode with modes of the other mesh: the largest shares, up to the fraction `connecting`; none if the other modes
     * do not represent the mode. One row for each mode of the other mesh, one column for each mode.
     *
     * @param G Gram matrix of the other modes
     * @param C products of the other modes with the modes, all normalised
     */
    Eigen::MatrixX<bool> connections(const ComplexDenseMatrix &G, const ComplexDenseMatrix &C)
    {
      Eigen::MatrixX<bool>      result = Eigen::MatrixX<bool>::Constant(C.rows(), C.cols(), false);
      const DenseMatrix         part   = shares(G, C);
      const ComplexDenseMatrix  one    = ComplexDenseMatrix::Identity(C.cols(), C.cols());
      const Eigen::RowVectorXd  whole  = shares_in_span(G, C, one);
      std::vector<Eigen::Index> order(C.rows());
      std::iota(order.begin(), order.end(), 0);
      for (Eigen::Index i = 0; i < C.cols(); ++i)
        {
          if (whole(i) < least_represented)
            continue;
          std::sort(order.begin(), order.end(), [&](const auto a, const auto b) { return part(a, i) > part(b, i); });
          double missing = connecting * part.col(i).sum();
          for (const Eigen::Index j : order)
            {
              if (missing <= 0. || part(j, i) < side * part(order.front(), i))
                break;
              result(j, i) = true;
              missing -= part(j, i);
            }
        }
      return result;
    }

    /// Connected modes of both meshes.
    struct Group
    {
      std::vector<int> coarse, fine;
    };

    std::vector<Group> groups_of(const Products &products)
    {
      const Eigen::MatrixX<bool> of_coarse = connections(products.fine, products.mixed),
                                 of_fine   = connections(products.coarse, products.mixed.adjoint());
      // Separate pairs of modes without other connections of their own, even if a third mode is connected with one of them
      const int                          n_fine = products.mixed.rows(), n_coarse = products.mixed.cols();
      const Eigen::VectorX<Eigen::Index> n_of_coarse = of_coarse.colwise().count(), n_of_fine = of_fine.colwise().count();
      const auto                         is_pair = [&](const int i, const int j) {
        return of_coarse(j, i) && of_fine(i, j) && n_of_coarse(i) == 1 && n_of_fine(j) == 1;
      };
      std::vector<bool> coarse_is_paired(n_coarse, false), fine_is_paired(n_fine, false);
      for (int i = 0; i < n_coarse; ++i)
        for (int j = 0; j < n_fine; ++j)
          if (is_pair(i, j))
            coarse_is_paired[i] = fine_is_paired[j] = true;
      const auto connected = [&](const int number, const int i) { // i < number, and coarse modes come first
        const int j = number - n_coarse;
        return i < n_coarse && j >= 0 && (coarse_is_paired[i] || fine_is_paired[j] ? is_pair(i, j) : of_coarse(j, i) || of_fine(i, j));
      };
      const int          n = n_coarse + n_fine;
      std::vector<Group> groups;
      for (const std::vector<int> &members : members_of(connected_groups(n, connected)))
        {
          groups.emplace_back();
          for (const int i : members)
            if (i < n_coarse)
              groups.back().coarse.push_back(i);
            else
              groups.back().fine.push_back(i - n_coarse);
        }
      return groups;
    }

    /// Drops modes of a group that are badly represented by the group's modes of the other mesh.
    Group represented(const Group &group, const Products &products)
    {
      const auto kept = [](const std::vector<int> &modes, const std::vector<int> &others, const ComplexDenseMatrix &others_gram,
                           const ComplexDenseMatrix &mixed) { // mixed: products of others with modes
        std::vector<int> result;
        for (const int i : modes)
          {
            const std::vector<int>   one  = {i};
            const ComplexDenseMatrix norm = ComplexDenseMatrix::Ones(1, 1);
            if (!others.empty() && shares_in_span(others_gram(others, others), mixed(others, one), norm)(0) >= least_represented)
              result.push_back(i);
          }
        return result;
      };
      return {kept(group.coarse, group.fine, products.fine, products.mixed),
              kept(group.fine, group.coarse, products.coarse, products.mixed.adjoint())};
    }

    /// Pairs of coarse and fine modes of a group that minimise the sum of squared distances of λ after a shift by the mean difference.
    std::vector<std::pair<int, int>> partners(const Group                &group,
                                              const std::vector<Complex> &coarse,
                                              const std::vector<Complex> &fine,
                                              const DenseMatrix          &shares)
    {
      Complex shift  = 0.;
      double  weight = 0.;
      for (const int i : group.coarse)
        for (const int j : group.fine)
          {
            shift += shares(j, i) * (fine[j] - coarse[i]);
            weight += shares(j, i);
          }
      if (weight > 0.)
        shift /= weight;

      const bool              is_wide = group.coarse.size() <= group.fine.size();
      const std::vector<int> &few = is_wide ? group.coarse : group.fine, &many = is_wide ? group.fine : group.coarse;
      const auto              gain = [&](const int row, const int column) {
        const int i = is_wide ? few[row] : many[column], j = is_wide ? many[column] : few[row];
        return -std::norm(fine[j] - coarse[i] - shift);
      };
      std::vector<std::pair<int, int>> result;
      const std::vector<int>           columns = best_assignment(few.size(), many.size(), gain);
      for (std::size_t row = 0; row < few.size(); ++row)
        result.push_back(is_wide ? std::make_pair(few[row], many[columns[row]]) : std::make_pair(many[columns[row]], few[row]));
      return result;
    }

    /// Replaces the result of this process by the result of process 0.
    void agree_on_pairs(const MPI_Comm communicator, std::vector<PairedMode> &modes)
    {
      DenseMatrix numbers(3, modes.size());
      for (std::size_t i = 0; i < modes.size(); ++i)
        numbers.col(i) << modes[i].partner, modes[i].overlap, modes[i].in_cluster;
      agree(communicator, numbers);
      for (std::size_t i = 0; i < modes.size(); ++i)
        modes[i] = {static_cast<int>(numbers(0, i)), numbers(1, i), numbers(2, i) > 0.};
    }
  } // namespace

  ModePairing pair_modes(const ModesAtPoints &coarse, const ModesAtPoints &fine)
  {
    ModePairing result = {std::vector<PairedMode>(coarse.lambda.size()), std::vector<PairedMode>(fine.lambda.size())};
    if (coarse.lambda.empty() || fine.lambda.empty())
      return result;
    const Products    all    = products(coarse, fine);
    const DenseMatrix weight = shares(all.fine, all.mixed);
    for (const Group &connected : groups_of(all))
      {
        if (connected.coarse.size() + connected.fine.size() > 2)
          {
            for (const int i : connected.coarse)
              result.coarse[i].in_cluster = true;
            for (const int j : connected.fine)
              result.fine[j].in_cluster = true;
          }
        for (const auto &[i, j] : partners(represented(connected, all), coarse.lambda, fine.lambda, weight))
          {
            const double overlap     = std::norm(all.mixed(j, i));
            result.coarse[i].partner = j;
            result.fine[j].partner   = i;
            result.coarse[i].overlap = result.fine[j].overlap = overlap;
          }
      }
    // Rounding errors may differ between processes: use the pairs of process 0
    agree_on_pairs(coarse.real_part.communicator(), result.coarse);
    agree_on_pairs(coarse.real_part.communicator(), result.fine);
    return result;
  }
} // namespace Squeal
