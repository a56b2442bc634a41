#include <squeal/assembly/cell_integrals.h>

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
  } // namespace

  std::vector<std::shared_ptr<const SparseMatrix>> assemble_cells(const Model                     &model,
                                                                  const CellPredicate             &contributes,
                                                                  const std::vector<CellIntegral> &integrals)
  {
    // A process knows all cells that have one of its rows, and integrates them: at the borders more than one does, and nothing is sent.
    const RowMap &map       = model.free_map();
    const auto    for_cells = [&](const std::function<void(const Cell &, const std::vector<FreeDof> &)> &action) {
      for (const auto &cell : model.dof_handler().active_cell_iterators())
        if (!cell->is_artificial() && contributes(cell))
          {
            const std::vector<FreeDof> dofs = free_dofs(model, cell);
            if (std::any_of(dofs.begin(), dofs.end(), [](const FreeDof &dof) { return dof.row >= 0; }))
              action(cell, dofs);
          }
    };

    DynamicSparsityPattern rows(map.n_local(), map.n());
    for_cells([&](const Cell &, const std::vector<FreeDof> &dofs) {
      std::vector<types::global_dof_index> columns;
      for (const FreeDof &dof : dofs)
        columns.push_back(dof.number);
      for (const FreeDof &dof : dofs)
        if (dof.row >= 0)
          rows.add_entries(dof.row, columns.begin(), columns.end());
    });
    SparsityPattern pattern;
    pattern.copy_from(rows);
    rows.reinit(0, 0);

    std::vector<dealii::SparseMatrix<double>> matrices(integrals.size());
    for (dealii::SparseMatrix<double> &matrix : matrices)
      matrix.reinit(pattern);
    FullMatrix<double> cell_matrix(model.dof_handler().get_fe().n_dofs_per_cell());
    for_cells([&](const Cell &cell, const std::vector<FreeDof> &dofs) {
      for (std::size_t k = 0; k < integrals.size(); ++k)
        {
          integrals[k](cell, cell_matrix);
          for (const FreeDof &i : dofs)
            if (i.row >= 0)
              for (const FreeDof &j : dofs)
                matrices[k].add(i.row, j.number, cell_matrix(i.in_cell, j.in_cell));
        }
    });
    std::vector<std::shared_ptr<const SparseMatrix>> result;
    for (const dealii::SparseMatrix<double> &matrix : matrices)
      result.push_back(std::make_shared<SparseMatrix>(map, map, [&](const int i, SparseMatrix::Row &row) {
        // Left out: directions that a mass does not couple, and the diagonal that deal.II adds in rows of other bodies
        for (auto entry = matrix.begin(i); entry != matrix.end(i); ++entry)
          if (entry->value() != 0.)
            row.emplace_back(entry->column(), entry->value());
      }));
    return result;
  }
} // namespace Squeal
