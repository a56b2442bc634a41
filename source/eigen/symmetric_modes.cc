// SPDX-License-Identifier: GPL-3.0-or-later

#include "symmetric_solver.h"

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/tasks.h>
#include <squeal/base/text.h>
#include <squeal/linear_algebra/communication.h>

#include <boost/pending/disjoint_sets.hpp>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <numeric>

namespace Squeal
{
  namespace
  {
    /// Rows of a matrix that are not coupled with other rows; each row stays on its process.
    struct UncoupledPart
    {
      RowMap                                  map;
      std::vector<int>                        places;  ///< local indices of its rows
      std::shared_ptr<const std::vector<int>> numbers; ///< number of each row of the matrix within its part
    };

    /// Smallest row number in the part of each row, identical on every process.
    std::vector<int> part_labels(const SparseMatrix &A)
    {
      std::vector<int> label(A.n_rows());
      std::iota(label.begin(), label.end(), 0);
      SparseMatrix::Row row;
      while (true)
        {
          // Join the parts found so far with the couplings in the local rows
          std::vector<int>                   rank(label.size(), 0), parent(label.size());
          boost::disjoint_sets<int *, int *> sets(rank.data(), parent.data());
          for (int i = 0; i < A.n_rows(); ++i)
            sets.make_set(i);
          for (int i = 0; i < A.n_rows(); ++i)
            sets.union_set(i, label[i]);
          for (int i = 0; i < A.rows().n_local(); ++i)
            {
              A.get_row(i, row);
              for (const auto &entry : row)
                sets.union_set(A.rows().number(i), entry.first);
            }
          std::vector<int> smallest(label.size(), A.n_rows()), joined(label.size());
          for (int i = A.n_rows(); i-- > 0;)
            smallest[sets.find_set(i)] = i;
          for (int i = 0; i < A.n_rows(); ++i)
            joined[i] = smallest[sets.find_set(i)];
          smallest_of_processes(A.communicator(), joined.data(), joined.size());
          if (joined == label)
            return label;
          label = joined;
        }
    }

    /// Connected components of the graph of a square symmetric matrix, in the order of their first rows.
    std::vector<UncoupledPart> uncoupled_parts(const SparseMatrix &A)
    {
      const std::vector<int>       labels  = part_labels(A);
      const auto                   numbers = std::make_shared<std::vector<int>>();
      std::map<int, UncoupledPart> parts;
      std::map<int, int>           sizes;
      // Rows keep their order, so that each process has a contiguous range of them
      for (const int label : labels)
        {
          parts[label];
          numbers->push_back(sizes[label]++);
        }
      for (int i = 0; i < A.rows().n_local(); ++i)
        parts[labels[A.rows().number(i)]].places.push_back(i);
      std::vector<UncoupledPart> result;
      for (auto &[label, part] : parts)
        result.push_back({RowMap(static_cast<int>(part.places.size()), A.communicator()), std::move(part.places), numbers});
      return result;
    }

    /// Rows and columns of @p A in one of its uncoupled parts.
    std::shared_ptr<SparseMatrix> matrix_of(const UncoupledPart &part, const SparseMatrix &A)
    {
      return std::make_shared<SparseMatrix>(part.map, part.map, [&](const int i, SparseMatrix::Row &row) {
        A.get_row(part.places[i], row);
        for (auto &entry : row)
          entry.first = (*part.numbers)[entry.first];
      });
    }

    /// Modes of all uncoupled parts, sorted, as vectors with all rows.
    SymmetricModes merged(const std::vector<UncoupledPart> &uncoupled, const std::vector<SymmetricModes> &parts, const RowMap &rows)
    {
      SymmetricModes all;
      struct Place
      {
        std::size_t part;
        int         mode;
      };
      std::vector<Place> order;
      for (std::size_t p = 0; p < parts.size(); ++p)
        {
          all.n_rigid_body += parts[p].n_rigid_body;
          all.n_counted += parts[p].n_counted;
          for (std::size_t j = 0; j < parts[p].eigenvalues.size(); ++j)
            order.push_back({p, static_cast<int>(j)});
        }
      if (order.empty())
        return all;
      std::stable_sort(order.begin(), order.end(), [&](const Place &a, const Place &b) {
        return parts[a.part].eigenvalues[a.mode] < parts[b.part].eigenvalues[b.mode];
      });
      all.vectors = std::make_shared<MultiVector>(rows, static_cast<int>(order.size()));
      for (std::size_t column = 0; column < order.size(); ++column)
        {
          const SymmetricModes &modes = parts[order[column].part];
          const int             mode  = order[column].mode;
          all.eigenvalues.push_back(modes.eigenvalues[mode]);
          all.residuals.push_back(modes.residuals[mode]);
          all.vectors->col(column)(uncoupled[order[column].part].places) = modes.vectors->col(mode);
        }
      return all;
    }

