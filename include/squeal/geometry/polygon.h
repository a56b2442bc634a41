// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <deal.II/base/point.h>

#include <array>
#include <optional>
#include <vector>

namespace Squeal
{
  /// Nodes of a closed curve in order, starting with the smallest number; empty if the edges do not form one closed curve.
  std::vector<unsigned int> closed_polygon(const std::vector<std::array<unsigned int, 2>> &edges);

  /// Area of a polygon that is given by the indices of its nodes, positive if the nodes are counter-clockwise [m²].
  template <typename Nodes>
  double signed_area(const Nodes &nodes, const std::vector<dealii::Point<2>> &points)
  {
    double twice = 0.;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      {
        const dealii::Point<2> &a = points[nodes[i]];
        const dealii::Point<2> &b = points[nodes[(i + 1) % nodes.size()]];
        twice += a[0] * b[1] - a[1] * b[0];
      }
    return twice / 2.;
  }

  /// Mean of points that are given by one or more indices [m].
  dealii::Point<2> mean_point(const std::vector<unsigned int> &nodes, const std::vector<dealii::Point<2>> &points);

  struct Circle
  {
    dealii::Point<2> centre; ///< [m]
    double           radius; ///< [m]
  };

  /// Circle from which all points deviate by at most 1e-6 of its radius, by linear least squares, x² + y² = 2 a x + 2 b y + c. Empty if
  /// there is no such circle, or for fewer than six different points, because the four corners of a square also lie on a circle.
  std::optional<Circle> circle_through(const std::vector<dealii::Point<2>> &points);
} // namespace Squeal
