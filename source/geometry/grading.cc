#include <squeal/geometry/grading.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace Squeal
{
  namespace
  {
    /// Rings of a pin: 0 for nodes of its outline, then the number of edges to it.
    std::map<unsigned int, unsigned int> distances_to_outline(const std::vector<Plan::Face> &faces)
    {
      std::map<unsigned int, unsigned int> distance;
      for (const unsigned int node : nodes_of(boundary_edges(faces)))
        distance[node] = 0;
      const std::size_t n = nodes_of(faces).size();
      for (unsigned int ring = 0; distance.size() < n; ++ring)
        for (const Plan::Face &face : faces)
          for (unsigned int v = 0; v < 4; ++v)
            for (const unsigned int neighbour : {face[(v + 1) % 4], face[(v + 3) % 4]})
              if (const auto here = distance.find(face[v]); here != distance.end() && here->second == ring)
                distance.emplace(neighbour, ring + 1);
      return distance;
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

  void grade_round_pins(Plan &plan, const double ratio)
  {
    if (ratio == 1.)
      return;
    std::set<std::vector<unsigned int>> done; // pins of both sides may be above the same faces
    for (const Plan::Pin &pin : plan.pins)
      if (pin.is_round && done.insert(pin.faces).second)
        {
          const std::vector<Plan::Face> faces    = plan.faces_of(pin);
          const auto                    distance = distances_to_outline(faces);
          unsigned int                  n_rings  = 0;
          Plan::Point                   centre;
          for (const auto &[node, rings] : distance)
            if (rings >= n_rings)
              {
                n_rings = rings;
                centre  = plan.points[node];
              }
          const std::vector<double> radii = graded_intervals(n_rings, ratio);
          for (const auto &[node, rings] : distance)
            if (rings > 0 && rings < n_rings)
              plan.points[node] = centre + radii[n_rings - rings] * n_rings / (n_rings - rings) * (plan.points[node] - centre);
        }
  }
} // namespace Squeal
