// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/estimates/body_frames.h>
#include <squeal/linear_algebra/communication.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Squeal
{
  using dealii::Point;

  namespace
  {
    const BodyFrame *find(const std::vector<BodyFrame> &frames, const std::string &name)
    {
      const auto found = std::find_if(frames.begin(), frames.end(), [&](const BodyFrame &frame) { return frame.name == name; });
      return found == frames.end() ? nullptr : &*found;
    }

    /// Maps x linearly from the interval [a, b] to [new_a, new_b].
    double moved(const double x, const double a, const double b, const double new_a, const double new_b)
    {
      return b > a ? new_a + (x - a) / (b - a) * (new_b - new_a) : new_a;
    }

    Point<3> moved(const Point<3> &point, const BodyFrame &from, const BodyFrame &to)
    {
      Point<3> result;
      for (unsigned int d = 0; d < 3; ++d)
        result[d] = moved(point[d], from.lower[d], from.upper[d], to.lower[d], to.upper[d]);
      if (const double radius = std::hypot(point[0], point[1]); from.outer_radius > 0. && radius > 0.)
        {
          const double factor = moved(radius, from.inner_radius, from.outer_radius, to.inner_radius, to.outer_radius) / radius;
          result[0]           = factor * point[0];
          result[1]           = factor * point[1];
        }
      return result;
    }
  } // namespace

  std::vector<BodyFrame> body_frames(const Model &model)
  {
    constexpr double       infinity = std::numeric_limits<double>::infinity();
    std::vector<BodyFrame> result;
    for (const std::string &name : model.component_names())
      result.push_back({name, Point<3>(infinity, infinity, infinity), -Point<3>(infinity, infinity, infinity), infinity, 0.});
    for (const Node &node : model.nodes())
      {
        BodyFrame   &frame  = result[node.component];
        const double radius = std::hypot(node.position[0], node.position[1]);
        frame.inner_radius  = std::min(frame.inner_radius, radius);
        frame.outer_radius  = std::max(frame.outer_radius, radius);
        for (unsigned int d = 0; d < 3; ++d)
          {
            frame.lower[d] = std::min(frame.lower[d], node.position[d]);
            frame.upper[d] = std::max(frame.upper[d], node.position[d]);
          }
      }
    for (BodyFrame &frame : result)
      {
        smallest_of_processes(model.communicator(), &frame.inner_radius, 1);
        frame.outer_radius = largest_of_processes(model.communicator(), frame.outer_radius);
        for (unsigned int d = 0; d < 3; ++d)
          {
            smallest_of_processes(model.communicator(), &frame.lower[d], 1);
            frame.upper[d] = largest_of_processes(model.communicator(), frame.upper[d]);
          }
      }
    for (BodyFrame &frame : result)
      if (frame.name != PhysicalNames::disc)
        frame.inner_radius = frame.outer_radius = 0.;
    return result;
  }

  CommonPoints carried_over(const CommonPoints &points, const std::vector<BodyFrame> &from, const std::vector<BodyFrame> &to)
  {
    CommonPoints result;
    for (const CommonPoints::Body &body : points.bodies)
      if (const BodyFrame *there = find(from, body.name), *here = find(to, body.name); there != nullptr && here != nullptr)
        {
          result.bodies.push_back(body);
          for (Point<3> &point : result.bodies.back().points)
            point = moved(point, *there, *here);
        }
    return result;
  }
} // namespace Squeal
