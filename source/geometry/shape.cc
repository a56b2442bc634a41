// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/geometry/shape.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_pyramid_p.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_wedge_p.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  using namespace dealii;

  const Topology &topology(const Shape shape)
  {
    using Q = Point<3>;
    // Faces are outwards by the right-hand rule; edges are in Gmsh's order
    static const std::array<Topology, 6> all = {
      {{"triangles", 2, {Q(0, 0, 0), Q(1, 0, 0), Q(0, 1, 0)}, {{{0, 1}}, {{1, 2}}, {{2, 0}}}, {{0, 1, 2}}},
       {"quadrilaterals", 2, {Q(0, 0, 0), Q(1, 0, 0), Q(1, 1, 0), Q(0, 1, 0)}, {{{0, 1}}, {{1, 2}}, {{2, 3}}, {{3, 0}}}, {{0, 1, 2, 3}}},
       {"tetrahedra",
        3,
        {Q(0, 0, 0), Q(1, 0, 0), Q(0, 1, 0), Q(0, 0, 1)},
        {{{0, 1}}, {{1, 2}}, {{2, 0}}, {{3, 0}}, {{2, 3}}, {{1, 3}}},
        {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}},
       {"pyramids",
        3,
        {Q(-1, -1, 0), Q(1, -1, 0), Q(1, 1, 0), Q(-1, 1, 0), Q(0, 0, 1)},
        {{{0, 1}}, {{0, 3}}, {{0, 4}}, {{1, 2}}, {{1, 4}}, {{2, 3}}, {{2, 4}}, {{3, 4}}},
        {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}},
       {"wedges",
        3,
        {Q(0, 0, 0), Q(1, 0, 0), Q(0, 1, 0), Q(0, 0, 1), Q(1, 0, 1), Q(0, 1, 1)},
        {{{0, 1}}, {{0, 2}}, {{0, 3}}, {{1, 2}}, {{1, 4}}, {{2, 5}}, {{3, 4}}, {{3, 5}}, {{4, 5}}},
        {{0, 1, 4, 3}, {0, 3, 5, 2}, {1, 2, 5, 4}, {0, 2, 1}, {3, 4, 5}}},
       {"hexahedra",
        3,
        {Q(0, 0, 0), Q(1, 0, 0), Q(1, 1, 0), Q(0, 1, 0), Q(0, 0, 1), Q(1, 0, 1), Q(1, 1, 1), Q(0, 1, 1)},
        {{{0, 1}}, {{0, 3}}, {{0, 4}}, {{1, 2}}, {{1, 5}}, {{2, 3}}, {{2, 6}}, {{3, 7}}, {{4, 5}}, {{4, 7}}, {{5, 6}}, {{6, 7}}},
        {{0, 3, 2, 1}, {0, 1, 5, 4}, {0, 4, 7, 3}, {1, 2, 6, 5}, {2, 3, 7, 6}, {4, 5, 6, 7}}}}};
    return all[static_cast<unsigned int>(shape)];
  }

  std::vector<Point<3>> reference_nodes(const Shape shape, const unsigned int degree)
  {
    const Topology       &parts = topology(shape);
    std::vector<Point<3>> nodes = parts.corners;
    if (degree == 1)
      return nodes;
    const auto add_centre = [&](const auto &corners) {
      Point<3> sum;
      for (const unsigned int corner : corners)
        sum += parts.corners[corner];
      nodes.push_back(sum / double(corners.size()));
    };
    for (const auto &edge : parts.edges)
      add_centre(edge);
    for (const auto &face : parts.faces)
      if (face.size() == 4)
        add_centre(face);
    if (shape == Shape::hexahedron)
      nodes.emplace_back(0.5, 0.5, 0.5);
    return nodes;
  }

  namespace
  {
    constexpr unsigned int n_shapes = 6;

    /// Table with a value for each shape in degree 1 and 2.
    template <typename Value, typename Make>
    std::array<std::array<Value, 2>, n_shapes> for_all_elements(const Make &make)
    {
      std::array<std::array<Value, 2>, n_shapes> result;
      for (unsigned int s = 0; s < n_shapes; ++s)
        for (unsigned int degree = 1; degree <= 2; ++degree)
          result[s][degree - 1] = make(static_cast<Shape>(s), degree);
      return result;
    }

    using FaceNodes = std::vector<std::vector<unsigned int>>;

    FaceNodes find_nodes_of_faces(const Shape shape, const unsigned int degree)
    {
      const Topology &parts = topology(shape);
      const auto      nodes = reference_nodes(shape, degree);
      FaceNodes       result;
      for (const auto &face : parts.faces)
        {
          const Shape face_shape = shape_of_face(face.size());
          const auto &functions  = ShapeFunctions::of(face_shape, 1);
          result.emplace_back();
          for (const Point<3> &on_face : reference_nodes(face_shape, degree))
            {
              Point<3> place;
              for (unsigned int i = 0; i < face.size(); ++i)
                place += functions.value(i, on_face) * parts.corners[face[i]];
              const auto node = std::find_if(nodes.begin(), nodes.end(), [&](const Point<3> &x) { return x.distance(place) < 1e-6; });
              result.back().push_back(node - nodes.begin());
            }
        }
      return result;
    }
  } // namespace

  const std::vector<unsigned int> &nodes_of_face(const Shape cell, const unsigned int degree, const unsigned int face)
  {
    static const auto all = for_all_elements<FaceNodes>(find_nodes_of_faces);
    return all[static_cast<unsigned int>(cell)][degree - 1][face];
  }

  namespace
  {
    /// An element of deal.II with its functions in the order of reference_nodes().
    template <int dim>
    class DealFunctions : public ShapeFunctions
    {
    public:
      DealFunctions(std::unique_ptr<FiniteElement<dim>> element, const std::vector<Point<3>> &nodes)
        : element(std::move(element))
      {
        for (const Point<3> &node : nodes)
          for (unsigned int i = 0; i < nodes.size(); ++i)
            if (this->element->shape_value(i, in_dimension(node)) > 0.5)
              number.push_back(i);
      }

      unsigned int n() const override
      {
        return number.size();
      }

      double value(const unsigned int i, const Point<3> &x) const override
      {
        return element->shape_value(number[i], in_dimension(x));
      }

      Tensor<1, 3> gradient(const unsigned int i, const Point<3> &x) const override
      {
        const Tensor<1, dim> gradient = element->shape_grad(number[i], in_dimension(x));
        Tensor<1, 3>         result;
        for (int d = 0; d < dim; ++d)
          result[d] = gradient[d];
        return result;
      }

    private:
      static Point<dim> in_dimension(const Point<3> &x)
      {
        Point<dim> result;
        for (int d = 0; d < dim; ++d)
          result[d] = x[d];
        return result;
      }

      std::unique_ptr<FiniteElement<dim>> element;
      std::vector<unsigned int>           number;
    };

    class QuadraticPyramid : public ShapeFunctions
    {
    public:
      QuadraticPyramid()
      {
        const auto nodes = reference_nodes(Shape::pyramid, 2);
        Matrix     at_nodes;
        for (unsigned int j = 0; j < n_functions; ++j)
          at_nodes.col(j) = space(nodes[j]).col(0);
        coefficients = at_nodes.inverse();
      }

      unsigned int n() const override
      {
        return n_functions;
      }

      double value(const unsigned int i, const Point<3> &x) const override
      {
        return coefficients.row(i) * space(x).col(0);
      }

      Tensor<1, 3> gradient(const unsigned int i, const Point<3> &x) const override
      {
        const Eigen::RowVector4d all = coefficients.row(i) * space(x);
        return Tensor<1, 3>({all[1], all[2], all[3]});
      }

    private:
      static constexpr unsigned int n_functions = 14;
      using Matrix                              = Eigen::Matrix<double, n_functions, n_functions>;

      /// Functions that span the space, with derivatives. w is set to zero at the apex, which is not a quadrature point.
      static Eigen::Matrix<double, n_functions, 4> space(const Point<3> &p)
      {
        using Function = Eigen::RowVector4d; // value and three derivatives
        const Function one(1., 0., 0., 0.), x(p[0], 1., 0., 0.), y(p[1], 0., 1., 0.), z(p[2], 0., 0., 1.);
        const double   below = 1. - p[2];
        const Function w     = below > 1e-12 ? Function(p[0] * p[1], p[1], p[0], p[0] * p[1] / below) / below : Function(Function::Zero());
        const auto     times = [](const Function &f, const Function &g) -> Function {
          Function product = f[0] * g + g[0] * f;
          product[0]       = f[0] * g[0];
          return product;
        };
        Eigen::Matrix<double, n_functions, 4> all;
        all << one, x, y, z, times(x, x), times(y, y), times(z, z), times(x, y), times(y, z), times(z, x), w, times(w, w), times(w, x),
          times(w, y);
        return all;
      }

      Matrix coefficients;
    };

    std::unique_ptr<const ShapeFunctions> make_functions(const Shape shape, const unsigned int degree)
    {
      const auto nodes = reference_nodes(shape, degree);
      const auto solid = [&](auto *element) {
        return std::make_unique<DealFunctions<3>>(std::unique_ptr<FiniteElement<3>>(element), nodes);
      };
      const auto flat = [&](auto *element) {
        return std::make_unique<DealFunctions<2>>(std::unique_ptr<FiniteElement<2>>(element), nodes);
      };
      switch (shape)
        {
          case Shape::triangle:
            return flat(new FE_SimplexP<2>(degree));
          case Shape::quadrilateral:
            return flat(new FE_Q<2>(degree));
          case Shape::tetrahedron:
            return solid(new FE_SimplexP<3>(degree));
          case Shape::wedge:
            return solid(new FE_WedgeP<3>(degree));
          case Shape::hexahedron:
            return solid(new FE_Q<3>(degree));
          default:
            return degree == 2 ? std::unique_ptr<const ShapeFunctions>(new QuadraticPyramid) : solid(new FE_PyramidP<3>(degree));
        }
    }

    /// Maps a rule on [0, 1]³ to the pyramid, whose width decreases as 1 − z.
    Quadrature<3> on_pyramid(const Quadrature<3> &cube)
    {
      std::vector<Point<3>> points;
      std::vector<double>   weights;
      for (unsigned int q = 0; q < cube.size(); ++q)
        {
          const Point<3> &p     = cube.point(q);
          const double    below = 1. - p[2];
          points.emplace_back((2. * p[0] - 1.) * below, (2. * p[1] - 1.) * below, p[2]);
          weights.push_back(4. * below * below * cube.weight(q));
        }
      return {points, weights};
    }

    Quadrature<3> on_wedge(const Quadrature<2> &triangle, const Quadrature<1> &line)
    {
      std::vector<Point<3>> points;
      std::vector<double>   weights;
      for (unsigned int q = 0; q < triangle.size(); ++q)
        for (unsigned int z = 0; z < line.size(); ++z)
          {
            points.emplace_back(triangle.point(q)[0], triangle.point(q)[1], line.point(z)[0]);
            weights.push_back(triangle.weight(q) * line.weight(z));
          }
      return {points, weights};
    }

    template <int dim>
    std::vector<QuadraturePoint> listed(const Quadrature<dim> &rule)
    {
      std::vector<QuadraturePoint> result(rule.size());
      for (unsigned int q = 0; q < rule.size(); ++q)
        {
          for (int d = 0; d < dim; ++d)
            result[q].x[d] = rule.point(q)[d];
          result[q].weight = rule.weight(q);
        }
      return result;
    }
  } // namespace

  const ShapeFunctions &ShapeFunctions::of(const Shape shape, const unsigned int degree)
  {
    static const auto all = for_all_elements<std::unique_ptr<const ShapeFunctions>>(make_functions);
    return *all[static_cast<unsigned int>(shape)][degree - 1];
  }

  std::vector<QuadraturePoint> quadrature(const Shape shape, const unsigned int degree)
  {
    const unsigned int n = degree + 1;
    switch (shape)
      {
        case Shape::triangle:
          return listed(QWitherdenVincentSimplex<2>(n));
        case Shape::quadrilateral:
          return listed(QGauss<2>(n));
        case Shape::tetrahedron:
          return listed(QWitherdenVincentSimplex<3>(n));
        case Shape::wedge:
          return listed(on_wedge(QWitherdenVincentSimplex<2>(n), QGauss<1>(n)));
        case Shape::hexahedron:
          return listed(QGauss<3>(n));
        default:
          return listed(on_pyramid(QGauss<3>(n + 1))); // one point more, for rational functions and the factor (1 − z)²
      }
  }
} // namespace Squeal
