// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <algorithm>
#include <functional>
#include <numeric>
#include <vector>

namespace Squeal
{
  /// Connected components of n items, where connected(i, j), j < i, is true for connected items. Returns for each item the index of the
  /// first member of its group.
  template <typename Predicate>
  std::vector<int> connected_groups(const int n, const Predicate &connected)
  {
    std::vector<int> group(n);
    std::iota(group.begin(), group.end(), 0);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < i; ++j)
        if (const auto [first, second] = std::minmax({group[i], group[j]}); first != second && connected(i, j))
          std::replace(group.begin(), group.end(), second, first);
    return group;
  }

  /// Members of each group, ascending; groups in the order of their first members.
  inline std::vector<std::vector<int>> members_of(const std::vector<int> &group)
  {
    std::vector<std::vector<int>> members(group.size());
    for (std::size_t i = 0; i < group.size(); ++i)
      members[group[i]].push_back(static_cast<int>(i));
    members.erase(std::remove_if(members.begin(), members.end(), [](const auto &list) { return list.empty(); }), members.end());
    return members;
  }

  /**
   * Assigns each of the @p n_rows rows to a different column so that the sum of gain(row, column) is maximised; requires n_rows ≤
   * n_columns. Returns the column of each row. Shortest augmenting paths (H. W. Kuhn 1955; R. Jonker, A. Volgenant 1987), n_rows² ·
   * n_columns operations.
   */
  std::vector<int> best_assignment(int n_rows, int n_columns, const std::function<double(int, int)> &gain);
} // namespace Squeal
