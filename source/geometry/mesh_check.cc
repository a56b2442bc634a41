// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/geometry/curved_cells.h>
#include <squeal/geometry/mesh_check.h>
#include <squeal/parameters/materials.h>

#include <boost/algorithm/string/join.hpp>
#include <boost/pending/disjoint_sets.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

namespace Squeal
{
  namespace
  {
    /// For each corner, the other ends of its three edges as a right-handed triple; the apex of a pyramid is omitted.
    struct CornerEdges
    {
      double                                   unit; ///< triple product of the unit edge vectors in a regular cell
      std::vector<std::array<unsigned int, 3>> ends;
    };

    const CornerEdges &corner_edges(const Shape shape)
    {
      static const double      half = std::sqrt(0.5);
      static const CornerEdges tetrahedron{half, {{{1, 2, 3}}, {{2, 0, 3}}, {{0, 1, 3}}, {{0, 2, 1}}}},
        pyramid{half, {{{1, 3, 4}}, {{2, 0, 4}}, {{3, 1, 4}}, {{0, 2, 4}}}},
        wedge{std::sqrt(0.75), {{{1, 2, 3}}, {{2, 0, 4}}, {{0, 1, 5}}, {{5, 4, 0}}, {{3, 5, 1}}, {{4, 3, 2}}}},
        hexahedron{1., {{{1, 3, 4}}, {{2, 0, 5}}, {{3, 1, 6}}, {{0, 2, 7}}, {{7, 5, 0}}, {{4, 6, 1}}, {{5, 7, 2}}, {{6, 4, 3}}}};
      return shape == Shape::tetrahedron ? tetrahedron : shape == Shape::pyramid ? pyramid : shape == Shape::wedge ? wedge : hexahedron;
    }

    /// Triple product of the three normalised edges at each corner, relative to a regular cell; 0 if an edge has no length.
    std::vector<double> scaled_jacobians(const Mesh &mesh, const Mesh::Cell &cell)
    {
      const CornerEdges  &corners = corner_edges(cell.shape);
      std::vector<double> result;
      for (unsigned int corner = 0; corner < corners.ends.size(); ++corner)
        {
          dealii::Tensor<2, 3> edges;
          double               lengths = corners.unit;
          for (unsigned int e = 0; e < 3; ++e)
            {
              edges[e] = mesh.corner(cell, corners.ends[corner][e]) - mesh.corner(cell, corner);
              lengths *= edges[e].norm();
            }
          result.push_back(lengths > 0. ? determinant(edges) / lengths : 0.);
        }
      return result;
    }

    /// True if two faces with the same corners have the same orientation: their cells are then on the same side.
    bool turn_alike(const CellFace &a, const CellFace &b)
    {
      const auto first = std::find(b.corners.begin(), b.corners.end(), a.corners[0]) - b.corners.begin();
      return b.corners[(first + 1) % b.n_corners] == a.corners[1];
    }

    std::string list(const std::vector<std::string> &names)
    {
      return names.empty() ? "(none)" : boost::algorithm::join(names, ", ");
    }

    /// Checks that every body is connected. The disc may have several pieces (several discs on one axis) if each piece has a mount and no
    /// volume extends over two pieces.
    void check_connected(const Mesh &mesh, const std::vector<std::string> &mounted_surfaces, const std::string &where)
    {
      boost::disjoint_sets_with_storage<> sets(mesh.points.size());
      for (const Mesh::Cell &cell : mesh.cells)
        for (const unsigned int node : cell.nodes)
          sets.union_set(node, cell.nodes[0]);
      for (const auto &[node, other] : tied_links(mesh))
        sets.union_set(node, other);
      std::vector<std::map<std::size_t, std::size_t>> pieces(mesh.body_names.size());       // number of elements of each piece, by root
      std::vector<std::set<std::size_t>>              of_volumes(mesh.volume_names.size()); // roots of the pieces of each volume
      std::set<std::size_t>                           held;                                 // roots of mounted pieces
      for (const Mesh::Cell &cell : mesh.cells)
        {
          const std::size_t root = sets.find_set(cell.nodes[0]);
          ++pieces[mesh.body_of(cell)][root];
          of_volumes[cell.volume].insert(root);
        }
      for (const Mesh::Face &face : mesh.faces)
        if (const std::string &surface = mesh.surface_names[face.surface];
            std::count(mounted_surfaces.begin(), mounted_surfaces.end(), surface) > 0)
          held.insert(sets.find_set(face.nodes[0]));
      const auto is_whole = [&](const std::size_t volume) { return mesh.body_of_volume[volume] != 0 || of_volumes[volume].size() == 1; };
      const auto is_held  = [&](const auto &piece) { return held.count(piece.first) > 0; };
      for (std::size_t body = 0; body < pieces.size(); ++body)
        {
          if (pieces[body].size() == 1)
            continue;
          bool are_discs = body == 0 && std::all_of(pieces[0].begin(), pieces[0].end(), is_held);
          for (std::size_t volume = 0; volume < of_volumes.size(); ++volume)
            are_discs = are_discs && is_whole(volume);
          if (are_discs)
            continue;
          std::string sizes;
          for (const auto &[root, size] : pieces[body])
            sizes += (sizes.empty() ? "" : ", ") + std::to_string(size);
          throw MeshError(
            "Body '" + mesh.body_names[body] + "' consists of " + std::to_string(pieces[body].size()) +
              " disconnected pieces, which have " + sizes + " elements",
            where,
            "join the pieces (Coherence, BooleanUnion or common curves), or tie their faces (Contact/Tied); if the pieces are pins, give "
            "each a separate physical volume; if they are discs, give each a physical volume 'disc_...' and a surface in "
            "Mounts/Elastic mounts");
        }
    }

