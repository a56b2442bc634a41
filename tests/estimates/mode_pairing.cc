#include "estimates/given_modes.h"

#include <squeal/estimates/mode_pairing.h>

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  /// Columns i and j turned into each other by an angle.
  void turn(ComplexDenseMatrix &X, const int i, const int j, const double degrees)
  {
    const double           angle = degrees * M_PI / 180., c = std::cos(angle), s = std::sin(angle);
    const Eigen::VectorXcd x = X.col(i), y = X.col(j);
    X.col(i) = c * x + s * y;
    X.col(j) = c * y - s * x;
  }

  std::vector<int> partners(const std::vector<PairedMode> &modes)
  {
    std::vector<int> result;
    for (const PairedMode &mode : modes)
      result.push_back(mode.partner);
    return result;
  }

  std::vector<int> marked(const std::vector<PairedMode> &modes)
  {
    std::vector<int> result;
    for (std::size_t i = 0; i < modes.size(); ++i)
      if (modes[i].in_cluster)
        result.push_back(i);
    return result;
  }
} // namespace

TEST(ModePairing, FollowsShapesNotNumbers)
{
  // The first two change places, and each has a factor of its own
  const ComplexDenseMatrix X = orthonormal(4);
  ComplexDenseMatrix       Y = X;
  Y.col(0)                   = 3. * i * X.col(1);
  Y.col(1)                   = -0.1 * X.col(0);
  const ModePairing pairing  = pair_modes(modes({10. * i, 11. * i, 20. * i, 30. * i}, X), modes({9.9 * i, 10.2 * i, 19. * i, 29. * i}, Y));
  EXPECT_EQ(partners(pairing.coarse), (std::vector<int>{1, 0, 2, 3}));
  EXPECT_EQ(partners(pairing.fine), (std::vector<int>{1, 0, 2, 3}));
  EXPECT_TRUE(marked(pairing.coarse).empty());
  EXPECT_TRUE(marked(pairing.fine).empty());
  for (const auto *side : {&pairing.coarse, &pairing.fine})
    for (const PairedMode &mode : *side)
      EXPECT_NEAR(mode.overlap, 1., 1e-12);
}

TEST(ModePairing, MarksTurnedModesAndNoOther)
{
  const ComplexDenseMatrix   X      = orthonormal(6);
  const std::vector<Complex> lambda = {10. * i, 10.1 * i, 20. * i, 20.1 * i, 30. * i, 30.1 * i};
  ComplexDenseMatrix         Y      = X;
  turn(Y, 0, 1, 45.); // a doublet
  turn(Y, 2, 3, 20.); // nearly one
  turn(Y, 4, 5, 70.); // turned on
  const ModePairing pairing = pair_modes(modes(lambda, Y), modes(lambda, X));
  // In a doublet the order of the frequencies decides; a turn by 70° is one by 20° of the other mode
  EXPECT_EQ(partners(pairing.coarse), (std::vector<int>{0, 1, 2, 3, 5, 4}));
  EXPECT_EQ(marked(pairing.coarse), (std::vector<int>{0, 1}));
  EXPECT_EQ(marked(pairing.fine), (std::vector<int>{0, 1}));
  EXPECT_NEAR(pairing.coarse[0].overlap, 0.5, 1e-12);
  EXPECT_NEAR(pairing.coarse[2].overlap, std::pow(std::cos(20. * M_PI / 180.), 2), 1e-12);
}

TEST(ModePairing, FindsClustersOfManyModes)
{
  // 12 modes mixed at random: none has a counterpart; the others have, also one with a small share of the cluster
  const ComplexDenseMatrix X = orthonormal(15), mixture = orthonormal(12).topRows(12);
  ComplexDenseMatrix       Y = X;
  std::vector<Complex>     lambda;
  std::vector<int>         members;
  Y.leftCols(12) = X.leftCols(12) * Eigen::HouseholderQR<ComplexDenseMatrix>(mixture).householderQ();
  turn(Y, 11, 12, 20.);
  for (int k = 0; k < 15; ++k)
    lambda.push_back((100. + k) * i);
  for (int k = 0; k < 12; ++k)
    members.push_back(k);
  const ModePairing pairing = pair_modes(modes(lambda, Y), modes(lambda, X));
  EXPECT_EQ(marked(pairing.coarse), members);
  EXPECT_EQ(marked(pairing.fine), members);
  for (int k = 0; k < 15; ++k)
    EXPECT_EQ(pairing.coarse[k].partner, k);
}

