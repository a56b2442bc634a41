#include "solutions.h"

#include <squeal/linear_algebra/mass_orthonormal.h>
#include <squeal/reduction/residual_products.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  constexpr double mu = 0.4;

  /// Largest difference between projected and direct products, in parts of the strain energies.
  struct Deviation
  {
    double coupling = 0., energy = 0., largest_energy = 0.;
  };

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

  Deviation deviation(const CoupledSystem  &system,
                      const double          shift,
                      const double          friction,
                      const ContactDamping &damping,
                      const MultiVector    &real)
  {
    const UpdatedInverse inverse(shift > 0. ? undamped(system) : system, shift, FactorizationLibrary::automatic);
    ProjectedResiduals   projected(system, inverse, shift, damping.values());
    ReducedModel         model(system);
    // In two steps, as a basis grows
    const SparseMatrix &M     = *system.mass;
    const MultiVector   first = orthonormalize(M, nullptr, real, 1e-10);
    model.extend(first);
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
    if (friction > 0.) // else residuals are rounding errors
      expect_same_span(projected, model, {values, modes.lambda, modes.right, modes.left}, vectors(modes), M);
    const DenseMatrix K      = model.stiffness();
    const auto        energy = [&](const ComplexDenseMatrix &X, const int j) {
      const ComplexDenseMatrix KX  = K * X;
      Complex                  sum = 0.;
      for (int i = 0; i < KX.rows(); ++i)
        sum += std::conj(X(i, j)) * KX(i, j);
      return sum.real();
    };
    Deviation result;
    for (int j = 0; j < k; ++j)
      {
        const double right = energy(modes.right, j), left = energy(modes.left, j);
        result.energy         = std::max(result.energy, std::abs(products.right_energies[j] - direct.right_energies[j]) / right);
        result.energy         = std::max(result.energy, std::abs(products.left_energies[j] - direct.left_energies[j]) / left);
        result.largest_energy = std::max({result.largest_energy, direct.right_energies[j] / right, direct.left_energies[j] / left});
        for (int i = 0; i < k; ++i)
          result.coupling =
            std::max(result.coupling, std::abs(products.coupling(i, j) - direct.coupling(i, j)) / std::sqrt(energy(modes.left, i) * right));
      }
    return result;
  }

  void expect_agreement(const CoupledSystem &system, const double shift, const ContactDamping &damping, const MultiVector &real)
  {
    // Nearly rigid motions, whose strain energy is small, have large rounding errors by comparison.
    const double tolerance = shift > 0. ? 1e-10 : 1e-12;
    for (const double friction : {0., mu})
      {
        const Deviation d = deviation(system, shift, friction, damping, real);
        EXPECT_LT(d.coupling, tolerance);
        EXPECT_LT(d.energy, tolerance);
        if (friction > 0.)
          {
            EXPECT_GT(d.largest_energy, 1e-9); // there is something to compare
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
  for (const auto &[c_b, c_t] : {std::make_pair(60., 0.), {0., -20.}, {60., -20.}})
    expect_agreement(s.coupled, 0., uneven(s.interface.size(), c_b, c_t), *real.vectors);
}

TEST(ProjectedResiduals, KnowEveryDamping)
{
  MaterialParameters materials  = mounted();
  materials.disc.rayleigh_alpha = 3.;
  materials.disc.rayleigh_beta  = 1e-7;
  materials.pin.rayleigh_beta   = 1e-6;
  const Scene s(mesh_of(skewed_pins), materials, operating());
  const auto  real   = real_modes(s.coupled);
  auto        system = s.coupled;
  expect_agreement(system, 0., uneven(s.interface.size(), 60., 0.), *real.vectors);
  const MultiVector &vectors = *real.vectors;
  add_modal_damping(system, vectors, real.eigenvalues, std::vector<double>(real.eigenvalues.size(), 0.01));
  expect_agreement(system, 0., {}, vectors);
  expect_agreement(system, 0., uneven(s.interface.size(), 60., -20.), vectors);
}

TEST(ProjectedResiduals, OfAFreeDiscUseTheShiftedStiffness)
{
  const FreeDisc disc;
  const auto &[s, shift, real] = disc;
  expect_agreement(s.coupled, shift, {}, *real.vectors);
  expect_agreement(s.coupled, shift, uneven(s.interface.size(), 60., 0.), *real.vectors);
}
