// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/linear_algebra/slave_rows.h>

namespace Squeal
{
  bool resolve(SlaveRows &rows)
  {
    constexpr int most_passes = 20; // chains of slaves are short unless they are circular
    for (int pass = 0; pass < most_passes; ++pass)
      {
        bool is_done = true;
        for (auto &[slave, row] : rows)
          {
            SlaveRows::mapped_type resolved;
            for (const auto &[master, coefficient] : row)
              if (const auto known = rows.find(master); known == rows.end())
                resolved.emplace_back(master, coefficient);
              else
                for (const auto &[its_master, share] : known->second)
                  {
                    resolved.emplace_back(its_master, coefficient * share);
                    is_done = false;
                  }
            row = std::move(resolved);
          }
        if (is_done)
          return true;
      }
    return false;
  }
} // namespace Squeal
