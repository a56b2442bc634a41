// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/geometry/surface_overlap.h>

#include <boost/iterator/function_output_iterator.hpp>
#include <deal.II/base/bounding_box.h>
#include <deal.II/numerics/rtree.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>

namespace Squeal
{
  using Eigen::Vector2d;
  using Eigen::Vector3d;

  namespace
  {
    using Space      = Eigen::Matrix<double, 3, most_face_nodes>; // coefficients of positions, by monomial
    using Plane      = Eigen::Matrix<double, 2, most_face_nodes>; // coefficients of positions in a plane
    using Derivative = Eigen::Matrix<double, most_face_nodes, 2>;

    /// Monomials m_k; combinations of them are the shape functions of all faces.
    FaceVector monomials(const Vector2d &r)
    {
      const double x = r[0], y = r[1];
      FaceVector   result;
      result << 1., x, y, x * y, x * x, y * y, x * x * y, x * y * y, x * x * y * y;
      return result;
    }

    Derivative derivatives(const Vector2d &r)
    {
      const double x = r[0], y = r[1];
      Derivative   result;
      result << 0., 0., 1., 0., 0., 1., y, x, 2. * x, 0., 0., 2. * y, 2. * x * y, x * x, y * y, 2. * x * y, 2. * x * y * y, 2. * x * x * y;
      return result;
    }

    Vector2d in_plane(const dealii::Point<3> &reference)
    {
      return {reference[0], reference[1]};
    }

    unsigned int degree_of(const SurfaceElement &element)
    {
      return element.nodes.size() > 4 ? 2 : 1;
    }

    /// Index of the face type: triangles and quadrilaterals of degree 1, then of degree 2.
    unsigned int kind(const SurfaceElement &element)
    {
      return 2 * (degree_of(element) - 1) + (element.shape == Shape::triangle ? 0 : 1);
    }

    /// Integer coefficients C of the shape functions, N_i = Σ_k C_ik m_k.
    FaceMatrix find_coefficients(const Shape shape, const unsigned int degree)
    {
      const auto      nodes = reference_nodes(shape, degree);
      const int       n     = nodes.size();
      Eigen::MatrixXd at_nodes(n, n);
      for (int j = 0; j < n; ++j)
        at_nodes.col(j) = monomials(in_plane(nodes[j])).head(n);
      FaceMatrix result          = FaceMatrix::Zero();
      result.topLeftCorner(n, n) = at_nodes.inverse().array().round();
      return result;
    }

    const FaceMatrix &coefficients(const SurfaceElement &element)
    {
      static const FaceMatrix all[] = {find_coefficients(Shape::triangle, 1), find_coefficients(Shape::quadrilateral, 1),
                                       find_coefficients(Shape::triangle, 2), find_coefficients(Shape::quadrilateral, 2)};
      return all[kind(element)];
    }

    Vector3d node(const SurfacePatch &patch, const SurfaceElement &element, const unsigned int i)
    {
      return Vector3d::Map(patch.points[element.nodes[i]].begin_raw());
    }

    Space map_of(const SurfacePatch &patch, const SurfaceElement &element)
    {
      Space result = Space::Zero();
      for (unsigned int i = 0; i < element.nodes.size(); ++i)
        result += node(patch, element, i) * coefficients(element).row(i);
      return result;
    }

    /// An element of degree 1, a quarter of an element of degree 2, or half of either if it is not convex.
    struct Facet
    {
      unsigned int          element;
      std::vector<Vector3d> corners;
      Vector2d              reference; ///< coordinates of the centre
      Vector3d              normal;    ///< unit normal
      double                area;      ///< [m²]
    };

    void add_facet(std::vector<Facet>              &facets,
                   const SurfacePatch              &patch,
                   const unsigned int               number,
                   const std::vector<unsigned int> &corners)
    {
      const SurfaceElement &element = patch.elements[number];
      const auto            nodes   = reference_nodes(element.shape, degree_of(element));
      const std::size_t     n       = corners.size();
      Facet                 facet{number, {}, Vector2d::Zero(), {}, 0.};
      for (const unsigned int corner : corners)
        {
          facet.corners.push_back(node(patch, element, corner));
          facet.reference += in_plane(nodes[corner]) / double(n);
        }
      const Vector3d area = 0.5 * (facet.corners[2] - facet.corners[0]).cross(facet.corners.back() - facet.corners[1]);
      facet.area          = area.norm();
      facet.normal        = area / facet.area;

      // Divide a quadrilateral that is not convex: clipping requires convex polygons
      if (n == 4)
        for (unsigned int i = 0; i < 4; ++i)
          {
            const unsigned int a = (i + 1) % 4, b = (i + 2) % 4, c = (i + 3) % 4;
            const Vector3d     along = facet.corners[a] - facet.corners[i], back = facet.corners[c] - facet.corners[i];
            if (along.cross(back).dot(facet.normal) <= 0.)
              {
                add_facet(facets, patch, number, {corners[i], corners[a], corners[b]});
                add_facet(facets, patch, number, {corners[i], corners[b], corners[c]});
                return;
              }
          }
      facets.push_back(facet);
    }

