// SPDX-License-Identifier: GPL-3.0-or-later

#include "flutter.h"

#include <squeal/base/exceptions.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/modes/condensed_determinant.h>
#include <squeal/modes/contour_count.h>
#include <squeal/linear_algebra/dense_lu.h>

#include <gtest/gtest.h>

#include <iterator>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  ContourOptions contour(const double        largest_circular_frequency,
                         const double        largest_growth = 0.,
                         const ContourMethod method         = ContourMethod::condensed)
  {
    ContourOptions options;
    options.largest_circular_frequency = largest_circular_frequency;
    options.largest_growth             = largest_growth;
    options.method                     = method;
    return options;
  }

  std::vector<ContourCount> count(const CoupledSystem &system, const std::vector<double> &mu, const ContourOptions &options)
  {
    Progress progress;
    return count_by_contour(system, mu, options, progress);
  }

  /// Methods available for this number of processes.
  std::vector<ContourMethod> methods(const CoupledSystem &system)
  {
    if (system.map().n_processes() > 1)
      return {ContourMethod::condensed};
    return {ContourMethod::condensed, ContourMethod::sparse_lu};
  }

  /// Number of eigenvalues in the rectangle.
  int n_inside(const std::vector<Complex> &lambda, const double largest_circular_frequency, const double largest_growth = 0.)
  {
    const double a = largest_growth > 0. ? largest_growth : 0.1 * largest_circular_frequency;
    return std::count_if(lambda.begin(), lambda.end(), [&](const Complex &l) {
      return std::abs(l.real()) < a && l.imag() > 1e-3 * largest_circular_frequency && l.imag() < largest_circular_frequency;
    });
  }

  std::string refusal(const CoupledSystem &system, const double mu, const ContourOptions &options)
  {
    try
      {
        count(system, {mu}, options);
      }
    catch (const SolverError &error)
      {
        return error.what();
      }
    return "";
  }

  Scene scene(const RadialDissipation dissipation, const MaterialParameters &materials = mounted())
  {
    return Scene(mesh_of(skewed_pins), materials, operating(dissipation));
  }
} // namespace

TEST(ContourCount, FlutterOfTwoDegreesOfFreedom)
{
  const Flutter       flutter;
  const CoupledSystem system = flutter.system();
  for (const ContourMethod method : methods(system))
    {
      // Below the threshold, both eigenvalues are imaginary, and a narrow contour contains them
      const double stable = 0.9 * flutter.coalescence(), omega = flutter.lambda(stable).back().imag();
      EXPECT_EQ(count(system, {stable}, contour(3., 0.01, method))[0].n_modes, 2);
      EXPECT_EQ(count(system, {stable}, contour(1.0001 * omega, 0.01, method))[0].n_modes, 2);
      EXPECT_EQ(count(system, {stable}, contour(0.9999 * omega, 0.01, method))[0].n_modes, 1);

      // Above the threshold, eigenvalues are ∓R + iω
      const double  unstable = 1.3 * flutter.coalescence();
      const Complex l        = flutter.lambda(unstable).back();
      ASSERT_GT(std::abs(l.real()), 0.05);
      EXPECT_EQ(count(system, {unstable}, contour(3., 1.01 * std::abs(l.real()), method))[0].n_modes, 2);
      const ContourCount narrow = count(system, {unstable}, contour(3., 0.99 * std::abs(l.real()), method))[0];
      EXPECT_EQ(narrow.n_modes, 0);
      EXPECT_EQ(narrow.n_frictionless, 2);
      EXPECT_EQ(count(system, {unstable}, contour(0.999 * l.imag(), 1., method))[0].n_modes, 0);
      EXPECT_EQ(count(system, {unstable}, contour(1.001 * l.imag(), 1., method))[0].n_modes, 2);
    }
}

