#include <squeal/base/exceptions.h>
#include <squeal/geometry/hex_mesh.h>
#include <squeal/geometry/plan.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

namespace Squeal
{
  namespace
  {
    constexpr unsigned int no_node = static_cast<unsigned int>(-1);

    bool starts_with(const std::string &name, const std::string &prefix)
    {
      return name.rfind(prefix, 0) == 0;
    }

    bool is_pin(const std::string &name)
    {
      return starts_with(name, "pin_top") || starts_with(name, "pin_bottom");
    }

    Plan::Side side_of(const std::string &name)
    {
      return starts_with(name, "pin_top") ? Plan::Side::top : Plan::Side::bottom;
    }

    Plan::Edge sorted(const Plan::Edge &edge)
    {
      return {{std::min(edge[0], edge[1]), std::max(edge[0], edge[1])}};
    }

    /// Twice the signed area, positive for a counter-clockwise polygon.
    template <typename Nodes>
    double twice_area(const Nodes &nodes, const std::vector<Plan::Point> &points)
    {
      double sum = 0.;
      for (std::size_t i = 0; i < nodes.size(); ++i)
        {
          const Plan::Point &a = points[nodes[i]];
          const Plan::Point &b = points[nodes[(i + 1) % nodes.size()]];
          sum += a[0] * b[1] - a[1] * b[0];
        }
      return sum;
    }

    Plan::Point mean(const std::vector<unsigned int> &nodes, const std::vector<Plan::Point> &points)
    {
      Plan::Point sum = {{0., 0.}};
      for (const unsigned int node : nodes)
        for (unsigned int d = 0; d < 2; ++d)
          sum[d] += points[node][d];
      return {{sum[0] / nodes.size(), sum[1] / nodes.size()}};
    }

    void check_joined(const Plan &plan, const std::string &where)
    {
      double smallest_edge = 1e300;
      for (const Plan::Face &face : plan.faces)
        for (unsigned int v = 0; v < 4; ++v)
          {
            const Plan::Point &a = plan.points[face[v]];
            const Plan::Point &b = plan.points[face[(v + 1) % 4]];
            smallest_edge        = std::min(smallest_edge, std::hypot(a[0] - b[0], a[1] - b[1]));
          }

      // Sorted by x, coincident nodes are close to each other in the list.
      const double              tolerance = 1e-3 * smallest_edge;
      std::vector<unsigned int> order(plan.points.size());
      std::iota(order.begin(), order.end(), 0);
      std::sort(order.begin(), order.end(), [&](unsigned int a, unsigned int b) { return plan.points[a] < plan.points[b]; });
      for (std::size_t i = 0; i < order.size(); ++i)
        for (std::size_t j = i + 1; j < order.size(); ++j)
          {
            const Plan::Point &a = plan.points[order[i]];
            const Plan::Point &b = plan.points[order[j]];
            if (b[0] - a[0] > tolerance)
              break;
            if (std::abs(b[1] - a[1]) <= tolerance)
              throw MeshError("Two nodes of the plan coincide at (" + std::to_string(a[0]) + ", " + std::to_string(a[1]) +
                                ") m: surfaces lie side by side without being joined",
                              where, "let neighbouring surfaces use the same curves, or join them with Coherence");
          }
    }

    void check_pins_apart(const Plan &plan, const std::string &where)
    {
      for (const Plan::Side side : {Plan::Side::top, Plan::Side::bottom})
        {
          std::vector<const Plan::Pin *> pin_at_node(plan.points.size(), nullptr);
          for (const Plan::Pin &pin : plan.pins)
            if (pin.side == side)
              for (const unsigned int face : pin.faces)
                for (const unsigned int node : plan.faces[face])
                  {
                    if (pin_at_node[node] != nullptr && pin_at_node[node] != &pin)
                      throw MeshError("'" + pin_at_node[node]->name + "' and '" + pin.name +
                                        "' touch each other: a node of the disc would be in contact with both",
                                      where, "leave at least one element between pins of the same side");
                    pin_at_node[node] = &pin;
                  }
        }
    }
  } // namespace

