// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/geometry/pin_grid.h>
#include <squeal/geometry/polygon.h>

#include <cmath>

namespace Squeal
{
  namespace
  {
    // Radii relative to the outline: inner end of all rings except the innermost, and corners of the blocks
    constexpr double rings_end = 0.8, blocks_end = 0.6;

    /// Shape of the sides of the triangle around the blocks: 0 for arcs, 1 for chords.
    constexpr double straightness = 0.5;

    Plan::Point between(const double t, const Plan::Point &a, const Plan::Point &b)
    {
      return Plan::Point((1. - t) * a + t * b);
    }

    /// Outline of the blocks inside the rings. The outer corners of blocks are halfway between the ends of spokes.
    std::vector<Plan::Point> bulging_triangle(const std::vector<unsigned int> &outline, const std::vector<Plan::Point> &points)
    {
      const unsigned int       side   = outline.size() / 3;
      const Plan::Point        centre = mean_point(outline, points);
      std::vector<Plan::Point> result;
      for (unsigned int i = 0; i < outline.size(); ++i)
        {
          const unsigned int along = (i + side / 2) % side, corner = i + outline.size() - along, next = corner + side;
          const Plan::Point  chord =
            between(double(along) / side, points[outline[corner % outline.size()]], points[outline[next % outline.size()]]);
          result.push_back(between(blocks_end, centre, between(straightness, points[outline[i]], chord)));
        }
      return result;
    }
  } // namespace

  std::vector<double> graded_intervals(const unsigned int n, const double ratio)
  {
    std::vector<double> ends = {0.};
    if (ratio == 1.)
      for (unsigned int i = 1; i <= n; ++i)
        ends.push_back(double(i) / n);
    else
      for (unsigned int i = 1; i <= n; ++i)
        ends.push_back((1. - std::pow(ratio, -double(i))) / (1. - std::pow(ratio, -double(n))));
    return ends;
  }

  std::vector<Plan::Face> fill_with_o_grid(const std::vector<unsigned int> &loop, std::vector<Plan::Point> &points)
  {
    const unsigned int k         = loop.size() / 6;
    const auto         at        = [&](const unsigned int i) { return loop[i % loop.size()]; };
    const auto         add_point = [&](const Plan::Point &point) -> unsigned int {
      points.push_back(point);
      return points.size() - 1;
    };

    const Plan::Point  centre      = mean_point(loop, points);
    const unsigned int centre_node = add_point(centre);
    for (unsigned int s = 0; s < 3; ++s)
      for (unsigned int i = 1; i < k; ++i)
        add_point((1. - double(i) / k) * centre + double(i) / k * points[at(2 * k * s)]);
    const auto spoke = [&](const unsigned int s, const unsigned int i) {
      return i == 0 ? centre_node : i == k ? at(2 * k * s) : centre_node + s % 3 * (k - 1) + i;
    };

    // Blocks: i runs along one spoke, j along the next one; the opposite sides are on the loop
    std::vector<Plan::Face> faces;
    for (unsigned int b = 0; b < 3; ++b)
      {
        std::vector<std::vector<unsigned int>> node(k + 1, std::vector<unsigned int>(k + 1, 0u));
        for (unsigned int i = 0; i <= k; ++i)
          {
            node[i][0] = spoke(b, i);
            node[0][i] = spoke(b + 1, i);
            node[k][i] = at(2 * k * b + i);
            node[i][k] = at(2 * k * (b + 1) - i);
          }

        // Transfinite interpolation between the four sides
        const auto p = [&](const unsigned int i, const unsigned int j) { return points[node[i][j]]; };
        for (unsigned int i = 1; i < k; ++i)
          for (unsigned int j = 1; j < k; ++j)
            {
              const double s = double(i) / k, t = double(j) / k;
              node[i][j] =
                add_point(Plan::Point((1. - t) * p(i, 0) + t * p(i, k) + (1. - s) * p(0, j) + s * p(k, j) - (1. - s) * (1. - t) * p(0, 0) -
                                      s * (1. - t) * p(k, 0) - (1. - s) * t * p(0, k) - s * t * p(k, k)));
            }

        for (unsigned int i = 0; i < k; ++i)
          for (unsigned int j = 0; j < k; ++j)
            faces.push_back({{node[i][j], node[i + 1][j], node[i + 1][j + 1], node[i][j + 1]}});
      }
    return faces;
  }

  PinGrid fill_pin(const std::vector<unsigned int> &outline, const PinRings &rings, std::vector<Plan::Point> &points)
  {
    PinGrid                   grid;
    std::vector<unsigned int> loop     = outline;
    const auto                add_ring = [&](const std::vector<Plan::Point> &inside) {
      std::vector<unsigned int> next;
      for (const Plan::Point &point : inside)
        {
          next.push_back(points.size());
          points.push_back(point);
        }
      for (std::size_t i = 0, j = 1; i < loop.size(); ++i, j = (i + 1) % loop.size())
        grid.faces.push_back({{loop[i], loop[j], next[j], next[i]}});
      grid.ring_nodes.insert(grid.ring_nodes.end(), next.begin(), next.end());
      loop = next;
    };

    const Plan::Point centre = mean_point(outline, points);
    if (rings.number > 1)
      {
        const std::vector<double> ends = graded_intervals(rings.number - 1, rings.grading);
        for (auto end = ends.rbegin() + 1; end != ends.rend(); ++end)
          {
            std::vector<Plan::Point> inside;
            for (const unsigned int node : outline)
              inside.push_back(between(rings_end + (1. - rings_end) * *end, centre, points[node]));
            add_ring(inside);
          }
      }
    if (rings.number > 0)
      add_ring(bulging_triangle(outline, points));
    const std::vector<Plan::Face> blocks = fill_with_o_grid(loop, points);
    grid.faces.insert(grid.faces.end(), blocks.begin(), blocks.end());
    return grid;
  }
} // namespace Squeal
