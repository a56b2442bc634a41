// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/parameters/parameter_file.h>
#include <squeal/studies/ingredients/ingredients.h>
#include <squeal/studies/steps/parameter_usage.h>

#include <ostream>

namespace Squeal
{
  namespace
  {
    /// A column with entries only for changes that were made.
    template <typename Value>
    Column<IngredientResult> where_made(const std::string &name, const std::string &unit, const Value &value, const int digits = 3)
    {
      return {name, unit, [value](const IngredientResult &row) { return row.obstacle.empty() ? Entry(value(row)) : Entry(); }, digits};
    }

    /// Smaller changes are due to rounding or solver tolerances [%].
    constexpr double no_change = 1e-6;

    std::string amount(const double change)
    {
      return change < no_change ? "0" : decimal_text(change, 3);
    }

    std::string label_of(const LargestChange &change)
    {
      return change.amount < no_change ? "" : to_string(change.mode->label) + (change.mode->variant ? "" : " (lost)");
    }

    /// Modes of all results, each with its result.
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
                return value ? Entry(factor * (modal_quantities(*value).*quantity)) : Entry();
              }};
    }

    /// One row for each change; the screen shows fewer columns.
    Table ingredient_table(const std::vector<IngredientResult> &results, const ReferenceModel &reference, const bool is_short)
    {
      using Row            = IngredientResult;
      const double total   = reference.costs.sum(&Cost::cpu_seconds);
      const auto   name    = [is_short](const char *full, const char *brief) { return is_short ? brief : full; };
      Columns<Row> columns = {
        {"ingredient", "", &Row::name},
        {"reference", "", &Row::here},
        {"variant", "", [=](const Row &row) { return row.obstacle.empty() || !is_short ? row.tried : "-"; }},
        where_made(name("change of frequency", "frequency"), "%", [](const Row &row) { return row.effect.frequency().amount; }),
        where_made(name("mode of that change", "mode"), "", [](const Row &row) { return label_of(row.effect.frequency()); }),
        where_made(
          name("change of divergence rate", "divergence"), name("percentage points", "points"),
          [](const Row &row) { return row.effect.divergence().amount; }, is_short ? 4 : 3),
        where_made(name("mode of that change of divergence rate", "mode"), "",
                   [](const Row &row) { return label_of(row.effect.divergence()); })};
      const auto add = [&](const Column<Row> &column) { columns.push_back(column); };
      if (is_short)
        {
          add(where_made("unstable", "",
                         [](const Row &row) { return text(row.effect.n_unstable(false), " -> ", row.effect.n_unstable(true)); }));
          add(where_made("verdict", "", [](const Row &row) { return row.effect.changes_verdict() ? "changes" : "same"; }));
        }
      else
        {
          add(where_made("modes without counterpart", "-", [](const Row &row) { return row.effect.n_lost(); }));
          add(where_made("unstable modes in reference", "-", [](const Row &row) { return row.effect.n_unstable(false); }));
          add(where_made("unstable modes in variant", "-", [](const Row &row) { return row.effect.n_unstable(true); }));
          add(where_made("verdict changed", "-", [](const Row &row) { return row.effect.changes_verdict(); }));
          add(where_made("wall time", "s", [](const Row &row) { return row.costs.sum(&Cost::seconds); }));
          add(where_made("CPU time", "s", [](const Row &row) { return row.costs.sum(&Cost::cpu_seconds); }));
          add(where_made("dofs", "-", [](const Row &row) { return row.n_dofs; }));
        }
      add(where_made(
        name("cost relative to reference", "cost"), "-", [total](const Row &row) { return row.costs.sum(&Cost::cpu_seconds) / total; },
        is_short ? 2 : 3));
      if (!is_short)
        add({"reason not tried", "", &Row::obstacle});
      return Table(columns, results);
    }

    /// One row for each mode of each variant, with its counterpart in the reference.
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
          {"variant", "", [](const IngredientMode &row) { return row.result->tried; }},
          {"label", "", [](const IngredientMode &row) { return row.mode->label; }},
          modal_column("reference frequency", "Hz", &C::reference, &Q::frequency, 1.),
          modal_column("variant frequency", "Hz", &C::variant, &Q::frequency, 1.),
          modal_column("reference divergence rate", "%", &C::reference, &Q::divergence_rate, 100.),
          modal_column("variant divergence rate", "%", &C::variant, &Q::divergence_rate, 100.),
          {"change of frequency", "%",
           [](const IngredientMode &row) {
             return row.mode->reference && row.mode->variant ? Entry(row.mode->frequency(row.result->effect.band_end)) : Entry();
           }},
          {"change of divergence rate", "percentage points", [](const IngredientMode &row) { return row.mode->divergence(); }},
          {"unstable in reference", "-", [](const IngredientMode &row) { return row.mode->unstable_reference; }},
          {"unstable in variant", "-", [](const IngredientMode &row) { return row.mode->unstable_variant; }},
          {"overlap of shapes", "-",
           [](const IngredientMode &row) { return row.mode->variant && row.mode->reference ? Entry(row.mode->overlap) : Entry(); }},
          {"in cluster", "-", [](const IngredientMode &row) { return row.mode->in_cluster; }}},
        rows);
    }

    /// "0.12 % in frequency (A0-4 +), 0.003 percentage points in divergence rate (F1)"
    std::string largest_changes(const Effect &effect)
    {
      const auto of = [](const std::string &label) { return label.empty() ? "" : " (" + label + ")"; };
      return text(amount(effect.frequency().amount), " % in frequency", of(label_of(effect.frequency())), ", ",
                  amount(effect.divergence().amount), " percentage points in divergence rate", of(label_of(effect.divergence())),
                  effect.changes_verdict() ? "; the verdict changes" : "");
    }

    /// A change counts as faster if the CPU time of the whole model is below this fraction of the reference [-].
    constexpr double clearly_faster = 0.95;

    std::vector<std::string> answer_of(const SolvedModel &model)
    {
      return verdict(model.friction, model.parameters.discretization.maximum_frequency);
    }

    /// Solves a variant and compares it with the reference, as a step of the run; an error becomes an obstacle.
    void measure(IngredientResult &result, const ReferenceModel &reference, const Variation &variation, Run &run)
    {
      run.progress.begin(result.name + ": " + result.tried);
      try
        {
          const SolvedModel variant = solve_variant(reference, variation, run);
          result.effect             = effect_of(reference, variant);
          result.severity           = result.effect.severity(run.parameters.ingredients);
          result.costs              = variant.costs;
          result.n_dofs             = variant.scene->model->free_map().n();
          result.answer             = answer_of(variant);
        }
      // Store the error, so that the other variants are still solved
      catch (const Error &error)
        {
          result.obstacle = error.reason;
          run.progress.finish("not possible");
          return;
        }
      run.progress.finish(largest_changes(result.effect));
    }

    IngredientResult single_change(const Ingredient &ingredient, const ReferenceModel &reference, Run &run)
    {
      const Parameters &p = run.parameters;
      IngredientResult  result{&ingredient, ingredient.name, ingredient.here(p), ingredient.tried(p)};
      if (ingredient.obstacle != nullptr)
        if (const Reason reason = ingredient.obstacle(p, reference.frictionless.linearisation.sliding))
          result.obstacle = reason;
      if (result.obstacle.empty())
        measure(result, reference, combined(p, {&ingredient}), run);
      return result;
    }

    /// True if the cheapest model may include this change.
    bool makes_cheaper(const IngredientResult &result, const ReferenceModel &reference)
    {
      if (!result.obstacle.empty())
        return false;
      const ChangeKind kind = result.ingredient->kind;
      return kind == ChangeKind::removes || (kind == ChangeKind::speeds && result.costs.sum(&Cost::cpu_seconds) <
                                                                             clearly_faster * reference.costs.sum(&Cost::cpu_seconds));
    }

    /// "radial dissipation = none, rotation of the disc = off"
    std::string changes_text(const std::vector<const IngredientResult *> &changes)
    {
      std::string result;
      for (const IngredientResult *change : changes)
        result += (result.empty() ? "" : ", ") + change->name + " = " + change->tried;
      return result;
    }

    /// The cheapest model found, and its changes.
    struct CheapestModel
    {
      std::vector<const IngredientResult *> changes;
      std::vector<const IngredientResult *> put_back;
      IngredientResult                      together; ///< result of all changes combined; empty if there are no changes
      Parameters                            parameters;
    };

    CheapestModel cheapest_model(const std::vector<IngredientResult> &results, const ReferenceModel &reference, Run &run)
    {
      std::vector<const IngredientResult *> candidates;
      for (const IngredientResult &result : results)
        if (makes_cheaper(result, reference))
          candidates.push_back(&result);
      std::vector<CheaperChange> changes;
      for (const IngredientResult *candidate : candidates)
        changes.push_back({candidate->name, candidate->severity});

      const auto variation_of = [&](const std::vector<int> &chosen) {
        std::vector<const Ingredient *> changed;
        for (const int i : chosen)
          changed.push_back(candidates[i]->ingredient);
        return combined(run.parameters, changed);
      };
      const auto results_of = [&](const std::vector<int> &chosen) {
        std::vector<const IngredientResult *> list;
        for (const int i : chosen)
          list.push_back(candidates[i]);
        return list;
      };

      CheapestModel         model;
      const ChangesTogether found = cheapest_changes(changes, [&](const std::vector<int> &chosen) {
        model.together = {nullptr, "together", "", changes_text(results_of(chosen))};
        measure(model.together, reference, variation_of(chosen), run);
        return model.together.obstacle.empty() ? model.together.severity : std::numeric_limits<double>::infinity();
      });
      model.changes               = results_of(found.changes);
      model.put_back              = results_of(found.put_back);
      model.parameters            = variation_of(found.changes).parameters;
      if (model.changes.size() == 1)
        model.together = *model.changes.front();
      if (model.changes.empty())
        model.together.answer = answer_of(reference);
      return model;
    }

    void note_obstacles(const std::vector<IngredientResult> &results, Run &run)
    {
      for (const IngredientResult &result : results)
        if (!result.obstacle.empty())
          run.progress.note("  not possible: " + result.name + " = " + result.tried + " (" + result.obstacle + ")");
    }

    /// Reports features that the model lacks and whose effect exceeds the required accuracy, one line each.
    void note_missing(const std::vector<IngredientResult> &results, Run &run)
    {
      for (const IngredientResult &result : results)
        if (result.obstacle.empty() && result.ingredient != nullptr && result.ingredient->kind == ChangeKind::adds && result.severity > 1.)
          run.progress.note("  missing feature with a significant effect: " + result.name + " = " + result.tried + ", up to " +
                            largest_changes(result.effect));
    }

    /// Writes a parameter file with the non-default parameters that have an effect.
    void write_changed_parameters(std::ostream &stream, Parameters parameters)
    {
      Declarations declarations;
      parameters.declare(declarations);
      std::set<std::string> unused;
      for (const UnusedParameter &parameter : unused_parameters(parameters))
        unused.insert(parameter.path);
      std::string section;
      const auto  end_section = [&] { stream << (section.empty() ? "" : "end\n"); };
      for (const std::string &path : changed_parameters(parameters))
        {
          const auto slash = path.find('/');
          if (slash == std::string::npos || unused.count(path) > 0)
            continue; // omit the study, which is the default, and unused parameters
          if (path.substr(0, slash) != section)
            {
              end_section();
              section = path.substr(0, slash);
              stream << "subsection " << section << '\n';
            }
          stream << "  set " << path.substr(slash + 1) << " = " << written_value(declarations.find(path)->print()) << '\n';
        }
      end_section();
    }

    void write_parameter_file(const CheapestModel &cheapest, const std::vector<std::string> &lines, const Run &run)
    {
      Parameters parameters    = cheapest.parameters;
      parameters.study         = studies().front();
      parameters.ingredients   = {};
      parameters.geometry.file = copy_of(parameters.geometry.path()).name;
      run.folder().write("cheapest.prm", [&](std::ostream &stream) {
        for (const auto *part : {&lines, &cheapest.together.answer})
          for (const std::string &line : *part)
            stream << '#' << line.substr(1) << '\n';
        write_changed_parameters(stream, parameters);
      });
    }

    /// Describes the cheapest model, its changes and its savings.
    std::vector<std::string> sentences(const CheapestModel &cheapest, const ReferenceModel &reference)
    {
      const IngredientsParameters &accuracy = reference.parameters.ingredients;
      const std::string            asked =
        text(exact_text(accuracy.frequency_tolerance), " % and ", exact_text(accuracy.divergence_tolerance), " percentage points");
      if (cheapest.changes.empty())
        return {text("  cheapest model within ", asked, ": the given model")};
      const double here = reference.costs.sum(&Cost::cpu_seconds), there = cheapest.together.costs.sum(&Cost::cpu_seconds);
      const std::vector<std::string> result = {
        text("  cheapest model within ", asked, ": ", changes_text(cheapest.changes)),
        text("    largest changes: ", largest_changes(cheapest.together.effect),
             "; unstable modes: ", cheapest.together.effect.n_unstable(true), " instead of ", cheapest.together.effect.n_unstable(false)),
        text("    ", decimal_text(there, 3), " s of CPU time instead of ", decimal_text(here, 3), " s")};
      return result;
    }
  } // namespace

  /// `Study = ingredients`: varies each model feature individually and reports the effects on every mode and on the verdict, and the costs.
  /// Writes a parameter file of the cheapest model found that preserves the verdict and meets the required accuracy.
  static void run_ingredients_study(Scene &scene, Run &run)
  {
    const Parameters    &p         = run.parameters;
    const ReferenceModel reference = solve_reference(std::move(scene), run);

    std::vector<IngredientResult> results;
    for (const Ingredient *ingredient : ingredients_to_try(p))
      results.push_back(single_change(*ingredient, reference, run));
    const CheapestModel cheapest = cheapest_model(results, reference, run);
    if (cheapest.changes.size() > 1)
      results.push_back(cheapest.together);

    // ------------------------------------------------------------------- results
    run.screen << '\n';
    for (const std::string &line : answer_of(reference))
      run.progress.note(line);
    const std::vector<std::string> lines = sentences(cheapest, reference);
    for (const std::string &line : lines)
      run.progress.note(line);
    for (const IngredientResult *back : cheapest.put_back)
      run.progress.note("    not included, because the combined effect of all changes is too large or cannot be computed: " + back->name +
                        " = " + back->tried);
    note_missing(results, run);
    run.screen << '\n';
    ingredient_table(results, reference, true).print(run.screen);
    run.screen << '\n';
    note_obstacles(results, run);
    run.store_table("ingredients", ingredient_table(results, reference, false));
    run.store_table("ingredients_modes", ingredient_mode_table(results));
    write_parameter_file(cheapest, lines, run);
    run.progress.note("  parameter file: cheapest.prm");
    run.finish();
  }

  extern const Study ingredients_study = [] {
    Study study{"ingredients", run_ingredients_study, {"Ingredients/"}};
    study.rules = {{"Output/", [](const Parameters &) { return "not written by Study = ingredients"; }}};
    // Count these parameters as used, because variants with another contact state, dissipation or solver use them
    const auto of_use = [](const Parameters &) -> Reason { return nullptr; };
    for (const char *path : {"Operation/Load per side", "Operation/Rotation speed", "Steady sliding/", "Complex modes/"})
      study.rules.push_back({path, of_use});
    return study;
  }();
} // namespace Squeal
