#pragma once

#include <squeal/linear_algebra/multivector.h>
#include <squeal/model/model.h>

#include <deal.II/lac/full_matrix.h>

#include <functional>
#include <memory>

namespace Squeal
{
  using Cell          = dealii::DoFHandler<3>::active_cell_iterator;
  using CellPredicate = std::function<bool(const Cell &)>;
  using CellIntegral  = std::function<void(const Cell &, dealii::FullMatrix<double> &)>;

  /**
   * A matrix on the free dofs: the sum of an integral over those cells that contribute.
   *
   * @param integral fills the matrix of a cell, as large as it has dofs
   */
  std::shared_ptr<const SparseMatrix> assemble_cells(const Model &model, const CellPredicate &contributes, const CellIntegral &integral);
} // namespace Squeal
