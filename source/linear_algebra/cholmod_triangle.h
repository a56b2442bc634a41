#pragma once

#include <suitesparse/cholmod.h>
#include <vector>

namespace Squeal
{
  /// CHOLMOD's view of the lower triangle of a symmetric matrix by columns, rows ascending; of its pattern alone where @p value is null.
  inline cholmod_sparse lower_triangle(std::vector<int> &start, std::vector<int> &row, double *value)
  {
    cholmod_sparse S = {};
    S.nrow = S.ncol = start.size() - 1;
    S.nzmax         = row.size();
    S.p             = start.data();
    S.i             = row.data();
    S.x             = value;
    S.stype         = -1;
    S.itype         = CHOLMOD_INT;
    S.xtype         = value != nullptr ? CHOLMOD_REAL : CHOLMOD_PATTERN;
    S.dtype         = CHOLMOD_DOUBLE;
    S.sorted        = 1;
    S.packed        = 1;
    return S;
  }
} // namespace Squeal
