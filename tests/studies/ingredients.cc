// SPDX-License-Identifier: GPL-3.0-or-later

#include "printed.h"

#include <squeal/base/conventions.h>
#include <squeal/studies/ingredients/ingredients.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  /// The default model with trial values.
  Parameters plain_scene()
  {
    Parameters result;
    result.ingredients.trial_slope         = -0.01;
    result.ingredients.trial_damping_ratio = 1e-3;
    return result;
  }

  /// A model with every ingredient.
  Parameters rich_scene()
  {
    Parameters result;
    result.operation.radial_dissipation = RadialDissipation::published;
    result.operation.friction_slope     = -0.02;
    result.operation.rotating_disc      = true;
    result.sliding.state                = ContactState::steady_sliding;
    result.materials.pin.rayleigh_beta  = 1e-7;
    result.damping.modal_ratios         = {{100., 1e-4}};
    result.solvers.complex_solver       = ComplexSolver::residual_iteration;
    return result;
  }

  /// λ [rad/s] from a frequency [Hz] and a divergence rate [%].
  std::complex<double> eigenvalue(const double frequency, const double divergence)
  {
    const double omega = circular_frequency(frequency);
    return {divergence / 100. * omega, omega};
  }

  Effect effect(const std::vector<ModeChange> &modes)
  {
    return {modes, circular_frequency(5000.), 0, 0};
  }
} // namespace

TEST(Ingredients, ChangesAreMadeAndNothingElseInEveryScene)
{
  std::set<std::string> all;
  for (const Ingredient &ingredient : ingredients())
    all.insert(ingredient.name);
  for (const Parameters &scene : {Parameters(), plain_scene(), rich_scene()})
    {
      std::set<std::string> names;
      for (const Ingredient *ingredient : ingredients_to_try(scene))
        {
          names.insert(ingredient->name);
          const Variation changed = combined(scene, {ingredient});
          EXPECT_NO_THROW(changed.parameters.check()) << ingredient->name << " = " << ingredient->tried(scene);
          const bool possible = ingredient->obstacle == nullptr || ingredient->obstacle(scene, std::nullopt) == nullptr;
          if (possible && ingredient->kind != ChangeKind::shows)
            {
              EXPECT_FALSE(changed.without_lift_off || !changed.basis.empty()) << ingredient->name;
              EXPECT_NE(printed(changed.parameters), printed(scene)) << ingredient->name;
              // Repeating the change has no effect
              const Variation twice = combined(changed.parameters, {ingredient});
              EXPECT_EQ(printed(twice.parameters), printed(changed.parameters)) << ingredient->name;
            }
        }
      EXPECT_EQ(names, all);
    }
}

TEST(Ingredients, WhatASceneCannotHaveSaysWhy)
{
  std::set<std::string> refused;
  Parameters            scene;
  scene.operation.rotation_speed = 0.;
  for (const Ingredient *ingredient : ingredients_to_try(scene))
    if (ingredient->obstacle != nullptr && ingredient->obstacle(scene, std::nullopt) != nullptr)
      refused.insert(ingredient->name);
  EXPECT_EQ(refused, (std::set<std::string>{"radial dissipation", "contact state", "lift-off", "friction slope", "Rayleigh damping",
                                            "modal damping"}));
}

TEST(Ingredients, CombinationsDepartFromTheEarliestStep)
{
  const Parameters                scene = rich_scene();
  std::vector<const Ingredient *> removed;
  for (const Ingredient *ingredient : ingredients_to_try(scene))
    if (ingredient->kind == ChangeKind::removes)
      removed.push_back(ingredient);
  const Variation variation = combined(scene, removed);
  EXPECT_EQ(variation.departure, Departure::mesh);
  EXPECT_FALSE(variation.parameters.has_contact_damping());
  EXPECT_FALSE(variation.parameters.operation.rotating_disc);
  EXPECT_FALSE(variation.parameters.materials.pin.is_damped());
  EXPECT_TRUE(variation.parameters.damping.modal_ratios.empty());
  EXPECT_EQ(variation.parameters.sliding.state, ContactState::equal_load);
  EXPECT_EQ(combined(scene, {}).departure, Departure::friction);
}

// ---------------------------------------------------------------------- effects

TEST(IngredientEffects, TheLargestChangesCount)
{
  const Effect result = effect({{{}, eigenvalue(1000., 0.1), eigenvalue(1002., 0.1), true, true},
                                {{}, eigenvalue(2000., -1.), eigenvalue(1999., -0.7), false, false}});
  EXPECT_NEAR(result.frequency().amount, 0.2, 1e-12);
  EXPECT_EQ(result.frequency().mode, &result.modes[0]);
  EXPECT_NEAR(result.divergence().amount, 0.3, 1e-12);
  EXPECT_EQ(result.divergence().mode, &result.modes[1]);
  EXPECT_FALSE(result.changes_verdict());
  IngredientsParameters accuracy;
  accuracy.frequency_tolerance  = 0.1;
  accuracy.divergence_tolerance = 0.5;
  EXPECT_NEAR(result.severity(accuracy), 2., 1e-12);
}

