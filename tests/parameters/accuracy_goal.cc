#include "printed.h"

#include <squeal/base/exceptions.h>
#include <squeal/parameters/parameters.h>

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  Parameters goal(const AccuracyGoal goal)
  {
    Parameters parameters;
    parameters.goal = goal;
    return parameters;
  }

  const std::vector<AccuracyGoal> goals = {AccuracyGoal::five_percent, AccuracyGoal::one_percent, AccuracyGoal::a_tenth_percent,
                                           AccuracyGoal::a_hundredth_percent};
} // namespace

TEST(AccuracyGoal, WithoutOneNothingChanges)
{
  EXPECT_EQ(printed(with_goal(Parameters())), printed(Parameters()));
}

TEST(AccuracyGoal, MeshesAreFinerAndToleranceSmallerFromGoalToGoal)
{
  for (std::size_t g = 0; g < goals.size(); ++g)
    {
      const Parameters fine = with_goal(goal(goals[g])), coarse = with_coarser_mesh(goal(goals[g]));
      fine.check();
      coarse.check();
      // Twice is once: a run repeats itself from the parameters that it leaves
      EXPECT_EQ(printed(with_goal(fine)), printed(fine));
      EXPECT_GT(coarse.discretization.maximum_frequency, fine.discretization.maximum_frequency);
      EXPECT_GE(coarse.geometry.element_size, fine.geometry.element_size);
      EXPECT_LT(coarse.geometry.pin_layers, fine.geometry.pin_layers);
      EXPECT_EQ(coarse.discretization.element, fine.discretization.element);
      if (g > 0)
        {
          const Parameters before = with_goal(goal(goals[g - 1]));
          EXPECT_LE(fine.solvers.iteration_tolerance, before.solvers.iteration_tolerance);
          EXPECT_LT(limits_of(goals[g]).frequency, limits_of(goals[g - 1]).frequency);
          EXPECT_NEAR(limits_of(goals[g]).divergence, 0.1 * limits_of(goals[g]).frequency, 1e-15);
        }
    }
}

TEST(AccuracyGoal, MeshesFollowTheScene)
{
  const Parameters reference = with_goal(goal(AccuracyGoal::one_percent));

  // Bending waves: ∝ 1/√f, and no longer than the plate is wide allows
  Parameters fast                       = goal(AccuracyGoal::one_percent);
  fast.discretization.maximum_frequency = 4. * reference.discretization.maximum_frequency;
  fast                                  = with_goal(fast);
  EXPECT_NEAR(fast.geometry.element_size / reference.geometry.element_size, 0.5, 0.1);
  EXPECT_GT(fast.geometry.disc_layers, reference.geometry.disc_layers);
  Parameters slow                       = goal(AccuracyGoal::one_percent);
  slow.discretization.maximum_frequency = 10.;
  slow                                  = with_goal(slow);
  slow.check();

  // Everything in another unit of length and time
  Parameters small = goal(AccuracyGoal::one_percent);
  small.discretization.maximum_frequency *= 1000.;
  for (double *length : {&small.geometry.disc_inner_radius, &small.geometry.disc_outer_radius, &small.geometry.disc_thickness,
                         &small.geometry.pin_diameter, &small.geometry.pin_height})
    *length /= 1000.;
  const GeometryParameters geometry = with_goal(small).geometry;
  EXPECT_NEAR(1000. * geometry.element_size, reference.geometry.element_size, 1e-12);
  EXPECT_EQ(geometry.disc_layers, reference.geometry.disc_layers);
  EXPECT_EQ(geometry.pin_layers, reference.geometry.pin_layers);

  // Tall pins have more layers
  Parameters tall          = goal(AccuracyGoal::one_percent);
  tall.geometry.pin_height = 4. * reference.geometry.pin_height;
  EXPECT_NEAR(with_goal(tall).geometry.pin_layers, 4. * reference.geometry.pin_layers, 1.);
}

TEST(AccuracyGoal, AMeshOfTheUsersOwnIsRefused)
{
  Parameters parameters    = goal(AccuracyGoal::one_percent);
  parameters.geometry.file = SQUEAL_SOURCE_DIRECTORY "/tests/no.msh";
  EXPECT_THROW(with_goal(parameters), Error);
}
