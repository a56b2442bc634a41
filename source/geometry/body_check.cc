#include <squeal/base/exceptions.h>
#include <squeal/geometry/mesh_check.h>

#include <boost/pending/disjoint_sets.hpp>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace Squeal
{
  namespace
  {
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

  void check_bodies(const HexMesh &mesh, const std::vector<std::string> &mounted_surfaces, const std::string &where)
  {
    check_connected(mesh, where);

    const std::vector<unsigned int> volume_of_node = volume_of_nodes(mesh);
    const std::set<unsigned int>    disc           = nodes_by_volume(mesh, volume_of_node, PhysicalNames::disc_contact)[0];
    const auto                      contacts       = nodes_by_volume(mesh, volume_of_node, PhysicalNames::pin_contact);
    const auto                      clamps         = nodes_by_volume(mesh, volume_of_node, PhysicalNames::pin_clamp);
    std::vector<bool>               is_held(mesh.volume_names.size(), false);
    for (const std::string &surface : mounted_surfaces)
      {
        const auto mounted = nodes_by_volume(mesh, volume_of_node, surface);
        for (std::size_t volume = 0; volume < mounted.size(); ++volume)
          is_held[volume] = is_held[volume] || !mounted[volume].empty();
      }
    for (std::size_t pin = 1; pin < mesh.volume_names.size(); ++pin)
      {
        const std::string &name = mesh.volume_names[pin];
        if (contacts[pin].empty())
          throw MeshError("'" + name + "' has no face on 'pin_contact', so it touches nothing", where,
                          "put its face on the disc into the physical surface 'pin_contact', or leave the volume out");
        if (clamps[pin].empty() && !is_held[pin])
          throw MeshError(
            "'" + name + "' has no face on 'pin_clamp', so nothing holds it", where,
            "put its backplate face into the physical surface 'pin_clamp', or one of its surfaces into Mounts/Elastic mounts");
        if (distance(mesh, clamps[pin], disc) < distance(mesh, contacts[pin], disc))
          throw MeshError("'" + name + "' touches the disc with its face on 'pin_clamp', and its face on 'pin_contact' is away from it",
                          where, "exchange the names 'pin_clamp' and 'pin_contact' there");
      }
  }
} // namespace Squeal
