// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/text.h>
#include <squeal/studies/designs/design_results.h>

#include <boost/algorithm/string/join.hpp>

#include <algorithm>
#include <limits>
#include <tuple>

namespace Squeal
{
  namespace
  {
    constexpr std::size_t n_shown = 20;

    /// Overlap rounded to six decimals; empty if there is none.
    Entry overlap_cell(const boost::optional<double> &overlap)
    {
      return overlap ? Entry(std::round(1e6 * *overlap) / 1e6) : Entry();
    }

    /// Value of a solved design; empty for other designs.
    template <typename Value>
    std::function<Entry(const DesignResult &)> of_solved(Value value)
    {
      return [value](const DesignResult &row) { return row.outcome == DesignOutcome::solved ? Entry(std::invoke(value, row)) : Entry(); };
    }

    /// A member of an onset or of the largest growth; empty if the design has none.
    template <typename Value>
    std::function<Entry(const DesignResult &)> at(boost::optional<DesignGrowth> DesignResult::*growth,
                                                  Value DesignGrowth::*value,
                                                  const double         factor = 1.)
    {
      return [=](const DesignResult &row) -> Entry {
        if (!(row.*growth))
          return Entry();
        if constexpr (std::is_same_v<Value, double>)
          return Entry(factor * (*(row.*growth)).*value);
        else
          return Entry((*(row.*growth)).*value);
      };
    }

    /// Items of all designs, each with the number of its design.
    template <typename Item>
    std::vector<std::pair<int, Item>> of_all(const std::vector<DesignResult> &designs, std::vector<Item> DesignResult::*items)
    {
      std::vector<std::pair<int, Item>> result;
      for (const DesignResult &design : designs)
        for (const Item &item : design.*items)
          result.emplace_back(design.number, item);
      return result;
    }

    Columns<DesignResult> variable_columns(const std::vector<std::string> &names)
    {
      Columns<DesignResult> columns = {{"design", "-", &DesignResult::number}};
      for (std::size_t v = 0; v < names.size(); ++v)
        columns.push_back({names[v], "", [v](const DesignResult &row) { return row.values[v]; }});
      return columns;
    }

    /// Solved designs from the quietest to the loudest: by descending weak_onset, then by ascending largest divergence rate.
    std::vector<DesignResult> by_quietness(const std::vector<DesignResult> &designs)
    {
      std::vector<DesignResult> result;
      std::copy_if(designs.begin(), designs.end(), std::back_inserter(result),
                   [](const DesignResult &row) { return row.outcome == DesignOutcome::solved; });
      const auto key = [](const DesignResult &row) {
        return std::tuple(row.weak_onset ? -row.weak_onset->friction_coefficient : -std::numeric_limits<double>::infinity(),
                          row.worst ? row.worst->divergence_rate : 0., row.number);
      };
      std::sort(result.begin(), result.end(), [&](const DesignResult &a, const DesignResult &b) { return key(a) < key(b); });
      return result;
    }

    std::string described(const std::vector<std::string> &names, const DesignResult &row)
    {
      std::vector<std::string> values;
      for (std::size_t v = 0; v < names.size(); ++v)
        values.push_back(names[v] + " = " + row.values[v]);
      return text("design ", row.number, " (", boost::algorithm::join(values, "; "), "): ", outcome_of(row),

                  row.worst ? text(", maximum ", decimal_text(100. * row.worst->divergence_rate), " % (", row.worst->label, " at ",
                                   decimal_text(row.worst->frequency), " Hz)") :
                              ", no mode grows");
    }
  } // namespace

  std::string outcome_of(const DesignResult &result)
  {
    if (result.outcome != DesignOutcome::solved)
      return to_string(result.outcome) + ": " + result.reason;
    const std::string limit = text(100. * weak_divergence, " %");
    return result.weak_onset ? text("divergence rate exceeds ", limit, " at mu = ", result.weak_onset->friction_coefficient, " (",
                                    result.weak_onset->label, ")") :
                               "divergence rate does not exceed " + limit;
  }

