// SPDX-License-Identifier: GPL-3.0-or-later

#include "flutter.h"
#include "solutions.h"

#include <squeal/model/elasticity.h>
#include <squeal/sensitivity/eigenvalue_derivatives.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  constexpr double friction = 0.5;

  /// Pins on a rotating disc with damped bodies and contact.
  struct DampedBrake
  {
    DampedBrake()
      : s(mesh_of(skewed_pins), damped(mounted({{"disc_bore", 2e10, 7.80e10, 1.88e10}})), operating(RadialDissipation::consistent))
      , bodies(body_terms(s.model, damped(mounted({{"disc_bore", 2e10, 7.80e10, 1.88e10}}))))
      , damping{s.damping.radial, s.damping.radial}
    {
      add_rotation(bodies, s.model, 30.);
      for (std::size_t node = 0; node < damping.sliding.size(); ++node)
        damping.sliding[node] *= -0.3 * (1. + node % 3);
    }

    CoupledSystem system(const ParameterValues &values, const ContactDamping &contact_damping) const
    {
      return Squeal::couple(merged(bodies.terms, values), s.contact, contact_damping);
    }

    CoupledSystem system() const
    {
      return system(bodies.values, damping);
    }

    Scene          s;
    BodyTerms      bodies;
    ContactDamping damping;
  };

  Eigentriples triples(const ComplexModes &modes)
  {
    return {modes.lambda, join({modes.real_part.get(), modes.imaginary_part.get()}),
            join({modes.left_real_part.get(), modes.left_imaginary_part.get()})};
  }

  /// dλ/ds of the eigenvalue nearest to each @p lambda, by fourth-order central differences from s = −2h, −h, h, 2h.
  std::vector<Complex> differences(const std::vector<Complex>                               &lambda,
                                   const std::function<std::vector<Complex>(double change)> &eigenvalues,
                                   const double                                              h)
  {
    std::vector<Complex> result(lambda.size(), 0.);
    for (const auto &[steps, weight] : {std::make_pair(1, 8. / 12.), std::make_pair(2, -1. / 12.)})
      for (const int side : {-1, 1})
        {
          const std::vector<Complex> there = eigenvalues(side * steps * h);
          for (std::size_t j = 0; j < lambda.size(); ++j)
            result[j] += side * weight / h * *std::min_element(there.begin(), there.end(), [&](const Complex &a, const Complex &b) {
                           return std::abs(a - lambda[j]) < std::abs(b - lambda[j]);
                         });
        }
    return result;
  }

  /// Compares derivatives with the tolerance 1e-5, plus the resolution 1e-9 |λ| of the differences.
  void expect_alike(const std::vector<Complex> &derivatives, const std::vector<Complex> &others, const std::vector<Complex> &lambda)
  {
    for (std::size_t j = 0; j < lambda.size(); ++j)
      EXPECT_LE(std::abs(derivatives[j] - others[j]), 1e-5 * std::abs(others[j]) + 1e-9 * std::abs(lambda[j])) << j << ": " << lambda[j];
  }

  std::vector<Complex> diagonal_derivatives(const ComplexDenseMatrix &N, const ComplexDenseMatrix &D)
  {
    std::vector<Complex> result;
    for (Eigen::Index j = 0; j < N.cols(); ++j)
      result.push_back(eigenvalue_derivative(N, D, static_cast<int>(j)));
    return result;
  }
} // namespace