  std::vector<Plan::Edge> boundary_edges(const std::vector<Plan::Face> &faces)
  {
    std::map<Plan::Edge, unsigned int> count;
    for (const Plan::Face &face : faces)
      for (unsigned int v = 0; v < 4; ++v)
        ++count[sorted({{face[v], face[(v + 1) % 4]}})];

    std::vector<Plan::Edge> boundary;
    for (const Plan::Face &face : faces)
      for (unsigned int v = 0; v < 4; ++v)
        if (count[sorted({{face[v], face[(v + 1) % 4]}})] == 1)
          boundary.push_back({{face[v], face[(v + 1) % 4]}});
    return boundary;
  }

  std::vector<Plan::Face> fill_with_o_grid(const std::vector<unsigned int> &loop, std::vector<Plan::Point> &points)
  {
    const unsigned int k = loop.size() / 6;

    const auto add_point = [&](const Plan::Point &point) -> unsigned int {
      points.push_back(point);
      return points.size() - 1;
    };
    const auto at = [&](const unsigned int i) { return loop[i % loop.size()]; };

    // Centre and spokes
    const Plan::Point                        centre      = mean(loop, points);
    const unsigned int                       centre_node = add_point(centre);
    std::array<std::vector<unsigned int>, 3> spokes;
    for (unsigned int s = 0; s < 3; ++s)
      {
        const unsigned int end = at(2 * k * s);
        spokes[s].push_back(centre_node);
        for (unsigned int i = 1; i < k; ++i)
          {
            const double t = double(i) / k;
            spokes[s].push_back(add_point({{(1. - t) * centre[0] + t * points[end][0], (1. - t) * centre[1] + t * points[end][1]}}));
          }
        spokes[s].push_back(end);
      }

    // Blocks: i runs along one spoke, j along the next, the far sides are on the loop
    std::vector<Plan::Face> faces;
    for (unsigned int b = 0; b < 3; ++b)
      {
        std::vector<std::vector<unsigned int>> node(k + 1, std::vector<unsigned int>(k + 1, no_node));
        for (unsigned int i = 0; i <= k; ++i)
          {
            node[i][0] = spokes[b][i];
            node[0][i] = spokes[(b + 1) % 3][i];
            node[k][i] = at(2 * k * b + i);
            node[i][k] = at(2 * k * (b + 1) - i);
          }

        for (unsigned int i = 1; i < k; ++i)
          for (unsigned int j = 1; j < k; ++j)
            {
              // Transfinite interpolation between the four sides
              const double s = double(i) / k, t = double(j) / k;
              Plan::Point  point;
              for (unsigned int d = 0; d < 2; ++d)
                point[d] = (1. - t) * points[node[i][0]][d] + t * points[node[i][k]][d] + (1. - s) * points[node[0][j]][d] +
                           s * points[node[k][j]][d] - (1. - s) * (1. - t) * points[node[0][0]][d] - s * (1. - t) * points[node[k][0]][d] -
                           (1. - s) * t * points[node[0][k]][d] - s * t * points[node[k][k]][d];
              node[i][j] = add_point(point);
            }

        for (unsigned int i = 0; i < k; ++i)
          for (unsigned int j = 0; j < k; ++j)
            faces.push_back({{node[i][j], node[i + 1][j], node[i + 1][j + 1], node[i][j + 1]}});
      }
    return faces;
  }

  namespace
  {
    /// Puts the edges of a closed curve one behind the other, counter-clockwise.
    std::vector<unsigned int> closed_loop(const std::vector<Plan::Edge>  &edges,
                                          const std::vector<Plan::Point> &points,
                                          const std::string              &name,
                                          const std::string              &where)
    {
      std::map<unsigned int, std::vector<unsigned int>> neighbours;
      for (const Plan::Edge &edge : edges)
        {
          neighbours[edge[0]].push_back(edge[1]);
          neighbours[edge[1]].push_back(edge[0]);
        }

      std::vector<unsigned int> loop = {neighbours.begin()->first};
      unsigned int              last = no_node;
      do
        {
          const unsigned int               here = loop.back();
          const std::vector<unsigned int> &next = neighbours.at(here);
          if (next.size() != 2)
            break;
          loop.push_back(next[0] == last ? next[1] : next[0]);
          last = here;
        }
      while (loop.back() != loop.front());

      if (loop.size() != edges.size() + 1 || loop.back() != loop.front())
        throw MeshError("Physical curve '" + name + "' is not one closed curve", where,
                        "give the curves around exactly one hole of the plan this name");
      loop.pop_back();

      if (loop.size() % 6 != 0)
        throw MeshError("Physical curve '" + name + "' has " + std::to_string(loop.size()) +
                          " nodes; a pin is filled by three blocks of equal size, which needs a multiple of 6",
                        where, "make it of three arcs with 'Transfinite Curve' of the same number of nodes");
      if (twice_area(loop, points) < 0.)
        std::reverse(loop.begin(), loop.end());

      // The first spoke points away from the axis of the disc.
      const Plan::Point centre = mean(loop, points);
      const double      radius = std::hypot(centre[0], centre[1]);
      if (radius > 0.)
        {
          const auto outward = [&](const unsigned int node) {
            return (points[node][0] * centre[0] + points[node][1] * centre[1]) / radius;
          };
          std::rotate(loop.begin(),
                      std::max_element(loop.begin(), loop.end(), [&](unsigned int a, unsigned int b) { return outward(a) < outward(b); }),
                      loop.end());
        }
      return loop;
    }
  } // namespace

