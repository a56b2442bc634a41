#include <squeal/model/cell_integrals.h>
#include <squeal/base/tasks.h>

#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_matrix.h>

#include <algorithm>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    /// A free dof of a cell, and its place among the rows of this process; -1 for those of others.
    struct FreeDof
    {
      unsigned int in_cell;
      int          number, row;
    };

    /// Free dofs of a cell: nothing is integrated over clamped ones.
    std::vector<FreeDof> free_dofs(const Model &model, const Cell &cell)
    {
      std::vector<types::global_dof_index> dofs(cell->get_fe().n_dofs_per_cell());
      cell->get_dof_indices(dofs);
      std::vector<FreeDof> result;
      for (unsigned int i = 0; i < dofs.size(); ++i)
        if (const int number = model.free_dof(dofs[i]); number >= 0)
          result.push_back({i, number, model.free_map().place(number)});
      return result;
    }
    /// A cell that contributes to rows of this process.
    struct IntegratedCell
    {
      Cell                 cell;
      std::vector<FreeDof> dofs;
    };

    /// A process knows all cells that have one of its rows, and integrates them: at the borders more than one does, and nothing is sent.
    std::vector<IntegratedCell> integrated_cells(const Model &model, const CellPredicate &contributes)
    {
      std::vector<IntegratedCell> result;
      for (const auto &cell : model.dof_handler().active_cell_iterators())
        if (!cell->is_artificial() && contributes(cell))
          {
            std::vector<FreeDof> dofs = free_dofs(model, cell);
            if (std::any_of(dofs.begin(), dofs.end(), [](const FreeDof &dof) { return dof.row >= 0; }))
              result.push_back({cell, std::move(dofs)});
          }
      return result;
    }

    void make_pattern(const std::vector<IntegratedCell> &cells, const RowMap &map, SparsityPattern &pattern)
    {
      DynamicSparsityPattern               rows(map.n_local(), map.n());
      std::vector<types::global_dof_index> columns;
      for (const auto &[cell, dofs] : cells)
        {
          columns.clear();
          for (const FreeDof &dof : dofs)
            columns.push_back(dof.number);
          for (const FreeDof &dof : dofs)
            if (dof.row >= 0)
              rows.add_entries(dof.row, columns.begin(), columns.end());
        }
      pattern.copy_from(rows);
    }

    /// Cells that one thread integrates with the same integrals, and those whose matrices are kept until they are added.
    constexpr int cells_of_task = 256, cells_together = 8 * cells_of_task;

    /// The sums over all cells. Of some cells at a time, threads first integrate, each other cells, then add, each to another matrix:
    /// always in the order of the cells.
    void integrate_and_add(const std::vector<IntegratedCell>         &cells,
                           const MakeIntegrals                       &make_integrals,
                           const unsigned int                         n_dofs_of_cell,
                           std::vector<dealii::SparseMatrix<double>> &matrices)
    {
      const int                                    n_cells    = static_cast<int>(cells.size());
      const int                                    n_together = std::min(n_cells, cells_together);
      std::vector<std::vector<FullMatrix<double>>> found(matrices.size(), std::vector<FullMatrix<double>>(n_together));
      std::vector<std::vector<CellIntegral>>       integrals((n_together + cells_of_task - 1) / cells_of_task);
      for (int first = 0; first < n_cells; first += n_together)
        {
          const int n_here = std::min(n_together, n_cells - first);
          run_tasks((n_here + cells_of_task - 1) / cells_of_task, [&](const int task) {
            if (integrals[task].empty())
              integrals[task] = make_integrals();
            for (int c = task * cells_of_task; c < std::min(n_here, (task + 1) * cells_of_task); ++c)
              for (std::size_t k = 0; k < matrices.size(); ++k)
                {
                  if (found[k][c].empty())
                    found[k][c].reinit(n_dofs_of_cell, n_dofs_of_cell, true);
                  integrals[task][k](cells[first + c].cell, found[k][c]);
                }
          });
          run_tasks(static_cast<int>(matrices.size()), [&](const int k) {
            for (int c = 0; c < n_here; ++c)
              for (const FreeDof &i : cells[first + c].dofs)
                if (i.row >= 0)
                  for (const FreeDof &j : cells[first + c].dofs)
                    matrices[k].add(i.row, j.number, found[k][c](i.in_cell, j.in_cell));
          });
        }
    }
  } // namespace

  std::vector<std::shared_ptr<const SparseMatrix>> assemble_cells(const Model         &model,
                                                                  const CellPredicate &contributes,
                                                                  const MakeIntegrals &make_integrals)
  {
    const RowMap                     &map   = model.free_map();
    const std::vector<IntegratedCell> cells = integrated_cells(model, contributes);
    SparsityPattern                   pattern;
    make_pattern(cells, map, pattern);
    std::vector<dealii::SparseMatrix<double>> matrices(make_integrals().size());
    for (dealii::SparseMatrix<double> &matrix : matrices)
      matrix.reinit(pattern);
    integrate_and_add(cells, make_integrals, model.dof_handler().get_fe().n_dofs_per_cell(), matrices);

    std::vector<std::shared_ptr<const SparseMatrix>> result(matrices.size());
    const auto                                       convert = [&](const int k) {
      result[k] = std::make_shared<SparseMatrix>(map, map, [&matrix = matrices[k]](const int i, SparseMatrix::Row &row) {
        // Left out: directions that a mass does not couple, and the diagonal that deal.II adds in rows of other bodies
        for (auto entry = matrix.begin(i); entry != matrix.end(i); ++entry)
          if (entry->value() != 0.)
            row.emplace_back(entry->column(), entry->value());
        // deal.II has the diagonal first
        if (!row.empty())
          std::rotate(row.begin(), row.begin() + 1, std::upper_bound(row.begin() + 1, row.end(), row.front()));
      });
    };
    const int n = static_cast<int>(matrices.size());
    if (map.n_processes() == 1)
      run_tasks(n, convert);
    else
      for (int k = 0; k < n; ++k)
        convert(k); // together with other processes
    return result;
  }
} // namespace Squeal
