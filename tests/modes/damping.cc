// SPDX-License-Identifier: GPL-3.0-or-later

#include "solutions.h"

#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/mass_orthonormal.h>

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  constexpr double friction_coefficient = 0.6;

  /// The same material for disc and pins, with C = α M + β K.
  MaterialParameters proportional(const double alpha, const double beta, const std::vector<Mount> &mounts = {})
  {
    MaterialParameters materials  = mounted(mounts);
    materials.disc.rayleigh_alpha = alpha;
    materials.disc.rayleigh_beta  = beta;
    materials.pin                 = materials.disc;
    return materials;
  }

  /// Modal damping ratio, between 1 and 4 % within the band.
  double ratio_at(const double omega)
  {
    return 0.01 + 0.03 * omega / omega_max;
  }

  std::vector<double> ratios_of(const SymmetricModes &real)
  {
    std::vector<double> ratios;
    for (const double eigenvalue : real.eigenvalues)
      ratios.push_back(ratio_at(std::sqrt(eigenvalue)));
    return ratios;
  }

  CoupledSystem with_modal_damping(CoupledSystem system, const SymmetricModes &real)
  {
    add_modal_damping(system, *real.vectors, real.eigenvalues, ratios_of(real));
    return system;
  }

  /// C_m X of a system whose last term is modal damping.
  MultiVector modal_forces(const CoupledSystem &system, const MultiVector &X)
  {
    return times({system.terms.back()}, system.values, 1, X);
  }

  /// λ with Im λ > 0 of real modes that are damped independently: λ² + c(ω) λ + ω² = 0.
  std::vector<Complex> damped_oscillators(const SymmetricModes &real, const std::function<double(double)> &c)
  {
    std::vector<Complex> result;
    for (std::size_t j = real.n_rigid_body; j < real.eigenvalues.size(); ++j)
      {
        const double half = 0.5 * c(std::sqrt(real.eigenvalues[j]));
        result.emplace_back(-half, std::sqrt(real.eigenvalues[j] - half * half));
      }
    return result;
  }
} // namespace

TEST(RayleighDamping, ProportionalDampingOfEveryMode)
{
  // Without friction, C = α M + β K gives λ = −(α + β ω²)/2 ± i √(ω² − ((α + β ω²)/2)²). With an elastic mount, this requires
  // dashpots with β times the stiffness of the mount.
  int n_growing = 0;
  for (const auto &[alpha, beta] : {std::make_pair(500., 0.), {100., 3e-6}})
    {
      const Mount        mount{"disc_bore", 0., 7.80e10, 1.88e10};
      MaterialParameters materials = proportional(alpha, beta, {mount});
      if (beta > 0.)
        materials.dashpots.push_back({mount.surface, beta * mount.radial, beta * mount.tangential, beta * mount.axial});
      const Scene s(mesh_of(skewed_pins), materials, operating());
      const auto  real = real_modes(s.coupled);
      const auto  expected =
        damped_oscillators(real, [alpha = alpha, beta = beta](const double omega) { return alpha + beta * omega * omega; });
      ASSERT_GT(expected.size(), 3u);
      EXPECT_LT(largest(distances(krylov(s.coupled, 0.).lambda, expected)), 1e-9);
      EXPECT_LT(largest(distances(iterated(s.coupled, 0., 1e-10).lambda, expected)), 1e-9);

      // With friction, C̃ = α M̃ + β K̃, and every undamped λ_0 becomes a root of λ² + (α + β κ) λ + κ = 0 with κ = −λ_0²
      const auto           growing = krylov(undamped(s.coupled), friction_coefficient);
      std::vector<Complex> shifted;
      for (const Complex &l : growing.lambda)
        {
          const Complex kappa = -l * l, half = 0.5 * (alpha + beta * kappa), root = std::sqrt(half * half - kappa);
          shifted.push_back(-half + (root.imag() > 0. ? root : -root));
        }
      n_growing += n_unstable(growing);
      EXPECT_LT(largest(distances(krylov(s.coupled, friction_coefficient).lambda, shifted)), 1e-8);
    }
  EXPECT_GT(n_growing, 0);
}

