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
    SymmetricModes merged(const std::vector<SymmetricModes> &parts, const RowMap &rows)
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
          insert_part(view(*modes.vectors, mode, 1), static_cast<int>(column), *all.vectors);
        }
      return all;
    }

    /// A problem or its uncoupled parts, counted.
    class CountedProblem
    {
    public:
      CountedProblem(const SparseMatrix &K, const SparseMatrix &M, const double limit, const SymmetricModesOptions &options)
        : by_parts(options.by_parts)
        , rows(K.columns())
      {
        if (!(limit > 0.))
          throw SolverError("modes were asked for up to " + std::to_string(limit) + " rad²/s²", options.what,
                            "give a positive end of the band");
        if (!by_parts)
          {
            solvers.emplace_back(K, M, limit, options);
            return;
          }
        for (const RowMap &map : uncoupled_parts(K))
          {
            const auto part_K = matrices.emplace_back(part(K, map)), part_M = matrices.emplace_back(part(M, map));
            solvers.emplace_back(*part_K, *part_M, limit, options);
          }
      }

      SymmetricModes modes()
      {
        if (by_parts && rows.n_processes() == 1)
          run_tasks(static_cast<int>(solvers.size()), [&](const int p) {
            if (solvers[p].is_dense())
              solvers[p].solve_densely();
          });
        std::vector<SymmetricModes> parts;
        for (SymmetricSolver &solver : solvers)
          parts.push_back(solver.modes());
        return by_parts ? merged(parts, rows) : parts.front();
      }

      /// Whether modes_alone() is worth an attempt.
      bool may_be_alone() const
      {
        return std::all_of(solvers.begin(), solvers.end(), [](const SymmetricSolver &solver) { return solver.may_be_alone(); });
      }

      /// The same without any call of MPI; nothing, rarely, where it would take one: modes() may still be asked for.
      std::optional<SymmetricModes> modes_alone()
      {
        const auto keep_to_itself = [&](const bool keep) {
          for (SymmetricSolver &solver : solvers)
            solver.keep_to_itself(keep);
        };
        keep_to_itself(true);
        try
          {
            return modes();
          }
        catch (const MustCommunicate &)
          {
            keep_to_itself(false);
            return {};
          }
      }

    private:
      const bool                                       by_parts;
      const RowMap                                     rows;
      std::vector<std::shared_ptr<const SparseMatrix>> matrices; ///< of the parts
      std::deque<SymmetricSolver>                      solvers;  ///< one for each part
    };
  } // namespace

  std::future<SymmetricModes> symmetric_modes_beside(const SparseMatrix          &K,
                                                     const SparseMatrix          &M,
                                                     const double                 largest_eigenvalue,
                                                     const SymmetricModesOptions &options)
  {
    const auto                                        problem = std::make_shared<CountedProblem>(K, M, largest_eigenvalue, options);
    std::shared_future<std::optional<SymmetricModes>> beside;
    if (is_done_beside(K.rows()) && problem->may_be_alone())
      beside = std::async(std::launch::async, [problem] { return problem->modes_alone(); }).share();
    return std::async(std::launch::deferred, [problem, beside] {
      std::optional<SymmetricModes> found = beside.valid() ? beside.get() : std::nullopt;
      return found ? std::move(*found) : problem->modes();
    });
  }

  std::shared_future<FactorBeside> factor_of_stiffness(const SparseMatrix &K, const SymmetricModesOptions &options)
  {
    if (options.inverse != nullptr || options.shift != 0. || K.n_rows() <= largest_dense_system)
      return {};
    return factorize_beside(
             K.rows(), [&K] { return std::shared_ptr<const SparseMatrix>(std::shared_ptr<const SparseMatrix>(), &K); }, options.library,
             options.what)
      .share();
  }

  SymmetricModes symmetric_modes(const SparseMatrix          &K,
                                 const SparseMatrix          &M,
                                 const double                 largest_eigenvalue,
                                 const SymmetricModesOptions &options)
  {
    return CountedProblem(K, M, largest_eigenvalue, options).modes();
  }
} // namespace Squeal
