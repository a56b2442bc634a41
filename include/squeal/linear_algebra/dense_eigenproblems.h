#pragma once

#include <squeal/linear_algebra/dense.h>

#include <complex>
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
    std::vector<double> values; ///< min(m, n) of them, descending
    DenseMatrix         right;  ///< V, n × n: its last n − rank columns span the kernel
  };
  SingularValues singular_values(DenseMatrix A);

  /**
   * Eigenvalues of a real square matrix with right and, where asked, left
   * eigenvectors (LAPACK's dgeev: left vectors satisfy yᴴ A = λ yᴴ).
   */
  struct DenseEigenpairs
  {
    std::vector<std::complex<double>> values;
    ComplexDenseMatrix                right; ///< one column per value
    ComplexDenseMatrix                left;  ///< empty unless asked for
  };
  DenseEigenpairs eigenpairs(DenseMatrix A, bool left_vectors = false);
} // namespace Squeal