    /// Nodes of a named surface, grouped by body.
    std::vector<std::set<unsigned int>> nodes_by_body(const Mesh                      &mesh,
                                                      const std::vector<unsigned int> &body_of_node,
                                                      const std::string               &name)
    {
      std::vector<std::set<unsigned int>> result(mesh.body_names.size());
      for (const Mesh::Face &face : mesh.faces)
        if (mesh.surface_names[face.surface] == name)
          for (const unsigned int node : face.nodes)
            result[body_of_node[node]].insert(node);
      return result;
    }

    double distance(const Mesh &mesh, const std::set<unsigned int> &some, const std::set<unsigned int> &others)
    {
      double nearest = std::numeric_limits<double>::infinity();
      for (const unsigned int a : some)
        for (const unsigned int b : others)
          nearest = std::min(nearest, mesh.points[a].distance(mesh.points[b]));
      return nearest;
    }

    /// Node permutation of the mirror image of a cell: bottom and top exchanged, or two coordinates of the base.
    std::vector<unsigned int> mirrored_nodes(const Shape shape, const unsigned int degree)
    {
      const auto                nodes = reference_nodes(shape, degree);
      std::vector<unsigned int> result;
      for (Mesh::Point x : nodes)
        {
          if (shape == Shape::wedge || shape == Shape::hexahedron)
            x[2] = 1. - x[2];
          else
            std::swap(x[0], x[1]);
          result.push_back(std::find_if(nodes.begin(), nodes.end(), [&](const Mesh::Point &y) { return x.distance(y) < 1e-6; }) -
                           nodes.begin());
        }
      return result;
    }
  } // namespace

  MeshQuality mesh_quality(const Mesh &mesh)
  {
    if (mesh.cells.empty())
      throw MeshError("The mesh has no elements", "mesh", "define and mesh the volumes of disc and pins in the geometry");

    MeshQuality quality{1., 0, 0};
    for (unsigned int element = 0; element < mesh.cells.size(); ++element)
      {
        const auto   corners         = scaled_jacobians(mesh, mesh.cells[element]);
        const double scaled_jacobian = *std::min_element(corners.begin(), corners.end());
        quality.n_bad += !(scaled_jacobian >= smallest_scaled_jacobian);
        if (scaled_jacobian < quality.worst_scaled_jacobian)
          {
            quality.worst_scaled_jacobian = scaled_jacobian;
            quality.worst_element         = element;
          }
      }

    return quality;
  }

  MeshQuality check_mesh(const Mesh &mesh)
  {
    const MeshQuality quality = mesh_quality(mesh);
    if (quality.n_bad > 0)
      throw MeshError(text(quality.n_bad, " of ", mesh.cells.size(), quality.n_bad == 1 ? " elements is" : " elements are",
                           " inverted or degenerate; the smallest scaled Jacobian is ", quality.worst_scaled_jacobian, ", but at least ",
                           smallest_scaled_jacobian, " is required"),
                      describe_cell(mesh, quality.worst_element),
                      "in the supplied geometry, change Geometry/Element size or Geometry/Nodes per pin face, or move pins away from edges "
                      "and from each other; in your own mesh, correct these elements (for flat tetrahedra, try Mesh.Algorithm3D = 10 or "
                      "another element size in Gmsh)");
    if (mesh.degree == 2)
      check_curved(mesh);
    return quality;
  }

