// SPDX-License-Identifier: GPL-3.0-or-later

#include "boxes.h"
#include "faces.h"
#include "solutions.h"

#include <gtest/gtest.h>

#include <iostream>
#include <thread>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  OperationParameters moving(const std::string &velocity, const Rotation rotation = Rotation::positive)
  {
    OperationParameters operation = operating(RadialDissipation::consistent, rotation);
    operation.sliding_direction   = velocity;
    return operation;
  }

  /// An off-centre block on a straight rail along x.
  Mesh block_on_rail()
  {
    Mesh mesh;
    add_box(mesh, {Cut::hexahedra, {{8, 2, 1}}, {-0.2, -0.03, -0.05}, {0.4, 0.05, 0.}, 0.}, "disc", {{"disc_bore", "disc_contact"}});
    add_box(mesh, {Cut::hexahedra, {{3, 2, 1}}, {0.07, -0.02, 0.}, {0.2, 0.04, 0.06}, 0.}, "pin_top_1", {{"pin_contact", "pin_clamp"}});
    return mesh;
  }

  Mesh turned_by_90_degrees(const Mesh &mesh)
  {
    return mapped(mesh, [](const Point3 &p) { return Point3{{-p[1], p[0], p[2]}}; });
  }

  const std::vector<Mount> resting = {{"disc_bore", 1e10, 1e10, 1e10}}; // an isotropic mount

  std::vector<std::complex<double>> eigenvalues(const Mesh &mesh, const OperationParameters &operation)
  {
    const Scene       s(mesh, mounted(resting), operation);
    const auto        matrices = with_friction(s.coupled, 0.5);
    const DenseMatrix damping  = to_dense(*matrices.damping);
    return dense_quadratic_modes(to_dense(*matrices.mass), &damping, to_dense(*matrices.stiffness), 1e9).values;
  }

  ContactInterface nodes(const Mesh &mesh, const SlidingVelocity &velocity)
  {
    return contact_nodes(Model(mesh, Element::trilinear, MPI_COMM_WORLD), ContactParameters().pairs, velocity, 1e-6).interface;
  }
} // namespace

TEST(SlidingVelocity, IsRotationAboutTheAxisUnlessGiven)
{
  const Mesh mesh = mesh_of(skewed_pins);
  for (const Rotation rotation : {Rotation::positive, Rotation::negative})
    {
      const auto given = nodes(mesh, {rotation, "0 - y, x * cos(0), sin(pi) * 0"}), twice = nodes(mesh, {rotation, "-2 * y, 2 * x, 0"}),
                 usual = nodes(mesh, rotation);
      for (std::size_t c = 0; c < usual.size(); ++c)
        {
          EXPECT_LT((given[c].sliding - usual[c].sliding).norm(), 1e-15);
          EXPECT_LT((twice[c].sliding - usual[c].sliding).norm(), 1e-15);
          EXPECT_EQ(usual[c].lever, usual[c].axis_distance());
          EXPECT_NEAR(given[c].lever, usual[c].lever, 1e-15);
          EXPECT_NEAR(twice[c].lever, 2. * usual[c].lever, 1e-15);
          EXPECT_TRUE(given[c].turns && usual[c].turns && !twice[c].turns);
        }
      // Doubling the speed halves the damping
      OperationParameters       operation = operating(RadialDissipation::consistent, rotation);
      const std::vector<double> reactions(usual.size(), -3.);
      const auto c_b = radial_dissipation(usual, reactions, operation), less = radial_dissipation(twice, reactions, operation);
      for (std::size_t c = 0; c < usual.size(); ++c)
        EXPECT_NEAR(less[c], 0.5 * c_b[c], 1e-14 * c_b[c]);
    }
  EXPECT_EQ(SlidingVelocity(Rotation::negative).rigid_motion()->tail(1)[0], -1.);
  EXPECT_NEAR(
    (*SlidingVelocity(Rotation::positive, "2 - 3 * y, 3 * x - z, y").rigid_motion() - Eigen::Matrix<double, 6, 1>{{2., 0., 0., 1., 0., 3.}})
      .norm(),
    0., 1e-14);
  EXPECT_FALSE(SlidingVelocity(Rotation::positive, "1, x * x, 0").rigid_motion());
  EXPECT_FALSE(SlidingVelocity(Rotation::positive, "-y / sqrt(x^2 + y^2), x / sqrt(x^2 + y^2), 0").rigid_motion());
}

TEST(SlidingVelocity, RailAlongXEqualsRailAlongY)
{
  const Mesh along_x = block_on_rail(), along_y = turned_by_90_degrees(along_x);
  const auto found = eigenvalues(along_x, moving("1, 0, 0"));
  ASSERT_GT(found.size(), 100u);
  EXPECT_LT(largest(distances(eigenvalues(along_y, moving("0, 1, 0")), found)), 1e-9);
  EXPECT_LT(largest(distances(eigenvalues(along_x, moving("-1, 0, 0", Rotation::negative)), found)), 1e-9);
  EXPECT_GT(largest(distances(eigenvalues(along_x, moving("-1, 0, 0")), found)), 1e-3);
  EXPECT_GT(largest(distances(eigenvalues(along_x, moving("0, 1, 0")), found)), 1e-3);
}

TEST(SlidingVelocity, ThreadsLeaveTheErrorStreamAsItIs)
{
  const std::streambuf    *before = std::cerr.rdbuf();
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([] {
      for (int i = 0; i < 50; ++i)
        SlidingVelocity(Rotation::positive, "-y, x, 0");
    });
  for (std::thread &thread : threads)
    thread.join();
  EXPECT_EQ(std::cerr.rdbuf(), before);
}

TEST(SlidingVelocity, Refusals)
{
  for (const char *velocity : {"", "1, 0", "-y, x, 0, 0", "-y, x, w", "-y, x,", "-y, (x, 0"})
    expect_refusal<ParameterError>([&] { moving(velocity).check(); },
                                   {"is not a list of three valid expressions in x, y, z", "parameter Operation/Sliding direction"});
  OperationParameters rail = moving("1, 0, 0");
  EXPECT_NO_THROW(rail.check());
  rail.rotating_disc = true;
  expect_refusal<ParameterError>([&] { rail.check(); }, {"Gyroscopic forces"});

  for (const char *velocity : {"0, 0, 0", "x - 0.07, 0, 0", "sqrt(x - 0.1), 0, 0", "1 / (x - 0.07), 0, 0"})
    expect_refusal<MeshError>(
      [&] {
        nodes(block_on_rail(), {Rotation::positive, velocity});
      },
      {"the sliding velocity of the disc is zero or undefined at a contact node", "contact node at (0.07"});
  expect_refusal<MeshError>(
    [&] {
      nodes(block_on_rail(), {Rotation::positive, "0, 0, 2"});
    },
    {"the sliding velocity of the disc is normal to the contact face", "contact node at (0.07"});
}
