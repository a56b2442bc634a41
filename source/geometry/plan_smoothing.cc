#include <squeal/geometry/plan_smoothing.h>
#include <squeal/geometry/plan_untangling.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace Squeal
{
  namespace
  {
    // Faces above this shape (a rectangle of sides 1 : 3, or an angle of 37°) stay as Gmsh made them.
    constexpr double good_shape = 0.6;
    constexpr int    max_sweeps = 100;

    // Enough for a displacement to spread from a pin to its neighbours; how evenly does not matter.
    constexpr int displacement_sweeps = 200;
    constexpr int displacement_steps  = 5;

    /// Least shape of the four corners.
    double shape(const Plan::Face &face, const std::vector<Plan::Point> &points)
    {
      double worst = 1.;
      for (unsigned int v = 0; v < 4; ++v)
        {
          const auto [a, b, cross] = Corner(face, v, points);
          const double squares     = a[0] * a[0] + a[1] * a[1] + b[0] * b[0] + b[1] * b[1];
          worst                    = std::min(worst, squares > 0. ? 2. * cross / squares : -1.);
        }
      return worst;
    }

    /// Marks the nodes on the outline of a set of faces.
    void fix_outline(const std::vector<Plan::Face> &faces, std::vector<bool> &fixed)
    {
      for (const Plan::Edge &edge : boundary_edges(faces))
        fixed[edge[0]] = fixed[edge[1]] = true;
    }

    /// Nodes on the outline of a pin and those of its rings.
    void fix(const Plan::Pin &pin, const Plan &plan, std::vector<bool> &fixed)
    {
      fix_outline(plan.faces_of(pin), fixed);
      for (const unsigned int node : pin.ring_nodes)
        fixed[node] = true;
    }

    /// A pin with its nodes where they are now: it may turn about its centre.
    TurningPart turning_part(const Plan::Pin &pin, const Plan &plan, const std::vector<Plan::Point> &points)
    {
      const std::vector<Plan::Face> faces = plan.faces_of(pin);
      const std::set<unsigned int>  nodes = nodes_of(faces), outline = nodes_of(boundary_edges(faces));
      TurningPart                   part{{nodes.begin(), nodes.end()}, {}};
      for (const unsigned int node : outline)
        part.centre += points[node] / double(outline.size());
      return part;
    }

    void smooth(const std::vector<Plan::Face> &faces, const std::vector<bool> &fixed, std::vector<Plan::Point> &points)
    {
      // Faces around the nodes that may move
      std::vector<std::vector<unsigned int>> faces_at(points.size());
      for (unsigned int face = 0; face < faces.size(); ++face)
        for (const unsigned int node : faces[face])
          if (!fixed[node])
            faces_at[node].push_back(face);

      // Length of steps: fixed, so that tangled nodes do not run away
      std::vector<double> longest_edge(points.size(), 0.);
      for (const Plan::Face &face : faces)
        for (unsigned int v = 0; v < 4; ++v)
          {
            const double length = points[face[v]].distance(points[face[(v + 1) % 4]]);
            for (const unsigned int node : {face[v], face[(v + 1) % 4]})
              longest_edge[node] = std::max(longest_edge[node], length);
          }

      // Sweeps: try the mean of the neighbours, then steps of decreasing length
      const auto worst_at = [&](const unsigned int node) {
        double worst = 1.;
        for (const unsigned int face : faces_at[node])
          worst = std::min(worst, shape(faces[face], points));
        return worst;
      };
      bool moved = true;
      for (int sweep = 0; sweep < max_sweeps && moved; ++sweep)
        {
          moved = false;
          for (unsigned int node = 0; node < points.size(); ++node)
            {
              if (fixed[node])
                continue;
              const double before = worst_at(node);
              if (before >= good_shape)
                continue;

              // The mean of the neighbours, if it is better
              const Plan::Point place = points[node];
              Plan::Point       sum;
              unsigned int      count = 0;
              for (const unsigned int face : faces_at[node])
                for (const unsigned int other : faces[face])
                  if (other != node)
                    {
                      sum += points[other];
                      ++count;
                    }
              points[node]      = sum / double(count);
              const double mean = worst_at(node);
              if (!(mean > before))
                points[node] = place;
              const double longest = 0.5 * longest_edge[node];
              const double best =
                -move_to_least(points[node], longest, 1e-3 * longest, -std::max(before, mean), [&] { return -worst_at(node); });
              moved = moved || best > before + 1e-4;
            }
        }
    }
  } // namespace

  void smooth(Plan &plan)
  {
    std::vector<bool> fixed(plan.points.size(), false);
    fix_outline(plan.faces, fixed);
    for (const Plan::Pin &pin : plan.pins)
      fix(pin, plan, fixed);
    smooth(plan.faces, fixed, plan.points);
    std::set<std::vector<unsigned int>> done; // pins of both sides may be above the same faces
    std::vector<TurningPart>            parts;
    for (const Plan::Pin &pin : plan.pins)
      if (pin.is_round && done.insert(pin.faces).second)
        parts.push_back(turning_part(pin, plan, plan.points));
    untangle(plan.faces, fixed, parts, plan.points);
  }

  std::vector<Plan::Point> points_on_side(const Plan &plan, const Plan::Side side)
  {
    // Pins of this side and the boundary of the annulus have given displacements
    std::vector<Plan::Point> displacements(plan.points.size());
    std::vector<bool>        outline(plan.points.size(), false), given(plan.points.size(), false);
    bool                     displaced = false;
    fix_outline(plan.faces, outline);
    given = outline;
    for (const Plan::Pin &pin : plan.pins)
      {
        displaced = displaced || pin.displacement != Plan::Point();
        if (pin.side != side)
          continue;
        fix(pin, plan, outline);
        for (const unsigned int node : nodes_of(plan.faces_of(pin)))
          {
            given[node]         = true;
            displacements[node] = pin.displacement;
          }
      }
    if (!displaced)
      return plan.points;

    // The other nodes follow their neighbours
    std::vector<std::vector<unsigned int>> neighbours(plan.points.size());
    for (const Plan::Face &face : plan.faces)
      for (unsigned int v = 0; v < 4; ++v)
        {
          neighbours[face[v]].push_back(face[(v + 1) % 4]);
          neighbours[face[v]].push_back(face[(v + 3) % 4]);
        }
    for (int sweep = 0; sweep < displacement_sweeps; ++sweep)
      for (std::size_t node = 0; node < given.size(); ++node)
        if (!given[node])
          {
            Plan::Point sum;
            for (const unsigned int neighbour : neighbours[node])
              sum += displacements[neighbour];
            displacements[node] = sum / double(neighbours[node].size());
          }

    // In steps, smoothed each time: faces that turned over at once might not be turned back
    std::vector<Plan::Point> points = plan.points;
    for (int step = 0; step < displacement_steps; ++step)
      {
        for (std::size_t node = 0; node < points.size(); ++node)
          points[node] += displacements[node] / displacement_steps;
        smooth(plan.faces, outline, points);
      }

    // A round pin may also roll along its neighbours; a pad has its place
    std::vector<TurningPart> parts;
    for (const Plan::Pin &pin : plan.pins)
      if (pin.side == side && pin.is_round)
        parts.push_back(turning_part(pin, plan, points));
    untangle(plan.faces, outline, parts, points);
    return points;
  }

  std::vector<Plan::Point> points_between(const Plan                     &plan,
                                          const std::vector<Plan::Point> &lower,
                                          const std::vector<Plan::Point> &upper,
                                          const double                    t)
  {
    std::vector<Plan::Point> points(lower.size());
    for (std::size_t node = 0; node < points.size(); ++node)
      points[node] = (1. - t) * lower[node] + t * upper[node];
    if (t > 0. && t < 1. && lower != upper)
      {
        std::vector<bool> boundary(points.size(), false);
        fix_outline(plan.faces, boundary);
        untangle(plan.faces, boundary, {}, points);
      }
    return points;
  }
} // namespace Squeal
