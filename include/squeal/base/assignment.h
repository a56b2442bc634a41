#pragma once

#include <functional>
#include <vector>

namespace Squeal
{
  /**
   * Assigns each of @p n_rows to a column of its own so that the sum of
   * gain(row, column) is largest; needs n_rows ≤ n_columns. Returns the column
   * of each row. Shortest augmenting paths (H. W. Kuhn 1955; R. Jonker,
   * A. Volgenant 1987), n_rows² · n_columns operations.
   */
  std::vector<int> best_assignment(int n_rows, int n_columns, const std::function<double(int, int)> &gain);
} // namespace Squeal
