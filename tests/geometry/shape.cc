// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/geometry/shape.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace Squeal;
using Point = dealii::Point<3>;

namespace
{
  constexpr Shape shapes[] = {Shape::triangle, Shape::quadrilateral, Shape::tetrahedron, Shape::pyramid, Shape::wedge, Shape::hexahedron};

  double linear(const Point &x)
  {
    return 0.3 + x[0] - 2. * x[1] + 3. * x[2];
  }
} // namespace

TEST(Shapes, FunctionsAreNodalAndReproduceLinearFunctions)
{
  for (const Shape shape : shapes)
    for (const unsigned int degree : {1, 2})
      {
        SCOPED_TRACE(std::string(topology(shape).name) + " of degree " + std::to_string(degree));
        const ShapeFunctions &N     = ShapeFunctions::of(shape, degree);
        const auto            nodes = reference_nodes(shape, degree);
        ASSERT_EQ(N.n(), nodes.size());
        for (unsigned int i = 0; i < N.n(); ++i)
          for (unsigned int j = 0; j < N.n(); ++j)
            EXPECT_NEAR(N.value(i, nodes[j]), i == j, 1e-12) << i << ' ' << j;
        for (const auto &[x, weight] : quadrature(shape, degree))
          {
            double               sum = 0., u = 0.;
            dealii::Tensor<1, 3> sum_gradient, gradient;
            for (unsigned int i = 0; i < N.n(); ++i)
              {
                sum += N.value(i, x);
                u += linear(nodes[i]) * N.value(i, x);
                sum_gradient += N.gradient(i, x);
                gradient += linear(nodes[i]) * N.gradient(i, x);
              }
            EXPECT_NEAR(sum, 1., 1e-12);
            EXPECT_NEAR(u, linear(x), 1e-12);
            EXPECT_LT(sum_gradient.norm(), 1e-12);
            EXPECT_LT((gradient - dealii::Tensor<1, 3>({1., -2., topology(shape).dimension == 3 ? 3. : 0.})).norm(), 1e-12);
          }
      }
}

TEST(Shapes, GradientsAreDerivatives)
{
  constexpr double h = 1e-6;
  const Point      x(0.21, 0.17, 0.31);
  for (const Shape shape : shapes)
    for (unsigned int i = 0; i < ShapeFunctions::of(shape, 2).n(); ++i)
      for (unsigned int d = 0; d < topology(shape).dimension; ++d)
        {
          const ShapeFunctions &N      = ShapeFunctions::of(shape, 2);
          Point                 before = x, behind = x;
          before[d] -= h;
          behind[d] += h;
          EXPECT_NEAR(N.gradient(i, x)[d], (N.value(i, behind) - N.value(i, before)) / (2. * h), 1e-8) << topology(shape).name << ' ' << i;
        }
}

TEST(Shapes, QuadratureHasPositiveWeightsAndIntegratesTheMass)
{
  const double volumes[] = {1. / 2., 1., 1. / 6., 4. / 3., 1. / 2., 1.};
  for (const Shape shape : shapes)
    for (const unsigned int degree : {1, 2})
      {
        const auto mass = [&](const unsigned int rule) { // weighted sum of all entries of the mass matrix
          const ShapeFunctions &N   = ShapeFunctions::of(shape, degree);
          double                sum = 0.;
          for (const auto &[x, weight] : quadrature(shape, rule))
            for (unsigned int i = 0; i < N.n(); ++i)
              for (unsigned int j = 0; j < N.n(); ++j)
                sum += std::cos(i + 3. * j) * weight * N.value(i, x) * N.value(j, x);
          return sum;
        };
        double volume = 0.;
        for (const QuadraturePoint &point : quadrature(shape, degree))
          {
            EXPECT_GT(point.weight, 0.);
            volume += point.weight;
          }
        EXPECT_NEAR(volume, volumes[static_cast<unsigned int>(shape)], 1e-12) << topology(shape).name;
        EXPECT_NEAR(mass(degree), mass(3), 1e-12) << topology(shape).name << ' ' << degree;
      }
}

TEST(Shapes, NodesOfFacesAreThoseOnThem)
{
  for (const Shape shape : shapes)
    for (const unsigned int degree : {1, 2})
      for (unsigned int f = 0; f < topology(shape).faces.size(); ++f)
        {
          const auto                &corners    = topology(shape).faces[f];
          const Shape                face_shape = shape_of_face(corners.size());
          const auto                 nodes = reference_nodes(shape, degree), on_face = reference_nodes(face_shape, degree);
          const auto                &numbers = nodes_of_face(shape, degree, f);
          const dealii::Tensor<1, 3> normal =
            cross_product_3d(nodes[corners[1]] - nodes[corners[0]], nodes[corners[2]] - nodes[corners[0]]);
          ASSERT_EQ(numbers.size(), on_face.size());
          for (unsigned int i = 0; i < numbers.size(); ++i)
            {
              Point place;
              for (unsigned int v = 0; v < corners.size(); ++v)
                place += ShapeFunctions::of(face_shape, 1).value(v, on_face[i]) * nodes[corners[v]];
              EXPECT_LT(place.distance(nodes.at(numbers[i])), 1e-12);
            }
          for (const Point &node : nodes) // the normal points outwards
            EXPECT_LT(topology(shape).dimension == 3 ? normal * (node - nodes[corners[0]]) : 0., 1e-12);
        }
}
