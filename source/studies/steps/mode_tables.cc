#include <squeal/base/conventions.h>
#include <squeal/studies/steps/mode_tables.h>

#include <boost/range/irange.hpp>

#include <algorithm>
#include <cmath>

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
} // namespace Squeal
