// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/sparse_matrix.h>

#include <string>

namespace Squeal
{
  /**
   * All entries of a matrix from a Matrix Market file: coordinate or array, real or integer, general, symmetric or skew-symmetric (both
   * triangles are returned); duplicate entries are added. This reader is stricter than CHOLMOD's, which reads 1.5D2 as 1.5.
   *
   * Throws a FileError with file and line.
   */
  SparseRows read_matrix_market(const std::string &path);

  /// Symmetry declared in the header of a Matrix Market file.
  enum class MatrixMarketSymmetry
  {
    general,  ///< all entries are listed
    symmetric ///< the lower triangle is listed
  };

  /// Text of A in Matrix Market coordinate form with 17 significant digits, so that exactly the same numbers are read back. Process 0
  /// returns the whole text, the other processes return an empty string. Collective.
  std::string matrix_market(const SparseMatrix &A, MatrixMarketSymmetry symmetry = MatrixMarketSymmetry::general);
} // namespace Squeal