  void check_unique(const Mesh &mesh, const std::string &where)
  {
    std::map<Mesh::Nodes, std::size_t>                 known; // index of the first element with these nodes
    std::optional<std::pair<std::size_t, std::size_t>> twins;
    for (std::size_t element = 0; element < mesh.cells.size(); ++element)
      {
        Mesh::Nodes nodes = mesh.cells[element].nodes;
        std::sort(nodes.begin(), nodes.end());
        if (const auto [first, is_new] = known.emplace(nodes, element); !is_new)
          twins = twins.value_or(std::make_pair(first->second, element));
      }
    if (twins)
      throw MeshError(text("Duplicates: ", mesh.cells.size() - known.size(), " of ", mesh.cells.size(), " elements; the first one is ",
                           describe_cell(mesh, twins->second), ", with the same nodes as ", describe_cell(mesh, twins->first)),
                      where, "remove duplicate elements, for example of a volume that was meshed or exported twice");

    const std::vector<CellFace> faces = all_faces(mesh);
    std::set<std::size_t>       elements;
    for (std::size_t i = 0; i + 2 < faces.size(); ++i)
      if (faces[i].key == faces[i + 2].key)
        elements.insert({faces[i].cell, faces[i + 1].cell, faces[i + 2].cell});
    if (!elements.empty())
      throw MeshError(text("More than two elements share a face; ", elements.size(), " elements have such faces, the first one is ",
                           describe_cell(mesh, *elements.begin())),
                      where, "remove overlapping elements");
  }

  unsigned int make_right_handed(Mesh &mesh)
  {
    unsigned int n_reordered = 0;
    for (Mesh::Cell &cell : mesh.cells)
      {
        const auto corners = scaled_jacobians(mesh, cell);
        if (std::any_of(corners.begin(), corners.end(), [](const double corner) { return !(corner < 0.); }))
          continue;
        const Mesh::Nodes given = cell.nodes;
        const auto        from  = mirrored_nodes(cell.shape, mesh.degree);
        for (unsigned int i = 0; i < from.size(); ++i)
          cell.nodes[i] = given[from[i]];
        ++n_reordered;
      }
    if (n_reordered == 0)
      return 0;

    const std::vector<CellFace> faces = all_faces(mesh);
    for (std::size_t i = 0; i + 1 < faces.size(); ++i)
      if (faces[i].key == faces[i + 1].key && turn_alike(faces[i], faces[i + 1]))
        throw MeshError("Two elements lie on the same side of their common face: one of them is inverted, or they overlap",
                        describe_cell(mesh, faces[i].cell) + " and " + describe_cell(mesh, faces[i + 1].cell),
                        "correct the order of the nodes of these elements, or remove overlapping elements");
    return n_reordered;
  }

  namespace
  {
    void check_volumes(const Mesh &mesh, const std::string &where)
    {
      std::vector<std::size_t> n_elements(mesh.volume_names.size(), 0);
      for (const Mesh::Cell &cell : mesh.cells)
        ++n_elements[cell.volume];
      std::size_t n_pins = 0, n_discs = 0;
      for (std::size_t v = 0; v < mesh.volume_names.size(); ++v)
        {
          if (n_elements[v] == 0)
            throw MeshError("Volume '" + mesh.volume_names[v] + "' has no elements", where, "mesh this volume, or remove its name");
          ++(is_of_disc(mesh.volume_names[v]) ? n_discs : n_pins);
        }
      if (n_discs == 0 || n_pins == 0)
        throw MeshError((n_discs == 0 ? "No physical volume is named 'disc' or 'disc_...'; the volumes are: " :
                                        "All physical volumes belong to the disc; the volumes are: ") +
                          list(mesh.volume_names),
                        where, "name the volume of the disc 'disc', and give each pin or pad another name, for example 'pin_1'");

      // Volumes that share nodes form one body; disc and pins must not share nodes
      std::vector<std::optional<unsigned int>> volume_of_node(mesh.points.size());
      for (const Mesh::Cell &cell : mesh.cells)
        for (const unsigned int node : cell.nodes)
          {
            const std::string &one = mesh.volume_names[cell.volume], &other = mesh.volume_names[volume_of_node[node].value_or(cell.volume)];
            if (is_of_disc(one) != is_of_disc(other))
              throw MeshError(
                "Volumes '" + one + "' and '" + other + "' share nodes, which prevents sliding", where,
                "give disc and pins separate surfaces and nodes at the contact; if both volumes are parts of the disc, give them names "
                "that begin with 'disc_'");
            volume_of_node[node] = cell.volume;
          }
    }
  } // namespace