TEST(ContourCount, AgreesWithBothSolversUnderStrongFriction)
{
  // Strong friction causes static divergence and growth rates beyond the band
  const Scene  s      = scene(RadialDissipation::none);
  const double radius = Band(omega_max).radius();
  int          n_real = 0;
  for (const double mu : {3., 10.})
    {
      const ComplexModes found = krylov(s.coupled, mu, 1e-9), other = iterated(s.coupled, mu, 1e-8);
      EXPECT_LT(largest(distances(other.lambda, found.lambda)), 1e-6);
      EXPECT_EQ(count(s.coupled, {mu}, contour(omega_max))[0].n_modes, n_inside(found.lambda, omega_max));

      // Compare real eigenvalues and all eigenvalues with |λ| ≤ radius with a dense solution
      const SecondOrderSystem matrices = with_friction(s.coupled, mu);
      const auto              dense    = dense_quadratic_modes(to_dense(*matrices.mass), nullptr, to_dense(*matrices.stiffness), omega_max);
      std::vector<Complex>    inside;
      std::copy_if(dense.values.begin(), dense.values.end(), std::back_inserter(inside),
                   [&](const Complex &l) { return std::abs(l) <= radius; });
      EXPECT_LT(largest(distances(found.lambda, inside)), 1e-7);
      std::vector<double> real;
      std::copy_if(dense.real_values.begin(), dense.real_values.end(), std::back_inserter(real),
                   [&](const double l) { return std::abs(l) <= radius; });
      ASSERT_EQ(found.real_values.size(), real.size());
      ASSERT_EQ(other.real_values.size(), real.size());
      for (std::size_t j = 0; j < real.size(); ++j)
        {
          EXPECT_NEAR(found.real_values[j] / real[j], 1., 1e-7);
          EXPECT_NEAR(other.real_values[j] / real[j], 1., 1e-6);
        }
      n_real += real.size();
    }
  EXPECT_GT(n_real, 0);
}

TEST(ContourCount, AgreesWithTheModesFound)
{
  const std::vector<double> mu = {0.4, 1.};
  for (const RadialDissipation dissipation : {RadialDissipation::none, RadialDissipation::consistent})
    {
      const Scene      s        = scene(dissipation);
      const int        n_real   = real_modes(s.coupled).eigenvalues.size();
      bool             unstable = false;
      std::vector<int> n_modes;
      for (const double friction : mu)
        {
          const auto modes = krylov(s.coupled, friction);
          unstable |= n_unstable(modes) > 0;
          n_modes.push_back(n_inside(modes.lambda, omega_max));
        }
      for (const ContourMethod method : methods(s.coupled))
        {
          const auto counts = count(s.coupled, mu, contour(omega_max, 0., method));
          for (std::size_t i = 0; i < mu.size(); ++i)
            {
              EXPECT_EQ(counts[i].n_modes, n_modes[i]) << to_string(method) << ", mu " << mu[i];
              EXPECT_EQ(counts[i].n_frictionless, n_real);
              EXPECT_LE(counts[i].largest_phase_step, M_PI / 3. * (1. + 1e-9));
              EXPECT_GT(counts[i].n_points, 5);
              EXPECT_LE(counts[i].truncation_bound, 0.25);
            }
        }
      EXPECT_TRUE(unstable);
    }
}

TEST(ContourCount, BetweenARealModeAndWhatFrictionMakesOfIt)
{
  // The condensed determinant has a pole on one side of the contour and a zero on the other
  const Scene s        = scene(RadialDissipation::none);
  const auto  real     = real_modes(s.coupled);
  const auto  modes    = krylov(s.coupled, 0.4);
  int         n_tested = 0;
  for (std::size_t j = 0; j < std::min(real.eigenvalues.size(), modes.lambda.size()); ++j)
    {
      const double omega = std::sqrt(real.eigenvalues[j]), end = 0.5 * (omega + modes.lambda[j].imag());
      if (std::abs(end / omega - 1.) < 1e-7)
        continue;
      EXPECT_EQ(count(s.coupled, {0.4}, contour(end))[0].n_modes, n_inside(modes.lambda, end)) << hertz(end) << " Hz";
      ++n_tested;
    }
  EXPECT_GT(n_tested, 5);

  // A contour through an eigenvalue is rejected
  const double omega = modes.lambda[5].imag(), omega_real = std::sqrt(real.eigenvalues[5]);
  for (const ContourMethod method : methods(s.coupled))
    {
      const std::string message = refusal(s.coupled, 0.4, contour(omega * (1. + 1e-13), 0., method));
      EXPECT_NE(message.find("rejected"), std::string::npos) << message;
      EXPECT_NE(message.find("change Band/Maximum frequency"), std::string::npos) << message;
    }
  EXPECT_NE(refusal(s.coupled, 0.4, contour(omega_real)).find("a real mode lies on the contour"), std::string::npos);
}

