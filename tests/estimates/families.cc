// SPDX-License-Identifier: GPL-3.0-or-later

#include "solutions.h"

#include <squeal/bases/static_modes.h>
#include <squeal/contact/coupled_system.h>
#include <squeal/linear_algebra/mass_orthonormal.h>
#include <squeal/reduction/residual_products.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  constexpr double friction_coefficient = 0.4;

  /// Designs on one mesh that differ in pin materials, mount and damping.
  std::vector<MaterialParameters> designs()
  {
    std::vector<MaterialParameters> result(3, damped(mounted()));
    result[1].pin.young_modulus *= 1.2;
    result[1].pin.rayleigh_beta = 2e-6;
    result[2].pin.density *= 0.9;
    result[2].mounts = {{"disc_bore", 0., 7.80e10, 1.50e10}};
    return result;
  }

  struct Family
  {
    Family()
      : s(mesh_of(skewed_pins), designs().front(), operating(RadialDissipation::consistent))
    {
      std::vector<ParameterValues> values;
      for (const MaterialParameters &materials : designs())
        values.push_back(body_values(s.model, materials));
      terms  = term_family(body_terms(s.model, designs().front()).terms, values);
      system = coupled_family(terms, s.contact, s.damping);
    }

    /// The same design, assembled from its own matrices.
    CoupledSystem direct(const std::size_t design) const
    {
      const BodyTerms bodies = body_terms(s.model, designs()[design]);
      return couple(merged(bodies.terms, bodies.values), s.contact, s.damping);
    }

    Scene         s;
    TermFamily    terms;
    CoupledSystem system;
  };

  void expect_near(const DenseMatrix &A, const DenseMatrix &B)
  {
    EXPECT_LT(max_norm(A - B), 1e-12 * max_norm(B));
  }
} // namespace

TEST(Families, ReducedMembersAndTheirResidualsAreThoseOfFullOrder)
{
  const Family         family;
  const UpdatedInverse inverse(undamped(family.system), 0., FactorizationLibrary::automatic);
  const auto           real = real_modes(family.system);
  const MultiVector    T    = orthonormalize(
          *family.system.mass, nullptr, join_all({*real.vectors, friction_response(family.system, inverse, *real.vectors, Side::right)}), 1e-8);
  ReducedModel       model(family.system);
  ProjectedResiduals residuals(family.system, inverse, 0., family.system.values);
  model.extend(view(T, 0, 5));
  residuals.extend(model);
  model.extend(view(T, 5, T.n_columns() - 5));
  residuals.extend(model);

  for (std::size_t design = 0; design < 3; ++design)
    {
      const ParameterValues values = family.system.at(friction_coefficient, family.terms.members[design]);
      const CoupledSystem   direct = family.direct(design);
      ReducedModel          other(direct);
      other.extend(T);
      const ReducedPencil ours = model.at(values), others = other.at(direct.at(friction_coefficient));
      expect_near(ours.mass, others.mass);
      expect_near(ours.damping, others.damping);
      expect_near(ours.stiffness, others.stiffness);

      ReducedModes modes         = local_reduced_modes(model, values, omega_max);
      const auto   products      = residuals.products(values, modes.lambda, modes.right, modes.left);
      modes.values               = direct.at(friction_coefficient);
      const auto direct_products = residual_vectors(direct, inverse, other, modes).products();
      ASSERT_GT(modes.lambda.size(), 3u);
      const ComplexDenseMatrix KR = other.stiffness() * modes.right, KL = other.stiffness() * modes.left;
      double                   largest = 0.;
      for (int j = 0; j < static_cast<int>(modes.lambda.size()); ++j)
        {
          const double right = std::abs(modes.right.col(j).dot(KR.col(j))), left = std::abs(modes.left.col(j).dot(KL.col(j)));
          largest = std::max(largest, direct_products.right_energies[j] / right);
          EXPECT_NEAR(products.right_energies[j], direct_products.right_energies[j], 1e-10 * right);
          EXPECT_NEAR(products.left_energies[j], direct_products.left_energies[j], 1e-10 * left);
          for (int i = 0; i < static_cast<int>(modes.lambda.size()); ++i)
            EXPECT_LT(std::abs(products.coupling(i, j) - direct_products.coupling(i, j)), 1e-10 * std::sqrt(right * left));
        }
      EXPECT_GT(largest, 1e-9); // residuals are large enough for a comparison
    }
}
