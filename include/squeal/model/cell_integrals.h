#pragma once

#include <squeal/linear_algebra/multivector.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/model/model.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/full_matrix.h>

#include <functional>
#include <memory>
#include <vector>

namespace Squeal
{
  using Cell          = dealii::DoFHandler<3>::active_cell_iterator;
  using CellPredicate = std::function<bool(const Cell &)>;

  /// Fills the matrix of a cell, as large as it has dofs.
  using CellIntegral = std::function<void(const Cell &, dealii::FullMatrix<double> &)>;

  /// Integrals that are called in their order for each cell. Several threads integrate, each with integrals of its own.
  using MakeIntegrals = std::function<std::vector<CellIntegral>()>;

  /// Matrices on the free dofs, one for each integral: its sum over those cells that contribute.
  std::vector<std::shared_ptr<const SparseMatrix>> assemble_cells(const Model         &model,
                                                                  const CellPredicate &contributes,
                                                                  const MakeIntegrals &make_integrals);
} // namespace Squeal