TEST(Sensitivities, OfEveryParameterAgreeWithDifferences)
{
  const DampedBrake     brake;
  const CoupledSystem   system = brake.system();
  const Eigentriples    modes  = triples(iterated(system, friction, 1e-13));
  const TermProducts    of_contact(system.terms, modes), of_bodies(brake.bodies.terms, on_bodies(brake.s.contact, friction, modes));
  const ParameterValues values = system.at(friction);
  const auto            D = of_contact.by_lambda(values), Q = of_contact.pencil(values);

  // Right and left vectors are biorthogonal eigenvectors
  for (Eigen::Index i = 0; i < Q.rows(); ++i)
    for (Eigen::Index j = 0; j < Q.cols(); ++j)
      {
        EXPECT_LE(std::abs(Q(i, j)), 1e-6 * std::abs(modes.lambda[j] * D(j, j))) << i << ' ' << j;
        EXPECT_TRUE(i == j || std::abs(D(i, j)) <= 1e-5 * std::abs(modes.lambda[j])) << i << ' ' << j;
      }

  const auto expect = [&](const ComplexDenseMatrix &N, const double h, const std::function<ComplexModes(double change)> &changed) {
    expect_alike(diagonal_derivatives(N, D),
                 differences(
                   modes.lambda, [&](const double change) { return changed(change).lambda; }, h),
                 modes.lambda);
  };
  for (const auto &[name, value] : brake.bodies.values)
    {
      SCOPED_TRACE(name);
      expect(of_bodies.along(brake.bodies.values, {{name, value}}), 1e-4, [&, &name = name](const double change) { // d/d ln p
        ParameterValues bodies = brake.bodies.values;
        bodies[name].front() *= 1. + change;
        return krylov(brake.system(bodies, brake.damping), friction, 1e-12);
      });
    }
  expect(of_contact.along(values, {{SystemParameter::friction, {1.}}}), 1e-3,
         [&](const double change) { return krylov(system, friction + change, 1e-12); });
  for (const auto &[name, list] : {std::make_pair(SystemParameter::radial_damping, &ContactDamping::radial),
                                   std::make_pair(SystemParameter::sliding_damping, &ContactDamping::sliding)})
    {
      SCOPED_TRACE(name);
      expect(of_contact.along(values, {{name, brake.damping.*list}}), 1e-2, [&, list = list](const double change) {
        ContactDamping damping = brake.damping;
        for (double &c : damping.*list)
          c *= 1. + change;
        return krylov(brake.system(brake.bodies.values, damping), friction, 1e-12);
      });
    }
}

TEST(Sensitivities, DoNotChangeWithTheUnitOfForce)
{
  // λ is proportional to √(stiffness / density) for any friction: dλ / d ln p sums to λ/2 over stiffnesses, −λ/2 over densities
  const Scene           s(mesh_of(skewed_pins), mounted(), operating());
  const BodyTerms       bodies = body_terms(s.model, mounted());
  const Eigentriples    modes  = triples(iterated(s.coupled, friction, 1e-13));
  const TermProducts    of_contact(s.coupled.terms, modes), of_bodies(bodies.terms, on_bodies(s.contact, friction, modes));
  const ParameterValues values = s.coupled.at(friction);
  ParameterValues       stiffnesses, densities;
  for (const auto &[name, value] : bodies.values)
    {
      if (name.find("density") == 0)
        densities[name] = value;
      else if (name.find("Rayleigh") != 0)
        stiffnesses[name] = value;
    }
  const auto D            = of_contact.by_lambda(values);
  const auto by_stiffness = diagonal_derivatives(of_bodies.along(bodies.values, stiffnesses), D);
  const auto by_density   = diagonal_derivatives(of_bodies.along(bodies.values, densities), D);
  for (std::size_t j = 0; j < modes.lambda.size(); ++j)
    {
      EXPECT_LE(std::abs(by_stiffness[j] - 0.5 * modes.lambda[j]), 1e-10 * std::abs(modes.lambda[j]));
      EXPECT_LE(std::abs(by_density[j] + 0.5 * modes.lambda[j]), 1e-10 * std::abs(modes.lambda[j]));
    }
}

namespace
{
  /// λ and vectors of both modes at a friction coefficient.
  Eigentriples flutter_modes(const CoupledSystem &system, const double mu)
  {
    UpdatedInverse           inverse(system, 0., FactorizationLibrary::automatic);
    ResidualIterationOptions options;
    options.band      = 10.;
    options.tolerance = 1e-12;
    Progress progress;
    return triples(residual_iteration(system, inverse, unit_vectors(system.map()), mu, options, progress));
  }
} // namespace

