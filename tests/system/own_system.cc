// SPDX-License-Identifier: GPL-3.0-or-later

#include "matrices.h"

#include <squeal/estimates/judged_modes.h>
#include <squeal/linear_algebra/dense_eigenproblems.h>
#include <squeal/sensitivity/eigenvalue_derivatives.h>
#include <squeal/tracking/branches.h>
#include <squeal/tracking/error_controlled_sweep.h>

#include <gtest/gtest.h>

#include <complex>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  using Complex = std::complex<double>;

  constexpr double band       = 3.6;                                ///< end of the band [rad/s]
  constexpr int    chain_size = 15, n_coupled = 2 * chain_size - 2; ///< dofs of each chain, and of both chains in contact
  constexpr double before = 0.2, after = 0.3;                       ///< flutter begins between these friction coefficients

  /// Two mass-spring chains in contact at two nodes, given by matrices without a mesh.
  struct Chains
  {
    explicit Chains(const double beta = 0.)
    {
      K = M = DenseMatrix::Zero(2 * chain_size, 2 * chain_size);
      P_n = P_t = DenseMatrix::Zero(2, 2 * chain_size);
      T_c       = DenseMatrix::Zero(2 * chain_size, n_coupled);
      for (int chain = 0; chain < 2; ++chain)
        for (int i = 0; i < chain_size; ++i)
          {
            const int dof = chain * chain_size + i;
            M(dof, dof)   = chain == 0 ? 1. + 0.1 * i : 0.6 + 0.05 * i;
            K(dof, dof) += 1. + 0.3 * i + 0.5 * chain;
            if (i + 1 < chain_size)
              spring(dof, dof + 1, 2. + 0.4 * i - 0.7 * chain, i % 2 == 0 ? 1. : -1.);
            if (i + 3 < chain_size)
              spring(dof, dof + 3, 1.5 + 0.2 * i, -1.);
          }
      C = beta * K;
      for (int c = 0; c < 2; ++c)
        {
          P_n(c, 2 * c) = P_t(c, 2 * c + 1) = 1.;
          P_n(c, chain_size + 2 * c) = P_t(c, chain_size + 2 * c + 1) = -1.;
        }
      // Dofs 0 and 2 of the second chain follow dofs 0 and 2 of the first
      for (int dof = 0, column = 0; dof < 2 * chain_size; ++dof)
        if (dof == chain_size || dof == chain_size + 2)
          T_c.row(dof) = T_c.row(dof - chain_size);
        else
          T_c(dof, column++) = 1.;
    }

    void spring(const int i, const int j, const double k, const double sign)
    {
      K(i, i) += k;
      K(j, j) += k;
      K(i, j) += sign * k;
      K(j, i) += sign * k;
    }

    CoupledSystem system() const
    {
      const RowMap apart = rows(2 * chain_size), contact = rows(2), coupled = rows(n_coupled);
      const auto   matrix = [](const RowMap &row_map, const RowMap &column_map, const DenseMatrix &A) {
        return sparse(row_map, column_map, [&](const int i) {
          Row row;
          for (int j = 0; j < A.cols(); ++j)
            if (A(i, j) != 0.)
              row[j] = A(i, j);
          return row;
        });
      };
      std::vector<Term> terms = {sparse_term("stiffness", 0, {}, matrix(apart, apart, K)),
                                 sparse_term("mass", 2, {}, matrix(apart, apart, M))};
      if (C.norm() > 0.)
        terms.push_back(sparse_term("damping", 1, {}, matrix(apart, apart, C)));
      return couple(terms, {matrix(contact, apart, P_n),
                            matrix(contact, apart, P_t),
                            matrix(contact, apart, 0. * P_t),
                            matrix(apart, coupled, T_c),
                            matrix(contact, apart, 0.5 * P_n),
                            {}});
    }

    /// λ in the band, by ascending frequency, from the companion form of T_cᵀ (I − (μ/2) P_tᵀ P_n) {M, C, K} T_c by LAPACK.
    std::vector<Complex> lambda(const double mu) const
    {
      const auto with_friction = [&](const DenseMatrix &X) -> DenseMatrix {
        return T_c.transpose() * (X - 0.5 * mu * P_t.transpose() * P_n * X) * T_c;
      };
      const auto  factor    = with_friction(M).partialPivLu();
      DenseMatrix companion = DenseMatrix::Zero(2 * n_coupled, 2 * n_coupled);
      companion.topRightCorner(n_coupled, n_coupled).setIdentity();
      companion.bottomLeftCorner(n_coupled, n_coupled)  = -factor.solve(with_friction(K));
      companion.bottomRightCorner(n_coupled, n_coupled) = -factor.solve(with_friction(C));
      std::vector<Complex> result;
      for (const Complex &value : eigenpairs(companion).values)
        if (value.imag() > 0. && value.imag() <= band)
          result.push_back(value);
      std::sort(result.begin(), result.end(), [](const Complex &a, const Complex &b) { return a.imag() < b.imag(); });
      return result;
    }

    bool is_unstable(const double mu) const
    {
      const auto values = lambda(mu);
      return std::any_of(values.begin(), values.end(), [](const Complex &value) { return value.real() > 1e-7; });
    }

    DenseMatrix M, C, K, P_n, P_t, T_c;
  };

  /// Results computed for a system without a mesh.
  struct Solved
  {
    explicit Solved(const double beta)
      : chains(beta)
      , system(chains.system())
      , frictionless(system_modes(system, 0., band, number_of_modes(system, 1.05 * band, solvers, progress), 8, solvers, progress))
    {
      solvers.complex_tolerance   = 1e-12;
      solvers.iteration_tolerance = 1e-10;
    }

    JudgedModes modes(const double mu, const ComplexSolver solver)
    {
      solvers.complex_solver = solver;
      return modes_with_friction(system, frictionless, mu, band, solvers, progress);
    }

    Progress         progress;
    SolverParameters solvers;
    Chains           chains;
    CoupledSystem    system;
    SystemModes      frictionless;
  };

  constexpr double undamped_and_damped[] = {0., 5e-4};

  /// Largest relative distance of an eigenvalue from its nearest neighbour in the other list; both lists must have the same size.
  double farthest(const std::vector<Complex> &found, const std::vector<Complex> &expected)
  {
    EXPECT_EQ(found.size(), expected.size());
    double result = 0.;
    for (const Complex &value : found)
      {
        double nearest = std::abs(value);
        for (const Complex &other : expected)
          nearest = std::min(nearest, std::abs(other - value));
        result = std::max(result, nearest / std::abs(value));
      }
    return result;
  }
} // namespace

