// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/contact/travel.h>
#include <squeal/studies/steps/mode_results.h>

namespace Squeal
{
  namespace
  {
    Table pin_table(const std::vector<PinContact> &pins)
    {
      return Table(Columns<PinContact>{{"pin", "", &PinContact::pin},
                                       {"side", "-", &PinContact::side},
                                       {"load", "N", &PinContact::load, 3},
                                       {"open nodes", "-", &PinContact::n_open},
                                       {"nodes", "-", &PinContact::n_nodes},
                                       {"pressure offset along t", "m", &PinContact::sliding_offset, 2, true},
                                       {"pressure offset outwards", "m", &PinContact::radial_offset, 2, true},
                                       {"largest pressure", "Pa", &PinContact::largest_pressure, 2, true},
                                       {"w_0", "m/s", &PinContact::sliding_speed, 4},
                                       {"c_b", "N s/m", &PinContact::radial_damping, 3},
                                       {"c_t", "N s/m", &PinContact::sliding_damping, 3},
                                       {"backplate travel", "m", &PinContact::approach, 4, true},
                                       {"largest gap", "m", &PinContact::largest_gap, 2, true}},
                   pins);
    }

    /// Residuals and uniqueness of a steady sliding state.
    Table sliding_table(const SlidingState &state, const std::vector<PinContact> &pins)
    {
      std::vector<std::pair<std::string, Entry>> rows;
      std::map<std::string, double>              loads; // sorted: the lower side comes before the upper side
      for (const PinContact &pin : pins)
        loads[pin.side == 0 ? pin.pin : pin.side > 0 ? "the upper side" : "the lower side"] += pin.load;
      for (const auto &[part, load] : loads)
        rows.emplace_back("normal load of " + part + " [N]", load);
      const SlidingChecks &c = state.checks;
      rows.emplace_back("residual of the full system [-]", c.residual);
      rows.emplace_back("error of the prescribed loads [-]", c.load);
      rows.emplace_back("largest tension over load [-]", c.tension);
      rows.emplace_back("largest overlap over travel [-]", c.overlap);
      rows.emplace_back("complementarity |r_n g| over load and travel [-]", c.complementarity);
      rows.emplace_back("force balance with the supports [-]", c.force_balance);
      rows.emplace_back("moment balance with the supports [-]", c.moment_balance);
      rows.emplace_back("changes of the contact set [-]", state.n_steps);
      if (std::isfinite(state.uniqueness.unique_below))
        rows.emplace_back("friction coefficient below which the state is unique [-]", state.uniqueness.unique_below);
      using Row = std::pair<std::string, Entry>;
      return Table(Columns<Row>{{"quantity", "", &Row::first}, {"value", "", &Row::second, 3, true}}, rows);
    }

    std::string uniqueness_note(const ContactUniqueness &uniqueness)
    {
      if (uniqueness.meets_condition)
        return text("the state is unique, because mu < ", uniqueness.unique_below);
      if (uniqueness.found_other)
        return "the state is NOT unique: another contact set also satisfies all conditions; the first set found is used";
      return text("uniqueness is not proved", uniqueness.unique_below > 0. ? text(" above mu = ", uniqueness.unique_below) : "", "; ",
                  counted(uniqueness.n_searches, "search", "searches"), " from other contact sets found no other state");
    }
  } // namespace

  void write_sliding_tables(const Scene &scene, const SlidingState &state, const OperationParameters &operation, Run &run)
  {
    const std::vector<PinContact> pins = pin_contacts(*scene.model, scene.interface, state, operation);
    run.store_table("sliding_pins", pin_table(pins));
    run.store_table("sliding_checks", sliding_table(state, pins));

    std::string open;
    for (const PinContact &pin : pins)
      if (pin.n_open > 0)
        open +=
          text(open.empty() ? "" : ", ", pin.pin, pin.n_open == pin.n_nodes ? " (all)" : text(" (", pin.n_open, " of ", pin.n_nodes, ")"));
    run.progress.note("  steady sliding: " + (open.empty() ? "all contact nodes are closed" : "open contact nodes of " + open));
    run.progress.note("  steady sliding: " + uniqueness_note(state.uniqueness));
  }

  void write_sliding_fields(const Linearisation &linearisation, Run &run)
  {
    const Scene               &scene     = *linearisation.scene;
    const SlidingState        &state     = *linearisation.sliding;
    const OperationParameters &operation = run.parameters.operation;
    const auto                 u         = state.total_displacement->col(0);
    const auto                 plates    = backplate_displacements(travels(*scene.model, scene.interface), state.approach);
    FieldWriter(*scene.model, scene.interface, linearisation.closed, run.folder())
      .write_contact_state({std::vector<double>(u.begin(), u.end()), plates, state.reactions, state.gaps,
                            radial_dissipation(scene.interface, state.reactions, operation),
                            sliding_dissipation(scene.interface, state.reactions, operation)});
  }
} // namespace Squeal