TEST(ModePairing, PairsClustersByTheirFrequenciesButForAShift)
{
  // Five modes mixed at random, all of them higher by more than their distances from each other
  const ComplexDenseMatrix X = orthonormal(7), mixture = orthonormal(5).topRows(5);
  ComplexDenseMatrix       Y         = X;
  Y.leftCols(5)                      = X.leftCols(5) * Eigen::HouseholderQR<ComplexDenseMatrix>(mixture).householderQ();
  const std::vector<Complex> fine    = {3500. * i, 3510. * i + 5., 3510. * i - 5., 3520. * i, 3540. * i, 4000. * i, 5000. * i};
  const std::vector<Complex> coarse  = {3600. * i, 3609. * i - 4., 3609. * i + 4., 3621. * i, 3642. * i, 4100. * i, 5100. * i};
  const ModePairing          pairing = pair_modes(modes(coarse, Y), modes(fine, X));
  EXPECT_EQ(partners(pairing.coarse), (std::vector<int>{0, 2, 1, 3, 4, 5, 6}));
  EXPECT_EQ(marked(pairing.coarse), (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST(ModePairing, SaysWhichModesHaveNoPartner)
{
  // Beyond the other band: single modes and a member of a doublet; a mode that is something else
  const ComplexDenseMatrix   X      = orthonormal(6);
  const std::vector<Complex> lambda = {10. * i, 20. * i, 30. * i, 30.1 * i};
  ComplexDenseMatrix         Y      = X.leftCols(4);
  turn(Y, 2, 3, 50.);
  Y.col(1)                  = X.col(4);
  const ModePairing pairing = pair_modes(modes({10. * i, 20. * i, 31. * i}, Y.leftCols(3)), modes(lambda, X.leftCols(4)));
  EXPECT_EQ(partners(pairing.coarse), (std::vector<int>{0, -1, 3}));
  EXPECT_EQ(partners(pairing.fine), (std::vector<int>{0, -1, -1, 2}));
  EXPECT_EQ(marked(pairing.coarse), (std::vector<int>{2}));
  EXPECT_EQ(marked(pairing.fine), (std::vector<int>{2, 3}));
  const ModesAtPoints none = modes({}, ComplexDenseMatrix(n_values, 0));
  EXPECT_EQ(partners(pair_modes(modes(lambda, X.leftCols(4)), none).coarse), (std::vector<int>(4, -1)));
  EXPECT_TRUE(pair_modes(none, none).coarse.empty());
}

TEST(ModePairing, KeepsTheTwoModesOfAFlutterApart)
{
  // u + e^{±iα} v: right eigenvectors of a coalesced pair overlap, yet growth and decay are two modes on both meshes
  const ComplexDenseMatrix X    = orthonormal(2);
  const auto               pair = [&X](const double angle) {
    ComplexDenseMatrix result(n_values, 2);
    result.col(0) = X.col(0) + std::polar(1., angle) * X.col(1);
    result.col(1) = X.col(0) + std::polar(1., -angle) * X.col(1);
    return result;
  };
  const ModePairing pairing = pair_modes(modes({10. * i - 1., 10. * i + 1.}, pair(0.7)), modes({9.9 * i + 0.9, 9.9 * i - 0.9}, pair(-0.6)));
  EXPECT_EQ(partners(pairing.coarse), (std::vector<int>{1, 0}));
  EXPECT_TRUE(marked(pairing.coarse).empty());
  EXPECT_GT(pairing.coarse[0].overlap, 0.99);
}
