#include <squeal/base/exceptions.h>
#include <squeal/geometry/mesh_file.h>

#include <deal.II/base/bounding_box.h>

#include <boost/algorithm/string/join.hpp>
#include <boost/algorithm/string/predicate.hpp>

#include <algorithm>
#include <limits>
#include <map>
#include <ostream>
#include <sstream>

namespace Squeal
{
  namespace
  {
    constexpr unsigned int not_numbered = static_cast<unsigned int>(-1);

    /// Elements of the groups of one dimension by their tags, which write_msh() gives in the order of the mesh: nodes and index of the group.
    template <std::size_t n_nodes>
    using TaggedElements = std::multimap<std::size_t, std::pair<std::array<unsigned int, n_nodes>, unsigned int>>;

    /// Adds the elements of a group, which all have to be of one type.
    template <std::size_t n_nodes>
    void add_group(TaggedElements<n_nodes>  &all,
                   const GmshMesh::Group    &group,
                   std::vector<std::string> &names,
                   const std::string        &wanted,
                   const std::string        &where)
    {
      for (const auto &[type, elements] : group.elements)
        {
          if (type != wanted)
            throw MeshError("'" + group.name + "' has " + std::to_string(elements.size()) + " elements of type '" + type + "'", where,
                            "mesh it with elements of type '" + wanted + "' only");
          for (const GmshMesh::Element &element : elements)
            {
              const auto added = all.emplace(element.tag, std::make_pair(std::array<unsigned int, n_nodes>(), names.size()));
              std::copy_n(element.nodes.begin(), n_nodes, added->second.first.begin());
            }
        }
      names.push_back(group.name);
    }

    /// Groups of volumes, the disc first.
    std::vector<const GmshMesh::Group *> volumes(const GmshMesh &mesh, const std::string &where)
    {
      std::vector<const GmshMesh::Group *> result;
      for (const GmshMesh::Group &group : mesh.groups)
        if (group.dimension == 3)
          {
            const bool is_disc = group.name == PhysicalNames::disc;
            if (!is_disc && !boost::starts_with(group.name, PhysicalNames::pin_prefix))
              throw MeshError("There is a physical volume '" + group.name + "'", where, "known names of volumes: disc, pin_...");
            result.insert(is_disc ? result.begin() : result.end(), &group);
          }
      return result;
    }
  } // namespace

  HexMesh make_hex_mesh(const GmshMesh &mesh, const std::vector<std::string> &additional_surfaces, const std::string &where)
  {
    if (mesh.n_unnamed_volume_elements > 0)
      throw MeshError(std::to_string(mesh.n_unnamed_volume_elements) + " volume elements belong to no physical volume", where,
                      "name every volume that is meshed 'disc' or 'pin_...'");
    HexMesh           result;
    TaggedElements<8> hexahedra;
    for (const GmshMesh::Group *group : volumes(mesh, where))
      add_group(hexahedra, *group, result.volume_names, "Hexahedron 8", where);

    std::vector<std::string> known = {PhysicalNames::disc_contact, PhysicalNames::pin_contact, PhysicalNames::pin_clamp,
                                      PhysicalNames::pin_side,     PhysicalNames::disc_bore,   PhysicalNames::disc_rim};
    known.insert(known.end(), additional_surfaces.begin(), additional_surfaces.end());
    TaggedElements<4> quadrilaterals;
    for (const GmshMesh::Group &group : mesh.groups)
      if (group.dimension == 2)
        {
          if (std::find(known.begin(), known.end(), group.name) == known.end())
            throw MeshError("There is a physical surface '" + group.name + "' that nothing uses", where,
                            "known names of surfaces: " + boost::algorithm::join(known, ", "));
          add_group(quadrilaterals, group, result.surface_names, "Quadrilateral 4", where);
        }

    // Nodes of the hexahedra in the order of Gmsh's
    std::vector<unsigned int> new_index(mesh.points.size(), not_numbered);
    for (const auto &[tag, hexahedron] : hexahedra)
      for (const unsigned int node : hexahedron.first)
        new_index[node] = 0;
    for (std::size_t node = 0; node < new_index.size(); ++node)
      if (new_index[node] != not_numbered)
        {
          new_index[node] = result.points.size();
          result.points.emplace_back(mesh.points[node][0], mesh.points[node][1], mesh.points[node][2]);
        }

    for (auto &[tag, hexahedron] : hexahedra)
      {
        auto &[nodes, volume] = hexahedron;
        if (const auto first = hexahedra.lower_bound(tag)->second.second; first != volume)
          throw MeshError(
            "A hexahedron belongs to physical volumes '" + result.volume_names[first] + "' and '" + result.volume_names[volume] + "'",
            where, "put every volume into one physical group; in a mesh file, let each group have an elementary tag (entity) of its own");
        for (unsigned int &node : nodes)
          node = new_index[node];
        result.hexahedra.push_back({nodes, volume});
        result.element_tags.push_back(tag);
      }
    for (auto &[tag, quadrilateral] : quadrilaterals)
      {
        auto &[nodes, surface] = quadrilateral;
        for (unsigned int &node : nodes)
          if ((node = new_index[node]) == not_numbered)
            throw MeshError("Surface '" + result.surface_names[surface] + "' has a face that is not a face of any hexahedron", where,
                            "name only outer faces of the disc and the pins");
        result.quadrilaterals.push_back({nodes, surface});
      }
    return result;
  }

