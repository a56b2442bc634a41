// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/groups.h>
#include <squeal/base/progress.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>
#include <sstream>

using namespace Squeal;

TEST(Conventions, OfAMode)
{
  const double omega = 2. * M_PI * 1234.5, R = 6.78;
  const auto   mode = modal_quantities({R, omega});
  EXPECT_DOUBLE_EQ(mode.frequency, 1234.5);
  EXPECT_DOUBLE_EQ(mode.growth_rate, R);
  EXPECT_DOUBLE_EQ(mode.divergence_rate, R / omega);
  EXPECT_DOUBLE_EQ(mode.damping_ratio, -2. * R / omega);
  // Rates relative to a zero frequency are defined as zero
  const auto decay = modal_quantities({-3., 0.});
  EXPECT_EQ(decay.frequency, 0.);
  EXPECT_EQ(decay.growth_rate, -3.);
  EXPECT_EQ(decay.divergence_rate, 0.);
  EXPECT_EQ(decay.damping_ratio, 0.);
}

TEST(Assignment, AgreesWithTryingAll)
{
  std::mt19937                           random(7);
  std::uniform_real_distribution<double> uniform(-1., 1.);
  for (int n_columns = 1; n_columns <= 6; ++n_columns)
    for (int n_rows = 1; n_rows <= n_columns; ++n_rows)
      for (int trial = 0; trial < 20; ++trial)
        {
          // Use small integers in every third matrix to produce ties
          std::vector<std::vector<double>> gain(n_rows, std::vector<double>(n_columns));
          for (auto &row : gain)
            for (double &value : row)
              value = trial % 3 == 0 ? std::round(2. * uniform(random)) : uniform(random);

          std::vector<int> order(n_columns);
          std::iota(order.begin(), order.end(), 0);
          double best = -1e300;
          do
            {
              double sum = 0.;
              for (int i = 0; i < n_rows; ++i)
                sum += gain[i][order[i]];
              best = std::max(best, sum);
            }
          while (std::next_permutation(order.begin(), order.end()));

          const auto found = best_assignment(n_rows, n_columns, [&](const int i, const int j) { return gain[i][j]; });
          ASSERT_EQ(found.size(), static_cast<std::size_t>(n_rows));
          EXPECT_EQ(std::set<int>(found.begin(), found.end()).size(), found.size());
          double sum = 0.;
          for (int i = 0; i < n_rows; ++i)
            sum += gain[i].at(found[i]);
          EXPECT_NEAR(sum, best, 1e-12);
        }
}

TEST(ProgressChannel, PrintsALinePerStepAndNote)
{
  std::ostringstream stream;
  {
    Progress progress(stream, false);
    progress.begin("Mesh");
    progress.update("busy");
    progress.finish("12 elements");
    progress.begin("Matrices");
    progress.begin("Modes"); // ends the previous step
    progress.finish();
    progress.finish("nothing to end");
    progress.note("a note");
    EXPECT_EQ(progress.steps().size(), 3u);
  }
  // Control characters are printed only to terminals
  const std::string text = stream.str();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4);
  EXPECT_EQ(text.find('\033'), std::string::npos);
  EXPECT_EQ(text.find("busy"), std::string::npos);
  EXPECT_NE(text.find("12 elements"), std::string::npos);
}

TEST(Groups, AreChainsOfConnectedThings)
{
  // The fifth value connects two groups of two
  const std::vector<double> values = {1., 2., 1.2, 2.1, 1.6, 9.};
  const auto                near   = [&](const int i, const int j) {
    EXPECT_LT(j, i);
    return std::abs(values[i] - values[j]) < 0.45;
  };
  EXPECT_EQ(members_of(connected_groups(4, near)), (std::vector<std::vector<int>>{{0, 2}, {1, 3}}));
  EXPECT_EQ(connected_groups(6, near), (std::vector<int>{0, 0, 0, 0, 0, 5}));
  EXPECT_EQ(members_of(connected_groups(6, near)), (std::vector<std::vector<int>>{{0, 1, 2, 3, 4}, {5}}));
}
