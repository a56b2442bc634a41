// SPDX-License-Identifier: GPL-3.0-or-later

#include "geometry/scenes.h"
#include "printed.h"

#include <squeal/parameters/geometry.h>

using namespace Scenes;
using Squeal::Testing::printed;

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

TEST(AccuracyGoal, MeshesAreFinerAndToleranceSmallerFromGoalToGoal)
{
  EXPECT_EQ(printed(with_goal(Parameters())), printed(Parameters()));
  for (std::size_t g = 0; g < goals.size(); ++g)
    {
      const Parameters fine = with_goal(goal(goals[g])), coarse = with_coarser_mesh(goal(goals[g]));
      fine.check();
      coarse.check();
      // with_goal() is idempotent, so that a run can be repeated from the parameters that it writes
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

  // The element size is proportional to the bending wavelength, that is, to 1/√f
  Parameters fast                       = goal(AccuracyGoal::one_percent);
  fast.discretization.maximum_frequency = 4. * reference.discretization.maximum_frequency;
  fast                                  = with_goal(fast);
  EXPECT_NEAR(fast.geometry.element_size / reference.geometry.element_size, 0.5, 0.1);
  EXPECT_GT(fast.geometry.disc_layers, reference.geometry.disc_layers);
  Parameters slow                       = goal(AccuracyGoal::one_percent);
  slow.discretization.maximum_frequency = 10.;
  slow                                  = with_goal(slow);
  slow.check();

  // A model that is 1000 times smaller, at 1000 times the frequency, has the same mesh
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

  // User-defined meshes cannot be adapted
  Parameters own    = goal(AccuracyGoal::one_percent);
  own.geometry.file = SQUEAL_SOURCE_DIRECTORY "/tests/no.msh";
  EXPECT_THROW(with_goal(own), Error);
}

TEST(CoarserMesh, SetsParametersOfTheGeometry)
{
  Parameters fine;
  fine.discretization.coarser_mesh = "Element size = 0.02, Disc layers = 1";
  const Parameters coarse          = with_coarser_mesh(fine);
  EXPECT_EQ(coarse.geometry.element_size, 0.02);
  EXPECT_EQ(coarse.geometry.disc_layers, 1u);
  EXPECT_GT(coarse.discretization.maximum_frequency, fine.discretization.maximum_frequency);
  EXPECT_TRUE(coarse.discretization.coarser_mesh.empty());
  EXPECT_EQ(error_by_difference(fine.goal), 1.);
  fine.discretization.coarser_mesh = "disc_pad.geo";
  EXPECT_EQ(with_coarser_mesh(fine).geometry.file, "disc_pad.geo");
}

TEST(MeshFamily, ScalesElementsLayersAndPinFaces)
{
  // Default mesh: elements of 11.5 mm, 19 = 1 + 3 k (k + 1) nodes per pin face (k = 2), 4 pin layers and 3 disc layers
  for (const auto &[factor, size, nodes, of_pin, of_disc] :
       std::vector<std::tuple<double, double, unsigned int, unsigned int, unsigned int>>{{1., 0.0115, 19, 4, 3},
                                                                                         {2., 0.00575, 61, 8, 6},
                                                                                         {1.5, 0.0115 / 1.5, 37, 6, 5},
                                                                                         {0.5, 0.023, 7, 2, 2},
                                                                                         {0.2, 0.0575, 7, 1, 1}})
    {
      const GeometryParameters result = refined({}, factor);
      EXPECT_NEAR(result.element_size, size, 1e-15) << factor;
      EXPECT_EQ(result.nodes_per_pin_face, nodes) << factor;
      EXPECT_EQ(result.pin_layers, of_pin) << factor;
      EXPECT_EQ(result.disc_layers, of_disc) << factor;
      result.check();
    }

  // Refinement keeps the bodies; volumes differ only because outlines are polygons
  const Mesh coarse = generate_mesh(one_pin()), fine = generate_mesh(refined(one_pin(), 2.));
  EXPECT_EQ(coarse.volume_names, fine.volume_names);
  EXPECT_GT(fine.cells.size(), 6 * coarse.cells.size());
  EXPECT_LT(fine.cells.size(), 10 * coarse.cells.size());
  EXPECT_NEAR(volume(fine, "disc") / volume(coarse, "disc"), 1., 0.02);
}

TEST(MeshFamily, RefusesMeshesThatDoNotFollow)
{
  const File mesh("bodies.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"disc\"\n$EndPhysicalNames\n");
  const File solid("bodies.geo", "Box(1) = {0, 0, 0, 1, 1, 1};\nPhysical Volume(\"disc\") = {1};\n");
  for (const std::string &file : {mesh.string(), solid.string()})
    {
      expect_mentions(message<ParameterError>([&] { refined(of_file(file), 2.); }),
                      {file, "cannot be changed", "Geometry/Element size", "element_size"});
      EXPECT_EQ(refined(of_file(file), 1.).element_size, GeometryParameters().element_size);
    }
  EXPECT_THROW(refined(of_file("missing.geo"), 2.), MeshError);
}
