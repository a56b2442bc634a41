#include <squeal/geometry/outlines.h>

#include <deal.II/base/numbers.h>

#include <cmath>
#include <map>
#include <optional>

namespace Squeal
{
  namespace
  {
    /// Largest distance of a node from its circle, relative to the radius.
    constexpr double roundness = 1e-6;

    /// Four corners of a square lie on a circle as well.
    constexpr std::size_t fewest_sides = 6;

    /// Nodes of a closed curve one behind the other; none where the edges are not one closed curve.
    std::vector<unsigned int> closed_polygon(const std::vector<Plan::Edge> &edges)
    {
      std::map<unsigned int, std::vector<unsigned int>> neighbours;
      for (const auto &[a, b] : edges)
        {
          neighbours[a].push_back(b);
          neighbours[b].push_back(a);
        }
      for (const auto &[node, others] : neighbours)
        if (others.size() != 2)
          return {};
      if (neighbours.empty())
        return {};
      std::vector<unsigned int> polygon = {neighbours.begin()->first};
      unsigned int              next    = neighbours.begin()->second[0];
      while (next != polygon.front())
        {
          const auto        &others = neighbours.at(next);
          const unsigned int last   = polygon.back();
          polygon.push_back(next);
          next = others[0] == last ? others[1] : others[0];
        }
      return polygon.size() == neighbours.size() ? polygon : std::vector<unsigned int>();
    }

    struct Circle
    {
      Plan::Point centre;
      double      radius;
    };

    /// Circle through three nodes that lie far from each other, if all others are on it.
    std::optional<Circle> circle_through(const std::vector<unsigned int> &polygon, const std::vector<Plan::Point> &points)
    {
      const std::size_t n = polygon.size();
      if (n < fewest_sides)
        return {};
      const Plan::Point         &a = points[polygon[0]];
      const dealii::Tensor<1, 2> b = points[polygon[n / 3]] - a, c = points[polygon[2 * n / 3]] - a;
      const double               twice_area = b[0] * c[1] - b[1] * c[0];
      if (std::abs(twice_area) < roundness * b.norm() * c.norm())
        return {};
      const double bb = b.norm_square(), cc = c.norm_square();
      const Circle circle{a + Plan::Point(c[1] * bb - b[1] * cc, b[0] * cc - c[0] * bb) / (2. * twice_area), 0.};
      const double radius = circle.centre.distance(a);
      for (const unsigned int node : polygon)
        if (std::abs(points[node].distance(circle.centre) - radius) > roundness * radius)
          return {};
      return Circle{circle.centre, radius};
    }

    double area(const std::vector<unsigned int> &polygon, const std::vector<Plan::Point> &points)
    {
      double twice = 0.;
      for (std::size_t i = 0; i < polygon.size(); ++i)
        {
          const Plan::Point &a = points[polygon[i]], &b = points[polygon[(i + 1) % polygon.size()]];
          twice += a[0] * b[1] - a[1] * b[0];
        }
      return std::abs(twice) / 2.;
    }

    /// Moves @p nodes away from the centre of the circle on which the closed curve lies, if it is one.
    void enlarge(const std::vector<Plan::Edge> &outline, const std::set<unsigned int> &nodes, std::vector<Plan::Point> &points)
    {
      const std::vector<unsigned int> polygon = closed_polygon(outline);
      const std::optional<Circle>     circle  = circle_through(polygon, points);
      if (!circle)
        return;
      const double factor = std::sqrt(dealii::numbers::PI * circle->radius * circle->radius / area(polygon, points));
      for (const unsigned int node : nodes)
        points[node] = circle->centre + factor * (points[node] - circle->centre);
    }
  } // namespace

  void enlarge_to_true_area(Plan &plan)
  {
    for (const Plan::Curve &curve : plan.curves)
      enlarge(curve.edges, nodes_of(curve.edges), plan.points);
    // Pins of both sides may be above the same faces
    std::set<std::vector<unsigned int>> done;
    for (const Plan::Pin &pin : plan.pins)
      if (done.insert(pin.faces).second)
        {
          const std::vector<Plan::Face> faces = plan.faces_of(pin);
          enlarge(boundary_edges(faces), nodes_of(faces), plan.points);
        }
  }
} // namespace Squeal
