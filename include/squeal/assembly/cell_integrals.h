#pragma once

#include <squeal/linear_algebra/multivector.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/model/model.h>

#include <deal.II/lac/full_matrix.h>

#include <functional>
#include <memory>
#include <vector>

namespace Squeal
{
  using Cell          = dealii::DoFHandler<3>::active_cell_iterator;
  using CellPredicate = std::function<bool(const Cell &)>;
  using CellIntegral  = std::function<void(const Cell &, dealii::FullMatrix<double> &)>;

  /**
   * Matrices on the free dofs, one for each integral: its sum over those cells that contribute.
   *
   * @param integrals called in this order for each cell; each fills the matrix of the cell, as large as it has dofs
   */
  std::vector<std::shared_ptr<const SparseMatrix>> assemble_cells(const Model                     &model,
                                                                  const CellPredicate             &contributes,
                                                                  const std::vector<CellIntegral> &integrals);
} // namespace Squeal
