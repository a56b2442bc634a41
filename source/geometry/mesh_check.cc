#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/geometry/mesh_check.h>

#include <boost/algorithm/string/join.hpp>
#include <boost/pending/disjoint_sets.hpp>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace Squeal
{
  namespace
  {
    /// For each corner, the corners at the ends of its edges, as a right-handed triple.
    constexpr unsigned int edges_at_corner[8][3] = {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};

    /// At each corner, the triple product of the three edges that meet there, each divided by its length; 0 where one has none.
    std::array<double, 8> scaled_jacobians(const HexMesh &mesh, const std::array<unsigned int, 8> &nodes)
    {
      std::array<double, 8> result;
      for (unsigned int corner = 0; corner < 8; ++corner)
        {
          dealii::Tensor<2, 3> edges;
          double               lengths = 1.;
          for (unsigned int e = 0; e < 3; ++e)
            {
              edges[e] = mesh.points[nodes[edges_at_corner[corner][e]]] - mesh.points[nodes[corner]];
              lengths *= edges[e].norm();
            }
          result[corner] = lengths > 0. ? determinant(edges) / lengths : 0.;
        }
      return result;
    }

    /// Whether the nodes of two faces, the same, follow each other in the same sense.
    bool turn_alike(const HexFace &a, const HexFace &b)
    {
      const auto first = std::find(b.nodes.begin(), b.nodes.end(), a.nodes[0]) - b.nodes.begin();
      return b.nodes[(first + 1) % 4] == a.nodes[1];
    }

    std::string describe(const HexMesh &mesh, const unsigned int element)
    {
      const HexMesh::Hexahedron &hexahedron = mesh.hexahedra[element];
      HexMesh::Point             centre;
      for (const unsigned int node : hexahedron.nodes)
        centre += mesh.points[node] / 8.;
      return text("element ", mesh.element_tags.empty() ? element : mesh.element_tags[element], " of volume '",
                  mesh.volume_names[hexahedron.volume], "', near (", centre[0], ", ", centre[1], ", ", centre[2], ") m");
    }

    std::string list(const std::vector<std::string> &names)
    {
      return names.empty() ? "(none)" : boost::algorithm::join(names, ", ");
    }

    void check_connected(const HexMesh &mesh, const std::string &where)
    {
      boost::disjoint_sets_with_storage<> sets(mesh.points.size());
      for (const HexMesh::Hexahedron &hexahedron : mesh.hexahedra)
        for (const unsigned int node : hexahedron.nodes)
          sets.union_set(node, hexahedron.nodes[0]);
      std::vector<std::map<std::size_t, std::size_t>> pieces(mesh.volume_names.size()); // elements, by root
      for (const HexMesh::Hexahedron &hexahedron : mesh.hexahedra)
        ++pieces[hexahedron.volume][sets.find_set(hexahedron.nodes[0])];
      for (std::size_t volume = 0; volume < pieces.size(); ++volume)
        if (pieces[volume].size() > 1)
          {
            std::string sizes;
            for (const auto &[root, size] : pieces[volume])
              sizes += (sizes.empty() ? "" : ", ") + std::to_string(size);
            throw MeshError("Volume '" + mesh.volume_names[volume] + "' is in " + std::to_string(pieces[volume].size()) +
                              " pieces that share no node, of " + sizes + " elements",
                            where, "join them (Coherence, BooleanUnion or common curves), or give every pin a physical volume of its own");
          }
    }

    /// Nodes of a named surface, by the volume they belong to.
    std::vector<std::set<unsigned int>> nodes_by_volume(const HexMesh                   &mesh,
                                                        const std::vector<unsigned int> &volume_of_node,
                                                        const std::string               &name)
    {
      std::vector<std::set<unsigned int>> result(mesh.volume_names.size());
      for (const HexMesh::Quadrilateral &quadrilateral : mesh.quadrilaterals)
        if (mesh.surface_names[quadrilateral.surface] == name)
          for (const unsigned int node : quadrilateral.nodes)
            result[volume_of_node[node]].insert(node);
      return result;
    }

    double distance(const HexMesh &mesh, const std::set<unsigned int> &some, const std::set<unsigned int> &others)
    {
      double nearest = std::numeric_limits<double>::infinity();
      for (const unsigned int a : some)
        for (const unsigned int b : others)
          nearest = std::min(nearest, mesh.points[a].distance(mesh.points[b]));
      return nearest;
    }
  } // namespace

  MeshQuality mesh_quality(const HexMesh &mesh)
  {
    if (mesh.hexahedra.empty())
      throw MeshError("The mesh has no elements", "mesh", "check the geometry");

    MeshQuality quality{1., 0, 0};
    for (unsigned int element = 0; element < mesh.hexahedra.size(); ++element)
      {
        const auto   corners         = scaled_jacobians(mesh, mesh.hexahedra[element].nodes);
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

  MeshQuality check_mesh(const HexMesh &mesh)
  {
    const MeshQuality quality = mesh_quality(mesh);
    if (quality.n_bad > 0)
      throw MeshError(text(quality.n_bad, " of ", mesh.hexahedra.size(), quality.n_bad == 1 ? " elements is" : " elements are",
                           " inverted or degenerate; the worst one has scaled Jacobian ", quality.worst_scaled_jacobian, ", at least ",
                           smallest_scaled_jacobian, " is needed"),
                      describe(mesh, quality.worst_element),
                      "change the element size or the number of nodes per pin face; keep pins away from "
                      "edges and from each other, and in a mesh of your own correct these elements");
    return quality;
  }

  unsigned int make_right_handed(HexMesh &mesh)
  {
    std::vector<unsigned int> reordered;
    for (unsigned int element = 0; element < mesh.hexahedra.size(); ++element)
      {
        auto      &nodes   = mesh.hexahedra[element].nodes;
        const auto corners = scaled_jacobians(mesh, nodes);
        if (std::all_of(corners.begin(), corners.end(), [](const double corner) { return corner < 0.; }))
          {
            std::rotate(nodes.begin(), nodes.begin() + 4, nodes.end());
            reordered.push_back(element);
          }
      }
    if (reordered.empty())
      return 0;

    const std::vector<HexFace> faces = all_faces(mesh);
    for (std::size_t i = 0; i + 1 < faces.size(); ++i)
      if (faces[i].key == faces[i + 1].key && turn_alike(faces[i], faces[i + 1]))
        {
          const auto has_face = [&](const unsigned int element) {
            const auto &nodes = mesh.hexahedra[element].nodes;
            return std::all_of(faces[i].key.begin(), faces[i].key.end(),
                               [&](const unsigned int node) { return std::count(nodes.begin(), nodes.end(), node) > 0; });
          };
          const auto element = std::find_if(reordered.begin(), reordered.end(), has_face);
          throw MeshError("An element is inverted: it and its neighbour lie on the same side of their common face",
                          describe(mesh, element == reordered.end() ? reordered[0] : *element),
                          "correct the nodes of this element, or let no two elements overlap");
        }
    return reordered.size();
  }

  void check_parts(const HexMesh &mesh, const std::vector<std::string> &additional_surfaces, const std::string &where)
  {
    // Volumes
    std::vector<std::size_t> n_elements(mesh.volume_names.size(), 0);
    for (const HexMesh::Hexahedron &hexahedron : mesh.hexahedra)
      ++n_elements[hexahedron.volume];
    std::size_t n_pins = 0, n_discs = 0;
    for (std::size_t v = 0; v < mesh.volume_names.size(); ++v)
      {
        if (n_elements[v] == 0)
          throw MeshError("Volume '" + mesh.volume_names[v] + "' has no elements", where, "mesh it with hexahedra, or remove the name");
        ++(mesh.volume_names[v] == PhysicalNames::disc ? n_discs : n_pins);
      }
    if (n_discs == 0 || n_pins == 0)
      throw MeshError(std::string("There is no physical volume '") + (n_discs == 0 ? "disc" : "pin_...") +
                        "', only: " + list(mesh.volume_names),
                      where, "name the disc's volume 'disc' and each pin's or pad's with a name that begins with 'pin_'");

    // Surfaces
    std::vector<std::string> needed = {PhysicalNames::disc_contact, PhysicalNames::pin_contact};
    needed.insert(needed.end(), additional_surfaces.begin(), additional_surfaces.end());
    std::set<std::string> with_faces;
    for (const HexMesh::Quadrilateral &quadrilateral : mesh.quadrilaterals)
      with_faces.insert(mesh.surface_names[quadrilateral.surface]);
    for (const std::string &name : needed)
      if (with_faces.count(name) == 0)
        throw MeshError("There is no face on a physical surface '" + name + "'; the surfaces are: " + list(mesh.surface_names), where,
                        "give the surface this name");

    // Nodes belong to one volume
    const std::vector<unsigned int> volume_of_node = volume_of_nodes(mesh);
    for (const HexMesh::Hexahedron &hexahedron : mesh.hexahedra)
      for (const unsigned int node : hexahedron.nodes)
        if (volume_of_node[node] != hexahedron.volume)
          throw MeshError("Volumes '" + mesh.volume_names[hexahedron.volume] + "' and '" + mesh.volume_names[volume_of_node[node]] +
                            "' share nodes, so nothing could slide",
                          where, "give each volume surfaces and nodes of its own where they touch");

    // Named faces are outer faces of volumes of their kind
    const std::vector<HexFace> faces = all_faces(mesh);
    for (const HexMesh::Quadrilateral &quadrilateral : mesh.quadrilaterals)
      {
        const std::string &name = mesh.surface_names[quadrilateral.surface];
        auto               key  = quadrilateral.nodes;
        std::sort(key.begin(), key.end());
        const auto first =
          std::lower_bound(faces.begin(), faces.end(), key, [](const HexFace &face, const auto &nodes) { return face.key < nodes; });
        const auto last = std::find_if(first, faces.end(), [&](const HexFace &face) { return face.key != key; });
        if (last - first != 1)
          throw MeshError("Surface '" + name + "' has a face that is " +
                            (first == last ? "not a face of any hexahedron" : "inside a volume"),
                          where, "name only outer faces of the disc and the pins");

        const bool on_disc = mesh.volume_names[first->volume] == PhysicalNames::disc;
        const bool of_disc = name == PhysicalNames::disc_contact || name == PhysicalNames::disc_bore || name == PhysicalNames::disc_rim;
        const bool of_pin  = name == PhysicalNames::pin_contact || name == PhysicalNames::pin_clamp || name == PhysicalNames::pin_side;
        if ((of_disc && !on_disc) || (of_pin && on_disc))
          throw MeshError("Surface '" + name + "' has a face on volume '" + mesh.volume_names[first->volume] + "'", where,
                          "put disc_... on the disc and pin_... on pins; perhaps names of disc and pin are exchanged");
      }
  }

  void check_bodies(const HexMesh &mesh, const std::vector<std::string> &mounted_surfaces, const std::string &where)
  {
    check_connected(mesh, where);

    const std::vector<unsigned int> volume_of_node = volume_of_nodes(mesh);
    const std::set<unsigned int>    disc           = nodes_by_volume(mesh, volume_of_node, PhysicalNames::disc_contact)[0];
    const auto                      contacts       = nodes_by_volume(mesh, volume_of_node, PhysicalNames::pin_contact);
    const auto                      clamps         = nodes_by_volume(mesh, volume_of_node, PhysicalNames::pin_clamp);
    std::set<unsigned int>          mounted; // volumes
    for (const std::string &surface : mounted_surfaces)
      {
        const auto nodes   = nodes_by_volume(mesh, volume_of_node, surface);
        bool       is_free = false;
        for (std::size_t volume = 0; volume < nodes.size(); ++volume)
          {
            if (!nodes[volume].empty())
              mounted.insert(volume);
            is_free = is_free || !std::includes(clamps[volume].begin(), clamps[volume].end(), nodes[volume].begin(), nodes[volume].end());
          }
        if (!is_free)
          throw MeshError("All nodes of '" + surface + "', on which Mounts/Elastic mounts puts a mount, are clamped by '" +
                            PhysicalNames::pin_clamp + "'",
                          where, "take the name 'pin_clamp' from these faces, or the mount from Mounts/Elastic mounts");
      }
    for (std::size_t pin = 1; pin < mesh.volume_names.size(); ++pin)
      {
        const std::string &name = mesh.volume_names[pin];
        if (contacts[pin].empty())
          throw MeshError("'" + name + "' has no face on 'pin_contact', so it touches nothing", where,
                          "put its face on the disc into the physical surface 'pin_contact', or leave the volume out");
        if (clamps[pin].empty() && mounted.count(pin) == 0)
          throw MeshError(
            "'" + name + "' has no face on 'pin_clamp', so nothing holds it", where,
            "put its backplate face into the physical surface 'pin_clamp', or one of its surfaces into Mounts/Elastic mounts");
        if (distance(mesh, clamps[pin], disc) < distance(mesh, contacts[pin], disc))
          throw MeshError("'" + name + "' touches the disc with its face on 'pin_clamp', and its face on 'pin_contact' is away from it",
                          where, "exchange the names 'pin_clamp' and 'pin_contact' there");
      }
  }
} // namespace Squeal
