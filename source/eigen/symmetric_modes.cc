#include "symmetric_solver.h"

#include <squeal/base/exceptions.h>
#include <squeal/base/tasks.h>
#include <squeal/eigen/symmetric_modes.h>
#include <squeal/eigen/uncoupled_parts.h>

#include <algorithm>
#include <deque>

namespace Squeal
{
  namespace
  {
    /// The modes of all uncoupled parts in one order, as vectors of the rows of all of them.
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
  } // namespace

  SymmetricModes symmetric_modes(const SparseMatrix          &K,
                                 const SparseMatrix          &M,
                                 const double                 largest_eigenvalue,
                                 const SymmetricModesOptions &options)
  {
    if (!(largest_eigenvalue > 0.))
      throw SolverError("modes were asked for up to " + std::to_string(largest_eigenvalue) + " rad²/s²", options.what,
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
} // namespace Squeal
