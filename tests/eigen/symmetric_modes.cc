// SPDX-License-Identifier: GPL-3.0-or-later

#include "matrices.h"

#include <squeal/base/exceptions.h>
#include <squeal/base/tasks.h>
#include <squeal/eigen/symmetric_modes.h>
#include <squeal/linear_algebra/mass_orthonormal.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <gtest/gtest.h>

#include <tuple>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  using Case = std::tuple<RealSolver, Distribution>;

  class SymmetricModesBy : public ::testing::TestWithParam<Case>
  {
  protected:
    SymmetricModesBy()
    {
      options.solver = std::get<0>(GetParam());
      options.what   = "test";
    }
    Distribution distribution() const
    {
      return std::get<1>(GetParam());
    }
    SymmetricModesOptions options;
  };
  INSTANTIATE_TEST_SUITE_P(Solvers,
                           SymmetricModesBy,
                           ::testing::Combine(::testing::Values(RealSolver::lanczos, RealSolver::anasazi, RealSolver::arpack),
                                              ::testing::Values(Distribution::even, Distribution::first_process_empty)));

  /// Checks that apply to every result.
  void check_modes(const SparseMatrix &K, const SparseMatrix &M, const double limit, const SymmetricModes &modes)
  {
    const int n_modes = modes.eigenvalues.size();
    EXPECT_EQ(modes.n_counted, n_modes);
    ASSERT_EQ(modes.residuals.size(), modes.eigenvalues.size());
    EXPECT_TRUE(std::is_sorted(modes.eigenvalues.begin(), modes.eigenvalues.end()));
    EXPECT_LE(modes.eigenvalues.back(), limit * (1 + 1e-7));
    EXPECT_EQ(std::count(modes.eigenvalues.begin(), modes.eigenvalues.end(), 0.), modes.n_rigid_body);
    ASSERT_EQ(modes.vectors->n_columns(), n_modes);
    EXPECT_LT(orthonormality_defect(M, *modes.vectors), 1e-12);

    for (int j = 0; j < n_modes; ++j)
      {
        const MultiVector x  = view(*modes.vectors, j, 1);
        const MultiVector Kx = K * x, Mx = M * x;
        MultiVector       r(Kx);
        r.local() -= modes.eigenvalues[j] * Mx.local();
        const double scale = modes.eigenvalues[j] == 0. ? limit * column_norms(Mx)[0] : column_norms(Kx)[0];
        EXPECT_LT(column_norms(r)[0], 1e-9 * scale) << "mode " << j;
        EXPECT_NEAR(column_norms(r)[0] / scale, modes.residuals[j], 1e-12 + 0.1 * modes.residuals[j]);
      }
  }

  void expect_values(const std::vector<double> &found, const std::vector<double> &expected, const double tolerance)
  {
    ASSERT_LE(found.size(), expected.size());
    for (std::size_t j = 0; j < found.size(); ++j)
      EXPECT_NEAR(found[j] / expected[j], 1., tolerance) << "mode " << j;
  }
} // namespace

TEST_P(SymmetricModesBy, LaplacianOnACube)
{
  // Exact eigenvalues are known, with multiplicities up to six by symmetry
  const int    m     = 9;
  const auto   K     = laplacian(m, 1, distribution());
  const auto   M     = diagonal(K->rows(), [](int) { return 2.; });
  const double limit = 0.95;
  auto         exact = laplacian_eigenvalues(m, 1);
  for (double &value : exact)
    value /= 2.;

  const SymmetricModes modes = symmetric_modes(*K, *M, limit, options);
  EXPECT_EQ(modes.n_counted, std::lower_bound(exact.begin(), exact.end(), limit) - exact.begin());
  EXPECT_GT(modes.n_counted, 20);
  EXPECT_EQ(modes.n_rigid_body, 0);
  check_modes(*K, *M, limit, modes);
  expect_values(modes.eigenvalues, exact, 1e-12);
}

TEST_P(SymmetricModesBy, EigenvaluesOfMoreCopiesThanABlockHas)
{
  // Twelve identical bodies turn simple and triple eigenvalues into eigenvalues of multiplicity 12 and 36, more than the block size
  const int            m = 5, n_copies = 12;
  const auto           K     = laplacian(m, n_copies, distribution());
  const auto           M     = diagonal(K->rows(), [](int) { return 1.; });
  const double         limit = 1.7;
  const auto           exact = laplacian_eigenvalues(m, n_copies);
  const SymmetricModes modes = symmetric_modes(*K, *M, limit, options);
  EXPECT_EQ(modes.n_counted, 12 + 36);
  check_modes(*K, *M, limit, modes);
  expect_values(modes.eigenvalues, exact, 1e-12);
}