  Table design_table(const std::vector<std::string> &names, const std::vector<DesignResult> &designs)
  {
    Columns<DesignResult> columns = variable_columns(names);
    const auto            add     = [&](const Column<DesignResult> &column) { columns.push_back(column); };
    using Growth                  = DesignGrowth;
    add({"outcome", "", &DesignResult::outcome});
    add({"mu of 0.01 %", "-", at(&DesignResult::weak_onset, &Growth::friction_coefficient), 5});
    add({"uncertainty of mu of 0.01 %", "-", at(&DesignResult::weak_onset, &Growth::uncertainty), 1, true});
    add({"label at 0.01 %", "", at(&DesignResult::weak_onset, &Growth::label)});
    add({"frequency at 0.01 %", "Hz", at(&DesignResult::weak_onset, &Growth::frequency), 2});
    add({"first onset", "-", at(&DesignResult::onset, &Growth::friction_coefficient), 6});
    add({"uncertainty of first onset", "-", at(&DesignResult::onset, &Growth::uncertainty), 1, true});
    add({"label of first onset", "", at(&DesignResult::onset, &Growth::label)});
    add({"largest divergence rate", "%", at(&DesignResult::worst, &Growth::divergence_rate, 100.), 4});
    add({"label of largest", "", at(&DesignResult::worst, &Growth::label)});
    add({"frequency of largest", "Hz", at(&DesignResult::worst, &Growth::frequency), 2});
    add({"mu of largest", "-", at(&DesignResult::worst, &Growth::friction_coefficient), 4});
    add({"estimated error of largest lambda", "-", at(&DesignResult::worst, &Growth::error), 1, true});
    add({"unstable modes", "-", of_solved(&DesignResult::n_unstable)});
    add({"undecided modes", "-", of_solved(&DesignResult::n_undecided)});
    add({"modes that grow", "-", of_solved(&DesignResult::n_growing)});
    add({"modes", "-", of_solved(&DesignResult::n_modes)});
    add({"modes counted", "-", of_solved(&DesignResult::n_counted)});
    add({"complete", "-", of_solved(&DesignResult::is_complete)});
    add({"doubtful steps", "-", of_solved(&DesignResult::n_doubtful)});
    add({"estimated error of lambda", "-", of_solved(&DesignResult::largest_error), 1, true});
    add({"eps_res", "-", of_solved(&DesignResult::largest_residual), 1, true});
    add({"dofs", "-", of_solved(&DesignResult::n_dofs)});
    add({"reason", "", &DesignResult::reason});
    add({"time", "s", &DesignResult::seconds, 1});
    return Table(columns, designs);
  }

  Table design_threshold_table(const std::vector<DesignResult> &designs)
  {
    using Line    = std::pair<int, DesignThreshold>;
    const auto of = [](auto member) { return [member](const Line &line) { return Entry(line.second.*member); }; };

    return Table(Columns<Line>{{"design", "-", &Line::first},
                               {"mu", "-", of(&DesignThreshold::friction_coefficient), 6},
                               {"uncertainty", "-", of(&DesignThreshold::uncertainty), 1, true},
                               {"event", "", of(&DesignThreshold::event)},
                               {"mechanism", "", of(&DesignThreshold::mechanism)},
                               {"label", "", of(&DesignThreshold::label)},
                               {"overlap with reference", "-", [](const Line &line) { return overlap_cell(line.second.overlap); }, 3},
                               {"partner label", "", of(&DesignThreshold::partner)},
                               {"frequency", "Hz", of(&DesignThreshold::frequency), 3}},
                 of_all(designs, &DesignResult::thresholds));
  }

