// SPDX-License-Identifier: GPL-3.0-or-later

#include "flutter.h"

#include <squeal/estimates/conditioning.h>
#include <squeal/linear_algebra/dense_eigenproblems.h>

#include <cmath>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  /// Modes in the band and their conditioning.
  std::pair<ComplexModes, Conditioning> conditioned(const CoupledSystem &system, const double mu, const double band = 10.)
  {
    UpdatedInverse   inverse(system, 0., FactorizationLibrary::automatic);
    SolverParameters solvers;
    Progress         progress;
    solvers.complex_tolerance = 1e-13;
    ComplexModes modes        = krylov_modes(system, inverse, 0., mu, band, system.map().n(), solvers, progress);
    return {modes, estimate_conditioning(system, inverse, 0., modes, modal_products(system, modes))};
  }

  /// Largest eigenvalue condition number ‖y‖ ‖x‖ / |yᴴ x| of ż = A z in the coordinates z = (K^½ u, v).
  double condition_of_first_order_system(const double mu)
  {
    const DenseMatrix K{{3., 0.7}, {0.7, 2.}}, K_mu{{3., 0.7 - mu}, {0.7, 2.}};
    const RealPairs   axes  = symmetric_eigenpairs(K);
    const auto        power = [&axes](const double p) {
      return DenseMatrix(axes.vectors * as_column(axes.values).array().pow(p).matrix().asDiagonal() * axes.vectors.transpose());
    };
    DenseMatrix A                 = DenseMatrix::Zero(4, 4);
    A.topRightCorner(2, 2)        = power(0.5);
    A.bottomLeftCorner(2, 2)      = -K_mu * power(-0.5);
    const DenseEigenpairs pairs   = eigenpairs(A);
    double                largest = 0.;
    for (int j = 0; j < 4; ++j)
      largest =
        std::max(largest, pairs.left.col(j).norm() * pairs.right.col(j).norm() / std::abs(pairs.left.col(j).dot(pairs.right.col(j))));
    return largest;
  }
} // namespace

TEST(Conditioning, OfALaplacianInAnyUnits)
{
  const int  m      = 3;
  const auto values = laplacian_eigenvalues(m, 1);
  const auto bounds = std::minmax_element(values.begin(), values.end());
  for (const double unit : {1e-12, 1e15})
    {
      const auto K                     = add(unit, *laplacian(m, 1), 0., *laplacian(m, 1));
      const auto M                     = Testing::diagonal(K->rows(), [unit](const int i) { return unit * (i % 2 == 0 ? 1. : 1e2); });
      const auto [modes, conditioning] = conditioned(system_of({M, nullptr, K}), 0.);
      EXPECT_NEAR(conditioning.stiffness, *bounds.second / *bounds.first, 1e-6 * conditioning.stiffness);
      EXPECT_NEAR(conditioning.mass, 1., 1e-12);
      ASSERT_FALSE(modes.lambda.empty());
      for (const double kappa : conditioning.modes)
        EXPECT_NEAR(kappa, 1., 1e-8);
      EXPECT_GT(conditioning.digits(), 9.);
    }
}

TEST(Conditioning, SeesWhatCancelsInTheStiffness)
{
  const double delta               = 1e-6;
  const auto   K                   = sparse(DenseMatrix{{1., delta - 1.}, {delta - 1., 1.}});
  const auto [modes, conditioning] = conditioned(system_of({sparse(DenseMatrix::Identity(2, 2)), nullptr, K}), 0., 0.1);
  ASSERT_EQ(modes.lambda.size(), 1u);
  EXPECT_NEAR(conditioning.largest_cancellation * delta, 2., 1e-5);
  EXPECT_NEAR(conditioning.stiffness * delta, 2., 1e-5);
  // The expected error is ½ ε γ = 2.2e-10
  EXPECT_GT(conditioning.errors[0], 2e-10);
  EXPECT_NEAR(conditioning.digits(), 9.6, 0.3);
}

TEST(Conditioning, GrowsTowardsACoalescence)
{
  const double threshold = Flutter{1.}.coalescence();
  for (const double distance : {0.5, 1e-2, 1e-4, -1e-2, -0.5})
    {
      const double mu                  = threshold * (1. - distance);
      const auto [modes, conditioning] = conditioned(Flutter{1.}.system(), mu);
      ASSERT_EQ(conditioning.modes.size(), 2u);
      const double expected = condition_of_first_order_system(mu);
      EXPECT_NEAR(std::max(conditioning.modes[0], conditioning.modes[1]) / expected, 1., 1e-4) << distance;
      EXPECT_GT(expected, std::abs(distance) < 1e-3 ? 30. : 1.);
    }
}