    std::vector<Facet> facets_of(const SurfacePatch &patch)
    {
      using Parts = std::vector<std::vector<unsigned int>>;
      static const std::array<Parts, 4> parts{{{{0, 1, 2}},
                                               {{0, 1, 2, 3}},
                                               {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}},
                                               {{0, 4, 8, 7}, {4, 1, 5, 8}, {8, 5, 2, 6}, {7, 8, 6, 3}}}};
      std::vector<Facet>                result;
      for (unsigned int e = 0; e < patch.elements.size(); ++e)
        for (const auto &corners : parts[kind(patch.elements[e])])
          add_facet(result, patch, e, corners);
      return result;
    }

    dealii::BoundingBox<3> box_around(const Facet &facet, const double distance)
    {
      std::vector<dealii::Point<3>> points;
      for (const Vector3d &corner : facet.corners)
        points.emplace_back(corner[0], corner[1], corner[2]);
      dealii::BoundingBox<3> box(points);
      box.extend(distance);
      return box;
    }

    using Polygon = std::vector<Vector2d>;

    double cross(const Vector2d &a, const Vector2d &b)
    {
      return a[0] * b[1] - a[1] * b[0];
    }

    /// Part of a polygon inside a convex polygon, both counter-clockwise (I. E. Sutherland, G. W. Hodgman 1974).
    Polygon clipped(Polygon polygon, const Polygon &by)
    {
      for (std::size_t k = 0; k < by.size(); ++k)
        {
          const Vector2d &origin = by[k], edge = by[(k + 1) % by.size()] - origin;
          Polygon         inside;
          for (std::size_t i = 0; i < polygon.size(); ++i)
            {
              const Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
              const double    left_a = cross(edge, a - origin), left_b = cross(edge, b - origin);
              if (left_a >= 0.)
                inside.push_back(a);
              if ((left_a < 0.) != (left_b < 0.))
                inside.push_back(a + left_a / (left_a - left_b) * (b - a));
            }
          polygon = inside;
        }
      return polygon;
    }

    double area(const Polygon &polygon)
    {
      double twice = 0.;
      for (std::size_t i = 2; i < polygon.size(); ++i)
        twice += cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
      return twice / 2.;
    }

    /// Reference coordinates of a position by Newton's method, starting at @p r.
    Vector2d located(const Plane &map, const Vector2d &place, Vector2d r)
    {
      constexpr double longest_step = 0.25;
      for (unsigned int i = 0; i < 50; ++i)
        {
          const Vector2d step = (map * derivatives(r)).inverse() * (place - map * monomials(r));
          // Limit the step: a longer step may reach a region where the map is folded
          r += step * std::min(1., longest_step / step.norm());
          // Newton's method has converged: the remaining error is of the order of the square of the step
          if (step.squaredNorm() < 1e-16)
            return r;
        }
      throw MeshError("no reference coordinates were found for a point of a face: the face is too distorted",
                      "surfaces disc_contact and pin_contact", "use less distorted or less curved elements on these surfaces");
    }

    /// Projections of both surfaces onto the plane of a slave facet.
    struct FacetPlane
    {
      explicit FacetPlane(const Facet &facet)
        : normal(facet.normal)
        , origin(facet.corners[0])
      {
        axes.row(0) = facet.normal.unitOrthogonal();
        axes.row(1) = facet.normal.cross(axes.row(0).transpose());
      }

      Polygon polygon(const Facet &facet) const
      {
        Polygon result;
        for (const Vector3d &corner : facet.corners)
          result.push_back(axes * (corner - origin));
        return result;
      }

      Vector3d                    normal, origin;
      Eigen::Matrix<double, 2, 3> axes;
    };

    /// Slave or master element of a segment.
    struct OverlapSide
    {
      OverlapSide(const SurfacePatch &patch, const Facet &facet, const FacetPlane &plane)
        : functions(coefficients(patch.elements[facet.element]))
        , space(map_of(patch, patch.elements[facet.element]))
        , r(facet.reference)
      {
        space.col(0) -= plane.origin; // coordinates relative to the origin avoid cancellation
        map = plane.axes * space;
      }

      /// True for a straight triangle, on which shape functions are polynomials of the position.
      bool is_affine() const
      {
        return space.rightCols<most_face_nodes - 3>().norm() < 1e-9 * space.middleCols<2>(1).norm();
      }

      void locate(const Vector2d &place)
      {
        r = located(map, place, r);
      }

      FaceVector values() const
      {
        return functions * monomials(r);
      }

      const FaceMatrix &functions;
      Space             space;
      Plane             map;
      Vector2d          r; ///< reference coordinates of the last position
    };

    /// Quadrature rule. On straight triangles, products of functions are polynomials of degree 4 at most, and the rule is exact. On
    /// distorted quadrilaterals and curved triangles, functions are not polynomials of the position: with 28 points, the nodal forces of a
    /// constant pressure have errors of 1e-13 if corners are shifted by 10 % of the element, and of 1e-10 for 20 %.
    const std::vector<QuadraturePoint> &rule(const bool are_affine)
    {
      static const auto polynomials = quadrature(Shape::triangle, 2), others = quadrature(Shape::triangle, 5);
      return are_affine ? polynomials : others;
    }

