#include "scenes.h"

#include <squeal/bases/rigid_body.h>
#include <squeal/bases/inertia_relief.h>
#include <squeal/linear_algebra/replicate.h>

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  constexpr double band = 2. * M_PI * 5000.;

  Scene scene(const std::vector<Mount> &mounts)
  {
    const std::vector<PolarPin> pins = {{Plan::Side::top, 0, 2, 1, 1}, {Plan::Side::bottom, -1, 2, 0, 1}};
    return Scene(extrude(polar_plan(0.15, 0.3, 3, 12, pins), layers(1, 2)), mounted(mounts), operating());
  }

  double largest(const std::vector<double> &values)
  {
    return *std::max_element(values.begin(), values.end());
  }
} // namespace

TEST(StaticResponse, SolvesWhereTheMountHoldsTheDisc)
{
  const Scene         s        = scene({{"disc_bore", 1e9, 7.80e10, 1.88e10}});
  const InertiaRelief response = static_response(s.model, s.system, band, FactorizationLibrary::automatic);
  EXPECT_EQ(response.rigid_body_modes(), nullptr);
  const MultiVector f    = transpose_times(*s.contact.normal, unit_vectors(s.contact.normal->rows()));
  MultiVector       rest = *s.system.stiffness * response.solve(f);
  rest -= f;
  EXPECT_LT(largest(column_norms(rest)), 1e-11);
}

TEST(StaticResponse, RelievesAFreeDiscByInertia)
{
  for (const auto &[mounts, n_free] :
       {std::make_pair(std::vector<Mount>(), 6), std::make_pair(std::vector<Mount>{{"disc_bore", 0., 7.80e10, 0.}}, 1)})
    {
      const Scene         s        = scene(mounts);
      const InertiaRelief response = static_response(s.model, s.system, band, FactorizationLibrary::automatic);
      const MultiVector  *N        = response.rigid_body_modes();
      ASSERT_NE(N, nullptr);
      ASSERT_EQ(N->n_columns(), n_free);
      const MultiVector MN = *s.system.mass * *N;
      EXPECT_LT(max_norm(gram(*N, MN) - DenseMatrix::Identity(n_free, n_free)), 1e-12);
      EXPECT_LT(largest(column_norms(*s.system.stiffness * *N)) / (max_norm(*s.system.stiffness) * largest(column_norms(*N))), 1e-12);

      const MultiVector f = transpose_times(*s.contact.normal, unit_vectors(s.contact.normal->rows()));
      const MultiVector u = response.solve(f);
      MultiVector       g = f;
      multiply_add(-1., MN, gram(*N, f), 1., g);
      MultiVector rest = *s.system.stiffness * u;
      rest -= g;
      EXPECT_LT(largest(column_norms(rest)), 1e-9);
      EXPECT_LT(max_norm(gram(MN, u)), 1e-12 * max_norm(replicate(u)) * largest(column_norms(MN)));

      // Flexibilities stay symmetric, as those of a free structure are
      const DenseMatrix F = replicate(*s.contact.normal * u);
      EXPECT_LT(max_norm(F - F.transpose()), 1e-9 * max_norm(F));
    }
}
