// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/geometry/polygon.h>
#include <squeal/geometry/second_order.h>

#include <deal.II/base/bounding_box.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

namespace Squeal
{
  using dealii::Point;

  namespace
  {
    using Edge = std::array<unsigned int, 2>; ///< numbers of its corners, lower number first
    using Key  = std::array<unsigned int, 4>; ///< see face_key()

    /// Largest relative difference of the distances of a face's corners from the axis [-].
    constexpr double round_within = 1e-6;

    /// Points at smaller distances coincide [m]. The limit is relative to the mesh size and far below the element size.
    double resolution(const std::vector<Point<3>> &points)
    {
      const auto [lower, upper] = dealii::BoundingBox<3>(points).get_boundary_points();
      return 1e-7 * lower.distance(upper);
    }

    Edge edge_between(const unsigned int a, const unsigned int b)
    {
      return {{std::min(a, b), std::max(a, b)}};
    }

    std::vector<Edge> edges_of(const CellFace &face)
    {
      std::vector<Edge> edges;
      for (unsigned int v = 0; v < face.n_corners; ++v)
        edges.push_back(edge_between(face.corners[v], face.corners[(v + 1) % face.n_corners]));
      return edges;
    }

    /// Edges and faces on circular cylinders about axes parallel to z.
    class Cylinders
    {
    public:
      explicit Cylinders(const Mesh &mesh)
        : mesh(mesh)
        , grid(resolution(mesh.points))
        , faces(all_faces(mesh))
      {
        find_surfaces();
        attach_surfaces();
        attach_other_side();
      }

      /// Axis of the cylinder of an edge or a face; null: none.
      const Point<2> *axis(const Edge &edge) const
      {
        const auto found = axis_of_edge.find(edge);
        return found == axis_of_edge.end() ? nullptr : &found->second;
      }

      const Point<2> *axis(const Key &face) const
      {
        const auto found = axis_of_face.find(face);
        return found == axis_of_face.end() ? nullptr : &found->second;
      }

    private:
      using Place = std::array<long, 3>; ///< position of the middle of an edge in units of the resolution

      const Mesh                                              &mesh;
      const double                                             grid;
      const std::vector<CellFace>                              faces;
      std::map<std::pair<std::size_t, unsigned int>, Point<2>> surfaces; ///< axes of faces on named cylinders, by cell and face number
      std::map<Edge, Point<2>>                                 axis_of_edge;
      std::map<Key, Point<2>>                                  axis_of_face;
      std::map<Place, Point<2>>                                axis_of_place;

      using Range = std::pair<std::vector<CellFace>::const_iterator, std::vector<CellFace>::const_iterator>;

      /// The one or two cells that contain the face with this key.
      Range cells_at(const Key &key) const
      {
        const auto first =
          std::lower_bound(faces.begin(), faces.end(), key, [](const CellFace &face, const Key &other) { return face.key < other; });
        return {first, std::find_if(first, faces.end(), [&](const CellFace &face) { return face.key != key; })};
      }

      void find_surfaces()
      {
        for (const char *name :
             {PhysicalNames::pin_side, PhysicalNames::disc_rim, PhysicalNames::disc_bore}) // the last surface takes precedence
          {
            std::map<unsigned int, std::vector<CellFace>> patches; // faces of the surface by body
            for (const Mesh::Face &face : mesh.faces)
              if (mesh.surface_names[face.surface] == name)
                if (const auto [first, last] = cells_at(face_key(face)); last - first == 1)
                  patches[first->body].push_back(*first);
            for (const auto &[body, patch] : patches)
              {
                std::vector<Point<2>> points; // projections of the corners along z
                for (const CellFace &face : patch)
                  for (unsigned int v = 0; v < face.n_corners; ++v)
                    points.emplace_back(mesh.points[face.corners[v]][0], mesh.points[face.corners[v]][1]);
                if (const auto circle = circle_through(points))
                  for (const CellFace &face : patch)
                    surfaces[{face.cell, face.number}] = circle->centre;
              }
          }
      }

