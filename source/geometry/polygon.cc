// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/geometry/polygon.h>

#include <Eigen/QR>

#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace Squeal
{
  namespace
  {
    /// Largest distance of a point from its circle, relative to the radius [-].
    constexpr double roundness = 1e-6;
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

  std::optional<Circle> circle_through(const std::vector<dealii::Point<2>> &points)
  {
    constexpr std::size_t fewest_points = 6;
    constexpr double      straight      = 1e-8;
    if (points.size() < fewest_points)
      return {};
    // Shift coordinates to the centroid and scale them by the root mean square distance from it
    Eigen::MatrixX2d x(points.size(), 2);
    for (std::size_t i = 0; i < points.size(); ++i)
      x.row(i) << points[i][0], points[i][1];
    const Eigen::RowVector2d origin = x.colwise().mean();
    x.rowwise() -= origin;
    const double length = std::sqrt(x.rowwise().squaredNorm().mean());
    x /= length;
    std::set<std::pair<long, long>> places;
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      places.insert({std::lround(x(i, 0) / roundness), std::lround(x(i, 1) / roundness)});
    if (!(length > 0.) || places.size() < fewest_points)
      return {};

    Eigen::MatrixX3d rows(x.rows(), 3);
    rows << 2. * x, Eigen::VectorXd::Ones(x.rows());
    Eigen::ColPivHouseholderQR<Eigen::MatrixX3d> factors(rows);
    factors.setThreshold(straight);
    if (factors.rank() < 3)
      return {};
    const Eigen::Vector3d    solution = factors.solve(x.rowwise().squaredNorm());
    const Eigen::RowVector2d centre   = solution.head<2>();
    const double             radius   = std::sqrt(solution[2] + centre.squaredNorm());
    if (((x.rowwise() - centre).rowwise().norm().array() - radius).abs().maxCoeff() > roundness * radius)
      return {};
    return Circle{{origin[0] + length * centre[0], origin[1] + length * centre[1]}, length * radius};
  }
} // namespace Squeal
