// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <map>
#include <utility>
#include <vector>

namespace Squeal
{
  /// Constraints u_slave = Σ coefficient u_master: pairs (master, coefficient) for each slave. Slaves and masters are numbers of dofs or
  /// nodes.
  using SlaveRows = std::map<int, std::vector<std::pair<int, double>>>;

  /// Replaces masters that are slaves in other rows by the masters of these rows. Returns false if slaves depend on each other circularly.
  bool resolve(SlaveRows &rows);
} // namespace Squeal
