// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/modes/complex_modes.h>

#include <gtest/gtest.h>

#include <limits>

using namespace Squeal;

namespace
{
  constexpr double infinity = std::numeric_limits<double>::infinity(), not_a_number = std::numeric_limits<double>::quiet_NaN();

  /// Verdict on a mode at 1000 rad/s, where rates up to 10⁻⁵ 1/s count as rounding errors.
  Verdict of_rate(const double rate, const double error = 0., const bool growth_needs_coalescence = false)
  {
    return verdict_of({rate, 1000.}, error, growth_needs_coalescence);
  }
} // namespace

TEST(Verdict, OfExactModesKnowsRoundingOnly)
{
  EXPECT_EQ(of_rate(2e-5), Verdict::unstable);
  EXPECT_EQ(of_rate(-2e-5), Verdict::stable);
  for (const double rate : {0., -0., 0.9e-5, -0.9e-5})
    EXPECT_EQ(of_rate(rate), Verdict::neutral) << rate;
  // The rounding level is relative to the frequency
  EXPECT_EQ(verdict_of({2e-5, 1.}), Verdict::unstable);
  EXPECT_EQ(verdict_of({2e-5, 1e4}), Verdict::neutral);
}

TEST(Verdict, LeavesOpenWhatThreeTimesTheErrorMayTurn)
{
  EXPECT_EQ(of_rate(3.1, 1.), Verdict::unstable);
  EXPECT_EQ(of_rate(2.9, 1.), Verdict::undecided);
  EXPECT_EQ(of_rate(0., 1.), Verdict::undecided);
  EXPECT_EQ(of_rate(-2.9, 1.), Verdict::undecided);
  EXPECT_EQ(of_rate(-3.1, 1.), Verdict::stable);
  // Errors below the rounding level do not change the verdict
  EXPECT_EQ(of_rate(0., 1e-6), Verdict::neutral);
  EXPECT_EQ(of_rate(0., 1e-5), Verdict::undecided);
  for (const double rate : {-1e6, 0., 1e6})
    EXPECT_EQ(of_rate(rate, infinity), Verdict::undecided) << rate;
}

TEST(Verdict, KeepsNeutralWhatGrowsByCoalescenceOnly)
{
  for (const double error : {0., 1., infinity})
    {
      EXPECT_EQ(of_rate(0., error, true), Verdict::neutral) << error;
      EXPECT_EQ(of_rate(-1., error, true), Verdict::stable) << error;
    }
  EXPECT_EQ(of_rate(4., 1., true), Verdict::unstable);
  EXPECT_EQ(of_rate(2., 1., true), Verdict::undecided);
}

TEST(Verdict, OfWhatIsNoNumberIsOpen)
{
  for (const bool growth_needs_coalescence : {false, true})
    {
      EXPECT_EQ(of_rate(not_a_number, 0., growth_needs_coalescence), Verdict::undecided);
      EXPECT_EQ(verdict_of({0., not_a_number}, 0., growth_needs_coalescence), Verdict::undecided);
      for (const double rate : {-1., 0., 1.})
        EXPECT_EQ(of_rate(rate, not_a_number, growth_needs_coalescence), Verdict::undecided) << rate;
    }
}
