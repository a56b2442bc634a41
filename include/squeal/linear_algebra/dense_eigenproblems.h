// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/dense.h>

#include <complex>
#include <functional>
#include <vector>

namespace Squeal
{
  /// Real eigenvalues, ascending, with their eigenvectors as columns.
  struct RealPairs
  {
    std::vector<double> values;
    DenseMatrix         vectors;
  };

  /// Eigenpairs of a symmetric matrix.
  RealPairs symmetric_eigenpairs(DenseMatrix A);

  /// Eigenpairs of A x = λ B x, A symmetric and B symmetric positive definite; the vectors are B-orthonormal.
  RealPairs symmetric_eigenpairs(DenseMatrix A, DenseMatrix B);

  /// Singular values and right singular vectors of an m × n matrix.
  struct SingularValues
  {
    std::vector<double> values; ///< min(m, n) singular values, descending
    DenseMatrix         right;  ///< V, n × n: its last n − rank columns span the kernel
  };
  SingularValues singular_values(DenseMatrix A);

  /// Eigenvalues of a real square matrix A, and right and left eigenvectors of norm one for selected eigenvalues: A x = λ x, yᴴ A = λ yᴴ.
  /// If an eigenvalue is selected, its conjugate is selected, too.
  struct DenseEigenpairs
  {
    std::vector<std::complex<double>> values;      ///< all eigenvalues
    std::vector<int>                  numbers;     ///< indices of the values with vectors, ascending
    ComplexDenseMatrix                right, left; ///< one column for each entry of numbers
  };
  DenseEigenpairs eigenpairs(
    DenseMatrix                                              A,
    const std::function<bool(const std::complex<double> &)> &is_wanted = [](const std::complex<double> &) { return true; });
} // namespace Squeal
