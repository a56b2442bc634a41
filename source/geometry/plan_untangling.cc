#include <squeal/geometry/plan_untangling.h>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    // Sine of a corner's angle below which a face is bad: far from what check_mesh() refuses, and below what plans have by design
    constexpr double least_sine = 0.1;

    // Rows of faces around the bad ones that move along; a pin and its neighbour are fewer apart.
    constexpr int n_rings = 6;

    constexpr int    max_untangling_sweeps = 100; ///< ε has been least for a third of them
    constexpr double epsilon_decrease      = 0.9;
    constexpr double smallest_epsilon      = 1e-3;
    constexpr double converged             = 1e-3; ///< relative decrease of a node's energy in a sweep
    constexpr double first_turn            = 0.3;  ///< [rad]
    constexpr double smallest_step         = 1e-3; ///< of a node [mean edge], of a part [rad]

    bool is_bad(const Plan::Face &face, const std::vector<Plan::Point> &points)
    {
      for (unsigned int v = 0; v < 4; ++v)
        if (const Corner c(face, v, points); !(c.cross >= least_sine * std::sqrt(c.a.norm_square() * c.b.norm_square())))
          return true;
      return false;
    }

    double area(const Plan::Face &face, const std::vector<Plan::Point> &points)
    {
      return (Corner(face, 0, points).cross + Corner(face, 2, points).cross) / 2.;
    }

    /// The faces around bad ones, with what of them may move.
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
              sum += area(face, points);
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

      /// Moves every node and part once; returns the greatest relative decrease of a node's energy.
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
      /// Faces whose shape depends on the angle of a part: those with nodes on and off it.
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
      std::vector<std::vector<unsigned int>> faces_at; ///< by node
      std::vector<unsigned int>              nodes;    ///< those that may move
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
} // namespace Squeal