      /// Attaches the surfaces to their cylinders, then the rings behind them.
      void attach_surfaces()
      {
        struct RingFace
        {
          CellFace    face; ///< face between two rings, or between the innermost ring and the interior
          std::size_t behind;
          Point<2>    axis;
        };
        std::vector<RingFace>               rings;
        std::map<std::size_t, unsigned int> n_faces; // number of ring faces of each cell behind a ring
        for (const auto &[place, axis] : surfaces)
          {
            CellFace face = face_of_cell(mesh, place.first, place.second);
            attach(face, axis);
            const bool is_pin = face.body > 0;
            while (const auto next = is_pin ? face_behind(face, axis) : std::nullopt)
              {
                rings.push_back({*next, next->cell, axis});
                ++n_faces[next->cell];
                face = *next;
              }
          }
        for (const RingFace &ring : rings)
          if (n_faces.at(ring.behind) == 1)
            attach(ring.face, ring.axis);
      }

      /// Opposite face of a hexahedron, as a face of the next cell; empty without a next cell or if the face is not round.
      std::optional<CellFace> face_behind(const CellFace &face, const Point<2> &axis) const
      {
        if (mesh.cells[face.cell].shape != Shape::hexahedron)
          return {};
        const unsigned int opposite = topology(Shape::hexahedron).faces.size() - 1 - face.number;
        const CellFace     own      = face_of_cell(mesh, face.cell, opposite);
        double             least = std::numeric_limits<double>::max(), most = 0.;
        for (const unsigned int node : own.corners)
          {
            const double r = std::hypot(mesh.points[node][0] - axis[0], mesh.points[node][1] - axis[1]);
            least          = std::min(least, r);
            most           = std::max(most, r);
          }
        const auto [first, last] = cells_at(own.key);
        if (last - first != 2 || most - least > round_within * most)
          return {};
        return first->cell == own.cell ? *(first + 1) : *first;
      }

      /// Attaches the coincident edges on the other side of the contact: the outline and rings of a pin on the disc, and the rim or bore of
      /// the disc on a pad that ends there.
      void attach_other_side()
      {
        for (const Mesh::Face &face : mesh.faces)
          if (const std::string &name = mesh.surface_names[face.surface];
              name == PhysicalNames::disc_contact || name == PhysicalNames::pin_contact)
            for (const auto &[a, b] : topology(face.shape).edges)
              if (const Edge edge = edge_between(face.nodes[a], face.nodes[b]); axis_of_place.count(place(edge)) > 0)
                axis_of_edge[edge] = axis_of_place.at(place(edge));
      }

      Place place(const Edge &edge) const
      {
        const Point<3> p = 0.5 * (mesh.points[edge[0]] + mesh.points[edge[1]]);
        return {{std::lround(p[0] / grid), std::lround(p[1] / grid), std::lround(p[2] / grid)}};
      }

      /// Attaches a face and its edges to a cylinder. Edges along the axis are not attached on the other side of the contact.
      void attach(const CellFace &face, const Point<2> &axis)
      {
        axis_of_face[face.key] = axis;
        for (const Edge &edge : edges_of(face))
          {
            axis_of_edge[edge] = axis;
            const Point<3> &a = mesh.points[edge[0]], &b = mesh.points[edge[1]];
            if (std::hypot(a[0] - b[0], a[1] - b[1]) > grid)
              axis_of_place[place(edge)] = axis;
          }
      }
    };

    /// Weighted mean of points: mean position or, with an axis, mean angle, radius and height.
    Point<3> mean(const std::vector<std::pair<double, Point<3>>> &points, const Point<2> *axis)
    {
      Point<3> sum;
      for (const auto &[weight, point] : points)
        sum += weight * point;
      if (axis == nullptr)
        return sum;
      const auto   angle_of = [&](const Point<3> &p) { return std::atan2(p[1] - (*axis)[1], p[0] - (*axis)[0]); };
      const double start    = angle_of(points[0].second);
      double       turn = 0., radius = 0.; // angle relative to the first point
      for (const auto &[weight, point] : points)
        {
          turn += weight * std::remainder(angle_of(point) - start, 2. * M_PI);
          radius += weight * std::hypot(point[0] - (*axis)[0], point[1] - (*axis)[1]);
        }
      return {(*axis)[0] + radius * std::cos(start + turn), (*axis)[1] + radius * std::sin(start + turn), sum[2]};
    }

