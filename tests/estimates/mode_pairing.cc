// SPDX-License-Identifier: GPL-3.0-or-later

#include "solutions.h"

#include <squeal/estimates/discretisation_error.h>
#include <squeal/estimates/mode_pairing.h>

#include <Eigen/QR>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  const Complex i(0., 1.);

  constexpr int n_values = 40;

  ModesAtPoints modes(const std::vector<Complex> &lambda, const ComplexDenseMatrix &shapes)
  {
    const RowMap map = RowMap::even(n_values, MPI_COMM_WORLD);
    return {lambda, distribute(shapes.real(), map), distribute(shapes.imag(), map)};
  }

  /// Random orthonormal columns.
  ComplexDenseMatrix orthonormal(const int k)
  {
    const MultiVector random = random_vectors(RowMap::even(n_values, MPI_COMM_WORLD), 2 * k, 7);
    return Eigen::HouseholderQR<ComplexDenseMatrix>(from_halves(replicate(random))).householderQ() *
           ComplexDenseMatrix::Identity(n_values, k);
  }

  /// Rotates columns i and j in the plane that they span.
  void turn(ComplexDenseMatrix &X, const int i, const int j, const double degrees)
  {
    const double           angle = degrees * M_PI / 180., c = std::cos(angle), s = std::sin(angle);
    const Eigen::VectorXcd x = X.col(i), y = X.col(j);
    X.col(i) = c * x + s * y;
    X.col(j) = c * y - s * x;
  }

  /// Mixes the first n columns at random.
  ComplexDenseMatrix mixed(const ComplexDenseMatrix &X, const int n)
  {
    const ComplexDenseMatrix random = orthonormal(n).topRows(n);
    ComplexDenseMatrix       Y      = X;
    Y.leftCols(n)                   = X.leftCols(n) * Eigen::HouseholderQR<ComplexDenseMatrix>(random).householderQ();
    return Y;
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

  constexpr double share = 1. / 3.;

  /// Errors of modes with equal shapes on both meshes.
  std::vector<DiscretisationError> errors(const std::vector<Complex> &coarse, const std::vector<Complex> &fine)
  {
    const ComplexDenseMatrix X = orthonormal(fine.size());
    return discretisation_errors(modes(coarse, X), modes(fine, X), share, {});
  }
} // namespace

TEST(ModePairing, MarksTurnedModesAndNoOther)
{
  const ComplexDenseMatrix   X      = orthonormal(6);
  const std::vector<Complex> lambda = {10. * i, 10.1 * i, 20. * i, 20.1 * i, 30. * i, 30.1 * i};
  ComplexDenseMatrix         Y      = X;
  turn(Y, 0, 1, 45.); // ambiguous pair
  turn(Y, 2, 3, 20.); // unambiguous pair
  turn(Y, 4, 5, 70.); // exchanged pair
  const ModePairing pairing = pair_modes(modes(lambda, Y), modes(lambda, X));
  // Ambiguous modes are paired by frequency; a rotation by 70° is a rotation by 20° of exchanged modes
  EXPECT_EQ(partners(pairing.coarse), (std::vector<int>{0, 1, 2, 3, 5, 4}));
  EXPECT_EQ(marked(pairing.coarse), (std::vector<int>{0, 1}));
  EXPECT_EQ(marked(pairing.fine), (std::vector<int>{0, 1}));
  EXPECT_NEAR(pairing.coarse[0].overlap, 0.5, 1e-12);
  EXPECT_NEAR(pairing.coarse[2].overlap, std::pow(std::cos(20. * M_PI / 180.), 2), 1e-12);
}

TEST(ModePairing, FindsClustersOfManyModes)
{
  // Only the 12 randomly mixed modes have no individual counterparts; a mode with a small share of the cluster has one
  const ComplexDenseMatrix X = orthonormal(15);
  ComplexDenseMatrix       Y = mixed(X, 12);
  std::vector<Complex>     lambda;
  std::vector<int>         all(15);
  turn(Y, 11, 12, 20.);
  for (int k = 0; k < 15; ++k)
    lambda.push_back((100. + k) * i);
  std::iota(all.begin(), all.end(), 0);
  const ModePairing pairing = pair_modes(modes(lambda, Y), modes(lambda, X));
  for (const auto *side : {&pairing.coarse, &pairing.fine})
    EXPECT_EQ(marked(*side), std::vector<int>(all.begin(), all.begin() + 12));
  EXPECT_EQ(partners(pairing.coarse), all);
}

TEST(ModePairing, PairsClustersByTheirFrequenciesButForAShift)
{
  // Mix five modes at random and shift them by more than their spacing
  const ComplexDenseMatrix   X       = orthonormal(7);
  const std::vector<Complex> fine    = {3500. * i, 3510. * i + 5., 3510. * i - 5., 3520. * i, 3540. * i, 4000. * i, 5000. * i};
  const std::vector<Complex> coarse  = {3600. * i, 3609. * i - 4., 3609. * i + 4., 3621. * i, 3642. * i, 4100. * i, 5100. * i};
  const ModePairing          pairing = pair_modes(modes(coarse, mixed(X, 5)), modes(fine, X));
  EXPECT_EQ(partners(pairing.coarse), (std::vector<int>{0, 2, 1, 3, 4, 5, 6}));
  EXPECT_EQ(marked(pairing.coarse), (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST(ModePairing, SaysWhichModesHaveNoPartner)
{
  // One member of a doublet lies outside the other band, and one mode has a different shape
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
}

TEST(ModePairing, KeepsTheTwoModesOfAFlutterApart)
{
  // The right eigenvectors u + e^{±iα} v of a flutter pair overlap, but the growing and the decaying mode must not be exchanged
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

TEST(DiscretisationError, IsAShareOfTheDifference)
{
  const auto lambda = [](const double error) { return std::vector<Complex>{100. * (1. + error) * Complex(0.01 + error, 1.)}; };
  const std::vector<DiscretisationError> found = errors(lambda(4e-3), lambda(1e-3));
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
  // Rates in order: growth above the error, growth below it, decay below it, decay above it
  const std::vector<DiscretisationError> found =
    errors({0.010 * 100. + 100. * i, 200. * 0.020 + 200. * i, 300. * -0.020 + 300. * i, -4. + 400. * i},
           {0.011 * 100. + 100. * i, 200. * 0.001 + 200. * i, 300. * -0.001 + 300. * i, -4.1 + 400. * i});
  const std::vector<Verdict> expected = {Verdict::unstable, Verdict::undecided, Verdict::undecided, Verdict::stable};
  for (std::size_t j = 0; j < expected.size(); ++j)
    EXPECT_EQ(found[j].verdict, expected[j]) << j;
}

TEST(DiscretisationError, NeutralModesThatMayMeetAreUndecided)
{
  // Gaps on the fine and the coarse mesh: 1 and 4; 1 and 1.5, a change below 100 %; 0.001 and 0.01, too small for noticeable growth
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
