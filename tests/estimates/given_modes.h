#pragma once

#include "solutions.h"

#include <squeal/estimates/common_points.h>

#include <Eigen/QR>

namespace Squeal::Testing
{
  inline const Complex i(0., 1.);

  inline constexpr int n_values = 40;

  inline ModesAtPoints modes(const std::vector<Complex> &lambda, const ComplexDenseMatrix &shapes)
  {
    const RowMap map = RowMap::even(n_values, MPI_COMM_WORLD);
    return {lambda, distribute(shapes.real(), map), distribute(shapes.imag(), map)};
  }

  /// Orthonormal columns.
  inline ComplexDenseMatrix orthonormal(const int k)
  {
    const MultiVector random = random_vectors(RowMap::even(n_values, MPI_COMM_WORLD), 2 * k, 7);
    return Eigen::HouseholderQR<ComplexDenseMatrix>(from_halves(replicate(random))).householderQ() *
           ComplexDenseMatrix::Identity(n_values, k);
  }
} // namespace Squeal::Testing
