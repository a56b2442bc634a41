// SPDX-License-Identifier: GPL-3.0-or-later

#include "solutions.h"

#include <squeal/linear_algebra/mass_orthonormal.h>
#include <squeal/reduction/residual_products.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  constexpr double mu = 0.4;

  /// Expects projected residuals to have the same products as full-order residuals, with and without friction.
  void expect_agreement(const CoupledSystem &system, const double shift, const ContactDamping &damping, const MultiVector &real)
  {
    const UpdatedInverse inverse(shift > 0. ? undamped(system) : system, shift, FactorizationLibrary::automatic);
    const SparseMatrix  &M = *system.mass;
    // Nearly rigid motions have little strain energy and therefore large relative rounding errors
    const double tolerance = shift > 0. ? 1e-10 : 1e-12;
    for (const double friction : {0., mu})
      {
        ProjectedResiduals projected(system, inverse, shift, damping.values());
        ReducedModel       model(system);
        // Extend the basis in two steps
        model.extend(orthonormalize(M, nullptr, real, 1e-10));
        projected.extend(model);
        const ParameterValues values  = system.at(friction, damping.values());
        const auto            vectors = [&](const ReducedModes &modes) { return residual_vectors(system, inverse, model, modes); };
        ReducedModes          modes   = local_reduced_modes(model, values, omega_max);
        std::vector<int>      all(modes.lambda.size());
        std::iota(all.begin(), all.end(), 0);
        model.extend(*new_vectors(system, model, {residual_directions(vectors(modes), modes, all)}));
        projected.extend(model);

        modes               = local_reduced_modes(model, values, omega_max);
        const auto direct   = vectors(modes).products();
        const auto products = projected.products(values, modes.lambda, modes.right, modes.left);
        const int  k        = static_cast<int>(modes.lambda.size());
        EXPECT_GT(k, 3);
        const auto energies = [&](const ComplexDenseMatrix &X) {
          return X.conjugate().cwiseProduct(model.stiffness() * X).colwise().sum().real().eval();
        };
        const auto right = energies(modes.right), left = energies(modes.left);
        double     largest_energy = 0.;
        for (int j = 0; j < k; ++j)
          {
            EXPECT_LT(std::abs(products.right_energies[j] - direct.right_energies[j]), tolerance * right[j]);
            EXPECT_LT(std::abs(products.left_energies[j] - direct.left_energies[j]), tolerance * left[j]);
            largest_energy = std::max({largest_energy, direct.right_energies[j] / right[j], direct.left_energies[j] / left[j]});
            for (int i = 0; i < k; ++i)
              EXPECT_LT(std::abs(products.coupling(i, j) - direct.coupling(i, j)), tolerance * std::sqrt(left[i] * right[j]));
          }
        EXPECT_TRUE(friction == 0. || largest_energy > 1e-9) << "residuals must exceed rounding errors";

        // The limit is five standard deviations of a squared norm for 128 vectors in the sketch
        ProjectedResiduals sketched(system, inverse, shift, damping.values());
        if (!sketched.use_sketch())
          continue;
        sketched.extend(model);
        const auto       sketches    = sketched.products(values, modes.lambda, modes.right, modes.left);
        constexpr double five_sigmas = 0.63;
        for (int j = 0; j < k; ++j)
          {
            EXPECT_LT(std::abs(sketches.right_energies[j] - direct.right_energies[j]),
                      five_sigmas * direct.right_energies[j] + 1e-20 * right[j]);
            EXPECT_LT(std::abs(sketches.left_energies[j] - direct.left_energies[j]),
                      five_sigmas * direct.left_energies[j] + 1e-20 * left[j]);
            for (int i = 0; i < k; ++i)
              EXPECT_LT(std::abs(sketches.coupling(i, j) - direct.coupling(i, j)),
                        five_sigmas * std::sqrt(direct.left_energies[i] * direct.right_energies[j]) +
                          1e-20 * std::sqrt(left[i] * right[j]));
          }
      }
  }

  ContactDamping uneven(const std::size_t n_c, const double c_b, const double c_t)
  {
    ContactDamping damping;
    for (std::size_t c = 0; c < n_c; ++c)
      {
        damping.radial.push_back(c_b * (1. + c % 3));
        damping.sliding.push_back(c_t * (1. + c % 2));
      }
    return damping;
  }
} // namespace

TEST(ProjectedResiduals, AreThoseOfFullOrder)
{
  const Scene s(mesh_of(skewed_pins), mounted(), operating());
  expect_agreement(s.coupled, 0., {}, *real_modes(s.coupled).vectors);
}

TEST(ProjectedResiduals, KnowEveryDamping)
{
  const Scene s(mesh_of(skewed_pins), damped(mounted()), operating());
  const auto  real   = real_modes(s.coupled);
  auto        system = s.coupled;
  add_modal_damping(system, *real.vectors, real.eigenvalues, std::vector<double>(real.eigenvalues.size(), 0.01));
  expect_agreement(system, 0., uneven(s.interface.size(), 60., -20.), *real.vectors);
}

TEST(ProjectedResiduals, OfAFreeDiscUseTheShiftedStiffness)
{
  const FreeDisc disc;
  expect_agreement(disc.s.coupled, disc.shift, uneven(disc.s.interface.size(), 60., -20.), *disc.real.vectors);
}
