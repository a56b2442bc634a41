// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/sparse_matrix.h>

#include <string>

namespace Squeal
{
  /**
   * All entries of a matrix from a Matrix Market file: coordinate or array, real or integer, general, symmetric or skew-symmetric (both
   * triangles are returned); duplicate entries are added. Stricter than CHOLMOD's reader, which reads 1.5D2 as 1.5.
   *
   * Throws FileError with file and line.
   */
  SparseRows read_matrix_market(const std::string &path);

  /// Symmetry declared in the header of a Matrix Market file.
  enum class MatrixMarketSymmetry
  {
    general,  ///< all entries are listed
    symmetric ///< the lower triangle is listed
  };

  /// A in Matrix Market coordinate form with 17 significant digits, which are read back exactly: the whole text on process 0, empty on the
  /// others. Collective.
  std::string matrix_market(const SparseMatrix &A, MatrixMarketSymmetry symmetry = MatrixMarketSymmetry::general);
} // namespace Squeal
