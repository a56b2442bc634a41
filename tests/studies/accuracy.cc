// SPDX-License-Identifier: GPL-3.0-or-later

#include "solutions.h"

#include <squeal/base/exceptions.h>
#include <squeal/studies/accuracy/accuracy.h>

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  constexpr int n_modes = 5;

  /// Exact values of the modes: frequencies 1000, 2000, ... Hz, divergence rates 1 %, 2 %, ...
  Complex limit(const int mode)
  {
    const double omega = circular_frequency(1000. * (mode + 1));
    return {0.01 * (mode + 1) * omega, omega};
  }

  /// Shapes are unit vectors; in a cluster, the last two are mixed in equal parts.
  ModesAtPoints modes(const double error, const bool has_cluster)
  {
    const RowMap map    = RowMap::even(n_modes, MPI_COMM_WORLD);
    DenseMatrix  shapes = DenseMatrix::Identity(n_modes, n_modes);
    if (has_cluster)
      shapes.bottomRightCorner(2, 2) << std::sqrt(0.5), -std::sqrt(0.5), std::sqrt(0.5), std::sqrt(0.5);
    ModesAtPoints result{{}, distribute(shapes, map), distribute(DenseMatrix::Zero(n_modes, n_modes), map)};
    for (int k = 0; k < n_modes; ++k)
      result.lambda.push_back((1. + error) * limit(k).imag() * Complex(0.01 * (k + 1) - 0.1 * error, 1.));
    return result;
  }

  /// Results with the discretisation error @p constant h²; a reduced basis adds the error @p reduction and takes half the time.
  SolvedMesh solved(const Element element, const double factor, const double constant, const double reduction, const bool has_cluster)
  {
    const double error = constant / (factor * factor);
    SolvedMesh   mesh{{element, Outlines::inscribed, factor}, static_cast<int>(1000 * factor), 10, modes(error, has_cluster), {}, 5, {}};
    mesh.labels.resize(n_modes);
    ModesByMethod full{"full order", 1000, {2. * factor, 2. * factor, 1e9}, mesh.modes.lambda, std::vector<double>(n_modes, 1e-9)};
    ModesByMethod reduced = full;
    reduced.method        = "basis";
    reduced.cost          = {factor, factor, 1e9};
    for (Complex &lambda : reduced.lambda)
      lambda *= 1. + reduction;
    mesh.methods = {full, reduced};
    return mesh;
  }
} // namespace

TEST(Accuracy, ExtrapolatesEveryFamilyAndTakesTheBest)
{
  std::vector<SolvedMesh> meshes;
  for (const double factor : {0.5, 1., 2.})
    {
      meshes.push_back(solved(Element::trilinear, factor, 0.01, 0., false));
      meshes.push_back(solved(Element::incompatible_modes, factor, 0.001, 0., factor < 1.));
    }
  meshes.push_back(solved(Element::quadratic, 0.5, 1e-6, 0., false)); // a single mesh has no order and no limit
  const auto families = converged_families(meshes, 6000.);
  ASSERT_EQ(families.size(), 2u);
  const ConvergedFamily &best = best_family(families);
  EXPECT_EQ(best.name, "incompatible modes, inscribed");
  for (int k = 0; k < n_modes; ++k)
    {
      const ConvergedMode &mode = best.modes[k];
      EXPECT_EQ(mode.in_cluster, k >= 3) << k;
      EXPECT_EQ(mode.numbers, (std::vector<int>(3, k))) << k;
      if (mode.in_cluster) // the value of the finest mesh is used
        EXPECT_NEAR(mode.frequency.value, 1.00025 * 1000. * (k + 1), 1e-9);
      else
        {
          EXPECT_NEAR(mode.frequency.sequence->order, 2., 1e-4);
          EXPECT_TRUE(mode.frequency.sequence->is_trustworthy);
          EXPECT_NEAR(mode.frequency.value, 1000. * (k + 1), 1e-6);
          EXPECT_NEAR(mode.divergence.value, 0.01 * (k + 1), 1e-9);
        }
    }
  meshes.erase(meshes.begin() + 2, meshes.end());
  EXPECT_THROW(best_family(converged_families(meshes, 6000.)), SolverError);
}

TEST(Accuracy, SplitsErrorsAndMarksTheFront)
{
  std::vector<SolvedMesh> meshes;
  for (const double factor : {1., 2., 4.})
    meshes.push_back(solved(Element::trilinear, factor, 0.01, 1e-3, false));
  meshes.push_back(solved(Element::quadratic, 3., 0.5, 1e-3, true)); // a slow and inaccurate mesh with two mixed modes
  meshes.back().mesh.factor = 3.;
  const auto families       = converged_families(meshes, 6000.);
  const auto methods        = compare(meshes, best_family(families), 4500.);
  ASSERT_EQ(methods.size(), 8u);
  for (std::size_t m = 0; m < 6; ++m)
    {
      const ComparedMethod &method = methods[m];
      const double          h2     = std::pow(method.mesh->mesh.factor, -2.);
      ASSERT_EQ(method.modes.size(), 4u); // modes up to 4500 Hz
      EXPECT_EQ(method.n_lost, 0);
      EXPECT_EQ(method.n_in_cluster, 0);
      EXPECT_NEAR(method.largest_frequency.discretisation, 0.01 * h2, 1e-9);
      EXPECT_NEAR(method.largest_divergence.discretisation, 0.001 * h2, 1e-9);
      EXPECT_NEAR(method.largest_frequency.reduction, m % 2 == 0 ? 0. : 1e-3 * (1. + 0.01 * h2), 1e-9);
      EXPECT_EQ(method.largest_frequency.algebraic, 1e-9);
      EXPECT_NEAR(method.largest_frequency.total,
                  m % 2 == 0 ? method.largest_frequency.discretisation :
                               method.largest_frequency.discretisation + method.largest_frequency.reduction,
                  1e-9);
      EXPECT_NEAR(method.rms_frequency, method.largest_frequency.total, 1e-9);
    }
  // Full order takes as long as the basis on the next finer mesh, which is more accurate
  std::vector<bool> front;
  for (const ComparedMethod &method : methods)
    front.push_back(method.on_front);
  EXPECT_EQ(front, (std::vector<bool>{false, true, false, true, true, true, false, false}));
  // Modes of a cluster are marked and counted
  EXPECT_EQ(methods[6].n_in_cluster, 1);
  EXPECT_TRUE(methods[6].modes[3].in_cluster);
}
