#include <squeal/base/decision.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace Squeal;

TEST(Decision, KeepsTheNearestValueOnEitherSide)
{
  static const Decision decision("part / whole", 1e-8); // static, as in the program: GCC's address sanitizer does not align the stack
  const auto            record = [] {
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

TEST(Decision, RecordsOfPartsAreMerged)
{
  const double inf = std::numeric_limits<double>::infinity();
  // The whole was asked for the first quantity only; parts have no value on one side of the second
  std::vector<DecisionRecord> whole = {{"b", 1e-8, 1e-16, 1e-3, 2, 1, "", ""}};
  merge(whole, {{"b", 1e-8, 1e-12, 1e-3, 3, 4, "one", "one"}, {"a", 1e-6, 0., 1e-2, 0, 5, "", "one"}});
  merge(whole, {{"b", 1e-8, 1e-14, 1e-5, 1, 1, "two", "two"}, {"a", 1e-6, 1e-9, inf, 1, 0, "two", ""}});
  ASSERT_EQ(whole.size(), 2u);

  EXPECT_EQ(whole[0].quantity, "a");
  EXPECT_EQ(whole[0].threshold, 1e-6);
  EXPECT_EQ(whole[0].below, 1e-9);
  EXPECT_EQ(whole[0].below_in, "two");
  EXPECT_EQ(whole[0].above, 1e-2);
  EXPECT_EQ(whole[0].above_in, "one");
  EXPECT_EQ(whole[0].n_below, 1);
  EXPECT_EQ(whole[0].n_above, 5);

  EXPECT_EQ(whole[1].quantity, "b");
  EXPECT_EQ(whole[1].below, 1e-12);
  EXPECT_EQ(whole[1].below_in, "one");
  EXPECT_EQ(whole[1].above, 1e-5);
  EXPECT_EQ(whole[1].above_in, "two");
  EXPECT_EQ(whole[1].n_below, 6);
  EXPECT_EQ(whole[1].n_above, 6);

  // Of equal values the first one stays
  merge(whole, {{"b", 1e-8, 1e-12, 1e-5, 0, 0, "three", "three"}});
  EXPECT_EQ(whole[1].below_in, "one");
  EXPECT_EQ(whole[1].above_in, "two");
}

TEST(Decision, WhatIsTakenIsForgotten)
{
  static const Decision decision("thing / other", 1e-8);
  EXPECT_FALSE(decision.exceeded_by(1e-16));
  const auto taken = Decision::take();
  EXPECT_EQ(std::count_if(taken.begin(), taken.end(), [](const DecisionRecord &r) { return r.quantity == "thing / other"; }), 1);
  EXPECT_TRUE(Decision::records().empty());
}
