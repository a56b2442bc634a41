// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/geometry/mesh_topology.h>

#include <deal.II/numerics/rtree.h>

#include <boost/iterator/function_output_iterator.hpp>
#include <boost/pending/disjoint_sets.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace Squeal
{
  namespace
  {
    namespace bgi = boost::geometry::index;

    using Position = Mesh::Point;
    using Box      = dealii::BoundingBox<3>;
    using Sample   = std::pair<Position, unsigned int>; ///< a position with the index of a node, face or element
    using Tree     = dealii::RTree<Sample>;

    // Tolerances of coincident nodes: well below intended distances, above rounding errors in files with six digits
    constexpr double of_shortest_edge = 1e-3, of_size = 2e-5, most_of_shortest_edge = 0.1, most_of_longest_edge = 5e-3;

    /// Largest distance between nodes of a finer part and faces of a coarser part if chords approximate their common curved surface,
    /// relative to the element [-].
    constexpr double off_curved_faces = 0.3;

    /// Overlaps deeper than this fraction of the extent of the element normal to the face are errors [-]; chords of a curved face may cause
    /// smaller overlaps.
    constexpr double chord_depth = 0.05;

    std::string place(const Position &p)
    {
      const auto coordinate = [&](const unsigned int d) { return std::abs(p[d]) > 1e-12 * p.norm() ? p[d] : 0.; };
      return text("(", coordinate(0), ", ", coordinate(1), ", ", coordinate(2), ") m");
    }

    template <typename Visit>
    void visit_box(const Tree &tree, const Box &box, const Visit &visit)
    {
      tree.query(bgi::intersects(box), boost::make_function_output_iterator(visit));
    }

    Box box_around(const Position &point, const double distance)
    {
      Box box(std::make_pair(point, point));
      box.extend(distance);
      return box;
    }

    /// Bounding box of the corners: edges are assumed straight.
    Box box_around(const Mesh &mesh, const Mesh::Cell &cell)
    {
      std::vector<Position> corners;
      for (unsigned int v = 0; v < topology(cell.shape).corners.size(); ++v)
        corners.push_back(mesh.corner(cell, v));
      return Box(corners);
    }

    /// For each node, the distance above which a neighbouring point is a different node [m].
    std::vector<double> node_tolerances(const Mesh &mesh)
    {
      std::vector<double> shortest(mesh.points.size(), std::numeric_limits<double>::infinity()), longest(mesh.points.size(), 0.);
      for (const Mesh::Cell &cell : mesh.cells)
        for (const auto &[a, b] : topology(cell.shape).edges)
          {
            const double length = mesh.corner(cell, a).distance(mesh.corner(cell, b));
            for (const unsigned int node : {cell.nodes[a], cell.nodes[b]})
              {
                shortest[node] = std::min(shortest[node], length);
                longest[node]  = std::max(longest[node], length);
              }
          }
      const auto          corners = Box(mesh.points).get_boundary_points();
      const double        size    = corners.first.distance(corners.second);
      std::vector<double> tolerances(mesh.points.size());
      for (std::size_t node = 0; node < tolerances.size(); ++node)
        tolerances[node] = std::min({std::max(of_shortest_edge * shortest[node], of_size * size), most_of_shortest_edge * shortest[node],
                                     most_of_longest_edge * longest[node]});
      return tolerances;
    }

    std::vector<Sample> nodes_of_outline(const Mesh &mesh, const std::vector<CellFace> &outline)
    {
      std::vector<bool> is_outer(mesh.points.size(), false);
      for (const CellFace &face : outline)
        for (const unsigned int node : face.corners)
          is_outer[node] = true;
      std::vector<Sample> samples;
      for (unsigned int node = 0; node < is_outer.size(); ++node)
        if (is_outer[node])
          samples.emplace_back(mesh.points[node], node);
      return samples;
    }

    // -------------------------------------------------------- coincident nodes

    /// Calls visit(node, other), node < other, for coincident nodes.
    template <typename Visit>
    void visit_coincident(const std::vector<Sample> &nodes, const std::vector<double> &tolerances, const Visit &visit)
    {
      const Tree tree = dealii::pack_rtree(nodes);
      for (const auto &[point, node] : nodes)
        visit_box(tree, box_around(point, tolerances[node]), [&, p = point, n = node](const Sample &other) {
          if (n < other.second && p.distance(other.first) <= std::min(tolerances[n], tolerances[other.second]))
            visit(n, other.second);
        });
    }

    void check_merged(const Mesh                      &mesh,
                      const std::vector<Sample>       &nodes,
                      const std::vector<double>       &tolerances,
                      const std::vector<unsigned int> &bodies,
                      const std::string               &where)
    {
      std::map<unsigned int, std::set<unsigned int>> twins; // by body: nodes that coincide with a node of lower number
      visit_coincident(nodes, tolerances, [&](const unsigned int node, const unsigned int other) {
        if (bodies[node] == bodies[other])
          twins[bodies[node]].insert(other);
      });
      for (const auto &[body, of_body] : twins)
        throw MeshError(counted(of_body.size(), "node") + " of body '" + mesh.body_names[body] + "' " +
                          (of_body.size() == 1 ? "coincides" : "coincide") + " with other nodes of the same body; the first one is at " +
                          place(mesh.points[*of_body.begin()]),
                        where,
                        "merge coincident nodes (Coherence Mesh in Gmsh, or merge duplicate nodes in the pre-processor), "
                        "or widen the crack between them");
    }

    /// Rejects quadrilaterals with triangles on the other side: the faces share nodes but do not conform.
    void check_matching(const Mesh &mesh, const std::vector<CellFace> &outline, const std::string &where)
    {
      std::set<std::array<unsigned int, 4>> triangles;
      for (const CellFace &face : outline)
        if (face.n_corners == 3)
          triangles.insert(face.key);
      std::vector<const CellFace *> unmatched;
      for (const CellFace &face : outline)
        if (const auto &[a, b, c, d] = face.key; face.n_corners == 4 && triangles.count({{a, b, c, c}}) + triangles.count({{a, b, d, d}}) +
                                                                            triangles.count({{a, c, d, d}}) +
                                                                            triangles.count({{b, c, d, d}}) ==
                                                                          2)
          unmatched.push_back(&face);
      if (!unmatched.empty())
        throw MeshError(counted(unmatched.size(), "quadrilateral face") + (unmatched.size() == 1 ? " has" : " have") +
                          " two triangles on the other side; the first one is in body '" + mesh.body_names[unmatched[0]->body] + "' at " +
                          place(face_geometry(mesh, *unmatched[0]).centre),
                        where, "insert pyramids between quadrilateral and triangular faces");
    }

    // ----------------------------------------------------- sides of the contact

    std::vector<CellFace> named_faces(const Mesh &mesh, const std::vector<CellFace> &outline, const std::string &name)
    {
      std::vector<CellFace> result;
      for (const Mesh::Face &named : mesh.faces)
        if (mesh.surface_names[named.surface] == name)
          {
            const auto key  = face_key(named);
            const auto face = std::lower_bound(outline.begin(), outline.end(), key,
                                               [](const CellFace &candidate, const auto &wanted) { return candidate.key < wanted; });
            if (face != outline.end() && face->key == key)
              result.push_back(*face);
          }
      return result;
    }

    void check_sides(const Mesh &mesh, const std::vector<CellFace> &outline, const double pairing_tolerance, const std::string &where)
    {
      std::vector<FaceGeometry> disc;
      std::vector<Sample>       centres;
      for (const CellFace &face : named_faces(mesh, outline, PhysicalNames::disc_contact))
        {
          disc.push_back(face_geometry(mesh, face));
          centres.emplace_back(disc.back().centre, centres.size());
        }
      const Tree                                    tree = dealii::pack_rtree(centres);
      std::map<unsigned int, std::vector<CellFace>> wrong; // faces with the wrong normal by pin
      for (const CellFace &face : named_faces(mesh, outline, PhysicalNames::pin_contact))
        {
          const FaceGeometry pin         = face_geometry(mesh, face);
          bool               is_opposite = true;
          visit_box(tree, box_around(pin.centre, pairing_tolerance),
                    [&](const Sample &partner) { is_opposite = is_opposite && pin.area_normal * disc[partner.second].area_normal <= 0.; });
          if (!is_opposite)
            wrong[face.body].push_back(face);
        }
      for (const auto &[pin, faces] : wrong)
        throw MeshError("'" + mesh.body_names[pin] + "' and the disc lie on the same side of " + counted(faces.size(), "contact face") +
                          ", the first one at " + place(face_geometry(mesh, faces.front()).centre) + ": one body is inside the other",
                        where, "move the pin to the other side of its contact face, for example by reversing its extrusion");
    }

    // --------------------------------------------------------- nodes in elements

    /// Nodes at which outer faces meet in several fans, and nodes of edges with more than two outer faces. Parts of a body are joined there
    /// only by single nodes or edges, for example on both sides of hanging nodes.
    std::vector<bool> pinched_nodes(const Mesh &mesh, const std::vector<CellFace> &outline)
    {
      struct Edge
      {
        std::array<unsigned int, 2> nodes, corners; ///< lower node number first; corner v of face f has the index 4 f + v
      };
      std::vector<Edge> all;
      all.reserve(4 * outline.size());
      for (unsigned int f = 0; f < outline.size(); ++f)
        for (unsigned int v = 0; v < outline[f].n_corners; ++v)
          {
            const unsigned int next = (v + 1) % outline[f].n_corners, a = outline[f].corners[v], b = outline[f].corners[next];
            all.push_back(a < b ? Edge{{{a, b}}, {{4 * f + v, 4 * f + next}}} : Edge{{{b, a}}, {{4 * f + next, 4 * f + v}}});
          }
      std::sort(all.begin(), all.end(), [](const Edge &a, const Edge &b) { return a.nodes < b.nodes; });

      std::vector<bool>                   result(mesh.points.size(), false);
      boost::disjoint_sets_with_storage<> fans(4 * outline.size()); // disjoint sets of corner indices
      for (auto first = all.begin(), last = first; first != all.end(); first = last)
        {
          last = std::find_if(first, all.end(), [&](const Edge &edge) { return edge.nodes != first->nodes; });
          for (unsigned int end = 0; end < 2; ++end)
            if (last - first == 2)
              fans.union_set(first->corners[end], (first + 1)->corners[end]);
            else
              result[first->nodes[end]] = true;
        }
      constexpr std::size_t    none = -1;
      std::vector<std::size_t> fan(mesh.points.size(), none);
      for (unsigned int corner = 0; corner < 4 * outline.size(); ++corner)
        {
          const CellFace &face = outline[corner / 4];
          if (corner % 4 >= face.n_corners)
            continue;
          const unsigned int node = face.corners[corner % 4];
          const std::size_t  root = fans.find_set(corner);
          if (fan[node] != none && fan[node] != root)
            result[node] = true;
          fan[node] = root;
        }
      return result;
    }

    /// Misplaced nodes or element centres, by index; the index of the centre of element e is the number of nodes + e.
    struct MisplacedPoints
    {
      std::map<unsigned int, std::set<unsigned int>>                          hanging;  ///< points on or in other elements of the same body
      std::map<std::pair<unsigned int, unsigned int>, std::set<unsigned int>> overlaps; ///< points by own and other body
    };

    std::vector<Box> boxes_of_bodies(const Mesh &mesh, const std::vector<unsigned int> &bodies)
    {
      std::vector<std::vector<Position>> points(mesh.body_names.size());
      for (std::size_t node = 0; node < bodies.size(); ++node)
        points[bodies[node]].push_back(mesh.points[node]);
      return std::vector<Box>(points.begin(), points.end());
    }

    MisplacedPoints find_misplaced(const Mesh                      &mesh,
                                   const std::vector<CellFace>     &outline,
                                   std::vector<Sample>              points,
                                   const std::vector<double>       &tolerances,
                                   const std::vector<unsigned int> &bodies,
                                   const double                     pairing_tolerance)
    {
      const unsigned int      n_nodes = mesh.points.size();
      const std::vector<bool> pinched = pinched_nodes(mesh, outline);
      const std::vector<Box>  boxes   = boxes_of_bodies(mesh, bodies);
      std::vector<bool>       is_outer(n_nodes, false);
      for (const Sample &node : points)
        is_outer[node.second] = true;
      for (unsigned int element = 0; element < mesh.cells.size(); ++element)
        points.emplace_back(centre(mesh, mesh.cells[element]), n_nodes + element);
      const Tree tree = dealii::pack_rtree(points);

      MisplacedPoints found;
      for (const Mesh::Cell &cell : mesh.cells)
        {
          const unsigned int own_body = mesh.body_of(cell);
          const auto         any_node = [&](const std::vector<bool> &is) {
            return std::any_of(cell.nodes.begin(), cell.nodes.end(), [&](const unsigned int node) { return is[node]; });
          };
          Box  box     = box_around(mesh, cell);
          bool is_near = any_node(is_outer);
          for (unsigned int other = 0; other < boxes.size() && !is_near; ++other)
            is_near = other != own_body && boost::geometry::intersects(boxes[other], box);
          if (!is_near)
            continue;

          const bool   is_pinched = any_node(pinched);
          const double diagonal   = box.get_boundary_points().first.distance(box.get_boundary_points().second);
          box.extend(is_pinched ? off_curved_faces * diagonal : tolerances[cell.nodes[0]]);
          visit_box(tree, box, [&](const Sample &sample) {
            const auto &[point, index] = sample;
            const bool         is_node = index < n_nodes;
            const unsigned int body    = is_node ? bodies[index] : mesh.body_of(mesh.cells[index - n_nodes]);
            if (body == own_body && (!is_node || std::count(cell.nodes.begin(), cell.nodes.end(), index) > 0))
              return;
            const std::optional<Depth> depth = depth_in_cell(mesh, cell, point);
            if (!depth)
              return;
            if (body != own_body)
              {
                if (depth->relative > chord_depth && depth->length > pairing_tolerance)
                  found.overlaps[{body, own_body}].insert(index);
              }
            else if (depth->length >= -tolerances[index] || (is_pinched && depth->relative >= -off_curved_faces))
              found.hanging[body].insert(index);
          });
        }
      return found;
    }

    void refuse(const MisplacedPoints &points, const Mesh &mesh, const std::string &where)
    {
      const unsigned int n_nodes  = mesh.points.size();
      const auto         place_of = [&](const unsigned int index) {
        return place(index < n_nodes ? mesh.points[index] : centre(mesh, mesh.cells[index - n_nodes]));
      };
      for (const auto &[body, nodes] : points.hanging)
        throw MeshError(counted(nodes.size(), "node") + " of body '" + mesh.body_names[body] + "' " + (nodes.size() == 1 ? "is" : "are") +
                          " on or inside elements of this body without being nodes of these elements; the first one is at " +
                          place_of(*nodes.begin()),
                        where, "mesh neighbouring parts of a body with the same nodes on their common faces (no hanging nodes)");
      const auto most = std::max_element(points.overlaps.begin(), points.overlaps.end(),
                                         [](const auto &a, const auto &b) { return a.second.size() < b.second.size(); });
      if (most == points.overlaps.end())
        return;
      const auto &[bodies, indices] = *most;
      const std::size_t n_inside    = std::distance(indices.begin(), indices.lower_bound(n_nodes));
      throw MeshError("Bodies '" + mesh.body_names[bodies.first] + "' and '" + mesh.body_names[bodies.second] +
                        "' overlap: " + counted(n_inside, "node") + " and " + counted(indices.size() - n_inside, "element centre") +
                        " of '" + mesh.body_names[bodies.first] + "' are inside '" + mesh.body_names[bodies.second] +
                        "', the first one at " + place_of(*indices.begin()),
                      where, "move one body, or remove duplicate bodies");
    }
  } // namespace

  void check_topology(const Mesh &mesh, const double pairing_tolerance, const std::string &where)
  {
    const std::vector<CellFace>     outline    = outer_faces(mesh);
    const std::vector<Sample>       nodes      = nodes_of_outline(mesh, outline);
    const std::vector<double>       tolerances = node_tolerances(mesh);
    const std::vector<unsigned int> bodies     = body_of_nodes(mesh);
    check_merged(mesh, nodes, tolerances, bodies, where);
    check_matching(mesh, outline, where);
    check_sides(mesh, outline, pairing_tolerance, where);
    refuse(find_misplaced(mesh, outline, nodes, tolerances, bodies, pairing_tolerance), mesh, where);
  }

  UnnamedContact find_unnamed_contact(const Mesh &mesh)
  {
    std::vector<bool> is_contact(mesh.points.size(), false);
    for (const Mesh::Face &face : mesh.faces)
      if (const std::string &name = mesh.surface_names[face.surface];
          name == PhysicalNames::disc_contact || name == PhysicalNames::pin_contact)
        for (const unsigned int node : face.nodes)
          is_contact[node] = true;

    const std::vector<unsigned int> bodies = body_of_nodes(mesh);
    UnnamedContact                  found;
    unsigned int                    first = mesh.points.size();
    visit_coincident(nodes_of_outline(mesh, outer_faces(mesh)), node_tolerances(mesh), [&](const unsigned int a, const unsigned int b) {
      if (bodies[a] == bodies[b] || (is_contact[a] && is_contact[b]))
        return;
      ++found.n_nodes;
      if (a < first)
        {
          first       = a;
          found.body  = mesh.body_names[bodies[a]];
          found.other = mesh.body_names[bodies[b]];
          found.place = mesh.points[a];
        }
    });
    return found;
  }
} // namespace Squeal