TEST(OwnSystem, ComplexModes)
{
  for (const double beta : undamped_and_damped)
    {
      Solved solved(beta);
      for (const double mu : {0., 0.1, 0.5})
        for (const ComplexSolver solver : {ComplexSolver::krylov, ComplexSolver::residual_iteration})
          {
            const JudgedModes judged = solved.modes(mu, solver);
            EXPECT_LT(farthest(judged.modes.lambda, solved.chains.lambda(mu)), 1e-9);
            EXPECT_EQ(judged.n_unstable(), mu == 0.5 ? 1u : 0u);
          }
    }
}

TEST(OwnSystem, ThresholdOfFlutter)
{
  for (const double beta : undamped_and_damped)
    {
      Solved     solved(beta);
      ChartModel model(solved.system, *solved.frictionless.inverse, 0., *solved.frictionless.real.vectors, band);
      const auto at = [](const double mu) {
        OperatingPoint point;
        point.friction_coefficient = mu;
        return point;
      };
      const auto points = [&](const std::vector<double> &mu) {
        std::vector<OperatingPoint> result;
        std::transform(mu.begin(), mu.end(), std::back_inserter(result), at);
        return result;
      };
      const std::vector<double>   grid = {0., 0.1, 0.2, 0.3, 0.4, 0.5};
      ErrorControlledSweepOptions sweep_options;
      sweep_options.tolerance = 1e-9;
      error_controlled_sweep(
        model, points(grid), {5, 0, 2}, sweep_options, [](int, ChartPoint &&) {}, MPI_COMM_WORLD, solved.progress);

      ChartOptions options;
      options.largest_circular_frequency = band;
      const StabilityChart chart         = stability_chart(
                grid, [&](const std::vector<double> &mu) { return evaluate(model, points(mu), MPI_COMM_WORLD); }, options,
                zero_predictor(model, at, MPI_COMM_WORLD));

      double low = before, high = after;
      ASSERT_FALSE(solved.chains.is_unstable(low));
      ASSERT_TRUE(solved.chains.is_unstable(high));
      while (high - low > 1e-9)
        (solved.chains.is_unstable(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
      ASSERT_EQ(chart.thresholds.size(), 1u);
      EXPECT_EQ(chart.thresholds[0].event, ThresholdEvent::onset);
      EXPECT_EQ(chart.thresholds[0].mechanism, beta == 0. ? ThresholdMechanism::coalescence : ThresholdMechanism::zero_growth);
      EXPECT_NEAR(chart.thresholds[0].friction_coefficient, low, 1e-6);
    }
}

TEST(OwnSystem, CountByTheArgumentPrinciple)
{
  for (const double beta : undamped_and_damped)
    {
      Solved               solved(beta);
      const ContourOptions options = contour_of_band(solved.system, solved.frictionless, band, solved.solvers);
      if (options.method == ContourMethod::sparse_lu && solved.system.map().n_processes() > 1)
        continue;
      for (const double mu : {0.1, 0.5})
        EXPECT_EQ(count_by_contour(solved.system, {mu}, options, solved.progress).front().n_modes,
                  static_cast<int>(solved.chains.lambda(mu).size()));
    }
}

TEST(OwnSystem, DerivativesByFriction)
{
  constexpr double mu = 0.15, h = 1e-4;
  for (const double beta : undamped_and_damped)
    {
      Solved                   solved(beta);
      const ComplexModes       modes = solved.modes(mu, ComplexSolver::residual_iteration).modes;
      const TermProducts       products(solved.system.terms, {modes.lambda, join({modes.real_part.get(), modes.imaginary_part.get()}),
                                                              join({modes.left_real_part.get(), modes.left_imaginary_part.get()})});
      const ParameterValues    values = solved.system.at(mu);
      const ComplexDenseMatrix N = products.along(values, {{SystemParameter::friction, {1.}}}), D = products.by_lambda(values);
      const auto               left = solved.chains.lambda(mu - h), right = solved.chains.lambda(mu + h);
      ASSERT_EQ(left.size(), modes.lambda.size());
      ASSERT_EQ(right.size(), modes.lambda.size());
      for (std::size_t j = 0; j < left.size(); ++j)
        EXPECT_LT(std::abs(eigenvalue_derivative(N, D, static_cast<int>(j)) - (right[j] - left[j]) / (2. * h)), 1e-6);
    }
}

TEST(OwnSystem, Reduction)
{
  constexpr double mu = 0.5;
  for (const double beta : undamped_and_damped)
    {
      Solved solved(beta);
      // Errors are 6e-4 with real modes only, and 4e-6 with real modes and their responses to friction
      ReducedModel real(solved.system);
      real.extend(MultiVector(*solved.frictionless.real.vectors));
      const ReducedModel responses = starting_model(solved.system, *solved.frictionless.inverse, *solved.frictionless.real.vectors, true);
      EXPECT_LT(responses.size(), n_coupled);
      EXPECT_LT(farthest(reduced_modes(real, mu, band).lambda, solved.chains.lambda(mu)), 1e-3);
      EXPECT_LT(farthest(reduced_modes(responses, mu, band).lambda, solved.chains.lambda(mu)), 1e-5);
    }
}
