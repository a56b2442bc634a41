// SPDX-License-Identifier: GPL-3.0-or-later

#include "matrices.h"
#include "scenes.h"

#include <squeal/eigen/dense_quadratic.h>
#include <squeal/eigen/symmetric_modes.h>
#include <squeal/linear_algebra/mass_orthonormal.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/reduction/reduced_model.h>

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  /// The smallest mesh of a disc between two pins.
  Scene tiny_scene(const RadialDissipation dissipation, const MaterialParameters &materials = mounted())
  {
    const std::vector<PolarPin> pins = {{Plan::Side::top, 0, 1, 0, 1}, {Plan::Side::bottom, 2, 1, 0, 1}};
    return Scene(extrude(polar_plan(0.1505, 0.3155, 1, 7, pins), layers(1, 2)), materials, operating(dissipation));
  }

  /// The system with 3 % modal damping of its modes below 15 kHz.
  CoupledSystem with_modal_damping(CoupledSystem system)
  {
    const auto real = symmetric_modes(*system.stiffness, *system.mass, std::pow(2. * M_PI * 15000., 2));
    add_modal_damping(system, *real.vectors, real.eigenvalues, std::vector<double>(real.eigenvalues.size(), 0.03));
    return system;
  }
} // namespace

TEST(ReducedModel, FullBasisGivesTheFullSpectrum)
{
  for (const auto &[dissipation, materials] : {std::make_pair(RadialDissipation::none, mounted()),
                                               {RadialDissipation::consistent, mounted()},
                                               {RadialDissipation::consistent, damped(mounted())}})
    {
      const Scene s = tiny_scene(dissipation, materials);
      const auto &M = *s.coupled.mass;

      // A random full basis, added in parts of different sizes
      const int         n = s.coupled.map().n();
      const MultiVector T = orthonormalize(M, nullptr, random_vectors(s.coupled.map(), n), 1e-13);
      ASSERT_EQ(T.n_columns(), n);
      ReducedModel reduced(s.coupled);
      reduced.extend(view(T, 0, 5));
      reduced.extend(view(T, 5, n - 20));
      reduced.extend(view(T, n - 15, 15));
      ASSERT_EQ(reduced.size(), n);

      // Limit the comparison, because a random basis is less accurate at the upper end of the spectrum
      const double limit = 2. * M_PI * 20000.;
      for (const double mu : {0., 0.6})
        {
          const SecondOrderSystem matrices = with_friction(s.coupled, mu);
          DenseMatrix             C;
          if (matrices.damping)
            C = to_dense(*matrices.damping);
          const auto full =
            dense_quadratic_modes(to_dense(*matrices.mass), matrices.damping ? &C : nullptr, to_dense(*matrices.stiffness), limit);
          const auto pencil = reduced.at(s.coupled.at(mu));
          EXPECT_EQ(pencil.has_damping, matrices.damping != nullptr);
          const auto small = dense_quadratic_modes(pencil.mass, pencil.has_damping ? &pencil.damping : nullptr, pencil.stiffness, limit);
          EXPECT_GT(full.values.size(), 20u);
          EXPECT_LT(largest(distances(full.values, small.values)), 1e-9);
        }
    }
}

TEST(ReducedModel, ProjectsEveryBlock)
{
  for (const MaterialParameters &materials : {mounted(), damped(mounted())})
    {
      const Scene       s = tiny_scene(RadialDissipation::published, materials);
      const MultiVector X = random_vectors(s.coupled.map(), 9, 3);
      ReducedModel      at_once(s.coupled), grown(s.coupled);
      at_once.extend(X);
      grown.extend(view(X, 0, 2));
      grown.extend(view(X, 2, 6));
      grown.extend(view(X, 8, 1));
      for (const double mu : {0., 0.3, 1.1})
        {
          const SecondOrderSystem matrices = with_friction(s.coupled, mu);
          const DenseMatrix       M = gram(X, *matrices.mass * X), C = gram(X, *matrices.damping * X), K = gram(X, *matrices.stiffness * X);
          for (const ReducedModel *model : {&at_once, &grown})
            {
              const ReducedPencil pencil = model->at(s.coupled.at(mu));
              EXPECT_LT(max_norm(pencil.mass - M), 1e-13 * max_norm(M));
              EXPECT_LT(max_norm(pencil.damping - C), 1e-13 * max_norm(C));
              EXPECT_LT(max_norm(pencil.stiffness - K), 1e-13 * max_norm(K));
            }
        }
      EXPECT_LT(max_norm(replicate(grown.basis()) - replicate(X)), 1e-16);
    }
}

TEST(ReducedModel, ModalDamping)
{
  // Modal damping alone and with a damping matrix, in a full basis and in a small basis extended in parts
  const double limit = 2. * M_PI * 20000., mu = 0.6;
  for (const MaterialParameters &materials : {mounted(), damped(mounted())})
    {
      const Scene             s        = tiny_scene(RadialDissipation::none, materials);
      const CoupledSystem     system   = with_modal_damping(s.coupled);
      const SecondOrderSystem matrices = with_friction(s.coupled, mu);
      const int               n        = system.map().n();
      const MultiVector       units    = unit_vectors(system.map());
      DenseMatrix             C        = replicate(times({system.terms.back()}, system.values, 1, units));
      if (matrices.damping)
        C += to_dense(*matrices.damping);
      const auto all = dense_quadratic_modes(to_dense(*matrices.mass), &C, to_dense(*matrices.stiffness), limit);

      const MultiVector T = orthonormalize(*system.mass, nullptr, random_vectors(system.map(), n), 1e-13);
      ReducedModel      full(system), grown(system);
      full.extend(T);
      const ReducedPencil pencil = full.at(system.at(mu));
      ASSERT_TRUE(pencil.has_damping);
      EXPECT_GT(all.values.size(), 20u);
      EXPECT_LT(largest(distances(all.values, dense_quadratic_modes(pencil.mass, &pencil.damping, pencil.stiffness, limit).values)), 1e-9);

      grown.extend(view(T, 0, 4));
      grown.extend(view(T, 4, 3));
      const DenseMatrix X = replicate(view(T, 0, 7)), expected = X.transpose() * C * X;
      EXPECT_LT(max_norm(grown.at(system.at(mu)).damping - expected), 1e-12 * max_norm(expected));
    }
}

TEST(ReducedModel, LessThanAFullBasisIsNotExact)
{
  // Verify that FullBasisGivesTheFullSpectrum would detect a missing direction
  const Scene       s     = tiny_scene(RadialDissipation::none);
  const int         n     = s.coupled.map().n();
  const MultiVector T     = unit_vectors(s.coupled.map());
  const double      limit = 2. * M_PI * 20000., mu = 0.6;
  ReducedModel      full(s.coupled), less(s.coupled);
  full.extend(T);
  less.extend(view(T, 0, n - 1));
  const auto all = full.at(s.coupled.at(mu)), some = less.at(s.coupled.at(mu));
  const auto values = dense_quadratic_modes(all.mass, nullptr, all.stiffness, limit).values,
             others = dense_quadratic_modes(some.mass, nullptr, some.stiffness, limit).values;
  EXPECT_TRUE(values.size() != others.size() || largest(distances(values, others)) > 1e-6);
}
