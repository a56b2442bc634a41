#include <squeal/base/conventions.h>
#include <squeal/studies/friction_modes.h>
#include <squeal/studies/paper_scene.h>
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
      std::string                              name;
      ContactState                             state;
      RadialDissipation                        dissipation;
      std::map<ModeShape, std::vector<double>> rates; ///< divergence rates [%] of the modes of each shape, by frequency
    };

    std::vector<Reading> readings()
    {
      std::vector<Reading> result = {{"no C_b", ContactState::equal_load, RadialDissipation::none, {}}};
      for (const ContactState state : {ContactState::equal_load, ContactState::steady_sliding})
        for (const RadialDissipation dissipation : {RadialDissipation::consistent, RadialDissipation::published})
          result.push_back({to_string(state) + " " + to_string(dissipation), state, dissipation, {}});
      return result;
    }

    /// A line of a table: what the paper prints, where it does, and under which label, and the divergence rates [%] of all readings.
    struct Row
    {
      std::string                        label;
      std::string                        paper_label; ///< empty where it prints no divergence rate
      std::optional<double>              paper;
      std::vector<std::optional<double>> rates;
    };

    Table table_beside_paper(const std::string          &head,
                             const std::vector<Row>     &rows,
                             const std::vector<Reading> &readings,
                             const bool                  beside_paper,
                             const int                   digits)
    {
      Columns<Row> columns = {{head, "", &Row::label}};
      if (beside_paper)
        {
          columns.push_back({"label in the paper", "", &Row::paper_label});
          columns.push_back({"paper with C_b", "%", &Row::paper, digits});
        }
      for (std::size_t i = 0; i < readings.size(); ++i)
        columns.push_back({readings[i].name, "%", [i](const Row &row) { return row.rates[i]; }, digits});
      return Table(columns, rows);
    }

    /**
     * Shapes in the order of their lowest frequencies; those of pin modes by divergence rate. Signs tell the two of a doublet
     * apart, which need not be two in every reading.
     */
    Table mode_table(std::vector<Reading> all, const std::vector<ModeLabel> &shapes, const bool beside_paper)
    {
      std::vector<Row> rows;
      for (ModeLabel label : shapes)
        {
          std::size_t n = 0;
          for (Reading &reading : all)
            n = std::max(n, reading.rates[label.shape()].size());
          if (n > 2)
            for (Reading &reading : all)
              std::sort(reading.rates[label.shape()].begin(), reading.rates[label.shape()].end());
          for (std::size_t member = 0; member < n; ++member)
            {
              label.sign       = n != 2 ? DoubletSign::none : member == 0 ? DoubletSign::minus : DoubletSign::plus;
              const auto paper = paper_divergence_damped(label);
              rows.push_back(
                {to_string(label), paper ? to_string(paper->label) : "", paper ? std::make_optional(paper->rate) : std::nullopt, {}});
              for (Reading &reading : all)
                {
                  const auto &rates = reading.rates[label.shape()];
                  rows.back().rates.push_back(member < rates.size() ? std::make_optional(rates[member]) : std::nullopt);
                }
            }
        }
      return table_beside_paper("label", rows, all, beside_paper, 3);
    }

    /// The pin modes that the paper lists as damped: all T1, and of F1 the half that bends radially.
    Table range_table(std::vector<Reading> all, const bool beside_paper)
    {
      std::vector<Row> rows;
      for (const PaperRange &range : paper_ranges_damped)
        for (const bool lowest : {true, false})
          {
            rows.push_back({to_string(range.label) + (lowest ? " most damped" : " least damped"),
                            to_string(range.label),
                            lowest ? range.lowest : range.highest,
                            {}});
            for (Reading &reading : all)
              {
                auto &rates = reading.rates[range.label.shape()];
                std::sort(rates.begin(), rates.end());
                rows.back().rates.push_back(rates.empty() ? std::nullopt :
                                                            std::make_optional(rates[lowest ? 0 : (rates.size() - 1) / range.every]));
              }
          }
      return table_beside_paper("damped pin modes", rows, all, beside_paper, 2);
    }
  } // namespace

  /**
   * `Study = dissipation`: complex modes at one friction coefficient without
   * radial dissipation and with each reading of it, c_b consistent and as
   * published, R_n0 from equal shares of the load and from steady sliding, side
   * by side with the last column of the paper's Table 1.
   */
  static void run_dissipation_study(Scene &scene, Run &run)
  {
    const Parameters &parameters = run.parameters;
    assemble_scene(scene, run);
    OperationParameters operation = parameters.operation;
    SlidingParameters   sliding   = parameters.sliding;
    sliding.state                 = ContactState::steady_sliding;
    const SlidingState state      = solve_sliding(scene, operation, sliding, run);

    std::optional<FrictionlessModes> frictionless;
    std::vector<Reading>             all = readings();
    std::vector<ModeLabel>           shapes;
    for (Reading &reading : all)
      {
        operation.radial_dissipation = reading.dissipation;
        Linearisation linearisation =
          linearise(scene, reading.state == ContactState::steady_sliding ? std::make_optional(state) : std::nullopt, operation);
        // The modes without friction belong to a contact set, not to a damping
        if (!frictionless || frictionless->linearisation.closed != linearisation.closed)
          frictionless = frictionless_modes(linearisation, run);
        frictionless->linearisation = linearisation;
        add_modal_damping(*frictionless, parameters);
        const FrictionModes friction = friction_modes(*frictionless, operation.friction_coefficient, run, reading.name);
        for (std::size_t j = 0; j < friction.labels.size(); ++j)
          {
            // Of a doublet first the one marked `-`
            const ModeLabel     &label = friction.labels[j];
            std::vector<double> &rates = reading.rates[label.shape()];
            rates.insert(label.sign == DoubletSign::minus ? rates.begin() : rates.end(),
                         100. * modal_quantities(friction.modes.lambda[j]).divergence_rate);
            if (std::none_of(shapes.begin(), shapes.end(), [&](const ModeLabel &shape) { return shape.shape() == label.shape(); }))
              shapes.push_back(label);
          }
      }

    write_sliding_tables(scene, state, parameters.operation, run);
    const bool beside_paper = is_paper_scene(parameters) && is_paper_operation(parameters);
    run.write_table("dissipation", mode_table(all, shapes, beside_paper));
    run.write_table("dissipation_ranges", range_table(all, beside_paper));
    run.screen << '\n';
    run.finish();
  }

  extern const Study dissipation_study = [] {
    Study study{"dissipation", run_dissipation_study};
    study.rules                = {{"Steady sliding/Contact state", [](const Parameters &) { return "the study compares both states"; }}};
    study.no_mode_shapes       = [](const Parameters &) { return "the study writes no mode shapes"; };
    study.compares_dissipation = true;
    return study;
  }();
} // namespace Squeal
