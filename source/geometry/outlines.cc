#include <squeal/geometry/outlines.h>
#include <squeal/geometry/polygon.h>

#include <deal.II/base/numbers.h>

#include <cmath>
#include <optional>

namespace Squeal
{
  namespace
  {
    /// Moves @p nodes away from the centre of the circle on which the closed curve lies, if it is one.
    void enlarge(const std::vector<Plan::Edge> &outline, const std::set<unsigned int> &nodes, std::vector<Plan::Point> &points)
    {
      const std::vector<unsigned int> polygon = closed_polygon(outline);
      std::vector<Plan::Point>        corners;
      for (const unsigned int node : polygon)
        corners.push_back(points[node]);
      const std::optional<Circle> circle = circle_through(corners);
      if (!circle)
        return;
      const double area   = std::abs(signed_area(polygon, points));
      const double factor = std::sqrt(dealii::numbers::PI * circle->radius * circle->radius / area);
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
