// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <map>
#include <utility>
#include <vector>

namespace Squeal
{
  /// u_slave = Σ coefficient u_master: (master, coefficient) of each slave, a number of any kind such as of a dof.
  using SlaveRows = std::map<int, std::vector<std::pair<int, double>>>;

  /// Replaces masters that are slaves of other rows by their masters. Returns whether that ends: false where slaves depend on each other in
  /// a circle.
  bool resolve(SlaveRows &rows);
} // namespace Squeal
