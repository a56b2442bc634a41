#include <squeal/tracking/mode_links.h>

#include <gtest/gtest.h>

#include <complex>
#include <vector>

using namespace Squeal;

namespace
{
  using Complex = std::complex<double>;
} // namespace

TEST(ModeClusters, HoldEigenvaluesThatAreIndistinguishable)
{
  const Complex lambda(0., 1000.);
  const auto    clusters = [&](const Complex &other) { return mode_clusters({lambda, other}); };
  for (const Complex &direction : {Complex(1., 0.), Complex(0., 1.)})
    {
      EXPECT_EQ(clusters(lambda + 0.9 * indistinguishable * 1000. * direction), (std::vector<int>{0, 0}));
      EXPECT_EQ(clusters(lambda + 1.1 * indistinguishable * 1000. * direction), (std::vector<int>{0, 1}));
    }
}

TEST(PairSign, IsThatOfTheSquareWhereItIsReal)
{
  // δ² = 1 + i ε to first order
  const auto sign = [](const double epsilon, const Complex &unit) { return pair_sign(unit * Complex(1., epsilon / 2.), 0.); };
  for (const double epsilon : {0., 1e-7, -1e-7})
    {
      EXPECT_EQ(sign(epsilon, 10.), 1);
      EXPECT_EQ(sign(epsilon, Complex(0., 10.)), -1);
    }
  for (const double epsilon : {1e-5, -1e-5, 1.})
    {
      EXPECT_EQ(sign(epsilon, 10.), 0);
      EXPECT_EQ(sign(epsilon, Complex(0., 10.)), 0);
    }
}