TEST(RayleighDamping, ADiscThatMovesFreely)
{
  // The shifted factor and the reactions contain damping; λ = 0 and −α are also eigenvalues
  constexpr double alpha = 20., beta = 1e-6;
  const FreeDisc   disc(proportional(alpha, beta));
  const auto &[s, shift, real] = disc;
  const auto expected          = damped_oscillators(real, [](const double omega) { return alpha + beta * omega * omega; });

  SolverParameters solvers;
  solvers.complex_tolerance = 1e-10;
  ResidualIterationOptions options;
  options.band      = omega_max;
  options.tolerance = 1e-9;
  UpdatedInverse inverse(s.coupled, shift, FactorizationLibrary::automatic);
  Progress       progress;
  for (const double friction : {0., friction_coefficient})
    {
      const auto modes = krylov_modes(s.coupled, inverse, shift, friction, omega_max, real.eigenvalues.size(), solvers, progress);
      const auto other = residual_iteration(s.coupled, inverse, *real.vectors, friction, options, progress);
      EXPECT_LT(largest(distances(other.lambda, modes.lambda)), 2e-9);
      for (const ComplexModes &found : {modes, other})
        {
          ASSERT_EQ(found.real_values.size(), 3u);
          for (const double l : found.real_values)
            EXPECT_NEAR(l, -alpha, 1e-6);
        }
      if (friction == 0.)
        {
          EXPECT_LT(largest(distances(modes.lambda, expected)), 1e-9);
        }
    }
}

TEST(RayleighDamping, ResidualsOfBothSidesAreThoseOfTheMatrices)
{
  const Scene                s(mesh_of(skewed_pins), damped(mounted()), operating(RadialDissipation::consistent));
  const auto                 system = with_modal_damping(s.coupled, real_modes(s.coupled));
  const std::vector<Complex> lambda = {{-300., 9000.}, {50., 20000.}};
  const MultiVector          X = random_vectors(system.map(), 4), re = view(X, 0, 2), im = view(X, 2, 2);
  const auto                 matrices = with_friction(s.coupled, friction_coefficient);
  const Eigen::VectorXcd     factors = as_column(lambda), squares = factors.array().square();
  for (const bool left : {false, true})
    {
      const ComplexDenseMatrix R = from_halves(replicate(force_residuals(system, system.at(friction_coefficient), lambda, re, im, left)));
      const auto               times = [&](const SparseMatrix &A) { return from_halves(replicate(left ? transpose_times(A, X) : A * X)); };
      const ComplexDenseMatrix modal = from_halves(replicate(modal_forces(system, X))) * factors.asDiagonal();
      const ComplexDenseMatrix expected =
        times(*matrices.stiffness) + times(*matrices.damping) * factors.asDiagonal() + modal + times(*matrices.mass) * squares.asDiagonal();
      for (int j = 0; j < 2; ++j)
        {
          EXPECT_LT((expected - R).col(j).real().norm(), 1e-13 * expected.col(j).real().norm());
          EXPECT_LT((expected - R).col(j).imag().norm(), 1e-13 * expected.col(j).imag().norm());
          EXPECT_GT(modal.col(j).norm(), 1e-9 * expected.col(j).norm());
        }
    }
}

TEST(SpeedDependentFriction, MassOnASpring)
{
  // A mass on a belt, m ẍ + c ẋ + k x = μ(w_0 − ẋ) N, linearised as m ẍ + (c + μ'N) ẋ + k x = 0, is unstable if −μ'N > c
  const double m = 2., c = 0.05, k = 18., N = 3., w_0 = 0.5;
  const auto   friction = [](const double w) { return 0.3 + 0.2 * std::exp(-w / 0.4); };
  const double falling  = -0.5 * std::exp(-w_0 / 0.4);

  // The belt has no dof: P_t u = 0 - x, without motion along n and b
  const RowMap     map = rows(1), nodes = rows(1);
  const auto       one  = [&](const double value) { return Testing::diagonal(map, [value](int) { return value; }); };
  const auto       none = sparse(nodes, map, [](int) { return Row{}; });
  ContactOperators contact;
  contact.normal     = none;
  contact.tangential = sparse(nodes, map, [](int) { return Row{{0, -1.}}; });
  contact.radial     = none;
  contact.reaction   = none;
  contact.kernel     = one(1.);
  const SecondOrderSystem system{one(m), one(c), one(k)};
  for (const double slope : {falling, -1.001 * c / N, -0.999 * c / N, 0., 0.4})
    {
      const double        R       = -0.5 * (c + slope * N) / m;
      const CoupledSystem coupled = couple(system, contact, {{0.}, {slope * N}});
      for (const auto &values : solutions(coupled, friction(w_0)))
        {
          ASSERT_EQ(values.size(), 1u);
          EXPECT_LT(std::abs(values[0] - Complex(R, std::sqrt(k / m - R * R))), 1e-13);
          EXPECT_EQ(values[0].real() > 0., -slope * N > c);
        }
    }
}