    void integrate(const Polygon                      &polygon,
                   const std::vector<QuadraturePoint> &rule,
                   const Vector3d                     &normal,
                   OverlapSide                         slave,
                   OverlapSide                         master,
                   FaceMatrix                         &mass,
                   FaceMatrix                         &coupling)
    {
      for (std::size_t i = 2; i < polygon.size(); ++i)
        {
          Eigen::Matrix2d edges;
          edges << polygon[i - 1] - polygon[0], polygon[i] - polygon[0];
          for (const QuadraturePoint &point : rule)
            {
              const Vector2d place = polygon[0] + edges * in_plane(point.x);
              slave.locate(place);
              master.locate(place);
              const Eigen::Matrix<double, 3, 2> tangents = slave.space * derivatives(slave.r);
              const Vector3d                    area     = tangents.col(0).cross(tangents.col(1));
              const FaceVector                  values   = slave.values();
              const FaceVector                  weighted = (point.weight * edges.determinant() * area.norm() / area.dot(normal)) * values;
              mass += weighted * values.transpose();
              coupling += weighted * master.values().transpose();
            }
        }
    }
  } // namespace

  SurfaceOverlap overlap(const SurfacePatch &slave, const SurfacePatch &master, const double search_distance)
  {
    // Skip pairs of facets if the angle between them exceeds 78°
    constexpr double least_cosine = 0.2;
    // Skip overlaps that are rounding errors along common edges
    constexpr double least_part = 1e-14;

    const std::vector<Facet> masters = facets_of(master);
    using Leaf                       = std::pair<dealii::BoundingBox<3>, unsigned int>;
    std::vector<Leaf> leaves;
    for (unsigned int m = 0; m < masters.size(); ++m)
      leaves.emplace_back(box_around(masters[m], 0.), m);
    const auto tree = dealii::pack_rtree(leaves);

    SurfaceOverlap result{std::vector<ElementOverlap>(slave.elements.size()), 0., 0., 0.};
    double         facing = 0.; // area of all overlaps
    for (const Facet &facet : facets_of(slave))
      {
        const FacetPlane  plane(facet);
        const Polygon     below = plane.polygon(facet);
        const OverlapSide of_slave(slave, facet, plane);
        ElementOverlap   &element = result.elements[facet.element];
        double            covered = 0., sizes = 0.;             // sums for the mean size of opposite master facets
        const double      beside = 0.1 * std::sqrt(facet.area); // margin: curved elements extend beyond the boxes of their facets
        const auto        visit  = [&](const Leaf &leaf) {
          const Facet  &other  = masters[leaf.second];
          const double  cosine = facet.normal.dot(other.normal);
          const Polygon above  = plane.polygon(other);
          const Polygon common = clipped(cosine < 0. ? Polygon(above.rbegin(), above.rend()) : above, below);
          const double  part   = area(common);
          if (!(part > least_part * facet.area) || std::abs(cosine) < least_cosine)
            return;
          Vector2d centre = Vector2d::Zero();
          for (const Vector2d &corner : common)
            centre += corner / double(common.size());
          OverlapSide lower = of_slave, upper(master, other, plane);
          lower.locate(centre);
          upper.locate(centre);
          const double gap = std::abs(plane.normal.dot(upper.space * monomials(upper.r) - lower.space * monomials(lower.r)));
          if (gap > search_distance)
            return;
          facing += part;
          result.mean_cosine += part * cosine;
          if (cosine > 0.)
            return;
          result.largest_gap = std::max(result.largest_gap, gap);
          covered += part;
          sizes += part * other.area;
          auto &coupling = element.coupling;
          auto  entry = std::find_if(coupling.begin(), coupling.end(), [&](const auto &pair) { return pair.first == other.element; });
          if (entry == coupling.end())
            entry = coupling.insert(entry, {other.element, FaceMatrix::Zero()});
          integrate(common, rule(lower.is_affine() && upper.is_affine()), plane.normal, lower, upper, element.mass, entry->second);
        };
        tree.query(boost::geometry::index::intersects(box_around(facet, search_distance + beside)),
                   boost::make_function_output_iterator(visit));
        if (covered > 0.)
          result.coarseness = std::max(result.coarseness, std::sqrt(facet.area * covered / sizes));
      }
    result.mean_cosine = facing > 0. ? result.mean_cosine / facing : -1.;
    return result;
  }

  WholeElement whole_element(const SurfacePatch &patch, const SurfaceElement &element)
  {
    const Space  map = map_of(patch, element);
    WholeElement result;
    for (const QuadraturePoint &point : quadrature(element.shape, degree_of(element)))
      {
        const Eigen::Matrix<double, 3, 2> tangents = map * derivatives(in_plane(point.x));
        const Vector3d                    area     = point.weight * tangents.col(0).cross(tangents.col(1));
        result.functions += area.norm() * coefficients(element) * monomials(in_plane(point.x));
        result.area_normal += area;
      }
    return result;
  }
} // namespace Squeal