  void check_parts(const Mesh &mesh, const std::vector<std::string> &additional_surfaces, const std::string &where)
  {
    check_volumes(mesh, where);

    std::vector<std::string> needed = {PhysicalNames::disc_contact, PhysicalNames::pin_contact};
    needed.insert(needed.end(), additional_surfaces.begin(), additional_surfaces.end());
    std::set<std::string> with_faces;
    for (const Mesh::Face &face : mesh.faces)
      with_faces.insert(mesh.surface_names[face.surface]);
    for (const std::string &name : needed)
      if (with_faces.count(name) == 0)
        throw MeshError("Physical surface '" + name + "' is missing or has no faces; the surfaces are: " + list(mesh.surface_names), where,
                        "give this name to a surface (in a plan, to a curve), or correct the name in section Contact, Mounts or Steady "
                        "sliding");

    // Named faces must be outer faces, and standard names must be on the matching bodies
    const std::vector<CellFace> faces = all_faces(mesh);
    for (const Mesh::Face &face : mesh.faces)
      {
        const std::string &name = mesh.surface_names[face.surface];
        const auto         key  = face_key(face);
        const auto         first =
          std::lower_bound(faces.begin(), faces.end(), key, [](const CellFace &other, const auto &wanted) { return other.key < wanted; });
        const auto last = std::find_if(first, faces.end(), [&](const CellFace &other) { return other.key != key; });
        if (last - first != 1)
          throw MeshError("Surface '" + name + "' has a face that is " + (first == last ? "not a face of any element" : "inside a body"),
                          where, "name only outer faces of the disc and the pins");

        const bool on_disc = first->body == 0;
        const bool of_disc = name == PhysicalNames::disc_contact || name == PhysicalNames::disc_bore || name == PhysicalNames::disc_rim;
        const bool of_pin  = name == PhysicalNames::pin_contact || name == PhysicalNames::pin_clamp || name == PhysicalNames::pin_side;
        if ((of_disc && !on_disc) || (of_pin && on_disc))
          throw MeshError("Surface '" + name + "' has a face on '" + mesh.body_names[first->body] + "'", where,
                          "use the names disc_contact, disc_bore and disc_rim on the disc only, and pin_contact, pin_clamp and pin_side on "
                          "pins only");
      }
  }

  void check_bodies(const Mesh &mesh, const std::vector<std::string> &mounted_surfaces, const std::string &where)
  {
    check_connected(mesh, mounted_surfaces, where);

    const std::vector<unsigned int> body_of_node = body_of_nodes(mesh);
    const std::set<unsigned int>    disc         = nodes_by_body(mesh, body_of_node, PhysicalNames::disc_contact)[0];
    const auto                      contacts     = nodes_by_body(mesh, body_of_node, PhysicalNames::pin_contact);
    const auto                      clamps       = nodes_by_body(mesh, body_of_node, PhysicalNames::pin_clamp);
    std::set<unsigned int>          mounted; // bodies with mounts
    for (const std::string &surface : mounted_surfaces)
      {
        const auto nodes   = nodes_by_body(mesh, body_of_node, surface);
        bool       is_free = false;
        for (std::size_t body = 0; body < nodes.size(); ++body)
          {
            if (!nodes[body].empty())
              mounted.insert(body);
            is_free = is_free || !std::includes(clamps[body].begin(), clamps[body].end(), nodes[body].begin(), nodes[body].end());
          }
        if (!is_free)
          throw MeshError(
            "All nodes of '" + surface + "' are clamped by '" + PhysicalNames::pin_clamp +
              "', so that mounts and loads on this surface have no effect",
            where, "remove its faces from 'pin_clamp', or remove its name from section Mounts and from Steady sliding/Pressed faces");
      }
    for (std::size_t pin = 1; pin < mesh.body_names.size(); ++pin)
      {
        const std::string &name = mesh.body_names[pin];
        if (contacts[pin].empty())
          throw MeshError("'" + name + "' has no contact face: none of its faces is on 'pin_contact' or in Contact/Pairs", where,
                          "add its contact face to the physical surface 'pin_contact' or to Contact/Pairs, or remove the volume");
        if (clamps[pin].empty() && mounted.count(pin) == 0)
          throw MeshError(
            "'" + name + "' is not held: it has no face on 'pin_clamp' and no mount", where,
            "add its backplate face to the physical surface 'pin_clamp' or one of its surfaces to Mounts/Elastic mounts, or merge its "
            "nodes with the volume to which it is fixed");
        if (distance(mesh, clamps[pin], disc) < distance(mesh, contacts[pin], disc))
          throw MeshError("The 'pin_clamp' face of '" + name + "' is closer to the contact face of the disc than its 'pin_contact' face",
                          where, "exchange the names 'pin_clamp' and 'pin_contact' on this body");
      }
  }
} // namespace Squeal