  void write_msh(const HexMesh &mesh, std::ostream &stream)
  {
    const std::size_t n_surfaces = mesh.surface_names.size(), n_volumes = mesh.volume_names.size();
    const std::size_t n_nodes = mesh.points.size(), n_hexahedra = mesh.hexahedra.size(),
                      n_elements = n_hexahedra + mesh.quadrilaterals.size();
    stream.precision(std::numeric_limits<double>::max_digits10);

    // One entity for each name, with the same number
    std::ostringstream names, entities;
    entities.precision(stream.precision());
    const auto box      = dealii::BoundingBox<3>(mesh.points).get_boundary_points();
    const auto add_part = [&](const int dimension, const std::size_t tag, const std::string &name) {
      names << dimension << ' ' << tag << " \"" << name << "\"\n";
      entities << tag << ' ' << box.first << ' ' << box.second << " 1 " << tag << " 0\n";
    };
    for (std::size_t s = 0; s < n_surfaces; ++s)
      add_part(2, s + 1, mesh.surface_names[s]);
    for (std::size_t v = 0; v < n_volumes; ++v)
      add_part(3, v + 1, mesh.volume_names[v]);
    stream << "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
    stream << "$PhysicalNames\n" << n_surfaces + n_volumes << '\n' << names.str() << "$EndPhysicalNames\n";
    stream << "$Entities\n0 0 " << n_surfaces << ' ' << n_volumes << '\n' << entities.str() << "$EndEntities\n";

    const std::vector<unsigned int> volumes = volume_of_nodes(mesh);
    stream << "$Nodes\n" << n_volumes << ' ' << n_nodes << " 1 " << n_nodes << '\n';
    for (std::size_t v = 0; v < n_volumes; ++v)
      {
        stream << "3 " << v + 1 << " 0 " << std::count(volumes.begin(), volumes.end(), v) << '\n';
        for (std::size_t node = 0; node < n_nodes; ++node)
          if (volumes[node] == v)
            stream << node + 1 << '\n';
        for (std::size_t node = 0; node < n_nodes; ++node)
          if (volumes[node] == v)
            stream << mesh.points[node] << '\n';
      }
    stream << "$EndNodes\n";

    // Elements carry their index, so that their order is kept
    const auto write_blocks = [&stream](const int dimension, const int type, const std::size_t n_blocks, const auto &elements,
                                        std::size_t tag) {
      std::vector<std::string> blocks(n_blocks);
      std::vector<std::size_t> n_elements(n_blocks, 0);
      for (const auto &[nodes, part] : elements)
        {
          blocks[part] += std::to_string(tag++);
          for (const unsigned int node : nodes)
            blocks[part] += ' ' + std::to_string(node + 1);
          blocks[part] += '\n';
          ++n_elements[part];
        }
      for (std::size_t block = 0; block < n_blocks; ++block)
        stream << dimension << ' ' << block + 1 << ' ' << type << ' ' << n_elements[block] << '\n' << blocks[block];
    };
    stream << "$Elements\n" << n_surfaces + n_volumes << ' ' << n_elements << " 1 " << n_elements << '\n';
    write_blocks(2, 3, n_surfaces, mesh.quadrilaterals, n_hexahedra + 1);
    write_blocks(3, 5, n_volumes, mesh.hexahedra, 1);
    stream << "$EndElements\n";
  }
} // namespace Squeal