  Plan make_plan(const GmshMesh &mesh, const std::string &where)
  {
    Plan plan;

    // Nodes that are used by a surface, and no others
    std::vector<unsigned int> plan_node(mesh.points.size(), no_node);
    const auto                node_index = [&](const unsigned int node) {
      if (plan_node[node] == no_node)
        {
          const std::array<double, 3> &point = mesh.points[node];
          if (std::abs(point[2]) > 1e-9 * (std::abs(point[0]) + std::abs(point[1])))
            throw MeshError("The plan has a node at z = " + std::to_string(point[2]) + " m", where,
                                           "draw the plan in z = 0; a solid needs physical volumes");
          plan_node[node] = plan.points.size();
          plan.points.push_back({{point[0], point[1]}});
        }
      return plan_node[node];
    };

    // Surfaces: disc and pins
    bool                               disc_found = false;
    std::map<Plan::Face, unsigned int> face_index; // by ascending nodes
    for (const GmshMesh::Group &group : mesh.groups)
      if (group.dimension == 2)
        {
          const bool is_disc = group.name == PhysicalNames::disc;
          if (!is_disc && !is_pin(group.name))
            throw MeshError("The plan has a physical surface '" + group.name + "'", where,
                            "known names of surfaces in a plan: disc, pin_top..., pin_bottom...");
          disc_found = disc_found || is_disc;

          std::vector<unsigned int> faces;
          for (const GmshMesh::Block &block : group.blocks)
            {
              if (block.type != "Quadrilateral 4")
                throw MeshError("Surface '" + group.name + "' has " + std::to_string(block.tags.size()) + " elements of type '" +
                                  block.type + "'",
                                where, "only four-node quadrilaterals can be extruded to hexahedra");
              for (std::size_t i = 0; i < block.tags.size(); ++i)
                {
                  Plan::Face face;
                  for (unsigned int v = 0; v < 4; ++v)
                    face[v] = node_index(block.nodes[4 * i + v]);
                  if (twice_area(face, plan.points) < 0.)
                    std::reverse(face.begin(), face.end());
                  Plan::Face key = face;
                  std::sort(key.begin(), key.end());
                  const auto [entry, is_new] = face_index.emplace(key, plan.faces.size());
                  if (is_new)
                    plan.faces.push_back(face);
                  faces.push_back(entry->second);
                }
            }
          std::sort(faces.begin(), faces.end());
          if (!is_disc)
            plan.pins.push_back({group.name, side_of(group.name), faces, {{0., 0.}}, false});
        }
    if (!disc_found)
      throw MeshError("The plan has no physical surface 'disc'", where, "give the surface of the disc that is not under a pin this name");

    // Curves, as edges between nodes of the surfaces
    std::vector<Plan::Curve> pin_curves;
    for (const GmshMesh::Group &group : mesh.groups)
      if (group.dimension == 1)
        {
          Plan::Curve curve{group.name, {}};
          for (const GmshMesh::Block &block : group.blocks)
            for (std::size_t i = 0; i < block.tags.size(); ++i)
              {
                Plan::Edge edge;
                for (unsigned int v = 0; v < 2; ++v)
                  edge[v] = plan_node[block.nodes[block.nodes_per_element * i + v]];
                if (edge[0] == no_node || edge[1] == no_node)
                  throw MeshError("Physical curve '" + group.name + "' is not on the surface 'disc'", where,
                                  "name only curves that bound the disc or a hole in it");
                curve.edges.push_back(edge);
              }
          if (group.name.empty())
            throw MeshError("The plan has a physical curve without a name", where, "write Physical Curve(\"name\") = {...}");
          for (const char *reserved :
               {PhysicalNames::disc_contact, PhysicalNames::pin_contact, PhysicalNames::pin_clamp, PhysicalNames::pin_side})
            if (group.name == reserved)
              throw MeshError("The plan has a physical curve '" + group.name + "'", where,
                              "choose another name; the extrusion gives this one to faces of its own");
          (is_pin(group.name) ? pin_curves : plan.curves).push_back(curve);
        }

    // Points: centres of pins
    std::map<std::string, Plan::Point> centres;
    for (const GmshMesh::Group &group : mesh.groups)
      if (group.dimension == 0)
        {
          if (group.blocks.size() != 1 || group.blocks[0].tags.size() != 1)
            throw MeshError("Physical point '" + group.name + "' is not one point", where,
                            "name one point, the centre of the pin of this name");
          const std::array<double, 3> &point = mesh.points[group.blocks[0].nodes[0]];
          centres[group.name]                = {{point[0], point[1]}};
        }

    // Pins around holes: a hole is filled once, for one or two pins
    std::set<Plan::Edge> outline;
    for (const Plan::Edge &edge : boundary_edges(plan.faces))
      outline.insert(sorted(edge));
    std::map<std::set<Plan::Edge>, std::vector<unsigned int>> filled;
    for (const Plan::Curve &curve : pin_curves)
      {
        std::set<Plan::Edge> edges;
        for (const Plan::Edge &edge : curve.edges)
          {
            edges.insert(sorted(edge));
            if (outline.count(sorted(edge)) == 0)
              throw MeshError("Physical curve '" + curve.name + "' does not surround a hole of the plan", where,
                              "cut the hole out of the surface 'disc', or name the surface under the pin instead");
          }
        std::vector<unsigned int> &faces = filled[edges];
        if (faces.empty())
          for (const Plan::Face &face : fill_with_o_grid(closed_loop(curve.edges, plan.points, curve.name, where), plan.points))
            {
              faces.push_back(plan.faces.size());
              plan.faces.push_back(face);
            }
        const auto  place        = centres.find(curve.name);
        Plan::Point displacement = {{0., 0.}};
        if (place != centres.end())
          {
            const Plan::Point centre = mean(closed_loop(curve.edges, plan.points, curve.name, where), plan.points);
            displacement             = {{place->second[0] - centre[0], place->second[1] - centre[1]}};
            centres.erase(place);
          }
        plan.pins.push_back({curve.name, side_of(curve.name), faces, displacement, true});
      }

    if (!centres.empty())
      throw MeshError("Physical point '" + centres.begin()->first + "' is not the centre of any pin", where,
                      "give it the name of a physical curve around a pin, or remove its name");

    // Top before bottom, pin_top_2 before pin_top_10
    std::sort(plan.pins.begin(), plan.pins.end(), [](const Plan::Pin &a, const Plan::Pin &b) {
      return std::make_tuple(a.side, a.name.size(), a.name) < std::make_tuple(b.side, b.name.size(), b.name);
    });

    // Whether all of it fits together
    if (plan.pins.empty())
      throw MeshError("The plan has no pin, so there is no contact", where,
                      "add a physical surface or curve 'pin_top_1' or 'pin_bottom_1'");
    for (const Plan::Pin &pin : plan.pins)
      {
        if (pin.faces.empty())
          throw MeshError("'" + pin.name + "' has no faces", where, "check what bears this name");
        for (const Plan::Pin &other : plan.pins)
          if (&other != &pin && other.name == pin.name)
            throw MeshError("'" + pin.name + "' names a surface and a curve", where, "keep one of them");
      }
    check_joined(plan, where);
    check_pins_apart(plan, where);

    outline.clear();
    for (const Plan::Edge &edge : boundary_edges(plan.faces))
      outline.insert(sorted(edge));
    for (const Plan::Curve &curve : plan.curves)
      for (const Plan::Edge &edge : curve.edges)
        if (outline.count(sorted(edge)) == 0)
          throw MeshError("Physical curve '" + curve.name + "' is not on the boundary of the disc", where,
                          "name only curves that become a surface of the extruded disc");
    return plan;
  }
} // namespace Squeal