    /// The search does not separate eigenvalues whose relative distance is smaller [-].
    constexpr double cluster_width = 1e-3;
  } // namespace

  SymmetricModes symmetric_modes(const SparseMatrix          &K,
                                 const SparseMatrix          &M,
                                 const double                 largest_eigenvalue,
                                 const SymmetricModesOptions &options)
  {
    if (!(largest_eigenvalue > 0.))
      throw SolverError(text("the end of the band is ", largest_eigenvalue, " rad²/s², but must be positive"), options.what,
                        "give a positive end of the band");
    if (!options.by_parts)
      return SymmetricSolver(K, M, largest_eigenvalue, options).modes();

    std::vector<std::shared_ptr<const SparseMatrix>> matrices;
    std::deque<SymmetricSolver>                      solvers; // one for each part
    const std::vector<UncoupledPart>                 uncoupled = uncoupled_parts(K);
    for (const UncoupledPart &part : uncoupled)
      {
        const auto part_K = matrices.emplace_back(matrix_of(part, K)), part_M = matrices.emplace_back(matrix_of(part, M));
        solvers.emplace_back(*part_K, *part_M, largest_eigenvalue, options);
      }
    if (K.rows().n_processes() == 1)
      run_tasks(static_cast<int>(solvers.size()), [&](const int p) {
        if (solvers[p].is_dense())
          solvers[p].solve_densely();
      });
    std::vector<SymmetricModes> parts;
    for (SymmetricSolver &solver : solvers)
      parts.push_back(solver.modes());
    return merged(uncoupled, parts, K.columns());
  }

  ModeCount count_below(const SparseMatrix &K, const SparseMatrix &M, double limit, const std::string &what)
  {
    // Increase the limit slightly if it is an eigenvalue, because a pivot then vanishes
    for (int attempt = 0; attempt < 4; ++attempt)
      {
        int       n_null  = 0;
        const int n_modes = count_negative_eigenvalues(*add(1., K, -limit, M), what, &n_null);
        if (n_null == 0)
          return {n_modes, limit};
        limit *= 1. + 1e-8;
      }
    throw SolverError(text("the modes below ", limit, " rad²/s² cannot be counted: K - limit M remains singular"), what,
                      "check that M is positive definite and that every dof has stiffness or mass");
  }

  double end_of_lowest(const SparseMatrix &K,
                       const SparseMatrix &M,
                       const int           n_modes,
                       const double        first,
                       const double        highest,
                       const std::string  &what)
  {
    // Bracket: too few modes below the lower limit, enough below the upper limit
    ModeCount lower = {0, 0.}, upper = count_below(K, M, std::min(first, highest), what);
    while (upper.n_modes < n_modes)
      {
        if (!(upper.limit < highest))
          throw SolverError(text(what, ": fewer than ", n_modes, n_modes == 1 ? " mode lies" : " modes lie", " below ",
                                 decimal_text(hertz(std::sqrt(highest))), " Hz"),
                            what, "lower the number of modes");
        lower = upper;
        upper = count_below(K, M, std::min(2. * upper.limit, highest), what);
      }

    // Use regula falsi, because modes are distributed fairly evenly; trial values stay away from the ends by a tenth of the interval
    while (upper.n_modes > n_modes && upper.limit - lower.limit > cluster_width * upper.limit)
      {
        const double    share                      = (n_modes + 0.5 - lower.n_modes) / (upper.n_modes - lower.n_modes);
        const double    trial                      = lower.limit + std::min(std::max(share, 0.1), 0.9) * (upper.limit - lower.limit);
        const ModeCount middle                     = count_below(K, M, trial, what);
        (middle.n_modes < n_modes ? lower : upper) = middle;
      }
    return upper.limit;
  }
} // namespace Squeal
