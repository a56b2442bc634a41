#include <squeal/base/conventions.h>
#include <squeal/contact/travel.h>
#include <squeal/linear_algebra/replicate.h>
#include <squeal/output/fields.h>
#include <squeal/studies/steps/mode_results.h>

#include <boost/range/irange.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace Squeal
{
  Table component_table(const FrictionlessModes &modes, const double largest_eigenvalue)
  {
    using Row = ListedComponentMode;
    return Table(Columns<Row>{{"component", "", &Row::component},
                              {"contact", "", &Row::contact},
                              {"label", "", &Row::label},
                              {"frequency", "Hz", [](const Row &row) { return row.frequency(); }, 2},
                              {"residual", "-", [](const Row &row) { return row.set->residuals[row.number]; }, 1, true}},
                 listed_component_modes(modes, largest_eigenvalue));
  }

  Table real_table(const FrictionlessModes &modes)
  {
    return Table(Columns<int>{{"label", "", [&](const int j) { return modes.labels[j]; }},
                              {"share", "-", [&](const int j) { return modes.labels[j].participation; }, 3},
                              {"frequency", "Hz", [&](const int j) { return hertz(std::sqrt(modes.real.eigenvalues[j])); }, 3},
                              {"residual", "-", [&](const int j) { return modes.real.residuals[j]; }, 1, true}},
                 boost::irange<int>(0, modes.labels.size()));
  }

  namespace
  {
    /// A column of modes with friction, known by their numbers, of what modal_quantities() says of them.
    Column<int> column_of(const FrictionModes &friction,
                          const std::string   &name,
                          const std::string   &unit,
                          double ModalQuantities::*quantity,
                          const int                digits)
    {
      const double factor = unit == "%" ? 100. : 1.;
      return {name, unit,
              [&friction, quantity, factor](const int j) { return factor * (modal_quantities(friction.modes.lambda[j]).*quantity); },
              digits};
    }
  } // namespace

  Table complex_table(const FrictionModes &friction, const std::vector<std::optional<WaveShares>> &waves, const Columns<int> &more)
  {
    const ComplexModes &modes = friction.modes;
    const auto          wave  = [&waves](double WaveShares::*share) {
      return [&waves, share](const int j) { return waves[j] ? std::make_optional(*waves[j].*share) : std::nullopt; };
    };
    Columns<int> columns = {{"label", "", [&](const int j) { return friction.labels[j]; }},
                            {"share", "-", [&](const int j) { return friction.labels[j].participation; }, 3},
                            column_of(friction, "frequency", "Hz", &ModalQuantities::frequency, 3),
                            column_of(friction, "growth rate", "1/s", &ModalQuantities::growth_rate, 4),
                            column_of(friction, "divergence rate", "%", &ModalQuantities::divergence_rate, 4),
                            column_of(friction, "effective damping ratio -2R/omega", "%", &ModalQuantities::damping_ratio, 4),
                            {"residual", "-", [&](const int j) { return modes.residuals[j]; }, 1, true},
                            {"eps_res", "-", [&](const int j) { return modes.energy_residuals[j]; }, 1, true},
                            {"unstable", "-", [&](const int j) { return bool(friction.unstable[j]); }},
                            {"wave with rotation", "-", wave(&WaveShares::positive), 3},
                            {"wave against rotation", "-", wave(&WaveShares::negative), 3}};
    if (!modes.estimated_errors.empty())
      columns.push_back({"estimated error of lambda", "-", [&](const int j) { return modes.estimated_errors[j]; }, 1, true});
    if (more.empty()) // else the error of the mesh is in the verdict
      columns.push_back({"verdict", "", [&](const int j) { return to_string(friction.verdicts[j]); }});
    columns.insert(columns.end(), more.begin(), more.end());
    return Table(columns, boost::irange<int>(0, friction.labels.size()));
  }

  Columns<int> mesh_error_columns(const std::vector<DiscretisationError> &errors, const AccuracyLimits &limits)
  {
    const auto known = [&errors](const double DiscretisationError::*error) {
      return
        [&errors, error](const int j) { return errors[j].has_counterpart ? std::make_optional(100. * (errors[j].*error)) : std::nullopt; };
    };
    return {{"estimated frequency error by the mesh", "%", known(&DiscretisationError::frequency), 1, true},
            {"estimated divergence rate error by the mesh", "%", known(&DiscretisationError::divergence), 1, true},
            {"in a cluster", "-", [&errors](const int j) { return errors[j].in_cluster; }},
            {"converged", "-", [&errors, limits](const int j) { return errors[j].is_within(limits.frequency, limits.divergence); }},
            {"verdict", "", [&errors](const int j) { return to_string(errors[j].verdict); }}};
  }

  Table unstable_table(const FrictionModes &friction, const std::size_t n_largest)
  {
    std::vector<int> growing;
    for (std::size_t j = 0; j < friction.unstable.size(); ++j)
      if (friction.unstable[j])
        growing.push_back(static_cast<int>(j));
    const auto rate = [&](const int j) { return modal_quantities(friction.modes.lambda[j]).divergence_rate; };
    std::stable_sort(growing.begin(), growing.end(), [&](const int a, const int b) { return rate(a) > rate(b); });
    growing.resize(std::min(growing.size(), n_largest));
    return Table(Columns<int>{{"unstable mode", "", [&](const int j) { return friction.labels[j]; }},
                              column_of(friction, "frequency", "Hz", &ModalQuantities::frequency, 1),
                              column_of(friction, "growth rate", "1/s", &ModalQuantities::growth_rate, 2),
                              column_of(friction, "divergence rate", "%", &ModalQuantities::divergence_rate, 4),
                              {"share", "-", [&](const int j) { return friction.labels[j].participation; }, 3}},
                 growing);
  }

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

  namespace
  {
    /// The state of contact, one row for each pin.
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
                                       {"travel of backplate", "m", &PinContact::approach, 4, true},
                                       {"largest gap", "m", &PinContact::largest_gap, 2, true}},
                   pins);
    }

    /// How well a steady sliding state fulfils its equations, and what is known of its uniqueness.
    Table sliding_table(const SlidingState &state, const std::vector<PinContact> &pins)
    {
      std::vector<std::pair<std::string, Cell>> rows;
      std::map<std::string, double>             loads; // lower before upper
      for (const PinContact &pin : pins)
        loads[pin.side == 0 ? pin.pin : pin.side > 0 ? "the upper side" : "the lower side"] += pin.load;
      for (const auto &[part, load] : loads)
        rows.emplace_back("normal load of " + part + " [N]", load);
      const SlidingCertificate &c = state.certificate;
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
      using Row = std::pair<std::string, Cell>;
      return Table(Columns<Row>{{"quantity", "", &Row::first}, {"value", "", &Row::second, 3, true}}, rows);
    }

    std::string uniqueness_note(const ContactUniqueness &uniqueness)
    {
      if (uniqueness.is_certified)
        return text("it is the only one: mu < ", uniqueness.unique_below);
      if (uniqueness.found_other)
        return "it is NOT the only one: another contact set fulfils all conditions too; the one found first is used";
      return text("whether it is the only one is not certified",
                  uniqueness.unique_below > 0. ? text(" above mu = ", uniqueness.unique_below) : "", "; ", uniqueness.n_searches,
                  " searches from other contact sets found no other");
    }
  } // namespace

  void write_sliding_tables(const Scene &scene, const SlidingState &state, const OperationParameters &operation, Run &run)
  {
    const std::vector<PinContact> pins = pin_contacts(*scene.model, scene.interface, state, operation);
    run.store_table("sliding_pins", pin_table(pins));
    run.store_table("sliding_certificate", sliding_table(state, pins));

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
                            sliding_dissipation(state.reactions, operation)});
  }
} // namespace Squeal
