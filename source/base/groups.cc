// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/groups.h>

#include <limits>

namespace Squeal
{
  std::vector<int> best_assignment(const int n_rows, const int n_columns, const std::function<double(int, int)> &gain)
  {
    // Rows and columns are numbered from 1; column 0 is the root of each search
    constexpr double    infinity = std::numeric_limits<double>::infinity();
    std::vector<double> row_potential(n_rows + 1, 0.), column_potential(n_columns + 1, 0.);
    std::vector<int>    row_of(n_columns + 1, 0);
    for (int row = 1; row <= n_rows; ++row)
      {
        // Dijkstra's algorithm on reduced costs until a free column is reached
        std::vector<double> distance(n_columns + 1, infinity);
        std::vector<int>    previous(n_columns + 1, 0);
        std::vector<bool>   done(n_columns + 1, false);
        int                 column = 0;
        row_of[0]                  = row;
        do
          {
            done[column]       = true;
            const int r        = row_of[column];
            double    smallest = infinity;
            int       next     = 0;
            for (int c = 1; c <= n_columns; ++c)
              if (!done[c])
                {
                  const double cost = -gain(r - 1, c - 1) - row_potential[r] - column_potential[c];
                  if (cost < distance[c])
                    {
                      distance[c] = cost;
                      previous[c] = column;
                    }
                  if (distance[c] < smallest)
                    {
                      smallest = distance[c];
                      next     = c;
                    }
                }
            for (int c = 0; c <= n_columns; ++c)
              if (done[c])
                {
                  row_potential[row_of[c]] += smallest;
                  column_potential[c] -= smallest;
                }
              else
                distance[c] -= smallest;
            column = next;
          }
        while (row_of[column] != 0);

        while (column != 0)
          {
            row_of[column] = row_of[previous[column]];
            column         = previous[column];
          }
      }

    std::vector<int> column_of(n_rows, -1);
    for (int c = 1; c <= n_columns; ++c)
      if (row_of[c] > 0)
        column_of[row_of[c] - 1] = c - 1;
    return column_of;
  }
} // namespace Squeal
