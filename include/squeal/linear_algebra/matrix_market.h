// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/sparse_matrix.h>

#include <string>

namespace Squeal
{
  /**
   * All entries of a matrix in a file of the Matrix Market, coordinate or array, real or integer, general, symmetric or skew-symmetric
   * (both triangles are returned); entries of one place are added. Strict, unlike CHOLMOD's reader, which takes 1.5D2 for 1.5.
   *
   * Throws FileError with file and line.
   */
  SparseRows read_matrix_market(const std::string &path);

  /// What the header of a Matrix Market file promises about its entries.
  enum class MatrixMarketSymmetry
  {
    general,  ///< all entries are listed
    symmetric ///< the lower triangle is listed
  };

  /// A in Matrix Market coordinate form with 17 significant digits, so that reading returns the same numbers: the whole text on process 0,
  /// nothing on the others. All processes must call.
  std::string matrix_market(const SparseMatrix &A, MatrixMarketSymmetry symmetry = MatrixMarketSymmetry::general);
} // namespace Squeal
