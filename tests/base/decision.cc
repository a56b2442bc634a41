#include <squeal/base/decision.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace Squeal;

TEST(Decision, KeepsTheNearestValueOnEitherSide)
{
  const Decision decision("part / whole", 1e-8);
  const auto     record = [] {
    const auto all = Decision::records();
    const auto it  = std::find_if(all.begin(), all.end(), [](const DecisionRecord &r) { return r.quantity == "part / whole"; });
    return it == all.end() ? DecisionRecord{} : *it;
  };
  EXPECT_EQ(record().quantity, ""); // not asked yet

  EXPECT_FALSE(decision.exceeded_by(1e-16));
  EXPECT_FALSE(decision.exceeded_by(1e-13));
  EXPECT_FALSE(decision.exceeded_by(0.));
  EXPECT_EQ(record().n_below, 3);
  EXPECT_NEAR(record().margin_below(), 5., 1e-12);
  EXPECT_TRUE(std::isinf(record().margin_above()));

  EXPECT_TRUE(decision.exceeded_by(0.5));
  EXPECT_TRUE(decision.exceeded_by(1e-2));
  EXPECT_EQ(record().n_above, 2);
  EXPECT_NEAR(record().margin_above(), 6., 1e-12);

  // The threshold itself does not exceed, nor does what is no number
  EXPECT_FALSE(decision.exceeded_by(1e-8));
  EXPECT_FALSE(decision.exceeded_by(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_EQ(record().margin_below(), 0.);

  Decision::forget();
  EXPECT_EQ(record().quantity, "");
}