TEST(ContourCount, DampingOfModesAndOfTheSlidingMotion)
{
  const Scene               s = scene(RadialDissipation::consistent);
  const std::vector<double> c_t(s.interface.size(), -20.);
  CoupledSystem             system = couple(s.system, s.contact, {s.damping.radial, c_t});
  for (const bool modal : {false, true})
    {
      if (modal)
        {
          const auto real = real_modes(system);
          add_modal_damping(system, *real.vectors, real.eigenvalues, std::vector<double>(real.eigenvalues.size(), 0.02));
        }
      const auto modes = krylov(system, 0.6);
      // Narrow contours pass between the growth rates
      for (const double a : {0., 0.01 * omega_max, 0.004 * omega_max})
        EXPECT_EQ(count(system, {0.6}, contour(omega_max, a))[0].n_modes, n_inside(modes.lambda, omega_max, a)) << a;
      EXPECT_LT(n_inside(modes.lambda, omega_max, 0.004 * omega_max), n_inside(modes.lambda, omega_max));
    }
  EXPECT_NE(refusal(system, 0.6, contour(omega_max, 0., ContourMethod::sparse_lu)).find("modal damping"), std::string::npos);
}

TEST(ContourCount, DampingOfTheBodies)
{
  const Scene s = scene(RadialDissipation::consistent, damped(mounted()));
  EXPECT_NE(refusal(s.coupled, 0.6, contour(omega_max)).find("damping of the bodies"), std::string::npos);
  const auto sparse = contour(omega_max, 0., ContourMethod::sparse_lu);
  if (s.coupled.map().n_processes() > 1)
    {
      EXPECT_NE(refusal(s.coupled, 0.6, sparse).find("one process"), std::string::npos);
      return;
    }
  const auto modes = krylov(s.coupled, 0.6);
  EXPECT_EQ(count(s.coupled, {0.6}, sparse)[0].n_modes, n_inside(modes.lambda, omega_max));
}

TEST(ContourCount, ADiscThatMovesFreely)
{
  for (const RadialDissipation dissipation : {RadialDissipation::none, RadialDissipation::consistent})
    {
      const Scene    s       = scene(dissipation, mounted({}));
      ContourOptions options = contour(omega_max);
      const double   shift   = stabilizing_shift(s.model, s.coupled, omega_max);
      ASSERT_GT(shift, 0.);
      options.real_modes.shift = shift * shift;

      SolverParameters solvers;
      UpdatedInverse   inverse(s.coupled, shift, FactorizationLibrary::automatic);
      Progress         progress;
      const auto       modes = krylov_modes(s.coupled, inverse, shift, 0.4, omega_max, 20, solvers, progress);
      for (const ContourMethod method : methods(s.coupled))
        {
          options.method = method;
          EXPECT_EQ(count(s.coupled, {0.4}, options)[0].n_modes, n_inside(modes.lambda, omega_max));
        }
    }
}

TEST(CondensedDeterminant, DoesNotDependOnHowManyModesAreTakenOut)
{
  const Scene                       s(mesh_of(skewed_pins), mounted(), operating(RadialDissipation::consistent));
  const double                      a = 0.1 * omega_max;
  const CondensedDeterminantRequest rough{{{0., omega_max}, {a, omega_max}}, 0.4, 1e-3}, fine{rough.lambda, 0.4, 1e-11};
  const auto                        factor = factorize_positive_definite(*s.coupled.stiffness, FactorizationLibrary::automatic, "test");
  const auto                        make   = [&](const double deflation, const CondensedDeterminantRequest &request) {
    const double         end   = deflation * omega_max;
    const SymmetricModes modes = symmetric_modes(*s.coupled.stiffness, *s.coupled.mass, end * end);
    return CondensedDeterminant(s.coupled, modes, end, *factor, 0., request);
  };
  const CondensedDeterminant few = make(1.2, fine), many = make(1.8, fine), short_series = make(1.2, rough);
  EXPECT_GT(few.n_moments, many.n_moments);
  EXPECT_GT(few.n_moments, short_series.n_moments);
  const auto logarithm = [](const CondensedDeterminant &determinant, const Complex lambda) {
    return ComplexLU(determinant.complement(lambda, 0.4)).log_determinant() +
           ComplexLU(determinant.on_modes(lambda, 0.4).matrix).log_determinant();
  };
  for (const Complex lambda : {Complex(a, omega_max), Complex(0., 0.613 * omega_max), Complex(-a, 0.2 * omega_max), Complex(0.5 * a, 1.)})
    {
      EXPECT_LT(std::abs(std::exp(logarithm(few, lambda) - logarithm(many, lambda)) - 1.), 1e-7);

      // The error of the truncated series is below its bound
      const ComplexDenseMatrix N = few.complement(lambda, 0.4), truncated = short_series.complement(lambda, 0.4);
      const double             size = N.cwiseAbs().maxCoeff(), difference = (N - truncated).cwiseAbs().maxCoeff();
      EXPECT_LE(difference, short_series.truncation(lambda, 0.4) + 1e-12 * size);
    }
}
