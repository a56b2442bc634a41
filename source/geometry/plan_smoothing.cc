#include <squeal/geometry/plan_smoothing.h>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    // Faces above this shape (a rectangle of sides 1 : 3, or an angle of 37°) stay as Gmsh made them.
    constexpr double good_shape = 0.6;
    constexpr int    max_sweeps = 100;

    /// Least shape of the four corners.
    double shape(const Plan::Face &face, const std::vector<Plan::Point> &points)
    {
      double worst = 1.;
      for (unsigned int v = 0; v < 4; ++v)
        {
          const Plan::Point &corner = points[face[v]];
          const Plan::Point &next   = points[face[(v + 1) % 4]];
          const Plan::Point &last   = points[face[(v + 3) % 4]];
          const double       ax = next[0] - corner[0], ay = next[1] - corner[1];
          const double       bx = last[0] - corner[0], by = last[1] - corner[1];
          const double       squares = ax * ax + ay * ay + bx * bx + by * by;
          worst = std::min(worst, squares > 0. ? 2. * (ax * by - ay * bx) / squares : -1.);
        }
      return worst;
    }
  } // namespace

  void smooth(Plan &plan)
  {
    // Nodes that may move, and the faces around them
    std::vector<bool> fixed(plan.points.size(), false);
    const auto        fix_outline = [&](const std::vector<Plan::Face> &faces) {
      for (const Plan::Edge &edge : boundary_edges(faces))
        fixed[edge[0]] = fixed[edge[1]] = true;
    };
    fix_outline(plan.faces);
    for (const Plan::Pin &pin : plan.pins)
      {
        std::vector<Plan::Face> faces;
        for (const unsigned int face : pin.faces)
          faces.push_back(plan.faces[face]);
        fix_outline(faces);
      }
    std::vector<std::vector<unsigned int>> faces_at(plan.points.size());
    for (unsigned int face = 0; face < plan.faces.size(); ++face)
      for (const unsigned int node : plan.faces[face])
        if (!fixed[node])
          faces_at[node].push_back(face);

    // Sweeps: try the mean of the neighbours, then steps of decreasing length
    const auto worst_at = [&](const unsigned int node) {
      double worst = 1.;
      for (const unsigned int face : faces_at[node])
        worst = std::min(worst, shape(plan.faces[face], plan.points));
      return worst;
    };
    bool moved = true;
    for (int sweep = 0; sweep < max_sweeps && moved; ++sweep)
      {
        moved = false;
        for (unsigned int node = 0; node < plan.points.size(); ++node)
          {
            if (fixed[node])
              continue;
            const double before = worst_at(node);
            if (before >= good_shape)
              continue;

            double      best          = before;
            Plan::Point best_position = plan.points[node];
            const auto  attempt       = [&](const Plan::Point &position) {
              plan.points[node]  = position;
              const double worst = worst_at(node);
              if (worst > best)
                {
                  best          = worst;
                  best_position = position;
                }
            };

            Plan::Point  mean    = {{0., 0.}};
            double       longest = 0.;
            unsigned int count   = 0;
            for (const unsigned int face : faces_at[node])
              for (const unsigned int other : plan.faces[face])
                if (other != node)
                  {
                    for (unsigned int d = 0; d < 2; ++d)
                      mean[d] += plan.points[other][d];
                    longest = std::max(longest, std::hypot(plan.points[other][0] - best_position[0],
                                                           plan.points[other][1] - best_position[1]));
                    ++count;
                  }
            attempt({{mean[0] / count, mean[1] / count}});
            for (double step = 0.5 * longest; step > 1e-3 * longest; step /= 2.)
              {
                const Plan::Point from = best_position;
                for (int direction = 0; direction < 8; ++direction)
                  attempt({{from[0] + step * std::cos(direction * std::acos(-1.) / 4.),
                            from[1] + step * std::sin(direction * std::acos(-1.) / 4.)}});
              }

            plan.points[node] = best_position;
            moved             = moved || best > before + 1e-4;
          }
      }
  }
} // namespace Squeal
