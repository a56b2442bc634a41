// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/geometry/plan_smoothing.h>
#include <squeal/geometry/polygon.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace Squeal
{
  namespace
  {
    /// Moves a point to reduce a function below its initial value @p least, by steps in eight directions with successively halved lengths.
    /// Returns the smallest value found.
    template <typename Function>
    double move_to_least(Plan::Point &point, const double longest_step, const double shortest_step, double least, const Function &function)
    {
      Plan::Point best = point;
      for (double step = longest_step; step > shortest_step; step /= 2.)
        {
          const Plan::Point from = best;
          for (int direction = 0; direction < 8; ++direction)
            {
              const double angle = direction * std::acos(-1.) / 4.;
              point              = from + step * Plan::Point(std::cos(angle), std::sin(angle));
              if (const double value = function(); value < least)
                {
                  least = value;
                  best  = point;
                }
            }
        }
      point = best;
      return least;
    }

    // Sine of a corner angle below which a face is bad: well above the limit of check_mesh(), and below the values in regular plans
    constexpr double least_sine = 0.1;

    // Number of rows of faces around bad faces whose nodes also move
    constexpr int n_rings = 6;

    constexpr int    max_untangling_sweeps = 100; ///< ε has its smallest value during a third of the sweeps
    constexpr double epsilon_decrease      = 0.9;
    constexpr double smallest_epsilon      = 1e-3;
    constexpr double converged             = 1e-3; ///< relative decrease of a node's energy in a sweep
    constexpr double first_turn            = 0.3;  ///< first step of the rotation of a part [rad]
    constexpr double smallest_step         = 1e-3; ///< smallest step of a node [mean edge] or of a part [rad]

    bool is_bad(const Plan::Face &face, const std::vector<Plan::Point> &points)
    {
      for (unsigned int v = 0; v < 4; ++v)
        if (const Corner c(face, v, points); !(c.cross >= least_sine * std::sqrt(c.a.norm_square() * c.b.norm_square())))
          return true;
      return false;
    }

    /// Bad faces and the faces around them, with the nodes and parts that may move.
    class Region
    {
    public:
      Region(const std::vector<Plan::Face>  &faces,
             const std::vector<bool>        &fixed,
             const std::vector<TurningPart> &all_parts,
             std::vector<Plan::Point>       &points)
        : points(points)
        , faces_at(points.size())
      {
        std::vector<bool> inside(points.size(), false);
        for (const Plan::Face &face : faces)
          if (is_bad(face, points))
            for (const unsigned int node : face)
              inside[node] = true;
        const auto touches = [&](const Plan::Face &face, const std::vector<bool> &nodes) {
          return std::any_of(face.begin(), face.end(), [&](const unsigned int node) { return nodes[node]; });
        };
        for (int ring = 0; ring < n_rings; ++ring)
          {
            const std::vector<bool> before = inside;
            for (const Plan::Face &face : faces)
              if (touches(face, before))
                for (const unsigned int node : face)
                  inside[node] = true;
          }

        double sum = 0.;
        for (const Plan::Face &face : faces)
          if (touches(face, inside))
            {
              for (const unsigned int node : face)
                faces_at[node].push_back(region.size());
              region.push_back(face);
              sum += signed_area(face, points);
            }
        mean_area = region.empty() ? 0. : std::abs(sum) / region.size();

        for (unsigned int node = 0; node < points.size(); ++node)
          if (inside[node] && !fixed[node])
            nodes.push_back(node);
        for (const TurningPart &part : all_parts)
          if (std::any_of(part.nodes.begin(), part.nodes.end(), [&](const unsigned int node) { return inside[node]; }))
            {
              parts.push_back(&part);
              part_faces.push_back(faces_around(part));
            }
      }

      bool is_untangled() const
      {
        return std::none_of(region.begin(), region.end(), [&](const Plan::Face &face) { return is_bad(face, points); });
      }

      /// Moves every node and part once; returns the largest relative decrease of a node's energy.
      double sweep(const double new_epsilon)
      {
        epsilon         = new_epsilon;
        double decrease = 0.;
        for (const unsigned int node : nodes)
          decrease = std::max(decrease, move(node));
        for (std::size_t p = 0; p < parts.size(); ++p)
          turn_to_best(*parts[p], part_faces[p]);
        return decrease;
      }

    private:
      /// Faces whose shape depends on the rotation of a part: they have nodes of the part and other nodes.
      std::vector<unsigned int> faces_around(const TurningPart &part) const
      {
        std::vector<bool> on_part(points.size(), false);
        for (const unsigned int node : part.nodes)
          on_part[node] = true;
        std::vector<unsigned int> result;
        for (unsigned int face = 0; face < region.size(); ++face)
          {
            const auto n = std::count_if(region[face].begin(), region[face].end(), [&](const unsigned int node) { return on_part[node]; });
            if (n > 0 && n < 4)
              result.push_back(face);
          }
        return result;
      }

      double energy(const std::vector<unsigned int> &some) const
      {
        double sum = 0.;
        for (const unsigned int face : some)
          for (unsigned int v = 0; v < 4; ++v)
            {
              const Corner c(region[face], v, points);
              const double D = c.cross / mean_area;
              sum += 2. * ((c.a.norm_square() + c.b.norm_square()) / mean_area) / (D + std::sqrt(epsilon * epsilon + D * D));
            }
        return sum;
      }

      double move(const unsigned int node)
      {
        const double before = energy(faces_at[node]), edge = std::sqrt(mean_area);
        const double least = move_to_least(points[node], edge / 2., smallest_step * edge, before, [&] { return energy(faces_at[node]); });
        return (before - least) / before;
      }

      void turn(const TurningPart &part, const double angle)
      {
        const double c = std::cos(angle), s = std::sin(angle);
        for (const unsigned int node : part.nodes)
          {
            const dealii::Tensor<1, 2> r = points[node] - part.centre;
            points[node]                 = {part.centre[0] + c * r[0] - s * r[1], part.centre[1] + s * r[0] + c * r[1]};
          }
      }

      void turn_to_best(const TurningPart &part, const std::vector<unsigned int> &around)
      {
        double least = energy(around);
        for (double step = first_turn; step > smallest_step; step /= 2.)
          for (const double angle : {step, -step})
            {
              turn(part, angle);
              if (const double energy_there = energy(around); energy_there < least)
                least = energy_there;
              else
                turn(part, -angle);
            }
      }

      std::vector<Plan::Point>              &points;
      std::vector<Plan::Face>                region;
      std::vector<std::vector<unsigned int>> faces_at; ///< indices of the faces at each node
      std::vector<unsigned int>              nodes;    ///< nodes that may move
      std::vector<const TurningPart *>       parts;
      std::vector<std::vector<unsigned int>> part_faces;
      double                                 mean_area = 0., epsilon = 1.;
    };
  } // namespace

  void untangle(const std::vector<Plan::Face>  &faces,
                const std::vector<bool>        &fixed,
                const std::vector<TurningPart> &parts,
                std::vector<Plan::Point>       &points)
  {
    if (std::none_of(faces.begin(), faces.end(), [&](const Plan::Face &face) { return is_bad(face, points); }))
      return;
    const std::vector<Plan::Point> before = points;
    Region                         region(faces, fixed, parts, points);
    double                         epsilon = 1.;
    for (int sweep = 0; sweep < max_untangling_sweeps; ++sweep)
      {
        if (region.sweep(epsilon) < converged && region.is_untangled())
          return;
        epsilon = std::max(smallest_epsilon, epsilon_decrease * epsilon);
      }
    if (!region.is_untangled())
      points = before;
  }

  namespace
  {
    // Nodes do not move if all adjacent faces have at least this quality (a rectangle of sides 1 : 3, or an angle of 37°)
    constexpr double good_shape = 0.6;
    constexpr int    max_sweeps = 100;

    // Enough sweeps to spread the displacement of a pin to the nodes around it; full convergence is not required
    constexpr int displacement_sweeps = 200;
    constexpr int displacement_steps  = 5;

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

    /// Fixes the nodes on the outline of a set of faces.
    void fix_outline(const std::vector<Plan::Face> &faces, std::vector<bool> &fixed)
    {
      for (const Plan::Edge &edge : boundary_edges(faces))
        fixed[edge[0]] = fixed[edge[1]] = true;
    }

    /// Fixes the nodes on the outline of a pin and the nodes of its rings.
    void fix(const Plan::Pin &pin, const Plan &plan, std::vector<bool> &fixed)
    {
      fix_outline(plan.faces_of(pin), fixed);
      for (const unsigned int node : pin.ring_nodes)
        fixed[node] = true;
    }

    /// A pin as a rotating part, with the current positions of its nodes.
    TurningPart turning_part(const Plan::Pin &pin, const Plan &plan, const std::vector<Plan::Point> &points)
    {
      const std::vector<Plan::Face> faces = plan.faces_of(pin);
      const std::set<unsigned int>  nodes = nodes_of(faces), outline = nodes_of(boundary_edges(faces));
      return {{nodes.begin(), nodes.end()}, mean_point({outline.begin(), outline.end()}, points)};
    }

    void smooth(const std::vector<Plan::Face> &faces, const std::vector<bool> &fixed, std::vector<Plan::Point> &points)
    {
      std::vector<std::vector<unsigned int>> faces_at(points.size());
      for (unsigned int face = 0; face < faces.size(); ++face)
        for (const unsigned int node : faces[face])
          if (!fixed[node])
            faces_at[node].push_back(face);

      // Limit steps by the initial edge lengths, so that tangled nodes do not move far away
      std::vector<double> longest_edge(points.size(), 0.);
      for (const Plan::Face &face : faces)
        for (unsigned int v = 0; v < 4; ++v)
          {
            const double length = points[face[v]].distance(points[face[(v + 1) % 4]]);
            for (const unsigned int node : {face[v], face[(v + 1) % 4]})
              longest_edge[node] = std::max(longest_edge[node], length);
          }

      // In each sweep and for each node, try the mean of the neighbours, then steps of decreasing length
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
    std::set<std::vector<unsigned int>> done; // faces of rotating pins: pins of both sides may share the same faces
    std::vector<TurningPart>            parts;
    for (const Plan::Pin &pin : plan.pins)
      if (pin.is_round && done.insert(pin.faces).second)
        parts.push_back(turning_part(pin, plan, plan.points));
    untangle(plan.faces, fixed, parts, plan.points);
  }

  std::vector<Plan::Point> points_on_side(const Plan &plan, const Plan::Side side)
  {
    // Prescribe displacements of the pins of this side and of the boundary of the annulus
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

    // Compute displacements of the other nodes as means of their neighbours
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

    // Move in several steps and smooth after each: faces inverted by one large step might not be repairable
    std::vector<Plan::Point> points = plan.points;
    for (int step = 0; step < displacement_steps; ++step)
      {
        for (std::size_t node = 0; node < points.size(); ++node)
          points[node] += displacements[node] / displacement_steps;
        smooth(plan.faces, outline, points);
      }

    // Round pins may also rotate about their centres
    std::vector<TurningPart> parts;
    for (const Plan::Pin &pin : plan.pins)
      if (pin.side == side && pin.is_round)
        parts.push_back(turning_part(pin, plan, points));
    untangle(plan.faces, outline, parts, points);
    return points;
  }
} // namespace Squeal
