#include "estimates/given_modes.h"

#include <squeal/estimates/discretisation_error.h>

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  constexpr double share = 1. / 3.;

  /// Modes of the same shapes on both meshes.
  std::vector<DiscretisationError> errors(const std::vector<Complex> &coarse, const std::vector<Complex> &fine)
  {
    const ComplexDenseMatrix X = orthonormal(fine.size());
    return discretisation_errors(modes(coarse, X), modes(fine, X), share, {});
  }
} // namespace

TEST(DiscretisationError, IsAShareOfTheDifference)
{
  // f = f* (1 + c h²) and ξ = ξ* + d h² at h = 2 and 1: a third of the difference is the error
  const double h[]    = {2., 1.};
  const auto   lambda = [&](const int mesh) {
    const double omega = 100. * (1. + 1e-3 * h[mesh] * h[mesh]), xi = 0.01 + 1e-3 * h[mesh] * h[mesh];
    return std::vector<Complex>{omega * Complex(xi, 1.)};
  };
  const std::vector<DiscretisationError> found = errors(lambda(0), lambda(1));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].has_counterpart);
  EXPECT_FALSE(found[0].in_cluster);
  EXPECT_NEAR(found[0].overlap, 1., 1e-12);
  EXPECT_NEAR(found[0].frequency, 1e-3 / 1.001, 1e-12);
  EXPECT_NEAR(found[0].divergence, 1e-3, 1e-12);
  EXPECT_EQ(found[0].verdict, Verdict::unstable);
  EXPECT_TRUE(found[0].is_within(1e-3, 1.1e-3));
  EXPECT_FALSE(found[0].is_within(1e-3, 0.9e-3));
  EXPECT_FALSE(found[0].is_within(0.9e-3, 1.1e-3));
}

TEST(DiscretisationError, DecidesWhatGrowsBeyondIt)
{
  // R / ω: growing beyond the error, growing within it, decaying within it, decaying beyond it
  const std::vector<DiscretisationError> found =
    errors({0.010 * 100. + 100. * i, 200. * 0.020 + 200. * i, 300. * -0.020 + 300. * i, -4. + 400. * i},
           {0.011 * 100. + 100. * i, 200. * 0.001 + 200. * i, 300. * -0.001 + 300. * i, -4.1 + 400. * i});
  EXPECT_EQ(found[0].verdict, Verdict::unstable);
  EXPECT_EQ(found[1].verdict, Verdict::undecided);
  EXPECT_EQ(found[2].verdict, Verdict::undecided);
  EXPECT_EQ(found[3].verdict, Verdict::stable);
}

TEST(DiscretisationError, NeutralModesThatMayMeetAreUndecided)
{
  // Distances: 1 from 4 on the coarse mesh; 1 from 1.5; 0.001 from 0.01, at which they could hardly grow
  const std::vector<DiscretisationError> found = errors({104. * i, 100. * i, 201.5 * i, 200. * i, 300.01 * i, 300. * i},
                                                        {101. * i, 100. * i, 201. * i, 200. * i, 300.001 * i, 300. * i});
  for (const int j : {0, 1})
    {
      EXPECT_EQ(found[j].verdict, Verdict::undecided) << j;
      EXPECT_NEAR(found[j].divergence, 0.5 / 100., 1e-4) << j;
    }
  for (const int j : {2, 3, 4, 5})
    EXPECT_EQ(found[j].verdict, Verdict::stable) << j;
}

TEST(DiscretisationError, PartnersOfAFlutterShareTheLargestError)
{
  const std::vector<DiscretisationError> found = errors({1.2 + 100. * i, -1.0 + 100. * i}, {0.9 + 100. * i, -1.0 + 100. * i});
  EXPECT_NEAR(found[0].divergence, 0.3 / 3. / 100., 1e-12);
  EXPECT_NEAR(found[1].divergence, 0.3 / 3. / 100., 1e-12);
  EXPECT_EQ(found[0].verdict, Verdict::unstable);
  EXPECT_EQ(found[1].verdict, Verdict::stable);
}

TEST(DiscretisationError, ModesWithoutCounterpartAreUndecided)
{
  const ComplexDenseMatrix               X = orthonormal(3);
  const std::vector<DiscretisationError> found =
    discretisation_errors(modes({100. * i, 200. * i}, X.leftCols(2)), modes({99. * i, 198. * i, 1. + 290. * i}, X), share, {});
  EXPECT_TRUE(found[1].has_counterpart);
  EXPECT_FALSE(found[2].has_counterpart);
  EXPECT_EQ(found[2].verdict, Verdict::undecided);
  EXPECT_FALSE(found[2].is_within(1., 1.));
}

TEST(DiscretisationError, ErrorsOfTheSolverCount)
{
  const ComplexDenseMatrix X = orthonormal(1);
  for (const double error : {1e-4, 1e-2})
    EXPECT_EQ(discretisation_errors(modes({1. + 100. * i}, X), modes({1. + 100. * i}, X), share, {error})[0].verdict,
              error < 1e-3 ? Verdict::unstable : Verdict::undecided);
}
