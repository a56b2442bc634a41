#pragma once

#include "panel_matrix.h"

#include <squeal/linear_algebra/multivector.h>

#include <algorithm>

namespace Squeal
{
  /// Columns [first, first + panel_width) of X to the own rows of a panel, zeros where X ends.
  template <typename Real>
  void to_panel(const MultiVector &X, const int first, Panel<Real> &panel)
  {
    const int     n_columns = std::min(panel_width, X.n_columns() - first);
    constexpr int block     = 64; // rows that stay in the cache
    for (int begin = 0; begin < X.n_local_rows(); begin += block)
      {
        const int end = std::min(begin + block, X.n_local_rows());
        for (int i = begin; i < end; ++i)
          panel[i].lanes = typename PanelRow<Real>::Lanes{};
        for (int j = 0; j < n_columns; ++j)
          {
            const double *column = X.local().data() + static_cast<std::size_t>(first + j) * X.n_local_rows();
            for (int i = begin; i < end; ++i)
              panel[i].lanes[j] = static_cast<Real>(column[i]);
          }
      }
  }

  /// The own rows of a panel to those columns.
  template <typename Real>
  void from_panel(const Panel<Real> &panel, const int first, MultiVector &X)
  {
    const int     n_columns = std::min(panel_width, X.n_columns() - first);
    constexpr int block     = 64;
    for (int begin = 0; begin < X.n_local_rows(); begin += block)
      for (int j = 0; j < n_columns; ++j)
        {
          double   *column = X.local().data() + static_cast<std::size_t>(first + j) * X.n_local_rows();
          const int end    = std::min(begin + block, X.n_local_rows());
          for (int i = begin; i < end; ++i)
            column[i] = panel[i].lanes[j];
        }
  }
} // namespace Squeal
