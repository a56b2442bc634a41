#include <squeal/base/conventions.h>
#include <squeal/studies/steps/power_results.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace Squeal
{
  namespace
  {
    /// What a body of a mode adds to its divergence rate [-].
    struct PowerRow
    {
      int                   mode;
      std::string           body;
      std::optional<double> friction, into_disc, into_pin, radial, sliding; ///< of pins
      double                damping;                                        ///< of the material or of the modes

      double sum() const
      {
        return friction.value_or(0.) + radial.value_or(0.) + sliding.value_or(0.) + damping;
      }
    };

    std::vector<PowerRow> rows_of(const int mode, const PowerBalance &balance, const Linearisation &linearisation)
    {
      const std::vector<std::string> &names = linearisation.scene->model->component_names();
      std::vector<PowerRow>           rows{{mode, names.front(), {}, {}, {}, {}, {}, balance.bodies.front()}};
      for (std::size_t pin = 1; pin < names.size(); ++pin)
        rows.push_back({mode, names[pin], 0., 0., 0., 0., 0., balance.bodies[pin]});
      for (std::size_t node = 0; node < linearisation.interface.size(); ++node)
        {
          PowerRow &row = rows[linearisation.interface[node].pin];
          *row.into_disc += balance.into_disc[node];
          *row.into_pin += balance.into_pins[node];
          *row.friction += balance.into_disc[node] + balance.into_pins[node];
          *row.radial += balance.radial_damping[node];
          *row.sliding += balance.sliding_damping[node];
        }
      if (balance.modal_damping != 0.)
        rows.push_back({mode, "all (modal damping)", {}, {}, {}, {}, {}, balance.modal_damping});
      return rows;
    }
  } // namespace

  PowerBalances power_balances(const Linearisation &linearisation, const FrictionModes &friction, Run &run)
  {
    const Scene  &scene = *linearisation.scene;
    PowerBalances result;
    double        imbalance = 0.;
    for (std::size_t j = 0; j < friction.labels.size(); ++j)
      if (friction.unstable[j])
        {
          const int                  column = static_cast<int>(j);
          const std::complex<double> lambda = friction.modes.lambda[j];
          const PowerBalance         balance =
            power_balance(scene.system, *scene.model, linearisation.coupled, linearisation.interface, linearisation.damping,
                          run.parameters.operation.friction_coefficient, lambda, view(*friction.modes.real_part, column, 1),
                          view(*friction.modes.imaginary_part, column, 1));
          imbalance      = std::max(imbalance, std::abs(balance.sum() - modal_quantities(lambda).divergence_rate));
          result[column] = balance;
        }
    if (!result.empty())
      run.measure("largest difference of a divergence rate from what its powers add up to [-]", imbalance);
    return result;
  }

  void write_power_table(const Linearisation &linearisation, const FrictionModes &friction, const PowerBalances &balances, Run &run)
  {
    if (balances.empty())
      return;
    std::vector<PowerRow> rows;
    for (const auto &[mode, balance] : balances)
      for (const PowerRow &row : rows_of(mode, balance, linearisation))
        rows.push_back(row);
    const auto part = [](std::optional<double> PowerRow::*share) {
      return [share](const PowerRow &row) { return row.*share ? std::make_optional(100. * *(row.*share)) : std::nullopt; };
    };
    run.store_table(
      "energy", Table(
                  Columns<PowerRow>{
                    {"mode", "-", [](const PowerRow &row) { return row.mode + 1; }},
                    {"label", "", [&](const PowerRow &row) { return friction.labels[row.mode]; }},
                    {"frequency", "Hz", [&](const PowerRow &row) { return modal_quantities(friction.modes.lambda[row.mode]).frequency; }},
                    {"divergence rate", "%",
                     [&](const PowerRow &row) { return 100. * modal_quantities(friction.modes.lambda[row.mode]).divergence_rate; }},
                    {"body", "", &PowerRow::body},
                    {"all of it", "%", [](const PowerRow &row) { return 100. * row.sum(); }},
                    {"friction", "%", part(&PowerRow::friction)},
                    {"friction into the disc", "%", part(&PowerRow::into_disc)},
                    {"friction into the pin", "%", part(&PowerRow::into_pin)},
                    {"radial dissipation", "%", part(&PowerRow::radial)},
                    {"slope of friction", "%", part(&PowerRow::sliding)},
                    {"damping", "%", [](const PowerRow &row) { return 100. * row.damping; }}},
                  rows));
  }

  std::vector<double> energy_input(const Linearisation &linearisation, const PowerBalance &balance)
  {
    std::vector<double> result(linearisation.scene->interface.size(), 0.);
    for (std::size_t node = 0; node < linearisation.closed.size(); ++node)
      result[linearisation.closed[node]] = balance.at(node) / linearisation.interface[node].area;
    return result;
  }
} // namespace Squeal
