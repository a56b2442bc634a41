// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/model/element_values.h>

namespace Squeal
{
  using namespace dealii;

  ElementValues::ElementValues(const Model &model, const unsigned int degree)
    : model(model)
    , degree(degree)
  {}

  const ElementValues::Table &ElementValues::table(const Shape shape)
  {
    Table &result = tables[static_cast<unsigned int>(shape)];
    if (result.n_nodes == 0)
      {
        const ShapeFunctions &functions = ShapeFunctions::of(shape, model.degree());
        result.n_nodes                  = functions.n();
        result.points                   = quadrature(shape, degree);
        for (const QuadraturePoint &point : result.points)
          for (unsigned int i = 0; i < functions.n(); ++i)
            {
              result.values.push_back(functions.value(i, point.x));
              result.gradients.push_back(functions.gradient(i, point.x));
            }
      }
    return result;
  }

  Point<3> ElementValues::node(const unsigned int i) const
  {
    const std::array<double, 3> &x = model.nodes()[current->nodes[i]].position;
    return Point<3>(x[0], x[1], x[2]);
  }

  void ElementValues::reinit(const NodalElement &element)
  {
    current             = &element;
    now                 = &table(element.shape);
    const bool is_solid = topology(element.shape).dimension == 3;
    places.assign(n_points(), Point<3>());
    weights.resize(n_points());
    jacobians.assign(n_points(), Tensor<2, 3>());
    normals.resize(n_points());
    gradients.resize(now->gradients.size());
    for (unsigned int q = 0; q < n_points(); ++q)
      {
        const unsigned int first = q * now->n_nodes;
        Tensor<2, 3>      &J     = jacobians[q];
        for (unsigned int i = 0; i < now->n_nodes; ++i)
          {
            const Point<3> x = node(i);
            places[q] += now->values[first + i] * x;
            J += outer_product(x, now->gradients[first + i]);
          }
        if (is_solid)
          {
            const Tensor<2, 3> to_real = transpose(invert(J));
            for (unsigned int i = 0; i < now->n_nodes; ++i)
              gradients[first + i] = to_real * now->gradients[first + i];
            weights[q] = determinant(J) * now->points[q].weight;
            continue;
          }
        const Tensor<2, 3> columns = transpose(J);
        normals[q]                 = cross_product_3d(columns[0], columns[1]);
        weights[q]                 = normals[q].norm() * now->points[q].weight;
        normals[q] /= normals[q].norm();
      }
  }
} // namespace Squeal
