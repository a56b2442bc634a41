#include <squeal/base/conventions.h>
#include <squeal/studies/dissipation_study.h>
#include <squeal/studies/friction_modes.h>
#include <squeal/studies/paper_table.h>
#include <squeal/studies/sliding_results.h>

#include <algorithm>
#include <map>
#include <ostream>

namespace Squeal
{
  namespace
  {
    /// A reading of the radial dissipation with the modes that it gives.
    struct Reading
    {
      std::string         name;
      ContactState        state;
      RadialDissipation   dissipation;
      std::map<std::string, std::vector<double>> rates; ///< divergence rates [%] of the modes of each label, ascending
    };

    std::vector<Reading> readings()
    {
      std::vector<Reading> result = {{"no C_b", ContactState::equal_load, RadialDissipation::none, {}}};
      for (const ContactState state : {ContactState::equal_load, ContactState::steady_sliding})
        for (const RadialDissipation dissipation : {RadialDissipation::consistent, RadialDissipation::published})
          result.push_back({to_string(state) + " " + to_string(dissipation), state, dissipation, {}});
      return result;
    }

    /// Modes in the order of their frequencies without C_b; the members of a family of pin modes by divergence rate.
    Table mode_table(const std::vector<Reading> &all, const std::vector<std::string> &labels)
    {
      std::vector<Column> columns = {{"label", ""}, {"paper with C_b", "%", 3}};
      for (const Reading &reading : all)
        columns.push_back({reading.name, "%", 3});
      Table                              table(columns);
      std::map<std::string, std::size_t> n_seen;
      for (const std::string &label : labels)
        {
          const std::size_t member = n_seen[label]++;
          const auto        paper  = paper_divergence_damped(label);
          std::vector<Cell> cells;
          cells.emplace_back(label);
          cells.push_back(paper ? Cell(*paper) : Cell());
          for (const Reading &reading : all)
            {
              const auto rates = reading.rates.find(label);
              const bool has   = rates != reading.rates.end() && member < rates->second.size();
              cells.push_back(has ? Cell(rates->second[member]) : Cell());
            }
          table.add_row(std::move(cells));
        }
      return table;
    }

    /// The pin modes that the paper lists as damped: all T1, and of F1 the half that bends radially.
    Table range_table(const std::vector<Reading> &all)
    {
      std::vector<Column> columns = {{"damped pin modes", ""}, {"paper with C_b", "%", 2}};
      for (const Reading &reading : all)
        columns.push_back({reading.name, "%", 2});
      Table table(columns);
      for (const PaperRange &range : paper_ranges_damped)
        for (const bool lowest : {true, false})
          {
            std::vector<Cell> cells;
            cells.emplace_back(std::string(range.label) + (lowest ? " most damped" : " least damped"));
            cells.emplace_back(lowest ? range.lowest : range.highest);
            for (const Reading &reading : all)
              {
                const auto rates = reading.rates.find(range.label);
                if (rates == reading.rates.end())
                  cells.emplace_back();
                else
                  cells.emplace_back(rates->second[lowest ? 0 : (rates->second.size() - 1) / range.every]);
              }
            table.add_row(std::move(cells));
          }
      return table;
    }
  } // namespace

  void run_dissipation_study(Run &run)
  {
    const Parameters &parameters = run.parameters;
    Scene             scene      = mesh_scene(run);
    if (run.is_dry)
      {
        run.progress.note("  dry run: nothing was computed or written");
        return;
      }
    assemble_scene(scene, run);
    OperationParameters operation = parameters.operation;
    SlidingParameters   sliding   = parameters.sliding;
    sliding.state                 = ContactState::steady_sliding;
    const SlidingState state      = solve_sliding(scene, operation, sliding, run);

    std::optional<FrictionlessModes> frictionless;
    std::vector<unsigned int>        closed; // of these modes
    std::vector<Reading>             all = readings();
    std::vector<std::string>         labels;
    for (Reading &reading : all)
      {
        operation.radial_dissipation      = reading.dissipation;
        Linearisation linearisation       = linearise(scene, reading.state == ContactState::steady_sliding ? &state : nullptr, operation);
        // The modes without friction belong to a contact set, not to a damping
        if (!frictionless || closed != linearisation.closed)
          {
            frictionless = frictionless_modes(scene, linearisation, run);
            closed       = linearisation.closed;
          }
        add_modal_damping(*frictionless, parameters.damping, linearisation);
        const FrictionModes friction =
          friction_modes(scene, linearisation, *frictionless, operation.friction_coefficient, run, reading.name);
        for (std::size_t j = 0; j < friction.labels.size(); ++j)
          reading.rates[friction.labels[j]].push_back(100. * modal_quantities(friction.modes.lambda[j]).divergence_rate);
        for (auto &entry : reading.rates)
          std::sort(entry.second.begin(), entry.second.end());
        if (labels.empty())
          labels = friction.labels;
      }

    write_sliding_tables(scene, state, parameters.operation, run);
    run.write_table("dissipation", mode_table(all, labels));
    run.write_table("dissipation_ranges", range_table(all));
    run.screen << '\n';
    run.finish();
  }
} // namespace Squeal
