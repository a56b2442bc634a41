#include "solutions.h"

#include <squeal/linear_algebra/mass_orthonormal.h>
#include <squeal/reduction/residual_products.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  constexpr double mu = 0.4;

  /// What displacement residuals have outside of the basis is in the span of their principal axes.
  void expect_same_span(const ProjectedResiduals          &projected,
                        const ReducedModel                &model,
                        const ProjectedResiduals::ModesAt &modes,
                        const ResidualVectors             &vectors,
                        const SparseMatrix                &M)
  {
    const auto all = projected.principal_responses(model, {modes}, 1e-7), few = projected.principal_responses(model, {modes}, 0.02);
    ASSERT_TRUE(all && few);
    EXPECT_LE(few->n_columns(), all->n_columns());
    const auto outside = orthonormalize_if_any(M, &model.basis(), *all, 1e-10);
    ASSERT_TRUE(outside);
    for (const MultiVector *displacements : {&vectors.right_displacements, &vectors.left_displacements})
      {
        MultiVector rest = *displacements;
        rest -= model.basis() * gram(model.basis(), M * rest);
        const double largest = max_norm(as_column(column_norms(rest)));
        rest -= *outside * gram(*outside, M * rest);
        EXPECT_LT(max_norm(as_column(column_norms(rest))), 1e-4 * largest);
      }
  }

  /// Products of the projected residuals are those of full order, without friction and with it.
  void expect_agreement(const CoupledSystem &system, const double shift, const ContactDamping &damping, const MultiVector &real)
  {
    const UpdatedInverse inverse(shift > 0. ? undamped(system) : system, shift, FactorizationLibrary::automatic);
    const SparseMatrix  &M = *system.mass;
    // Nearly rigid motions, whose strain energy is small, have large rounding errors by comparison.
    const double tolerance = shift > 0. ? 1e-10 : 1e-12;
    for (const double friction : {0., mu})
      {
        ProjectedResiduals projected(system, inverse, shift, damping.values());
        ReducedModel       model(system);
        // In two steps, as a basis grows
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
        if (friction > 0.) // else residuals are rounding errors
          {
            EXPECT_GT(largest_energy, 1e-9);
            expect_same_span(projected, model, {values, modes.lambda, modes.right, modes.left}, vectors(modes), M);
          }
      }
  }

  ContactDamping uneven(const std::size_t n_c, const double c_b, const double c_t)
  {
    ContactDamping damping;
    for (std::size_t c = 0; c < n_c; ++c)
      {
        if (c_b != 0.)
          damping.radial.push_back(c_b * (1. + c % 3));
        if (c_t != 0.)
          damping.sliding.push_back(c_t * (1. + c % 2));
      }
    return damping;
  }
} // namespace

TEST(ProjectedResiduals, AreThoseOfFullOrder)
{
  const Scene s(mesh_of(skewed_pins), mounted(), operating());
  const auto  real = real_modes(s.coupled);
  expect_agreement(s.coupled, 0., {}, *real.vectors);
  expect_agreement(s.coupled, 0., uneven(s.interface.size(), 0., -20.), *real.vectors);
}

TEST(ProjectedResiduals, KnowEveryDamping)
{
  const Scene s(mesh_of(skewed_pins), damped(mounted()), operating());
  const auto  real   = real_modes(s.coupled);
  auto        system = s.coupled;
  expect_agreement(system, 0., uneven(s.interface.size(), 60., 0.), *real.vectors);
  add_modal_damping(system, *real.vectors, real.eigenvalues, std::vector<double>(real.eigenvalues.size(), 0.01));
  expect_agreement(system, 0., uneven(s.interface.size(), 60., -20.), *real.vectors);
}

TEST(ProjectedResiduals, OfAFreeDiscUseTheShiftedStiffness)
{
  const FreeDisc disc;
  const auto &[s, shift, real] = disc;
  expect_agreement(s.coupled, shift, {}, *real.vectors);
  expect_agreement(s.coupled, shift, uneven(s.interface.size(), 60., 0.), *real.vectors);
}
