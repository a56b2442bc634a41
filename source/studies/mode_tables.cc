#include <squeal/base/conventions.h>
#include <squeal/studies/mode_tables.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace Squeal
{
  Table component_table(const FrictionlessModes &modes, const double largest_eigenvalue)
  {
    struct ComponentSet
    {
      const char           *component, *contact;
      const ComponentModes &modes;
    };
    Table table({{"component", ""}, {"contact", ""}, {"label", ""}, {"frequency", "Hz", 2}, {"residual", "-", 1, true}});
    for (const ComponentSet &set : {ComponentSet{"disc", "free", modes.disc}, ComponentSet{"pins", "sliding", modes.pins_sliding},
                                    ComponentSet{"pins", "free", modes.pins_free}})
      {
        const std::size_t        n = n_in_band(set.modes.eigenvalues, largest_eigenvalue);
        std::vector<std::string> labels(set.modes.labels.begin(), set.modes.labels.begin() + static_cast<std::ptrdiff_t>(n));
        mark_doublets(labels);
        for (std::size_t j = 0; j < n; ++j)
          table.add_row({std::string(set.component), std::string(set.contact), labels[j], hertz(std::sqrt(set.modes.eigenvalues[j])),
                         set.modes.residuals[j]});
      }
    return table;
  }

  Table real_table(const FrictionlessModes &modes)
  {
    Table table({{"label", ""}, {"share", "-", 3}, {"frequency", "Hz", 3}, {"residual", "-", 1, true}});
    for (std::size_t j = 0; j < modes.labels.size(); ++j)
      table.add_row({modes.labels[j], modes.identities[j].share, hertz(std::sqrt(modes.real.eigenvalues[j])), modes.real.residuals[j]});
    return table;
  }

  Table complex_table(const FrictionModes &friction)
  {
    const ComplexModes &modes         = friction.modes;
    std::vector<Column> columns       = {{"label", ""},
                                         {"share", "-", 3},
                                         {"frequency", "Hz", 3},
                                         {"growth rate", "1/s", 4},
                                         {"divergence rate", "%", 4},
                                         {"effective damping ratio -2R/omega", "%", 4},
                                         {"residual", "-", 1, true},
                                         {"eps_res", "-", 1, true},
                                         {"unstable", "-"}};
    const bool          has_estimates = !modes.estimated_errors.empty();
    if (has_estimates)
      columns.push_back({"estimated error of lambda", "-", 1, true});
    Table table(columns);
    for (std::size_t j = 0; j < friction.labels.size(); ++j)
      {
        const ModalQuantities mode  = modal_quantities(modes.lambda[j]);
        std::vector<Cell>     cells = {friction.labels[j], friction.identities[j].share, mode.frequency,
                                       mode.growth_rate,   100. * mode.divergence_rate,  100. * mode.damping_ratio,
                                       modes.residuals[j], modes.energy_residuals[j],    static_cast<long>(friction.unstable[j])};
        if (has_estimates)
          cells.emplace_back(modes.estimated_errors[j]);
        table.add_row(std::move(cells));
      }
    return table;
  }

  Table unstable_table(const FrictionModes &friction, const std::size_t n_largest)
  {
    struct Growing
    {
      std::size_t     mode;
      ModalQuantities quantities;
    };
    std::vector<Growing> growing;
    for (std::size_t j = 0; j < friction.unstable.size(); ++j)
      if (friction.unstable[j])
        growing.push_back({j, modal_quantities(friction.modes.lambda[j])});
    std::stable_sort(growing.begin(), growing.end(),
                     [](const Growing &a, const Growing &b) { return a.quantities.divergence_rate > b.quantities.divergence_rate; });
    growing.resize(std::min(growing.size(), n_largest));

    Table table({{"unstable mode", ""}, {"frequency", "Hz", 1}, {"growth rate", "1/s", 2}, {"divergence rate", "%", 4}, {"share", "-", 3}});
    for (const Growing &mode : growing)
      table.add_row({friction.labels[mode.mode], mode.quantities.frequency, mode.quantities.growth_rate,
                     100. * mode.quantities.divergence_rate, friction.identities[mode.mode].share});
    return table;
  }

  Table real_eigenvalue_table(const std::vector<double> &values)
  {
    Table table({{"growth rate", "1/s", 4}, {"kind", ""}});
    for (auto value = values.rbegin(); value != values.rend(); ++value)
      table.add_row({*value, std::string(*value > 0. ? "static divergence" : "decay")});
    return table;
  }

  Table pin_table(const std::vector<PinContact> &pins)
  {
    Table table({{"pin", ""},
                 {"side", "-"},
                 {"load", "N", 3},
                 {"open nodes", "-"},
                 {"nodes", "-"},
                 {"pressure offset along t", "m", 2, true},
                 {"pressure offset outwards", "m", 2, true},
                 {"largest pressure", "Pa", 2, true},
                 {"w_0", "m/s", 4},
                 {"c_b", "N s/m", 3},
                 {"c_t", "N s/m", 3},
                 {"travel of backplate", "m", 4, true},
                 {"largest gap", "m", 2, true}});
    for (const PinContact &pin : pins)
      table.add_row({pin.pin, static_cast<long>(pin.side), pin.load, static_cast<long>(pin.n_open), static_cast<long>(pin.n_nodes),
                     pin.sliding_offset, pin.radial_offset, pin.largest_pressure, pin.sliding_speed, pin.radial_damping,
                     pin.sliding_damping, pin.approach, pin.largest_gap});
    return table;
  }

  Table sliding_table(const SlidingState &state, const std::vector<PinContact> &pins)
  {
    Table                 table({{"quantity", ""}, {"value", "", 3, true}});
    std::map<int, double> loads;
    for (const PinContact &pin : pins)
      loads[pin.side] += pin.load;
    for (const auto &[side, load] : loads)
      table.add_row({std::string("normal load of the ") + (side > 0 ? "upper" : "lower") + " side [N]", load});
    const SlidingCertificate &c = state.certificate;
    table.add_row({std::string("residual of the full system [-]"), c.residual});
    table.add_row({std::string("error of the prescribed loads [-]"), c.load});
    table.add_row({std::string("largest tension over load [-]"), c.tension});
    table.add_row({std::string("largest overlap over travel [-]"), c.overlap});
    table.add_row({std::string("complementarity |r_n g| over load and travel [-]"), c.complementarity});
    table.add_row({std::string("force balance with the supports [-]"), c.force_balance});
    table.add_row({std::string("moment balance with the supports [-]"), c.moment_balance});
    table.add_row({std::string("changes of the contact set [-]"), static_cast<long>(state.n_steps)});
    if (std::isfinite(state.uniqueness.unique_below))
      table.add_row({std::string("friction coefficient below which the state is unique [-]"), state.uniqueness.unique_below});
    return table;
  }
} // namespace Squeal