TEST_P(SymmetricModesBy, FreeBodyHasSixRigidModes)
{
  const Body   body  = plate({{12, 8, 2}}, 0.02, 0., distribution());
  const double limit = std::pow(2. * M_PI * 20e3, 2);
  const auto   modes = symmetric_modes(*body.stiffness, *body.mass, limit, options);
  EXPECT_EQ(modes.n_rigid_body, 6);
  EXPECT_GT(modes.n_counted, 10);
  EXPECT_GT(modes.eigenvalues[6], 1e-4 * limit);
  check_modes(*body.stiffness, *body.mass, limit, modes);

  options.shift       = 0.2 * limit;
  const auto by_shift = symmetric_modes(*body.stiffness, *body.mass, limit, options);
  ASSERT_EQ(by_shift.n_counted, modes.n_counted);
  for (int j = 6; j < modes.n_counted; ++j)
    EXPECT_NEAR(by_shift.eigenvalues[j] / modes.eigenvalues[j], 1., 1e-9);
}

TEST_P(SymmetricModesBy, SmallSystemsAndBandsWithoutModes)
{
  for (const int m : {1, 3})
    {
      const auto   K     = laplacian(m, 2, distribution());
      const auto   M     = diagonal(K->rows(), [](int) { return 0.5; });
      const double limit = 100.;
      const auto   modes = symmetric_modes(*K, *M, limit, options);
      EXPECT_EQ(modes.n_counted, 2 * m * m * m);
      check_modes(*K, *M, limit, modes);

      const auto none = symmetric_modes(*K, *M, 1e-3, options);
      EXPECT_EQ(none.n_counted, 0);
      EXPECT_TRUE(none.eigenvalues.empty());
      EXPECT_EQ(none.vectors, nullptr);
    }
}

TEST_P(SymmetricModesBy, IndefiniteStiffnessIsRefused)
{
  const auto L = laplacian(8, 1, distribution());
  const auto M = diagonal(L->rows(), [](int) { return 1.; });
  const auto K = add(1., *L, -1., *M);
  EXPECT_THROW(symmetric_modes(*K, *M, 2., options), SolverError);
  options.shift = 2.;
  EXPECT_THROW(symmetric_modes(*K, *M, 2., options), SolverError);
  EXPECT_THROW(symmetric_modes(*L, *M, -1., options), SolverError);
}

TEST(SymmetricModes, SolversAndLibrariesAgree)
{
  const Body   body  = plate({{14, 8, 2}}, 0.02, 1e10);
  const double limit = std::pow(2. * M_PI * 15e3, 2);

  std::vector<SymmetricModes> results;
  for (const RealSolver solver : {RealSolver::lanczos, RealSolver::anasazi, RealSolver::arpack})
    for (const FactorizationLibrary library : {FactorizationLibrary::automatic, FactorizationLibrary::mumps})
      {
        SymmetricModesOptions options;
        options.solver  = solver;
        options.library = library;
        results.push_back(symmetric_modes(*body.stiffness, *body.mass, limit, options));
        check_modes(*body.stiffness, *body.mass, limit, results.back());
      }
  EXPECT_EQ(count_below(*body.stiffness, *body.mass, limit, "test").n_modes, results.front().n_counted);
  EXPECT_GT(results.front().n_counted, 10);
  for (const SymmetricModes &modes : results)
    {
      ASSERT_EQ(modes.n_counted, results.front().n_counted);
      expect_values(modes.eigenvalues, results.front().eigenvalues, 1e-10);

      // Subspaces are equal if all singular values of ΦᵀMΨ are one
      DenseMatrix       overlap = gram(*results.front().vectors, *body.mass * *modes.vectors);
      const DenseMatrix squares = overlap.transpose() * overlap;
      EXPECT_LT(max_norm(squares - DenseMatrix::Identity(modes.n_counted, modes.n_counted)), 1e-8);
    }
}

TEST(SymmetricModes, DoNotDependOnThreads)
{
  const auto            copies = laplacian(5, 12), unit = diagonal(copies->rows(), [](int) { return 1.; });
  SymmetricModesOptions options;
  options.by_parts = true;
  const auto one   = symmetric_modes(*copies, *unit, 1.7, options);
  set_task_threads(2);
  const auto two = symmetric_modes(*copies, *unit, 1.7, options);
  set_task_threads(1);
  // Results are bitwise equal only on one process, because the order of sums over processes varies
  if (copies->rows().n_processes() > 1)
    {
      ASSERT_EQ(one.n_counted, two.n_counted);
      expect_values(two.eigenvalues, one.eigenvalues, 1e-10);
      return;
    }
  EXPECT_EQ(one.eigenvalues, two.eigenvalues);
  EXPECT_EQ(one.residuals, two.residuals);
  EXPECT_EQ(max_norm(one.vectors->local() - two.vectors->local()), 0.);
}