  Table design_mode_table(const std::vector<DesignResult> &designs)
  {
    using Line         = std::pair<int, DesignMode>;
    const auto of      = [](auto member) { return [member](const Line &line) { return Entry(line.second.*member); }; };
    const auto percent = [](double DesignMode::*member) {
      return [member](const Line &line) { return Entry(100. * line.second.*member); };
    };

    return Table(Columns<Line>{{"design", "-", &Line::first},
                               {"label", "", of(&DesignMode::label)},
                               {"own label", "", of(&DesignMode::own_label)},
                               {"overlap with reference", "-", [](const Line &line) { return overlap_cell(line.second.overlap); }, 3},
                               {"frequency at smallest mu", "Hz", of(&DesignMode::first_frequency), 3},
                               {"largest mu", "-", of(&DesignMode::last_friction_coefficient), 4},
                               {"frequency", "Hz", of(&DesignMode::last_frequency), 3},
                               {"growth rate", "1/s", of(&DesignMode::last_growth_rate), 4},
                               {"divergence rate", "%", percent(&DesignMode::last_divergence_rate), 4},
                               {"estimated error of lambda", "-", of(&DesignMode::last_error), 1, true},
                               {"verdict", "", of(&DesignMode::verdict)},
                               {"largest divergence rate", "%", percent(&DesignMode::largest_divergence_rate), 4},
                               {"onset", "-", [](const Line &line) { return line.second.onset ? Entry(*line.second.onset) : Entry(); }, 6}},
                 of_all(designs, &DesignResult::modes));
  }

  Table quietest_designs(const std::vector<std::string> &names, const std::vector<DesignResult> &designs)
  {
    std::vector<DesignResult> rows = by_quietness(designs);
    rows.resize(std::min(rows.size(), n_shown));
    Columns<DesignResult> columns = variable_columns(names);
    columns.push_back({"mu of 0.01 %", "-", at(&DesignResult::weak_onset, &DesignGrowth::friction_coefficient), 5});
    columns.push_back({"label", "", at(&DesignResult::weak_onset, &DesignGrowth::label)});
    columns.push_back({"largest rate", "%", at(&DesignResult::worst, &DesignGrowth::divergence_rate, 100.), 4});
    columns.push_back({"label", "", at(&DesignResult::worst, &DesignGrowth::label)});
    columns.push_back({"frequency", "Hz", at(&DesignResult::worst, &DesignGrowth::frequency), 2});
    columns.push_back({"unstable", "-", &DesignResult::n_unstable});
    columns.push_back({"estimated error", "-", &DesignResult::largest_error, 1, true});
    return Table(columns, rows);
  }

  std::vector<std::string> verdict(const std::vector<std::string> &names, const std::vector<DesignResult> &designs)
  {
    std::vector<std::string>        lines;
    const std::vector<DesignResult> ordered = by_quietness(designs);
    if (!ordered.empty())
      lines.push_back("  quietest: " + described(names, ordered.front()));
    if (ordered.size() > 1)
      {
        const auto rate = [](const DesignResult &row) { return row.worst ? row.worst->divergence_rate : 0.; };
        lines.push_back(
          "  largest divergence rate: " +
          described(names, *std::max_element(ordered.begin(), ordered.end(),
                                             [&](const DesignResult &a, const DesignResult &b) { return rate(a) < rate(b); })));
      }
    const auto n = [&](const DesignOutcome outcome) {
      return std::count_if(designs.begin(), designs.end(), [outcome](const DesignResult &row) { return row.outcome == outcome; });
    };
    lines.push_back(text("  ", counted(designs.size(), "design"), ": ", n(DesignOutcome::solved), " solved, ", n(DesignOutcome::refused),
                         " refused, ", n(DesignOutcome::failed), " failed"));
    const auto n_incomplete = std::count_if(
      designs.begin(), designs.end(), [](const DesignResult &row) { return row.outcome == DesignOutcome::solved && !row.is_complete; });
    if (n_incomplete > 0)
      lines.push_back(
        text("  note: designs in which the number of modes differs from a count: ", n_incomplete, " (column `complete` of designs.csv)"));
    return lines;
  }
} // namespace Squeal
