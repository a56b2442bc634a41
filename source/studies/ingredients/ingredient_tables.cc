#include <squeal/base/conventions.h>
#include <squeal/studies/ingredients/ingredient_tables.h>

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

  Table ingredient_table(const std::vector<IngredientResult> &results, const ReferenceModel &reference)
  {
    const double total = reference.costs.cpu_seconds();
    return Table(
      Columns<IngredientResult>{
        {"ingredient", "", &IngredientResult::name},
        {"here", "", &IngredientResult::here},
        {"tried", "", &IngredientResult::tried},
        where_made("change of frequency", "%", [](const IngredientResult &row) { return row.effect.frequency(); }),
        where_made("mode of that change", "",
                   [](const IngredientResult &row) { return label_of(row.effect.largest_frequency(), row.effect.frequency()); }),
        where_made("change of divergence rate", "percentage points", [](const IngredientResult &row) { return row.effect.divergence(); }),
        where_made("mode of that change of divergence rate", "",
                   [](const IngredientResult &row) { return label_of(row.effect.largest_divergence(), row.effect.divergence()); }),
        where_made("modes without counterpart", "-", [](const IngredientResult &row) { return row.effect.n_lost(); }),
        where_made("unstable modes here", "-", [](const IngredientResult &row) { return row.effect.n_unstable(false); }),
        where_made("unstable modes tried", "-", [](const IngredientResult &row) { return row.effect.n_unstable(true); }),
        where_made("verdict changed", "-", [](const IngredientResult &row) { return row.effect.changes_verdict() ? 1 : 0; }),
        where_made("wall time", "s", [](const IngredientResult &row) { return row.costs.seconds(); }),
        where_made("processor time", "s", [](const IngredientResult &row) { return row.costs.cpu_seconds(); }),
        where_made("dofs", "-", [](const IngredientResult &row) { return row.n_dofs; }),
        where_made("cost beside the reference", "-", [total](const IngredientResult &row) { return row.costs.cpu_seconds() / total; }),
        {"not tried because", "", &IngredientResult::obstacle}},
      results);
  }

  Table short_ingredient_table(const std::vector<IngredientResult> &results, const ReferenceModel &reference)
  {
    const double total = reference.costs.cpu_seconds();
    return Table(
      Columns<IngredientResult>{
        {"ingredient", "", &IngredientResult::name},
        {"here", "", &IngredientResult::here},
        {"tried", "", [](const IngredientResult &row) { return row.obstacle.empty() ? row.tried : "-"; }},
        where_made("frequency", "%", [](const IngredientResult &row) { return row.effect.frequency(); }),
        where_made("mode", "",
                   [](const IngredientResult &row) { return label_of(row.effect.largest_frequency(), row.effect.frequency()); }),
        where_made(
          "divergence", "points", [](const IngredientResult &row) { return row.effect.divergence(); }, 4),
        where_made("mode", "",
                   [](const IngredientResult &row) { return label_of(row.effect.largest_divergence(), row.effect.divergence()); }),
        where_made("unstable", "",
                   [](const IngredientResult &row) { return text(row.effect.n_unstable(false), " -> ", row.effect.n_unstable(true)); }),
        where_made("verdict", "",
                   [](const IngredientResult &row) { return row.effect.changes_verdict() ? std::string("changes") : "same"; }),
        where_made(
          "cost", "-", [total](const IngredientResult &row) { return row.costs.cpu_seconds() / total; }, 2)},
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
