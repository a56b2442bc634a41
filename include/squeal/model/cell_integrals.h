// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/model/element_values.h>

#include <deal.II/lac/full_matrix.h>

#include <functional>
#include <memory>
#include <vector>

namespace Squeal
{
  /// Thread-safe function that adds an element integral to the matrix of a cell or face; the dofs of node i are 3 i, 3 i + 1, 3 i + 2.
  using ElementIntegral = std::function<void(const ElementValues &, dealii::FullMatrix<double> &)>;

  /// Assembles one matrix on the free dofs for each integral over the given elements of this process.
  std::vector<std::shared_ptr<const SparseMatrix>> assemble(const Model                             &model,
                                                            const std::vector<const NodalElement *> &elements,
                                                            const std::vector<ElementIntegral>      &integrals);

  /// Adds ∫ integrand(i, j, q) to the entries that couple equal directions of nodes i and j.
  template <typename Integrand>
  void add_in_each_direction(const ElementValues &values, dealii::FullMatrix<double> &matrix, const Integrand &integrand)
  {
    for (unsigned int i = 0; i < values.n_nodes(); ++i)
      for (unsigned int j = 0; j < values.n_nodes(); ++j)
        {
          double sum = 0.;
          for (unsigned int q = 0; q < values.n_points(); ++q)
            sum += integrand(i, j, q) * values.JxW(q);
          for (unsigned int c = 0; c < 3; ++c)
            matrix(3 * i + c, 3 * j + c) += sum;
        }
  }
} // namespace Squeal
