// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <map>
#include <utility>
#include <vector>

namespace Squeal
{
  /// u_slave = Σ coefficient u_master: (master, coefficient) for each slave, numbered by dof or otherwise.
  using SlaveRows = std::map<int, std::vector<std::pair<int, double>>>;

  /// Replaces masters that are slaves of other rows by their masters. Returns false if slaves depend on each other circularly.
  bool resolve(SlaveRows &rows);
} // namespace Squeal