TEST(SymmetricModes, ModesOnTheLimitAreCountedAgain)
{
  // Twelve modes lie at the end of the band, and a thirteenth, included in the given count, just above it
  const auto            K = diagonal(rows(400), [](const int i) { return i < 12 ? 1. : i == 12 ? 1. + 5e-9 : 5. + i; });
  const auto            M = diagonal(K->rows(), [](int) { return 1.; });
  SymmetricModesOptions options;
  options.count = ModeCount{13, 1. + 1e-9};
  EXPECT_EQ(symmetric_modes(*K, *M, 1., options).n_counted, 13);
  options.count = ModeCount{14, 1. + 1e-7};
  EXPECT_THROW(symmetric_modes(*K, *M, 1., options), SolverError);
}

TEST(SymmetricModes, EndOfTheLowestIsFoundByCounting)
{
  const RowMap              map    = rows(9);
  const std::vector<double> values = {1., 2., 3., 50., 50., 50.02, 70., 400., 1e4};
  const auto                K      = Testing::diagonal(map, [&values](const int i) { return values[i]; });
  const auto                M      = Testing::diagonal(map, [](int) { return 1.; });
  const auto                end    = [&](const int n, const double first, const double highest = 1e5) {
    return end_of_lowest(*K, *M, n, first, highest, "test");
  };
  for (const double first : {0.5, 5e4})
    {
      for (const int n : {1, 2, 3, 6, 7, 8, 9})
        EXPECT_EQ(count_below(*K, *M, end(n, first), "test").n_modes, n) << "from " << first;
      // A multiple eigenvalue cannot be split; a cluster may require one more mode
      for (const int n : {4, 5})
        {
          const int n_below = count_below(*K, *M, end(n, first), "test").n_modes;
          EXPECT_GE(n_below, 5) << "from " << first;
          EXPECT_LE(n_below, 6) << "from " << first;
        }
    }
  EXPECT_THROW(end(9, 10., 5e3), SolverError); // fewer than 9 modes lie below this limit
}

TEST_P(SymmetricModesBy, UncoupledPartsAreSolvedAlone)
{
  // Every eigenvalue of seven equal chains of 60 masses, with interleaved dofs, is sevenfold
  constexpr int n_chains = 7, length = 60;
  const auto    map = rows(n_chains * length, distribution());
  const auto    K   = sparse(map, map, [](const int i) {
    Row row = {{i, 2.}};
    for (const int j : {i - n_chains, i + n_chains})
      if (j >= 0 && j < n_chains * length)
        row[j] = -1.;
    return row;
  });
  const auto    M   = Testing::diagonal(map, [](int) { return 1.; });

  const double limit         = 0.05;
  options.by_parts           = true;
  const SymmetricModes parts = symmetric_modes(*K, *M, limit, options);
  check_modes(*K, *M, limit, parts);
  EXPECT_EQ(parts.eigenvalues.size() % n_chains, 0u);
  for (std::size_t j = 0; j < parts.eigenvalues.size(); ++j)
    {
      const double omega = 2. * std::sin(0.5 * M_PI * (j / n_chains + 1.) / (length + 1.));
      EXPECT_NEAR(parts.eigenvalues[j] / (omega * omega), 1., 1e-11);
    }
}

// The basis must have space for one more block.
TEST_P(SymmetricModesBy, LargeBlocksInASmallSystem)
{
  constexpr int n            = 420;
  const auto    map          = rows(n, distribution());
  const auto    K            = Testing::diagonal(map, [](const int i) { return 1. + i / 12; });
  const auto    M            = Testing::diagonal(map, [](int) { return 1.; });
  options.block_size         = 24;
  const SymmetricModes modes = symmetric_modes(*K, *M, 7.5, options);
  check_modes(*K, *M, 7.5, modes);
  EXPECT_EQ(modes.eigenvalues.size(), 84u);
}

TEST(SymmetricModes, CallZeroWhatRoundingHidesWhateverTheBand)
{
  // The lowest mode of a chain of unit masses and springs, held at one end by a much softer spring k, has ω² ≈ k / n
  for (const int n : {40, 400}) // solved by a dense method, and by Lanczos
    for (const double stiffness : {0., 1e-7, 1e-3})
      for (const double limit : {1e-2, 3.})
        {
          const auto           K     = sparse(rows(n), rows(n), [&](const int i) {
            Row row = {{i, (i > 0) + (i + 1 < n) + (i == 0 ? stiffness : 0.)}};
            if (i > 0)
              row[i - 1] = -1.;
            if (i + 1 < n)
              row[i + 1] = -1.;
            return row;
          });
          const SymmetricModes modes = symmetric_modes(*K, *diagonal(K->rows(), [](int) { return 1.; }), limit);
          EXPECT_EQ(modes.n_rigid_body, stiffness == 0. ? 1 : 0) << n << ", " << stiffness << ", " << limit;
          EXPECT_NEAR(modes.eigenvalues.front(), stiffness / n, 0.2 * stiffness / n) << n << ", " << stiffness << ", " << limit;
        }
}
