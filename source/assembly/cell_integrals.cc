#include <squeal/assembly/cell_integrals.h>

#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    /// Numbers of a cell's free dofs; local positions of the clamped ones are left out.
    struct FreeDofs
    {
      std::vector<TrilinosWrappers::types::int_type> numbers;
      std::vector<unsigned int>                      local;

      void reinit(const Model &model, const std::vector<types::global_dof_index> &cell_dofs)
      {
        numbers.clear();
        local.clear();
        for (unsigned int i = 0; i < cell_dofs.size(); ++i)
          if (const int number = model.free_dof(cell_dofs[i]); number >= 0)
            {
              numbers.push_back(number);
              local.push_back(i);
            }
      }
    };

    void add_to(TrilinosWrappers::SparseMatrix &matrix, const FreeDofs &dofs, const FullMatrix<double> &cell_matrix)
    {
      const unsigned int                   n = dofs.numbers.size();
      std::vector<types::global_dof_index> columns(dofs.numbers.begin(), dofs.numbers.end());
      std::vector<double>                  values(n);
      for (unsigned int i = 0; i < n; ++i)
        {
          for (unsigned int j = 0; j < n; ++j)
            values[j] = cell_matrix(dofs.local[i], dofs.local[j]);
          matrix.add(columns[i], columns, values);
        }
    }
  } // namespace

  std::shared_ptr<const SparseMatrix> assemble_cells(const Model &model, const CellPredicate &contributes, const CellIntegral &integral)
  {
    IndexSet owned(model.free_map().NumGlobalElements());
    if (model.free_map().NumMyElements() > 0)
      owned.add_range(model.free_map().MinMyGID(), model.free_map().MaxMyGID() + 1);
    TrilinosWrappers::SparsityPattern    pattern(owned, model.communicator());
    const unsigned int                   n = model.dof_handler().get_fe().n_dofs_per_cell();
    std::vector<types::global_dof_index> cell_dofs(n);
    FreeDofs                             free;
    const auto                           for_cells = [&](const std::function<void(const Cell &)> &action) {
      for (const auto &cell : model.dof_handler().active_cell_iterators())
        if (cell->is_locally_owned() && contributes(cell))
          {
            cell->get_dof_indices(cell_dofs);
            free.reinit(model, cell_dofs);
            action(cell);
          }
    };
    for_cells([&](const Cell &) {
      for (const auto row : free.numbers)
        pattern.add_entries(row, free.numbers.begin(), free.numbers.end());
    });
    pattern.compress();

    TrilinosWrappers::SparseMatrix matrix;
    FullMatrix<double>             cell_matrix(n, n);
    matrix.reinit(pattern);
    for_cells([&](const Cell &cell) {
      integral(cell, cell_matrix);
      add_to(matrix, free, cell_matrix);
    });
    matrix.compress(VectorOperation::add);
    return std::make_shared<SparseMatrix>(static_cast<const SparseMatrix &>(matrix.trilinos_matrix()));
  }
} // namespace Squeal
