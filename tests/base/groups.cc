#include <squeal/base/groups.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace Squeal;

TEST(Groups, AreChainsOfConnectedThings)
{
  // The fifth connects two groups of two
  const std::vector<double> values = {1., 2., 1.2, 2.1, 1.6, 9.};
  const auto                near   = [&](const int i, const int j) {
    EXPECT_LT(j, i);
    return std::abs(values[i] - values[j]) < 0.45;
  };
  EXPECT_EQ(connected_groups(4, near), (std::vector<int>{0, 1, 0, 1}));
  EXPECT_EQ(members_of(connected_groups(4, near)), (std::vector<std::vector<int>>{{0, 2}, {1, 3}}));
  EXPECT_EQ(connected_groups(6, near), (std::vector<int>{0, 0, 0, 0, 0, 5}));
  EXPECT_EQ(members_of(connected_groups(6, near)), (std::vector<std::vector<int>>{{0, 1, 2, 3, 4}, {5}}));
  EXPECT_TRUE(members_of(connected_groups(0, near)).empty());
}