TEST(IngredientEffects, GrowingModesButWeakOnesDecideAVerdict)
{
  const auto change = [](const double here, const double there) {
    return effect({{{}, eigenvalue(1000., here), eigenvalue(1000., there), here > 0., there > 0.}}).changes_verdict();
  };
  EXPECT_FALSE(change(0.009, -0.1)); // weak growth, below 0.01 %
  EXPECT_TRUE(change(0.011, -0.1));
  EXPECT_TRUE(change(-0.1, 0.011));
  EXPECT_FALSE(change(0.5, 0.005)); // grows in both models

  Effect divergence                 = effect({}); // static divergence
  divergence.n_growing_real_variant = 1;
  EXPECT_TRUE(divergence.changes_verdict());
  EXPECT_TRUE(std::isinf(divergence.severity({})));
}

TEST(IngredientEffects, ModesWithoutCounterpartCount)
{
  // A mode that leaves the band has changed its frequency at least to the end of the band
  const Effect lost = effect({{{}, eigenvalue(4900., 0.), std::nullopt}});
  EXPECT_NEAR(lost.frequency().amount, 100. * (5000. / 4900. - 1.), 1e-12);
  EXPECT_EQ(lost.n_lost(), 1u);
  EXPECT_EQ(lost.divergence().amount, 0.);
  EXPECT_FALSE(lost.changes_verdict());
  EXPECT_TRUE(effect({{{}, eigenvalue(4900., 0.2), std::nullopt, true}}).changes_verdict());
  EXPECT_TRUE(effect({{{}, std::nullopt, eigenvalue(4900., 0.2), false, true}}).changes_verdict());
  // A mode above the end of a narrower band is not compared
  Effect shorter   = lost;
  shorter.band_end = circular_frequency(2500.);
  EXPECT_EQ(shorter.frequency().amount, 0.);
  EXPECT_EQ(shorter.n_lost(), 1u);
}

// -------------------------------------------------------------------- selection

TEST(IngredientSelection, CheapestChangesThatKeepTheAccuracyTogether)
{
  using Numbers = std::vector<int>;
  struct Case
  {
    std::vector<CheaperChange>                   changes;
    std::function<double(const Numbers &chosen)> severity_of;
    ChangesTogether                              expected;
  };
  const std::vector<CheaperChange> unlike = {{"a", 0.2}, {"b", 0.8}, {"c", 0.6}},
                                   of_one = {{"element", 3.}, {"element", 0.7}, {"element", 0.1}, {"a", 0.2}};
  const auto always                       = [](const double severity) { return [severity](const Numbers &) { return severity; }; };
  const auto sum                          = [&](const Numbers &chosen) {
    return std::accumulate(chosen.begin(), chosen.end(), 0., [&](const double s, const int i) { return s + unlike[i].severity; });
  };
  for (const auto &[changes, severity_of, expected] :
       std::vector<Case>{// All changes with a severity below 1 meet the accuracy together
                         {{{"a", 0.2}, {"b", 1.5}, {"c", 0.9}}, always(0.95), {{0, 2}, {}, 1, 0.95}},
                         // The change with the largest effect is reverted
                         {unlike, sum, {{0, 2}, {1}, 2, 0.8}},
                         // The first sufficient change of an ingredient is made, or the next one if the combination is too inaccurate
                         {of_one, always(0.9), {{1, 3}, {}, 1, 0.9}},
                         {of_one, [](const Numbers &chosen) { return chosen.front() == 1 ? 1.2 : 0.4; }, {{2, 3}, {1}, 2, 0.4}},
                         // A single change, or none, requires no further solution
                         {{{"a", 0.3}, {"b", INFINITY}}, nullptr, {{0}, {}, 0, 0.3}},
                         {{{"a", 1.1}}, nullptr, {{}, {}, 0, 0.}},
                         {{}, nullptr, {{}, {}, 0, 0.}},
                         // Of two incompatible changes, the change with the smaller effect remains
                         {{{"a", 0.3}, {"b", 0.4}}, always(INFINITY), {{0}, {1}, 1, 0.3}}})
    {
      const ChangesTogether found = cheapest_changes(changes, severity_of);
      EXPECT_EQ(found.changes, expected.changes);
      EXPECT_EQ(found.put_back, expected.put_back);
      EXPECT_EQ(found.n_solved, expected.n_solved);
      EXPECT_NEAR(found.severity, expected.severity, 1e-12);
    }
}
