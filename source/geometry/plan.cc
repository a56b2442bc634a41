// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/geometry/mesh.h>
#include <squeal/geometry/pin_grid.h>
#include <squeal/geometry/plan.h>
#include <squeal/geometry/polygon.h>

#include <deal.II/base/numbers.h>

#include <boost/algorithm/string/predicate.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

namespace Squeal
{
  namespace
  {
    constexpr unsigned int no_node = static_cast<unsigned int>(-1);

    using boost::starts_with;

    bool is_pin(const std::string &name)
    {
      return starts_with(name, "pin_top") || starts_with(name, "pin_bottom");
    }

    Plan::Edge sorted(const Plan::Edge &edge)
    {
      return {{std::min(edge[0], edge[1]), std::max(edge[0], edge[1])}};
    }

    Plan::Edge edge(const Plan::Face &face, const unsigned int v)
    {
      return {{face[v], face[(v + 1) % 4]}};
    }

    std::set<Plan::Edge> sorted_edges(const std::vector<Plan::Edge> &edges)
    {
      std::set<Plan::Edge> result;
      for (const Plan::Edge &edge : edges)
        result.insert(sorted(edge));
      return result;
    }

    /// Nodes of a closed curve around a pin in order, counter-clockwise.
    std::vector<unsigned int> closed_loop(const Plan::Curve &curve, const std::vector<Plan::Point> &points, const std::string &where)
    {
      std::vector<unsigned int> loop = closed_polygon(curve.edges);
      if (loop.empty())
        throw MeshError("Physical curve '" + curve.name + "' is not one closed curve", where,
                        "assign this name to the curves around exactly one hole of the plan");
      if (loop.size() % 6 != 0)
        throw MeshError("Physical curve '" + curve.name + "' has " + std::to_string(loop.size()) +
                          " nodes; the three equal blocks in a pin require a multiple of 6",
                        where, "draw it with three arcs that have equal numbers of nodes by 'Transfinite Curve'");
      if (signed_area(loop, points) < 0.)
        std::reverse(loop.begin(), loop.end());

      // Begin the loop at its outermost node, so that the first spoke points away from the axis of the disc
      const Plan::Point centre = mean_point(loop, points);
      if (const double radius = std::hypot(centre[0], centre[1]); radius > 0.)
        {
          const auto outward = [&](const unsigned int node) { return (points[node] * centre) / radius; };
          std::rotate(loop.begin(),
                      std::max_element(loop.begin(), loop.end(), [&](unsigned int a, unsigned int b) { return outward(a) < outward(b); }),
                      loop.end());
        }
      return loop;
    }

    // ------------------------------------------------------------------- checks

    void check_joined(const Plan &plan, const double unit, const std::string &where)
    {
      double smallest_edge = 1e300;
      for (const Plan::Face &face : plan.faces)
        for (unsigned int v = 0; v < 4; ++v)
          smallest_edge = std::min(smallest_edge, plan.points[face[v]].distance(plan.points[face[(v + 1) % 4]]));

      // Sort by x, so that coincident nodes are close to each other in the list
      const double             tolerance = 1e-3 * smallest_edge;
      std::vector<Plan::Point> points    = plan.points;
      std::sort(points.begin(), points.end(), [](const Plan::Point &a, const Plan::Point &b) { return a[0] < b[0]; });
      for (auto a = points.begin(); a != points.end(); ++a)
        for (auto b = a + 1; b != points.end() && (*b)[0] - (*a)[0] <= tolerance; ++b)
          if (std::abs((*b)[1] - (*a)[1]) <= tolerance)
            throw MeshError(text("Two nodes of the plan coincide at (", unit * (*a)[0], ", ", unit * (*a)[1],
                                 ") m: neighbouring surfaces are not joined"),
                            where, "use the same curves for neighbouring surfaces, or join them with Coherence");
    }

