// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/geometry/plan.h>
#include <squeal/geometry/pin_grid.h>
#include <squeal/geometry/plan_smoothing.h>

#include <set>

namespace Squeal
{
  namespace
  {
    /// Surfaces of every extruded mesh, followed by one surface for each curve of the plan.
    enum ExtrudedSurface : unsigned int
    {
      disc_contact,
      pin_contact,
      pin_clamp,
      pin_side,
      first_curve
    };

    /// Points at a height between the faces of the disc: (1 - t) lower + t upper, untangled if faces would invert.
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
          for (const Plan::Edge &edge : boundary_edges(plan.faces))
            boundary[edge[0]] = boundary[edge[1]] = true;
          untangle(plan.faces, boundary, {}, points);
        }
      return points;
    }

    /// A stack of layers of cells over some faces of the plan, with its own nodes.
    class Stack
    {
    public:
      /// Interpolates the points between the lower and the upper end, see points_between(); @p ends are the layer boundaries in [0, 1].
      Stack(const Plan                     &plan,
            const std::vector<Plan::Point> &lower,
            const std::vector<Plan::Point> &upper,
            const std::vector<Plan::Face>  &faces,
            const double                    z_lower,
            const double                    z_upper,
            const std::vector<double>      &ends,
            const unsigned int              volume,
            Mesh                           &mesh)
        : nodes(ends.size(), std::vector<unsigned int>(plan.points.size()))
        , mesh(mesh)
      {
        // Use the given points unchanged at both ends, so that contact faces coincide exactly
        const std::set<unsigned int> used     = nodes_of(faces);
        const unsigned int           n_layers = ends.size() - 1;
        for (unsigned int layer = 0; layer <= n_layers; ++layer)
          {
            const std::vector<Plan::Point> points = points_between(plan, lower, upper, ends[layer]);
            const double                   z      = layer == n_layers ? z_upper : z_lower + (z_upper - z_lower) * ends[layer];
            for (const unsigned int node : used)
              {
                nodes[layer][node] = mesh.points.size();
                mesh.points.emplace_back(points[node][0], points[node][1], z);
              }
          }

        // Hexahedra: the faces of the plan are counter-clockwise as seen from above
        for (unsigned int layer = 0; layer < n_layers; ++layer)
          for (const auto &[a, b, c, d] : faces)
            {
              const auto &below = nodes[layer], &above = nodes[layer + 1];
              mesh.cells.push_back(
                {Shape::hexahedron, {below[a], below[b], below[c], below[d], above[a], above[b], above[c], above[d]}, volume});
            }
      }

      void name_end(const bool is_upper, const std::vector<Plan::Face> &faces, const unsigned int surface)
      {
        const auto &end = is_upper ? nodes.back() : nodes.front();
        for (const auto &[a, b, c, d] : faces)
          mesh.faces.push_back({Shape::quadrilateral, {end[a], end[b], end[c], end[d]}, surface});
      }

      void name_side(const std::vector<Plan::Edge> &edges, const unsigned int surface)
      {
        for (unsigned int layer = 0; layer + 1 < nodes.size(); ++layer)
          for (const auto &[a, b] : edges)
            mesh.faces.push_back(
              {Shape::quadrilateral, {nodes[layer][a], nodes[layer][b], nodes[layer + 1][b], nodes[layer + 1][a]}, surface});
      }

    private:
      std::vector<std::vector<unsigned int>> nodes; ///< node numbers by layer and node of the plan
      Mesh                                  &mesh;
    };
  } // namespace

  Mesh extrude(const Plan &plan, const GeometryParameters &parameters)
  {
    Mesh mesh;
    mesh.surface_names = {PhysicalNames::disc_contact, PhysicalNames::pin_contact, PhysicalNames::pin_clamp, PhysicalNames::pin_side};
    for (const Plan::Curve &curve : plan.curves)
      mesh.surface_names.push_back(curve.name);
    mesh.volume_names = {PhysicalNames::disc};
    for (const Plan::Pin &pin : plan.pins)
      mesh.volume_names.push_back(pin.name);

    const double                   z_face = parameters.disc_thickness / 2., z_end = z_face + parameters.pin_height;
    const std::vector<Plan::Point> top = points_on_side(plan, Plan::Side::top), bottom = points_on_side(plan, Plan::Side::bottom);
    Stack disc(plan, bottom, top, plan.faces, -z_face, z_face, graded_intervals(parameters.disc_layers, 1.), 0, mesh);
    for (const Plan::Pin &pin : plan.pins)
      disc.name_end(pin.side == Plan::Side::top, plan.faces_of(pin), disc_contact);
    for (std::size_t c = 0; c < plan.curves.size(); ++c)
      disc.name_side(plan.curves[c].edges, first_curve + c);

    // Pins: thinner layers towards the clamped end
    const std::vector<double> upwards = graded_intervals(parameters.pin_layers, parameters.pin_grading);
    std::vector<double>       downwards;
    for (auto end = upwards.rbegin(); end != upwards.rend(); ++end)
      downwards.push_back(1. - *end);
    for (std::size_t p = 0; p < plan.pins.size(); ++p)
      {
        const bool                    is_top = plan.pins[p].side == Plan::Side::top;
        const std::vector<Plan::Face> faces  = plan.faces_of(plan.pins[p]);
        const auto                   &points = is_top ? top : bottom;
        Stack pin(plan, points, points, faces, is_top ? z_face : -z_end, is_top ? z_end : -z_face, is_top ? upwards : downwards, p + 1,
                  mesh);
        pin.name_end(!is_top, faces, pin_contact);
        pin.name_end(is_top, faces, pin_clamp);
        pin.name_side(boundary_edges(faces), pin_side);
      }
    find_bodies(mesh);
    return mesh;
  }
} // namespace Squeal
