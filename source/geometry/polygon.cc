#include <squeal/geometry/polygon.h>

#include <deal.II/base/tensor.h>

#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace Squeal
{
  namespace
  {
    using dealii::Point;
    using dealii::Tensor;

    /// Largest distance of a point from its circle, relative to the radius.
    constexpr double roundness = 1e-6;

    constexpr std::size_t fewest_points = 6;

    Point<2> mean(const std::vector<Point<2>> &points)
    {
      Point<2> sum;
      for (const Point<2> &p : points)
        sum += p;
      return sum / double(points.size());
    }

    /// Root of the mean square of the distances.
    double mean_distance(const std::vector<Point<2>> &points, const Point<2> &from)
    {
      double sum = 0.;
      for (const Point<2> &p : points)
        sum += p.distance_square(from);
      return std::sqrt(sum / double(points.size()));
    }

    /// Those that differ by @p length or more.
    std::size_t n_different(const std::vector<Point<2>> &points, const Point<2> &origin, const double length)
    {
      std::set<std::pair<long, long>> places;
      for (const Point<2> &p : points)
        places.insert({std::lround((p[0] - origin[0]) / length), std::lround((p[1] - origin[1]) / length)});
      return places.size();
    }
  } // namespace

  std::vector<unsigned int> closed_polygon(const std::vector<std::array<unsigned int, 2>> &edges)
  {
    std::map<unsigned int, std::vector<unsigned int>> neighbours;
    for (const auto &[a, b] : edges)
      {
        neighbours[a].push_back(b);
        neighbours[b].push_back(a);
      }
    if (neighbours.empty())
      return {};
    for (const auto &[node, others] : neighbours)
      if (others.size() != 2)
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

  dealii::Point<2> mean_point(const std::vector<unsigned int> &nodes, const std::vector<dealii::Point<2>> &points)
  {
    dealii::Point<2> sum;
    for (const unsigned int node : nodes)
      sum += points[node];
    return sum / double(nodes.size());
  }

  std::optional<Circle> circle_through(const std::vector<Point<2>> &points)
  {
    if (points.empty())
      return {};
    // About the centroid and in units of their distances from it the normal equations are well scaled
    const Point<2> origin = mean(points);
    const double   length = mean_distance(points, origin);
    if (length == 0. || n_different(points, origin, roundness * length) < fewest_points)
      return {};

    Tensor<2, 3> normal;
    Tensor<1, 3> rhs;
    for (const Point<2> &p : points)
      {
        const Tensor<1, 2> d = (p - origin) / length;
        const Tensor<1, 3> row({2. * d[0], 2. * d[1], 1.});
        normal += outer_product(row, row);
        rhs += d.norm_square() * row;
      }
    if (std::abs(determinant(normal)) < 1e-14 * std::pow(normal.norm(), 3))
      return {}; // on a straight line
    const Tensor<1, 3> solution = invert(normal) * rhs;
    const Circle       circle{origin + length * Point<2>(solution[0], solution[1]),
                        length * std::sqrt(solution[2] + solution[0] * solution[0] + solution[1] * solution[1])};

    for (const Point<2> &p : points)
      if (std::abs(p.distance(circle.centre) - circle.radius) > roundness * circle.radius)
        return {};
    return circle;
  }
} // namespace Squeal
