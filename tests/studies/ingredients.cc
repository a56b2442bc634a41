#include "printed.h"

#include <squeal/base/conventions.h>
#include <squeal/studies/ingredients/ingredients.h>

#include <gtest/gtest.h>

#include <cmath>
#include <set>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  /// The default scene with values to try.
  Parameters plain_scene()
  {
    Parameters result;
    result.ingredients.trial_slope         = -0.01;
    result.ingredients.trial_damping_ratio = 1e-3;
    return result;
  }

  /// A scene that has every ingredient.
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

  std::set<std::string> names(const std::vector<const Ingredient *> &list)
  {
    std::set<std::string> result;
    for (const Ingredient *ingredient : list)
      result.insert(ingredient->name);
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

TEST(Ingredients, EveryOneHasARowInEveryScene)
{
  std::vector<const Ingredient *> all;
  for (const Ingredient &ingredient : ingredients())
    all.push_back(&ingredient);
  for (const Parameters &scene : {Parameters(), plain_scene(), rich_scene()})
    EXPECT_EQ(names(ingredients_to_try(scene)), names(all));
}

TEST(Ingredients, AChangeIsMadeAndNothingElse)
{
  for (const Parameters &scene : {plain_scene(), rich_scene()})
    for (const Ingredient *ingredient : ingredients_to_try(scene))
      {
        const Variation changed = combined(scene, {ingredient});
        EXPECT_NO_THROW(changed.parameters.check()) << ingredient->name << " = " << ingredient->tried(scene);
        const bool is_shown = changed.without_lift_off || !changed.basis.empty();
        const bool possible = ingredient->obstacle == nullptr || ingredient->obstacle(scene, std::nullopt) == nullptr;
        if (possible && ingredient->kind != ChangeKind::shows)
          {
            EXPECT_FALSE(is_shown) << ingredient->name;
            EXPECT_NE(printed(changed.parameters), printed(scene)) << ingredient->name;
            // Once made it is not made again
            const Variation twice = combined(changed.parameters, {ingredient});
            EXPECT_EQ(printed(twice.parameters), printed(changed.parameters)) << ingredient->name;
          }
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

TEST(IngredientEffects, WeakModesDoNotDecideAVerdict)
{
  const auto change = [](const double here, const double there) {
    return effect({{{}, eigenvalue(1000., here), eigenvalue(1000., there), here > 0., there > 0.}}).changes_verdict();
  };
  EXPECT_FALSE(change(0.009, -0.1)); // weak: below 0.01 %
  EXPECT_TRUE(change(0.011, -0.1));
  EXPECT_TRUE(change(-0.1, 0.011));
  EXPECT_FALSE(change(0.5, 0.005)); // it grows in both
}

TEST(IngredientEffects, ModesWithoutCounterpartCount)
{
  // A mode that leaves the band has moved at least to its end
  const Effect lost = effect({{{}, eigenvalue(4900., 0.), std::nullopt}});
  EXPECT_NEAR(lost.frequency().amount, 100. * (5000. / 4900. - 1.), 1e-12);
  EXPECT_EQ(lost.n_lost(), 1u);
  EXPECT_EQ(lost.divergence().amount, 0.);
  EXPECT_FALSE(lost.changes_verdict());
  EXPECT_TRUE(effect({{{}, eigenvalue(4900., 0.2), std::nullopt, true}}).changes_verdict());
  EXPECT_TRUE(effect({{{}, std::nullopt, eigenvalue(4900., 0.2), false, true}}).changes_verdict());
  // One that lies beyond the end of a shorter band is not there to be compared
  Effect shorter   = lost;
  shorter.band_end = circular_frequency(2500.);
  EXPECT_EQ(shorter.frequency().amount, 0.);
  EXPECT_EQ(shorter.n_lost(), 1u);
}

TEST(IngredientEffects, StaticDivergenceIsAVerdict)
{
  Effect result                 = effect({});
  result.n_growing_real_variant = 1;
  EXPECT_TRUE(result.changes_verdict());
  EXPECT_TRUE(std::isinf(result.severity({})));
}

// -------------------------------------------------------------------- selection

TEST(IngredientSelection, AllThatKeepTheAccuracyTogether)
{
  const std::vector<CheaperChange> changes = {{"a", 0.2}, {"b", 1.5}, {"c", 0.9}};
  const ChangesTogether            found   = cheapest_changes(changes, [](const std::vector<int> &) { return 0.95; });
  EXPECT_EQ(found.changes, (std::vector<int>{0, 2}));
  EXPECT_TRUE(found.put_back.empty());
  EXPECT_EQ(found.n_solved, 1);
  EXPECT_EQ(found.severity, 0.95);
}

TEST(IngredientSelection, TheMostImportantOneIsPutBack)
{
  const std::vector<CheaperChange> changes = {{"a", 0.2}, {"b", 0.8}, {"c", 0.6}};
  const ChangesTogether            found   = cheapest_changes(changes, [&](const std::vector<int> &chosen) {
    double sum = 0.;
    for (const int i : chosen)
      sum += changes[i].severity;
    return sum;
  });
  EXPECT_EQ(found.changes, (std::vector<int>{0, 2}));
  EXPECT_EQ(found.put_back, std::vector<int>{1});
  EXPECT_EQ(found.n_solved, 2);
  EXPECT_NEAR(found.severity, 0.8, 1e-12);
}

TEST(IngredientSelection, OfOneIngredientTheSimplestThatServes)
{
  const std::vector<CheaperChange> changes = {{"element", 3.}, {"element", 0.7}, {"element", 0.1}, {"a", 0.2}};
  EXPECT_EQ(cheapest_changes(changes, [](const std::vector<int> &) { return 0.9; }).changes, (std::vector<int>{1, 3}));
  // Too much together: the next one of the ingredient
  const ChangesTogether found = cheapest_changes(changes, [](const std::vector<int> &chosen) { return chosen.front() == 1 ? 1.2 : 0.4; });
  EXPECT_EQ(found.changes, (std::vector<int>{2, 3}));
  EXPECT_EQ(found.put_back, std::vector<int>{1});
}

TEST(IngredientSelection, OneAloneAndNone)
{
  const auto never = [](const std::vector<int> &) -> double {
    ADD_FAILURE() << "solved again";
    return 0.;
  };
  const ChangesTogether one = cheapest_changes({{"a", 0.3}, {"b", INFINITY}}, never);
  EXPECT_EQ(one.changes, std::vector<int>{0});
  EXPECT_EQ(one.severity, 0.3);
  EXPECT_TRUE(cheapest_changes({{"a", 1.1}}, never).changes.empty());
  EXPECT_TRUE(cheapest_changes({}, never).changes.empty());
  // Two that contradict each other: the smaller one is left
  EXPECT_EQ(cheapest_changes({{"a", 0.3}, {"b", 0.4}}, [](const std::vector<int> &) { return INFINITY; }).changes, std::vector<int>{0});
}
