// SPDX-License-Identifier: GPL-3.0-or-later

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
    /// A free dof of an element or of a master of its tied nodes, with its local row (-1 if another process owns the row).
    struct FreeDof
    {
      unsigned int in_element;
      int          number, row;
      double       weight; ///< weight in the dof of the element
    };

    struct Contribution
    {
      const NodalElement  *element;
      std::vector<FreeDof> dofs; ///< free dofs of the element; clamped dofs are omitted
    };

    /// Elements with one or more local rows. Several processes integrate the elements at partition boundaries, so that no matrix entries
    /// need to be sent.
    std::vector<Contribution> contributions(const Model &model, const std::vector<const NodalElement *> &elements)
    {
      std::vector<Contribution> result;
      for (const NodalElement *element : elements)
        {
          std::vector<FreeDof> dofs;
          for (unsigned int i = 0; i < element->nodes.size(); ++i)
            for (unsigned int c = 0; c < 3; ++c)
              model.nodes()[element->nodes[i]].for_each_dof(c, [&](const int number, const double weight) {
                dofs.push_back({3 * i + c, number, model.free_map().place(number), weight});
              });
          if (std::any_of(dofs.begin(), dofs.end(), [](const FreeDof &dof) { return dof.row >= 0; }))
            result.push_back({element, std::move(dofs)});
        }
      return result;
    }

    void make_pattern(const std::vector<Contribution> &contributions, const RowMap &map, SparsityPattern &pattern)
    {
      DynamicSparsityPattern               rows(map.n_local(), map.n());
      std::vector<types::global_dof_index> columns;
      for (const auto &[element, dofs] : contributions)
        {
          columns.clear();
          for (const FreeDof &dof : dofs)
            columns.push_back(dof.number);
          std::sort(columns.begin(), columns.end());
          columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
          for (const FreeDof &dof : dofs)
            if (dof.row >= 0)
              rows.add_entries(dof.row, columns.begin(), columns.end(), true);
        }
      pattern.copy_from(rows);
    }

    /// Number of elements in a task, and number of element matrices that are stored before they are added.
    constexpr int elements_of_task = 256, elements_together = 8 * elements_of_task;

    /// Integrates and assembles blocks of elements: threads first integrate different elements, then add the element matrices, in the order
    /// of the elements, to different matrices.
    void integrate_and_add(const Model                               &model,
                           const std::vector<Contribution>           &contributions,
                           const std::vector<ElementIntegral>        &integrals,
                           std::vector<dealii::SparseMatrix<double>> &matrices)
    {
      const int                                    n_elements = static_cast<int>(contributions.size());
      const int                                    n_together = std::min(n_elements, elements_together);
      std::vector<std::vector<FullMatrix<double>>> found(matrices.size(), std::vector<FullMatrix<double>>(n_together));
      std::vector<std::unique_ptr<ElementValues>>  values((n_together + elements_of_task - 1) / elements_of_task);
      for (int first = 0; first < n_elements; first += n_together)
        {
          const int n_here = std::min(n_together, n_elements - first);
          run_tasks((n_here + elements_of_task - 1) / elements_of_task, [&](const int task) {
            if (!values[task])
              values[task] = std::make_unique<ElementValues>(model);
            for (int e = task * elements_of_task; e < std::min(n_here, (task + 1) * elements_of_task); ++e)
              {
                const NodalElement &element = *contributions[first + e].element;
                values[task]->reinit(element);
                for (std::size_t k = 0; k < matrices.size(); ++k)
                  {
                    found[k][e].reinit(3 * element.nodes.size(), 3 * element.nodes.size());
                    integrals[k](*values[task], found[k][e]);
                  }
              }
          });
          run_tasks(static_cast<int>(matrices.size()), [&](const int k) {
            for (int e = 0; e < n_here; ++e)
              for (const FreeDof &i : contributions[first + e].dofs)
                if (i.row >= 0)
                  for (const FreeDof &j : contributions[first + e].dofs)
                    matrices[k].add(i.row, j.number, i.weight * j.weight * found[k][e](i.in_element, j.in_element));
          });
        }
    }
  } // namespace

  std::vector<std::shared_ptr<const SparseMatrix>> assemble(const Model                             &model,
                                                            const std::vector<const NodalElement *> &elements,
                                                            const std::vector<ElementIntegral>      &integrals)
  {
    const RowMap                   &map         = model.free_map();
    const std::vector<Contribution> contributed = contributions(model, elements);
    SparsityPattern                 pattern;
    make_pattern(contributed, map, pattern);
    std::vector<dealii::SparseMatrix<double>> matrices(integrals.size());
    for (dealii::SparseMatrix<double> &matrix : matrices)
      matrix.reinit(pattern);
    integrate_and_add(model, contributed, integrals, matrices);

    std::vector<std::shared_ptr<const SparseMatrix>> result(matrices.size());
    const auto                                       convert = [&](const int k) {
      result[k] = std::make_shared<SparseMatrix>(map, map, [&matrix = matrices[k]](const int i, SparseMatrix::Row &row) {
        // Omit zeros: directions that are not coupled in a mass matrix, and the diagonal that deal.II adds to rows of other bodies
        for (auto entry = matrix.begin(i); entry != matrix.end(i); ++entry)
          if (entry->value() != 0.)
            row.emplace_back(entry->column(), entry->value());
        // Move the diagonal, which deal.II stores first, to its position
        if (!row.empty())
          std::rotate(row.begin(), row.begin() + 1, std::upper_bound(row.begin() + 1, row.end(), row.front()));
      });
    };
    const int n = static_cast<int>(matrices.size());
    if (map.n_processes() == 1)
      run_tasks(n, convert);
    else
      for (int k = 0; k < n; ++k)
        convert(k); // collective, therefore not in tasks
    return result;
  }
} // namespace Squeal