    void check_pins(const Plan &plan, const std::string &where)
    {
      if (plan.pins.empty())
        throw MeshError("The plan has no pin", where, "add a physical surface or curve 'pin_top_1' or 'pin_bottom_1'");
      std::map<std::pair<Plan::Side, unsigned int>, const Plan::Pin *> pin_at_node;
      for (const Plan::Pin &pin : plan.pins)
        {
          if (pin.faces.empty())
            throw MeshError("'" + pin.name + "' has no faces", where, "assign a meshed surface or a curve around a hole to this name");
          for (const Plan::Pin &other : plan.pins)
            if (&other != &pin && other.name == pin.name)
              throw MeshError("'" + pin.name + "' is the name of a surface and of a curve", where, "remove or change one of the two names");
          for (const unsigned int node : nodes_of(plan.faces_of(pin)))
            if (const auto [entry, is_new] = pin_at_node.emplace(std::make_pair(pin.side, node), &pin); !is_new)
              throw MeshError("'" + entry->second->name + "' and '" + pin.name +
                                "' touch each other: a node of the disc would be in contact with both",
                              where, "leave at least one element between pins of the same side");
        }
    }

    // ------------------------------------------------------------------ reading

    /// Reads the groups of a Gmsh mesh into a plan, highest dimension first.
    class PlanReader
    {
    public:
      PlanReader(const GmshMesh &mesh, const PinRings &rings, const std::string &where)
        : mesh(mesh)
        , rings(rings)
        , where(where)
        , plan_node(mesh.points.size(), no_node)
      {}

      void add_surface(const GmshMesh::Group &group)
      {
        if (group.name != PhysicalNames::disc && !is_pin(group.name))
          throw MeshError("The plan has a physical surface with the unknown name '" + group.name + "'", where,
                          "use the names disc, pin_top..., pin_bottom... for surfaces of a plan");
        std::vector<unsigned int> faces;
        for (const auto &[type, elements] : group.elements)
          {
            if (type != "Quadrilateral 4")
              throw MeshError("Surface '" + group.name + "' has elements of the unsupported type '" + type +
                                "' (number: " + std::to_string(elements.size()) + ")",
                              where, "mesh the plan with four-node quadrilaterals, which are extruded to hexahedra");
            for (const GmshMesh::Element &element : elements)
              faces.push_back(add_face(element));
          }
        std::sort(faces.begin(), faces.end());
        if (group.name == PhysicalNames::disc)
          has_disc = true;
        else
          {
            Plan::Pin pin;
            pin.faces = faces;
            add_pin(group.name, pin);
          }
      }

      void add_curve(const GmshMesh::Group &group)
      {
        Plan::Curve curve{group.name, {}};
        for (const auto &[type, elements] : group.elements)
          for (const GmshMesh::Element &element : elements)
            {
              const Plan::Edge edge = {{plan_node[element.nodes[0]], plan_node[element.nodes[1]]}};
              if (edge[0] == no_node || edge[1] == no_node)
                throw MeshError("Physical curve '" + group.name + "' has a node that is not on a surface of the plan", where,
                                "name only curves that bound the disc or a hole in it");
              curve.edges.push_back(edge);
            }
        for (const char *reserved :
             {PhysicalNames::disc_contact, PhysicalNames::pin_contact, PhysicalNames::pin_clamp, PhysicalNames::pin_side})
          if (group.name == reserved)
            throw MeshError("The name '" + group.name + "' of a physical curve is reserved for faces of the extrusion", where,
                            "choose another name for the curve");
        (is_pin(group.name) ? pin_curves : plan.curves).push_back(curve);
      }

      void add_centre(const GmshMesh::Group &group)
      {
        if (group.elements.size() != 1 || group.elements.begin()->second.size() != 1)
          throw MeshError("Physical point '" + group.name + "' does not consist of exactly one point", where,
                          "assign this name to one point only, the centre of the pin with this name");
        const auto &point   = mesh.points[group.elements.begin()->second[0].nodes[0]];
        centres[group.name] = {point[0], point[1]};
      }

