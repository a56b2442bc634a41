#include <squeal/base/conventions.h>
#include <squeal/studies/ingredients/ingredients.h>

namespace Squeal
{
  namespace
  {
    /// A column that only has values where the change was made.
    template <typename Value>
    Column<IngredientResult> where_made(const std::string &name, const std::string &unit, const Value &value, const int digits = 3)
    {
      return {name, unit, [value](const IngredientResult &row) { return row.obstacle.empty() ? Cell(value(row)) : Cell(); }, digits};
    }

    /// Smaller changes are rounding, or the tolerances of solvers [%].
    constexpr double no_change = 1e-6;

    std::string amount(const double change)
    {
      return change < no_change ? "0" : decimal_text(change, 3);
    }

    std::string label_of(const ModeChange *mode, const double change)
    {
      if (mode == nullptr || change < no_change)
        return "";
      return to_string(mode->label) + (mode->variant ? "" : " (lost)");
    }

    /// Modes of the results one after the other, each with its result.
    struct IngredientMode
    {
      const IngredientResult *result;
      const ModeChange       *mode;
    };

    Column<IngredientMode> modal_column(const std::string                  &name,
                                        const std::string                  &unit,
                                        std::optional<std::complex<double>> ModeChange::*lambda,
                                        double ModalQuantities::*quantity,
                                        const double             factor)
    {
      return {name, unit, [=](const IngredientMode &row) {
                const auto &value = row.mode->*lambda;
                return value ? Cell(factor * (modal_quantities(*value).*quantity)) : Cell();
              }};
    }
  } // namespace

  Table ingredient_table(const std::vector<IngredientResult> &results, const ReferenceModel &reference, const bool is_short)
  {
    using Row           = IngredientResult;
    const double total  = reference.costs.sum(&Cost::cpu_seconds);
    const auto   column = [is_short](const char *name, const char *short_name, const char *unit, const auto &value, const int digits = 3) {
      return where_made(is_short ? short_name : name, unit, value, digits);
    };
    const auto frequency      = column("change of frequency", "frequency", "%", [](const Row &row) { return row.effect.frequency(); });
    const auto frequency_mode = column("mode of that change", "mode", "",
                                       [](const Row &row) { return label_of(row.effect.largest_frequency(), row.effect.frequency()); });
    const auto divergence     = column(
          "change of divergence rate", "divergence", is_short ? "points" : "percentage points",
          [](const Row &row) { return row.effect.divergence(); }, is_short ? 4 : 3);
    const auto divergence_mode = column("mode of that change of divergence rate", "mode", "",
                                        [](const Row &row) { return label_of(row.effect.largest_divergence(), row.effect.divergence()); });
    const auto cost            = column(
                 "cost beside the reference", "cost", "-", [total](const Row &row) { return row.costs.sum(&Cost::cpu_seconds) / total; },
      is_short ? 2 : 3);
    if (is_short)
      return Table(
        Columns<Row>{
          {"ingredient", "", &Row::name},
          {"here", "", &Row::here},
          {"tried", "", [](const Row &row) { return row.obstacle.empty() ? row.tried : "-"; }},
          frequency,
          frequency_mode,
          divergence,
          divergence_mode,
          where_made("unstable", "",
                     [](const Row &row) { return text(row.effect.n_unstable(false), " -> ", row.effect.n_unstable(true)); }),
          where_made("verdict", "", [](const Row &row) { return row.effect.changes_verdict() ? std::string("changes") : "same"; }),
          cost},
        results);
    return Table(Columns<Row>{{"ingredient", "", &Row::name},
                              {"here", "", &Row::here},
                              {"tried", "", &Row::tried},
                              frequency,
                              frequency_mode,
                              divergence,
                              divergence_mode,
                              where_made("modes without counterpart", "-", [](const Row &row) { return row.effect.n_lost(); }),
                              where_made("unstable modes here", "-", [](const Row &row) { return row.effect.n_unstable(false); }),
                              where_made("unstable modes tried", "-", [](const Row &row) { return row.effect.n_unstable(true); }),
                              where_made("verdict changed", "-", [](const Row &row) { return row.effect.changes_verdict() ? 1 : 0; }),
                              where_made("wall time", "s", [](const Row &row) { return row.costs.sum(&Cost::seconds); }),
                              where_made("processor time", "s", [](const Row &row) { return row.costs.sum(&Cost::cpu_seconds); }),
                              where_made("dofs", "-", [](const Row &row) { return row.n_dofs; }),
                              cost,
                              {"not tried because", "", &Row::obstacle}},
                 results);
  }

  Table ingredient_mode_table(const std::vector<IngredientResult> &results)
  {
    std::vector<IngredientMode> rows;
    for (const IngredientResult &result : results)
      for (const ModeChange &mode : result.effect.modes)
        rows.push_back({&result, &mode});
    using C = ModeChange;
    using Q = ModalQuantities;
    return Table(
      Columns<IngredientMode>{
        {"ingredient", "", [](const IngredientMode &row) { return row.result->name; }},
        {"tried", "", [](const IngredientMode &row) { return row.result->tried; }},
        {"label", "", [](const IngredientMode &row) { return row.mode->label; }},
        modal_column("frequency here", "Hz", &C::reference, &Q::frequency, 1.),
        modal_column("frequency tried", "Hz", &C::variant, &Q::frequency, 1.),
        modal_column("divergence rate here", "%", &C::reference, &Q::divergence_rate, 100.),
        modal_column("divergence rate tried", "%", &C::variant, &Q::divergence_rate, 100.),
        {"change of frequency", "%",
         [](const IngredientMode &row) {
           return row.mode->reference && row.mode->variant ? Cell(row.mode->frequency(row.result->effect.band_end)) : Cell();
         }},
        {"change of divergence rate", "percentage points", [](const IngredientMode &row) { return row.mode->divergence(); }},
        {"unstable here", "-", [](const IngredientMode &row) { return row.mode->unstable_reference; }},
        {"unstable tried", "-", [](const IngredientMode &row) { return row.mode->unstable_variant; }},
        {"overlap of shapes", "-",
         [](const IngredientMode &row) { return row.mode->variant && row.mode->reference ? Cell(row.mode->overlap) : Cell(); }},
        {"in cluster", "-", [](const IngredientMode &row) { return row.mode->in_cluster; }}},
      rows);
  }

  std::string largest_changes(const Effect &effect)
  {
    const auto of = [](const std::string &label) { return label.empty() ? "" : " (" + label + ")"; };
    return text(amount(effect.frequency()), " % in frequency", of(label_of(effect.largest_frequency(), effect.frequency())), ", ",
                amount(effect.divergence()), " percentage points in divergence rate",
                of(label_of(effect.largest_divergence(), effect.divergence())), effect.changes_verdict() ? "; the verdict changes" : "");
  }
} // namespace Squeal
