#pragma once

#include <squeal/output/table.h>
#include <squeal/studies/ingredients/ingredient_effects.h>
#include <squeal/studies/ingredients/ingredients.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// What came of a change of the model, or why it could not be made.
  struct IngredientResult
  {
    const Ingredient *ingredient; ///< null for several changes together
    std::string       name, here, tried;
    std::string       obstacle = {}; ///< empty if it was made; else nothing below has a meaning
    Effect            effect   = {};
    double            severity = 0.; ///< see Effect::severity()
    StepCosts         costs    = {};
    int               n_dofs   = 0;

    std::vector<std::string> answer = {}; ///< the verdict of the variant, line by line
  };

  /// One row for each change: what was changed, its largest effects, the verdict, and what the variant costs beside the reference.
  Table ingredient_table(const std::vector<IngredientResult> &results, const ReferenceModel &reference);

  /// The same in fewer columns, for the screen.
  Table short_ingredient_table(const std::vector<IngredientResult> &results, const ReferenceModel &reference);

  /// Every mode of every variant beside that of the reference.
  Table ingredient_mode_table(const std::vector<IngredientResult> &results);

  /// "0.12 % in frequency (A0-4 +) and 0.003 percentage points in divergence rate (F1)"
  std::string largest_changes(const Effect &effect);
} // namespace Squeal