      /// Fills each hole once, for one pin or for a top and a bottom pin.
      void fill_holes()
      {
        const std::set<Plan::Edge>                outline = sorted_edges(boundary_edges(plan.faces));
        std::map<std::set<Plan::Edge>, Plan::Pin> filled;
        for (const Plan::Curve &curve : pin_curves)
          {
            const std::set<Plan::Edge> edges = sorted_edges(curve.edges);
            if (!std::includes(outline.begin(), outline.end(), edges.begin(), edges.end()))
              throw MeshError("Physical curve '" + curve.name + "' does not surround a hole of the plan", where,
                              "cut the hole out of the surface 'disc', or name the surface under the pin instead");
            const std::vector<unsigned int> loop = closed_loop(curve, plan.points, where);
            const auto [hole, is_new]            = filled.emplace(edges, Plan::Pin());
            if (is_new)
              hole->second = fill(loop);
            Plan::Point displacement;
            if (const auto place = centres.find(curve.name); place != centres.end())
              {
                displacement = Plan::Point(place->second - mean_point(loop, plan.points));
                centres.erase(place);
              }
            hole->second.displacement = displacement;
            add_pin(curve.name, hole->second);
          }
        if (!centres.empty())
          throw MeshError("Physical point '" + centres.begin()->first + "' has no physical curve with the same name around a pin", where,
                          "give the point the name of such a curve, or remove its name");
      }

      bool has_disc = false;
      Plan plan;

    private:
      void add_pin(const std::string &name, Plan::Pin pin)
      {
        pin.name = name;
        pin.side = starts_with(name, "pin_top") ? Plan::Side::top : Plan::Side::bottom;
        plan.pins.push_back(pin);
      }

      /// Pin that fills a closed curve with faces and nodes, without name, side and position.
      Plan::Pin fill(const std::vector<unsigned int> &loop)
      {
        const PinGrid grid = fill_pin(loop, rings, plan.points);
        Plan::Pin     pin;
        pin.is_round   = true;
        pin.ring_nodes = grid.ring_nodes;
        for (const Plan::Face &face : grid.faces)
          {
            pin.faces.push_back(plan.faces.size());
            plan.faces.push_back(face);
          }
        return pin;
      }

      /// Index of a node in the plan, which contains only nodes of surfaces.
      unsigned int node_index(const unsigned int node)
      {
        if (plan_node[node] == no_node)
          {
            const auto &[x, y, z] = mesh.points[node];
            if (std::abs(z) > 1e-9 * (std::abs(x) + std::abs(y)))
              throw MeshError(text("The plan has a node at z = ", z, " m"), where,
                              "draw the plan in the plane z = 0, or define physical volumes for a solid");
            plan_node[node] = plan.points.size();
            plan.points.emplace_back(x, y);
          }
        return plan_node[node];
      }

      /// Index of a face, which may belong to several surfaces.
      unsigned int add_face(const GmshMesh::Element &element)
      {
        Plan::Face face;
        for (unsigned int v = 0; v < 4; ++v)
          face[v] = node_index(element.nodes[v]);
        if (signed_area(face, plan.points) < 0.)
          std::reverse(face.begin(), face.end());
        Plan::Face key = face;
        std::sort(key.begin(), key.end());
        const auto [entry, is_new] = face_index.emplace(key, plan.faces.size());
        if (is_new)
          plan.faces.push_back(face);
        return entry->second;
      }

      const GmshMesh                    &mesh;
      const PinRings                     rings;
      const std::string                 &where;
      std::vector<unsigned int>          plan_node;
      std::map<Plan::Face, unsigned int> face_index; ///< index of each face by its ascending nodes
      std::vector<Plan::Curve>           pin_curves;
      std::map<std::string, Plan::Point> centres; ///< centres of pins by name
    };
  } // namespace

  std::vector<Plan::Face> Plan::faces_of(const Pin &pin) const
  {
    std::vector<Face> result;
    for (const unsigned int face : pin.faces)
      result.push_back(faces[face]);
    return result;
  }

