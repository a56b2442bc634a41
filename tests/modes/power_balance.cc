// SPDX-License-Identifier: GPL-3.0-or-later

#include "solutions.h"

#include <squeal/base/conventions.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/modes/power_balance.h>

#include <gtest/gtest.h>

#include <numeric>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  constexpr double friction = 0.6;

  double summed(const std::vector<double> &values)
  {
    return std::accumulate(values.begin(), values.end(), 0.);
  }

  /// Pins on a disc with all kinds of damping.
  struct DampedBrake
  {
    DampedBrake()
      : s(mesh_of(skewed_pins), damped(mounted()), operating(RadialDissipation::consistent))
      , damping(s.damping)
    {
      damping.sliding.resize(damping.radial.size());
      for (std::size_t node = 0; node < damping.radial.size(); ++node)
        damping.sliding[node] = -0.3 * damping.radial[node] * (1. + node % 3);
      system                    = couple(s.system, s.contact, damping);
      const SymmetricModes real = real_modes(system);
      add_modal_damping(system, *real.vectors, real.eigenvalues, std::vector<double>(real.eigenvalues.size(), 1e-4));
    }

    PowerBalance balance(const ComplexModes &modes, const int j) const
    {
      return power_balance(s.system, s.model, system, s.interface, damping, friction, modes.lambda[j], view(*modes.real_part, j, 1),
                           view(*modes.imaginary_part, j, 1));
    }

    Scene          s;
    ContactDamping damping;
    CoupledSystem  system;
  };

  /// φᴴ A φ with a sparse matrix on coupled dofs.
  std::complex<double> quadratic_form(const SparseMatrix &A, const MultiVector &re, const MultiVector &im)
  {
    const DenseMatrix x = replicate(re), y = replicate(im), Ax = replicate(A * re), Ay = replicate(A * im);
    return {(x.transpose() * Ax + y.transpose() * Ay)(0, 0), (x.transpose() * Ay - y.transpose() * Ax)(0, 0)};
  }
} // namespace

TEST(PowerBalances, AddUpToTheDivergenceRateAndAgreeWithTheSparseMatrices)
{
  const DampedBrake  brake;
  const ComplexModes modes  = krylov(brake.system, friction);
  CoupledSystem      bodies = couple(brake.s.system, brake.s.contact); // the system without contact damping and modal damping
  const auto         with = with_friction(bodies, friction), without = with_friction(bodies, 0.);
  ASSERT_GT(n_unstable(modes), 0);
  ASSERT_LT(n_unstable(modes), static_cast<int>(modes.lambda.size()));
  for (std::size_t j = 0; j < modes.lambda.size(); ++j)
    {
      const PowerBalance b  = brake.balance(modes, j);
      const double       xi = modal_quantities(modes.lambda[j]).divergence_rate;
      EXPECT_NEAR(b.sum(), xi, 1e-8 * std::max(std::abs(xi), 1e-4)) << j;

      // Damping dissipates energy, except for a friction coefficient that decreases with sliding speed
      EXPECT_LE(*std::max_element(b.radial_damping.begin(), b.radial_damping.end()), 0.);
      EXPECT_GE(*std::min_element(b.sliding_damping.begin(), b.sliding_damping.end()), 0.);
      EXPECT_LE(*std::max_element(b.bodies.begin(), b.bodies.end()), 0.);
      EXPECT_LT(summed(b.radial_damping), 0.);
      EXPECT_GT(summed(b.sliding_damping), 0.);
      EXPECT_LT(b.bodies.front(), 0.);
      EXPECT_NEAR(b.modal_damping, -1e-4, 5e-5);

      // Compute the same contributions from the sparse matrices
      const MultiVector          re = view(*modes.real_part, j, 1), im = view(*modes.imaginary_part, j, 1);
      const std::complex<double> lambda  = modes.lambda[j];
      const auto                 form    = [&](const std::shared_ptr<const SparseMatrix> &A) { return quadratic_form(*A, re, im); };
      const double               energy  = (std::norm(lambda) * form(without.mass) + form(without.stiffness)).real() / 4.;
      const double               to_rate = 1. / (2. * lambda.imag() * energy);

      const std::complex<double> force = lambda * lambda * (form(with.mass) - form(without.mass)) +
                                         lambda * (form(with.damping) - form(without.damping)) + form(with.stiffness) -
                                         form(without.stiffness);
      const double by_friction = -0.5 * (std::conj(lambda) * force).real() * to_rate;
      EXPECT_NEAR(summed(b.into_disc) + summed(b.into_pins), by_friction, 1e-9 * std::max(std::abs(by_friction), 1e-4)) << j;

      const double by_bodies = -0.5 * std::norm(lambda) * form(without.damping).real() * to_rate;
      EXPECT_NEAR(summed(b.bodies), by_bodies, 1e-9 * std::abs(by_bodies)) << j;
    }
}
