#pragma once

#include "matrices.h"

#include <squeal/linear_algebra/multigrid.h>

namespace Squeal::Testing
{
  /// Rigid-body motions of plate(): its nodes are numbered across the thickness first.
  inline NearNullSpace near_null_space_of_plate(const RowMap &map, const std::array<int, 3> &cells, const double h)
  {
    NearNullSpace space{MultiVector(map, 6), {}};
    const int     ny = cells[1] + 1, nz = cells[2] + 1;
    for (int i = 0; i < map.n_local(); ++i)
      {
        const int    node = map.number(i) / 3, k = map.number(i) % 3;
        const double p[3]         = {h * (node / (nz * ny)), h * ((node / nz) % ny), h * (node % nz)};
        const double values[6][3] = {{1., 0., 0.}, {0., 1., 0.}, {0., 0., 1.}, {0., -p[2], p[1]}, {p[2], 0., -p[0]}, {-p[1], p[0], 0.}};
        for (int j = 0; j < 6; ++j)
          space.vectors(i, j) = values[j][k];
        space.points.push_back(node);
      }
    return space;
  }
} // namespace Squeal::Testing