  std::vector<Plan::Edge> boundary_edges(const std::vector<Plan::Face> &faces)
  {
    std::map<Plan::Edge, unsigned int> count;
    for (const Plan::Face &face : faces)
      for (unsigned int v = 0; v < 4; ++v)
        ++count[sorted(edge(face, v))];

    std::vector<Plan::Edge> boundary;
    for (const Plan::Face &face : faces)
      for (unsigned int v = 0; v < 4; ++v)
        if (count[sorted(edge(face, v))] == 1)
          boundary.push_back(edge(face, v));
    return boundary;
  }

  Corner::Corner(const Plan::Face &face, const unsigned int v, const std::vector<Plan::Point> &points)
    : a(points[face[(v + 1) % 4]] - points[face[v]])
    , b(points[face[(v + 3) % 4]] - points[face[v]])
    , cross(a[0] * b[1] - a[1] * b[0])
  {}

  Plan make_plan(const GmshMesh &mesh, const PinRings &rings, const double unit, const std::string &where)
  {
    PlanReader reader(mesh, rings, where);
    const auto for_groups = [&](const int dimension, void (PlanReader::*add)(const GmshMesh::Group &)) {
      for (const GmshMesh::Group &group : mesh.groups)
        if (group.dimension == dimension)
          (reader.*add)(group);
    };
    for_groups(2, &PlanReader::add_surface);
    if (!reader.has_disc)
      throw MeshError("The plan has no physical surface 'disc'", where, "give this name to the surface of the disc outside the pins");
    for_groups(1, &PlanReader::add_curve);
    for_groups(0, &PlanReader::add_centre);
    reader.fill_holes();
    Plan plan = std::move(reader.plan);

    // Order: top before bottom, pin_top_2 before pin_top_10
    std::sort(plan.pins.begin(), plan.pins.end(), [](const Plan::Pin &a, const Plan::Pin &b) {
      return std::make_tuple(a.side, a.name.size(), a.name) < std::make_tuple(b.side, b.name.size(), b.name);
    });

    check_joined(plan, unit, where);
    check_pins(plan, where);
    const std::set<Plan::Edge> outline = sorted_edges(boundary_edges(plan.faces));
    for (const Plan::Curve &curve : plan.curves)
      for (const Plan::Edge &edge : curve.edges)
        if (outline.count(sorted(edge)) == 0)
          throw MeshError("Physical curve '" + curve.name + "' is not on the boundary of the disc", where,
                          "name only curves on the boundary of the disc");
    return plan;
  }

  namespace
  {
    /// Moves @p nodes outwards if the closed curve lies on a circle.
    void enlarge(const std::vector<Plan::Edge> &outline, const std::set<unsigned int> &nodes, std::vector<Plan::Point> &points)
    {
      const std::vector<unsigned int> polygon = closed_polygon(outline);
      std::vector<Plan::Point>        corners;
      for (const unsigned int node : polygon)
        corners.push_back(points[node]);
      const std::optional<Circle> circle = circle_through(corners);
      if (!circle)
        return;
      const double area   = std::abs(signed_area(polygon, points));
      const double factor = std::sqrt(dealii::numbers::PI * circle->radius * circle->radius / area);
      for (const unsigned int node : nodes)
        points[node] = circle->centre + factor * (points[node] - circle->centre);
    }
  } // namespace

  void enlarge_to_true_area(Plan &plan)
  {
    for (const Plan::Curve &curve : plan.curves)
      enlarge(curve.edges, nodes_of(curve.edges), plan.points);
    // Enlarge the faces once, because pins of both sides may share them
    std::set<std::vector<unsigned int>> done;
    for (const Plan::Pin &pin : plan.pins)
      if (done.insert(pin.faces).second)
        {
          const std::vector<Plan::Face> faces = plan.faces_of(pin);
          enlarge(boundary_edges(faces), nodes_of(faces), plan.points);
        }
  }
} // namespace Squeal