    /// Adds the missing nodes of elements of degree 2, once for all cells that share a node.
    class AddedNodes
    {
    public:
      /// @param cylinders null: straight edges
      AddedNodes(Mesh &mesh, const Cylinders *cylinders)
        : mesh(mesh)
        , cylinders(cylinders)
      {}

      void add()
      {
        for (const Mesh::Cell &cell : mesh.cells)
          if (cell.nodes.size() == ShapeFunctions::of(cell.shape, 2).n())
            for (unsigned int f = 0; f < topology(cell.shape).faces.size(); ++f)
              if (const auto &numbers = nodes_of_face(cell.shape, 2, f); numbers.size() == 9)
                faces[key_of(cell.nodes, numbers)] = cell.nodes[numbers[8]];
        for (Mesh::Cell &cell : mesh.cells)
          add(cell.shape, cell.nodes);
        for (Mesh::Face &face : mesh.faces)
          add(face.shape, face.nodes);
      }

    private:
      Mesh                        &mesh;
      const Cylinders             *cylinders;
      std::map<Edge, unsigned int> edges;
      std::map<Key, unsigned int>  faces; ///< centre nodes of quadrilateral faces

      static Key key_of(const Mesh::Nodes &nodes, const std::vector<unsigned int> &numbers)
      {
        Key key = {{nodes[numbers[0]], nodes[numbers[1]], nodes[numbers[2]], nodes[numbers[3]]}};
        std::sort(key.begin(), key.end());
        return key;
      }

      /// Adds nodes to a cell or face that has corner nodes, corner and edge nodes, or all nodes.
      void add(const Shape shape, Mesh::Nodes &nodes)
      {
        const Topology    &parts     = topology(shape);
        const unsigned int n_corners = parts.corners.size(), n_outline = n_corners + parts.edges.size();
        if (nodes.size() == n_corners)
          for (const auto &[a, b] : parts.edges)
            nodes.push_back(on_edge(edge_between(nodes[a], nodes[b])));
        if (nodes.size() > n_outline)
          return;
        for (unsigned int f = 0; f < parts.faces.size(); ++f)
          if (const auto &numbers = nodes_of_face(shape, 2, f); numbers.size() == 9)
            nodes.push_back(on_face(nodes, numbers));
        // Transfinite interpolation with the weights of face, edge and corner nodes
        std::vector<std::pair<double, Point<3>>> points;
        for (unsigned int i = 0; i < nodes.size(); ++i)
          points.emplace_back(i < n_corners ? 1. / 8. : i < n_outline ? -1. / 4. : 1. / 2., mesh.points[nodes[i]]);
        if (shape == Shape::hexahedron)
          nodes.push_back(add_point(mean(points, nullptr)));
      }

      unsigned int add_point(const Point<3> &point)
      {
        mesh.points.push_back(point);
        return mesh.points.size() - 1;
      }

      unsigned int on_edge(const Edge &edge)
      {
        const auto [found, is_new] = edges.emplace(edge, mesh.points.size());
        if (is_new)
          add_point(
            mean({{0.5, mesh.points[edge[0]]}, {0.5, mesh.points[edge[1]]}}, cylinders == nullptr ? nullptr : cylinders->axis(edge)));
        return found->second;
      }

      unsigned int on_face(const Mesh::Nodes &nodes, const std::vector<unsigned int> &numbers)
      {
        const Key key              = key_of(nodes, numbers);
        const auto [found, is_new] = faces.emplace(key, mesh.points.size());
        std::vector<std::pair<double, Point<3>>> points;
        for (unsigned int i = 0; i < 8 && is_new; ++i)
          points.emplace_back(i < 4 ? -1. / 4. : 1. / 2., mesh.points[nodes[numbers[i]]]);
        if (is_new)
          add_point(mean(points, cylinders == nullptr ? nullptr : cylinders->axis(key)));
        return found->second;
      }
    };
  } // namespace

  std::size_t add_centres(Mesh &mesh)
  {
    const std::size_t n_given = mesh.points.size();
    AddedNodes(mesh, nullptr).add();
    return mesh.points.size() - n_given;
  }

  Mesh second_order(Mesh mesh)
  {
    if (mesh.degree == 2)
      return mesh;
    const Cylinders cylinders(mesh);
    AddedNodes(mesh, &cylinders).add();
    mesh.degree = 2;
    return mesh;
  }
} // namespace Squeal
