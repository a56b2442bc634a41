#pragma once

#include <squeal/modes/power_balance.h>
#include <squeal/studies/steps/friction_modes.h>

#include <map>
#include <vector>

namespace Squeal
{
  /// Where the energy of every growing mode comes from, by numbers of the modes.
  using PowerBalances = std::map<int, PowerBalance>;

  /// The balances of all growing modes; how far the largest is from adding up to ξ goes to the run record.
  PowerBalances power_balances(const Linearisation &linearisation, const FrictionModes &friction, Run &run);

  /// `energy.csv`: of each growing mode what disc and pins, friction and damping add to its divergence rate. Nothing without a growing mode.
  void write_power_table(const Linearisation &linearisation, const FrictionModes &friction, const PowerBalances &balances, Run &run);

  /// What friction and damping at each of all contact nodes add to ξ, over its area [1/m²]; zero at open ones.
  std::vector<double> energy_input(const Linearisation &linearisation, const PowerBalance &balance);
} // namespace Squeal
