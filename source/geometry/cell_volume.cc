// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/geometry/cell_volume.h>

#include <algorithm>
#include <array>
#include <limits>

namespace Squeal
{
  namespace
  {
    /// Gradients of shape functions at the points of quadrature(), then at the nodes except the apex of a pyramid.
    struct Gradients
    {
      std::vector<QuadraturePoint>                   rule;
      std::vector<std::vector<dealii::Tensor<1, 3>>> at_points;
    };

    const Gradients &gradients(const Shape shape, const unsigned int degree)
    {
      static const auto all = [] {
        std::array<std::array<Gradients, 2>, 6> result;
        for (const Shape solid : {Shape::tetrahedron, Shape::pyramid, Shape::wedge, Shape::hexahedron})
          for (const unsigned int p : {1, 2})
            {
              Gradients               &of        = result[static_cast<unsigned int>(solid)][p - 1];
              std::vector<Mesh::Point> points    = reference_nodes(solid, p);
              const ShapeFunctions    &functions = ShapeFunctions::of(solid, p);
              of.rule                            = quadrature(solid, p);
              if (solid == Shape::pyramid)
                points.erase(points.begin() + 4);
              for (auto point = of.rule.rbegin(); point != of.rule.rend(); ++point)
                points.insert(points.begin(), point->x);
              for (const Mesh::Point &x : points)
                {
                  of.at_points.emplace_back();
                  for (unsigned int i = 0; i < functions.n(); ++i)
                    of.at_points.back().push_back(functions.gradient(i, x));
                }
            }
        return result;
      }();
      return all[static_cast<unsigned int>(shape)][degree - 1];
    }

    double determinant_of(const Mesh &mesh, const Mesh::Cell &cell, const std::vector<dealii::Tensor<1, 3>> &gradients)
    {
      dealii::Tensor<2, 3> jacobian;
      for (unsigned int i = 0; i < gradients.size(); ++i)
        jacobian += outer_product(dealii::Tensor<1, 3>(mesh.points[cell.nodes[i]]), gradients[i]);
      return determinant(jacobian);
    }
  } // namespace

  double volume_of(const Mesh &mesh, const Mesh::Cell &cell)
  {
    const auto &[rule, at_points] = gradients(cell.shape, mesh.degree);
    double volume                 = 0.;
    for (std::size_t q = 0; q < rule.size(); ++q)
      volume += rule[q].weight * determinant_of(mesh, cell, at_points[q]);
    return volume;
  }

  double worst_determinant(const Mesh &mesh, const Mesh::Cell &cell)
  {
    constexpr double rounding     = 1e-6; // accepts the flat corner of an O-grid block on the circle
    const auto &[rule, at_points] = gradients(cell.shape, mesh.degree);
    double least = std::numeric_limits<double>::infinity(), largest = 0.;
    for (std::size_t q = 0; q < at_points.size(); ++q)
      if (const double value = determinant_of(mesh, cell, at_points[q]); q < rule.size() || value < -rounding * largest)
        {
          least   = std::min(least, value);
          largest = std::max(largest, value);
        }
    return least;
  }
} // namespace Squeal