TEST(ModalDamping, GivesEachModeItsRatioAndTheRestNothing)
{
  const Scene       s(mesh_of(skewed_pins), mounted(), operating());
  const auto        real   = real_modes(s.coupled);
  const MultiVector Phi    = *real.vectors;
  const auto        system = with_modal_damping(s.coupled, real);

  // Modal damping has no effect on vectors that are M-orthogonal to the modes
  const MultiVector X = random_vectors(system.map(), 3);
  const MultiVector Y = orthonormalize(*system.mass, &Phi, X, 1e-10);
  EXPECT_LT(max_norm(gram(Y, modal_forces(system, Y))), 1e-11 * max_norm(gram(Phi, modal_forces(system, Phi))));

  // Rigid-body modes and modes with zero ratio are undamped
  std::vector<double> eigenvalues = real.eigenvalues;
  eigenvalues.front()             = 0.;
  CoupledSystem free = s.coupled, none = s.coupled;
  add_modal_damping(free, Phi, eigenvalues, ratios_of(real));
  EXPECT_LT(column_norms(modal_forces(free, view(Phi, 0, 1)))[0], 1e-10 * column_norms(modal_forces(free, view(Phi, 1, 1)))[0]);
  add_modal_damping(none, Phi, real.eigenvalues, std::vector<double>(eigenvalues.size(), 0.));
  EXPECT_FALSE(none.has_damping());
  EXPECT_FALSE(s.coupled.has_damping());

  // Each mode has its own ratio: λ = −ζ ω ± i ω √(1 − ζ²)
  const auto expected = damped_oscillators(real, [](const double omega) { return 2. * ratio_at(omega) * omega; });
  EXPECT_LT(largest(distances(krylov(system, 0.).lambda, expected)), 1e-10);
  EXPECT_LT(largest(distances(krylov(system, 0., 1e-11, ShiftInverse::sparse_lu).lambda, expected)), 1e-10);
  EXPECT_LT(largest(distances(iterated(system, 0., 1e-11).lambda, expected)), 1e-10);
}

TEST(ModalDamping, BothSolversAgreeWithFriction)
{
  const Scene         s(mesh_of(skewed_pins), damped(mounted()), operating());
  const CoupledSystem bare =
    couple(s.system, s.contact, {std::vector<double>(s.interface.size(), 50.), std::vector<double>(s.interface.size(), -20.)});
  const auto system    = with_modal_damping(bare, real_modes(bare));
  const auto reference = krylov(system, friction_coefficient);
  for (const double tolerance : {1e-4, 1e-8})
    EXPECT_LT(largest(distances(iterated(system, friction_coefficient, tolerance).lambda, reference.lambda)), 2. * tolerance);
  EXPECT_LT(largest(reference.residuals), 1e-11);
  EXPECT_GT(largest(distances(krylov(bare, friction_coefficient).lambda, reference.lambda)), 1e-3); // modal damping changes the eigenvalues
}

TEST(ModalDamping, OfADiscThatMovesFreely)
{
  // The Krylov solver with a shift rejects modal damping, which the inverse does not include; the residual iteration accepts it
  const FreeDisc disc;
  const auto &[s, shift, real] = disc;
  const auto     system        = with_modal_damping(s.coupled, real);
  UpdatedInverse inverse(system, shift, FactorizationLibrary::automatic);
  Progress       progress;

  ResidualIterationOptions options;
  options.band      = omega_max;
  options.tolerance = 1e-10;
  const auto modes  = residual_iteration(system, inverse, *real.vectors, 0., options, progress);
  EXPECT_EQ(modes.n_rigid_body, 3);
  EXPECT_LT(largest(distances(modes.lambda, damped_oscillators(real, [](const double omega) { return 2. * ratio_at(omega) * omega; }))),
            1e-9);

  try
    {
      krylov_modes(system, inverse, shift, 0., omega_max, real.eigenvalues.size(), SolverParameters(), progress);
      FAIL() << "accepted modal damping with a shift";
    }
  catch (const SolverError &error)
    {
      const std::string message = error.what();
      EXPECT_NE(message.find("modal damping"), std::string::npos) << message;
      EXPECT_NE(message.find("Complex modes/Solver = residual iteration"), std::string::npos) << message;
    }
}
