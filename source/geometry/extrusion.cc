#include <squeal/geometry/extrusion.h>
#include <squeal/geometry/plan_smoothing.h>

namespace Squeal
{
  namespace
  {
    /// A stack of layers of hexahedra over some faces of the plan, with nodes of its own.
    class Stack
    {
    public:
      /**
       * @p heights ascend; the points go from those of the lower end to
       * those of the upper end, see points_between().
       */
      Stack(const Plan                      &plan,
            const std::vector<Plan::Point>  &lower,
            const std::vector<Plan::Point>  &upper,
            const std::vector<unsigned int> &faces,
            const std::vector<double>       &heights,
            const unsigned int               volume,
            HexMesh                         &mesh)
        : plan(plan)
        , faces(faces)
        , n_layers(heights.size() - 1)
        , nodes(heights.size(), std::vector<unsigned int>(plan.points.size()))
        , mesh(mesh)
      {
        // Nodes, layer by layer, in the order of the plan
        std::vector<bool> used(plan.points.size(), false);
        for (const unsigned int face : faces)
          for (const unsigned int node : plan.faces[face])
            used[node] = true;
        for (unsigned int layer = 0; layer <= n_layers; ++layer)
          {
            const std::vector<Plan::Point> points = points_between(plan, lower, upper, double(layer) / n_layers);
            for (std::size_t node = 0; node < used.size(); ++node)
              if (used[node])
                {
                  nodes[layer][node] = mesh.points.size();
                  mesh.points.push_back({{points[node][0], points[node][1], heights[layer]}});
                }
          }

        // Hexahedra; the faces of the plan are counter-clockwise seen from above
        for (unsigned int layer = 0; layer < n_layers; ++layer)
          for (const unsigned int face : faces)
            {
              HexMesh::Hexahedron hexahedron;
              for (unsigned int v = 0; v < 4; ++v)
                {
                  hexahedron.nodes[v]     = nodes[layer][plan.faces[face][v]];
                  hexahedron.nodes[v + 4] = nodes[layer + 1][plan.faces[face][v]];
                }
              hexahedron.volume = volume;
              mesh.hexahedra.push_back(hexahedron);
            }
      }

      void name_bottom(const std::vector<unsigned int> &part, const unsigned int surface)
      {
        name_layer(0, part, surface);
      }

      void name_top(const std::vector<unsigned int> &part, const unsigned int surface)
      {
        name_layer(n_layers, part, surface);
      }

      void name_side(const std::vector<Plan::Edge> &edges, const unsigned int surface)
      {
        for (unsigned int layer = 0; layer < n_layers; ++layer)
          for (const Plan::Edge &edge : edges)
            mesh.quadrilaterals.push_back(
              {{{nodes[layer][edge[0]], nodes[layer][edge[1]], nodes[layer + 1][edge[1]], nodes[layer + 1][edge[0]]}}, surface});
      }

    private:
      void name_layer(const unsigned int layer, const std::vector<unsigned int> &part, const unsigned int surface)
      {
        for (const unsigned int face : part)
          {
            HexMesh::Quadrilateral quadrilateral;
            for (unsigned int v = 0; v < 4; ++v)
              quadrilateral.nodes[v] = nodes[layer][plan.faces[face][v]];
            quadrilateral.surface = surface;
            mesh.quadrilaterals.push_back(quadrilateral);
          }
      }

      const Plan                            &plan;
      const std::vector<unsigned int>       &faces;
      const unsigned int                     n_layers;
      std::vector<std::vector<unsigned int>> nodes; ///< by layer and node of the plan
      HexMesh                               &mesh;
    };

    /// n_layers + 1 heights; both ends exactly as given, so that contact faces coincide to the last bit.
    std::vector<double> heights(const double first, const double last, const unsigned int n_layers)
    {
      std::vector<double> z(n_layers + 1);
      for (unsigned int i = 0; i <= n_layers; ++i)
        z[i] = first + (last - first) * i / n_layers;
      z.back() = last;
      return z;
    }
  } // namespace

  HexMesh extrude(const Plan &plan, const GeometryParameters &parameters)
  {
    HexMesh mesh;

    // Names
    enum : unsigned int
    {
      disc_contact,
      pin_contact,
      pin_clamp,
      pin_side,
      first_curve
    };
    mesh.surface_names = {PhysicalNames::disc_contact, PhysicalNames::pin_contact, PhysicalNames::pin_clamp, PhysicalNames::pin_side};
    for (const Plan::Curve &curve : plan.curves)
      mesh.surface_names.push_back(curve.name);
    mesh.volume_names = {PhysicalNames::disc};
    for (const Plan::Pin &pin : plan.pins)
      mesh.volume_names.push_back(pin.name);

    // Disc
    const double              z_top = parameters.disc_thickness / 2.;
    std::vector<unsigned int> all_faces(plan.faces.size());
    for (std::size_t i = 0; i < all_faces.size(); ++i)
      all_faces[i] = i;
    const std::vector<Plan::Point> top    = points_on_side(plan, Plan::Side::top);
    const std::vector<Plan::Point> bottom = points_on_side(plan, Plan::Side::bottom);
    Stack                          disc(plan, bottom, top, all_faces, heights(-z_top, z_top, parameters.disc_layers), 0, mesh);
    for (const Plan::Pin &pin : plan.pins)
      if (pin.side == Plan::Side::top)
        disc.name_top(pin.faces, disc_contact);
      else
        disc.name_bottom(pin.faces, disc_contact);
    for (std::size_t c = 0; c < plan.curves.size(); ++c)
      disc.name_side(plan.curves[c].edges, first_curve + c);

    // Pins
    for (std::size_t p = 0; p < plan.pins.size(); ++p)
      {
        const Plan::Pin &pin   = plan.pins[p];
        const double     z_end = z_top + parameters.pin_height;

        std::vector<Plan::Face> faces;
        for (const unsigned int face : pin.faces)
          faces.push_back(plan.faces[face]);

        if (pin.side == Plan::Side::top)
          {
            Stack stack(plan, top, top, pin.faces, heights(z_top, z_end, parameters.pin_layers), p + 1, mesh);
            stack.name_bottom(pin.faces, pin_contact);
            stack.name_top(pin.faces, pin_clamp);
            stack.name_side(boundary_edges(faces), pin_side);
          }
        else
          {
            Stack stack(plan, bottom, bottom, pin.faces, heights(-z_end, -z_top, parameters.pin_layers), p + 1, mesh);
            stack.name_top(pin.faces, pin_contact);
            stack.name_bottom(pin.faces, pin_clamp);
            stack.name_side(boundary_edges(faces), pin_side);
          }
      }
    return mesh;
  }
} // namespace Squeal
