#include "near_null_spaces.h"

#include <squeal/base/exceptions.h>
#include <squeal/eigen/symmetric_modes.h>
#include <squeal/linear_algebra/iterative_inverse.h>
#include <squeal/linear_algebra/mass_orthonormal.h>

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  class ModesWithoutFactor : public ::testing::TestWithParam<Distribution>
  {
  protected:
    ModesWithoutFactor()
    {
      options.solver  = RealSolver::lobpcg;
      options.library = FactorizationLibrary::multigrid;
      options.what    = "test";
    }
    SymmetricModesOptions options;
  };
  INSTANTIATE_TEST_SUITE_P(Distributions, ModesWithoutFactor, ::testing::Values(Distribution::even, Distribution::first_process_empty));

  constexpr std::array<int, 3> cells = {{14, 8, 2}};
  constexpr double             h     = 0.02;

  /// Every modes' residual, and the same modes as by a factor.
  void expect_equal(const Body &body, const SymmetricModes &modes, const SymmetricModes &reference)
  {
    ASSERT_EQ(modes.eigenvalues.size(), reference.eigenvalues.size());
    EXPECT_EQ(modes.n_rigid_body, reference.n_rigid_body);
    EXPECT_LT(orthonormality_defect(*body.mass, *modes.vectors), 1e-12);
    for (std::size_t j = 0; j < modes.eigenvalues.size(); ++j)
      if (reference.eigenvalues[j] > 0.)
        {
          EXPECT_NEAR(modes.eigenvalues[j] / reference.eigenvalues[j], 1., 1e-10) << "mode " << j;
          EXPECT_LT(modes.residuals[j], 1e-9) << "mode " << j;
        }
    // The same space: all singular values of ΦᵀMΨ are one.
    const DenseMatrix overlap = gram(*reference.vectors, *body.mass * *modes.vectors);
    EXPECT_NEAR(singular_values(overlap).values.back(), 1., 1e-8);
  }
} // namespace

TEST_P(ModesWithoutFactor, EqualThoseOfAFactor)
{
  const Body           body      = plate(cells, h, 1e10, GetParam());
  const double         limit     = std::pow(2. * M_PI * 15e3, 2);
  const SymmetricModes reference = symmetric_modes(*body.stiffness, *body.mass, limit);
  const NearNullSpace  space     = near_null_space_of_plate(body.stiffness->rows(), cells, h);
  options.near_null_space        = &space;

  const SymmetricModes counted = symmetric_modes(*body.stiffness, *body.mass, limit, options);
  EXPECT_EQ(counted.n_counted, reference.n_counted);
  expect_equal(body, counted, reference);

  // Without a count, whatever is expected
  options.counting = ModeCounting::none;
  for (const int n_expected : {0, reference.n_counted, 2 * reference.n_counted})
    {
      options.n_expected          = n_expected;
      const SymmetricModes others = symmetric_modes(*body.stiffness, *body.mass, limit, options);
      EXPECT_EQ(others.n_counted, not_counted);
      expect_equal(body, others, reference);
    }

  // By shift-invert with the iterative inverse
  options.counting          = ModeCounting::inertia;
  options.solver            = RealSolver::anasazi;
  const SymmetricModes same = symmetric_modes(*body.stiffness, *body.mass, limit, options);
  expect_equal(body, same, reference);
}

TEST_P(ModesWithoutFactor, MultipleEigenvalues)
{
  // Twelve equal bodies with a simple mode, then threefold ones: 12- and 36-fold
  const int     m = 5, n_copies = 12;
  const auto    K = laplacian(m, n_copies, GetParam());
  const auto    M = diagonal(K->rows(), [](int) { return 1.; });
  NearNullSpace space{MultiVector(K->rows(), 1), {}};
  for (int i = 0; i < K->rows().n_local(); ++i)
    {
      space.vectors(i, 0) = 1.;
      space.points.push_back(K->rows().number(i));
    }
  options.near_null_space = &space;
  const auto exact        = laplacian_eigenvalues(m, n_copies);
  for (const ModeCounting counting : {ModeCounting::inertia, ModeCounting::none})
    {
      options.counting           = counting;
      options.n_expected         = 40;
      const SymmetricModes modes = symmetric_modes(*K, *M, 1.7, options);
      ASSERT_EQ(modes.eigenvalues.size(), 12u + 36u);
      for (std::size_t j = 0; j < modes.eigenvalues.size(); ++j)
        EXPECT_NEAR(modes.eigenvalues[j] / exact[j], 1., 1e-11) << "mode " << j;
    }
}

TEST_P(ModesWithoutFactor, FreeBodyHasSixRigidModes)
{
  const Body           body      = plate(cells, h, 0., GetParam());
  const double         limit     = std::pow(2. * M_PI * 10e3, 2);
  const SymmetricModes reference = symmetric_modes(*body.stiffness, *body.mass, limit);
  const NearNullSpace  space     = near_null_space_of_plate(body.stiffness->rows(), cells, h);
  options.near_null_space        = &space;
  options.shift                  = 0.01 * limit;
  for (const ModeCounting counting : {ModeCounting::inertia, ModeCounting::none})
    {
      options.counting           = counting;
      const SymmetricModes modes = symmetric_modes(*body.stiffness, *body.mass, limit, options);
      EXPECT_EQ(modes.n_rigid_body, 6);
      expect_equal(body, modes, reference);
    }
}

TEST_P(ModesWithoutFactor, NeedANearNullSpace)
{
  const Body   body  = plate(cells, h, 1e10, GetParam());
  const double limit = std::pow(2. * M_PI * 15e3, 2);
  EXPECT_THROW(symmetric_modes(*body.stiffness, *body.mass, limit, options), SolverError);
  options.solver = RealSolver::anasazi;
  EXPECT_THROW(symmetric_modes(*body.stiffness, *body.mass, limit, options), SolverError);
  EXPECT_THROW(factorize_general(*body.stiffness, FactorizationLibrary::multigrid, "test"), SolverError);
}