TEST(Sensitivities, OfACoalescence)
{
  // The coalescence satisfies 1 + 2.8 (0.7 − s μ_c) = 0
  const double           s = 1.3, mu_c = Flutter{s}.coalescence();
  const CoupledSystem    system = Flutter{s}.system();
  std::array<Complex, 3> by_friction{}, by_stiffness{};
  for (int distance = 1; distance <= 3; ++distance)
    for (const int side : {-1, 1})
      {
        const double       mu    = mu_c + side * distance * 0.01;
        const Eigentriples modes = flutter_modes(system, mu);
        ASSERT_EQ(modes.lambda.size(), 2u);
        const TermProducts products(system.terms, modes);
        const auto         values = system.at(mu);
        const auto         D      = products.by_lambda(values);
        by_friction[distance - 1] +=
          0.5 * squared_difference_derivative(products.along(values, {{SystemParameter::friction, {1.}}}), D, modes.lambda);
        // dQ/dk for a spring k at the first mass
        const DenseMatrix        u = replicate(modes.right), w = replicate(modes.left);
        const auto               x = from_halves(u), y = from_halves(w);
        const ComplexDenseMatrix N = y.row(0).transpose() * x.row(0);
        by_stiffness[distance - 1] += 0.5 * squared_difference_derivative(N, D, modes.lambda);
      }
  const ValueAtCentre of_friction = value_at_centre(by_friction), of_stiffness = value_at_centre(by_stiffness);

  // With ω² = a ± √b, a = 5/2 + k/2, b = (1 + k)²/4 + 0.7 (0.7 − s μ): δ² = (λ_1 − λ_2)² = −2 a + 2 √(a² − b), b = 0 at μ_c
  const double db_dmu = -0.7 * s, db_dk = 0.5, a = 2.5;
  EXPECT_NEAR(of_friction.value.real(), -db_dmu / a, 1e-6);
  EXPECT_NEAR(of_friction.value.imag(), 0., 1e-8);
  EXPECT_LE(std::abs(of_friction.value.real() + db_dmu / a), 3. * of_friction.error);
  const double rate = -(of_stiffness.value / of_friction.value).real();
  EXPECT_NEAR(rate, -db_dk / db_dmu, 1e-6 * std::abs(db_dk / db_dmu));
}

TEST(Sensitivities, OfTheMeanStayFiniteAtACoalescence)
{
  const double         s = 1.3, mu_c = Flutter{s}.coalescence();
  const CoupledSystem  system = Flutter{s}.system();
  double               single = 0.;
  std::vector<Complex> means;
  for (const double distance : {1e-3, 1e-5, 1e-7})
    {
      const double       mu    = mu_c + distance;
      const Eigentriples modes = flutter_modes(system, mu);
      ASSERT_EQ(modes.lambda.size(), 2u);
      const TermProducts products(system.terms, modes);
      const auto         values = system.at(mu);
      const auto         D = products.by_lambda(values), N = products.along(values, {{SystemParameter::friction, {1.}}});
      const double       modulus = std::abs(eigenvalue_derivative(N, D, 0));
      EXPECT_GT(modulus, 5. * single); // derivatives grow like the inverse square root of the distance
      single = modulus;
      means.push_back(mean_derivative(N, D, {0, 1}));
    }
  // λ² = −a ± i √|b|: the mean of both is i √((a + √(a² − b)) / 2), with the derivative −i b' / (8 a^{3/2}) at b = 0
  const double expected = 0.7 * s / (8. * std::pow(2.5, 1.5));
  for (const Complex &mean : means)
    EXPECT_LE(std::abs(mean - Complex(0., expected)), 2e-3 * expected) << mean;
  EXPECT_LE(std::abs(means.back() - Complex(0., expected)), 1e-5 * expected) << means.back();
}
