#include <squeal/base/exceptions.h>
#include <squeal/base/file_writing.h>
#include <squeal/geometry/gmsh_session.h>
#include <squeal/geometry/mesh_file.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <unistd.h>

namespace Squeal
{
  namespace
  {
    constexpr unsigned int no_node = static_cast<unsigned int>(-1);

    const std::vector<std::string> known_surfaces = {PhysicalNames::disc_contact, PhysicalNames::pin_contact, PhysicalNames::pin_clamp,
                                                     PhysicalNames::pin_side,     PhysicalNames::disc_bore,   PhysicalNames::disc_rim};

    void check_type(const GmshMesh::Group &group, const std::string &wanted, const std::string &where)
    {
      for (const GmshMesh::Block &block : group.blocks)
        if (block.type != wanted)
          throw MeshError("'" + group.name + "' has " + std::to_string(block.tags.size()) + " elements of type '" + block.type + "'", where,
                          "mesh it with elements of type '" + wanted + "' only");
    }
  } // namespace

  HexMesh make_hex_mesh(const GmshMesh &mesh, const std::vector<std::string> &additional_surfaces, const std::string &where)
  {
    HexMesh result;

    // Volumes, the disc first
    if (mesh.n_unnamed_volume_elements > 0)
      throw MeshError(std::to_string(mesh.n_unnamed_volume_elements) + " volume elements belong to no physical volume", where,
                      "name every volume that is meshed 'disc' or 'pin_...'");
    std::vector<const GmshMesh::Group *> volumes, surfaces;
    for (const GmshMesh::Group &group : mesh.groups)
      if (group.dimension == 3)
        {
          const bool is_disc = group.name == PhysicalNames::disc;
          if (!is_disc && group.name.rfind(PhysicalNames::pin_prefix, 0) != 0)
            throw MeshError("There is a physical volume '" + group.name + "'", where, "known names of volumes: disc, pin_...");
          check_type(group, "Hexahedron 8", where);
          volumes.insert(is_disc ? volumes.begin() : volumes.end(), &group);
        }

    // Surfaces
    for (const GmshMesh::Group &group : mesh.groups)
      if (group.dimension == 2)
        {
          if (std::find(known_surfaces.begin(), known_surfaces.end(), group.name) == known_surfaces.end() &&
              std::find(additional_surfaces.begin(), additional_surfaces.end(), group.name) == additional_surfaces.end())
            {
              std::string known;
              for (const std::vector<std::string> &names : {known_surfaces, additional_surfaces})
                for (const std::string &name : names)
                  known += (known.empty() ? "" : ", ") + name;
              throw MeshError("There is a physical surface '" + group.name + "' that nothing uses", where,
                              "known names of surfaces: " + known);
            }
          check_type(group, "Quadrilateral 4", where);
          surfaces.push_back(&group);
        }

    // Hexahedra
    std::vector<bool>                                        used(mesh.points.size(), false);
    std::vector<std::pair<std::size_t, HexMesh::Hexahedron>> tagged_hexahedra;
    for (const GmshMesh::Group *group : volumes)
      {
        for (const GmshMesh::Block &block : group->blocks)
          for (std::size_t i = 0; i < block.tags.size(); ++i)
            {
              HexMesh::Hexahedron hexahedron;
              std::copy_n(block.nodes.begin() + 8 * i, 8, hexahedron.nodes.begin());
              hexahedron.volume = result.volume_names.size();
              for (const unsigned int node : hexahedron.nodes)
                used[node] = true;
              tagged_hexahedra.emplace_back(block.tags[i], hexahedron);
            }
        result.volume_names.push_back(group->name);
      }
    // A stable order by tag restores the order in which write_msh() wrote them.
    const auto by_tag = [](const auto &a, const auto &b) { return a.first < b.first; };
    std::stable_sort(tagged_hexahedra.begin(), tagged_hexahedra.end(), by_tag);
    for (std::size_t i = 0; i < tagged_hexahedra.size(); ++i)
      {
        if (i > 0 && tagged_hexahedra[i].first == tagged_hexahedra[i - 1].first)
          throw MeshError("A hexahedron belongs to '" + result.volume_names[tagged_hexahedra[i - 1].second.volume] + "' and to '" +
                            result.volume_names[tagged_hexahedra[i].second.volume] + "'",
                          where, "put every volume into one physical group");
        result.hexahedra.push_back(tagged_hexahedra[i].second);
      }

    // Their nodes
    std::vector<unsigned int> new_index(mesh.points.size(), no_node);
    for (std::size_t node = 0; node < used.size(); ++node)
      if (used[node])
        {
          new_index[node] = result.points.size();
          result.points.push_back(mesh.points[node]);
        }
    for (HexMesh::Hexahedron &hexahedron : result.hexahedra)
      for (unsigned int &node : hexahedron.nodes)
        node = new_index[node];

    // Named faces
    std::vector<std::pair<std::size_t, HexMesh::Quadrilateral>> tagged_quadrilaterals;
    for (const GmshMesh::Group *group : surfaces)
      {
        for (const GmshMesh::Block &block : group->blocks)
          for (std::size_t i = 0; i < block.tags.size(); ++i)
            {
              HexMesh::Quadrilateral quadrilateral;
              for (unsigned int v = 0; v < 4; ++v)
                {
                  quadrilateral.nodes[v] = new_index[block.nodes[4 * i + v]];
                  if (quadrilateral.nodes[v] == no_node)
                    throw MeshError("Surface '" + group->name + "' has a face that is not a face of any hexahedron", where,
                                    "name only outer faces of the disc and the pins");
                }
              quadrilateral.surface = result.surface_names.size();
              tagged_quadrilaterals.emplace_back(block.tags[i], quadrilateral);
            }
        result.surface_names.push_back(group->name);
      }
    std::stable_sort(tagged_quadrilaterals.begin(), tagged_quadrilaterals.end(), by_tag);
    for (const auto &[tag, quadrilateral] : tagged_quadrilaterals)
      result.quadrilaterals.push_back(quadrilateral);
    return result;
  }

  void write_msh(const HexMesh &mesh, const std::string &file)
  {
    // One group for each name; elements carry their index, so that their order is kept
    GmshMesh gmsh_mesh;
    gmsh_mesh.points                    = mesh.points;
    gmsh_mesh.n_unnamed_volume_elements = 0;
    for (const std::string &name : mesh.surface_names)
      gmsh_mesh.groups.push_back({2, name, {{"Quadrilateral 4", 4, {}, {}}}});
    for (const std::string &name : mesh.volume_names)
      gmsh_mesh.groups.push_back({3, name, {{"Hexahedron 8", 8, {}, {}}}});

    std::size_t tag = 0;
    const auto  add = [&tag](GmshMesh::Group &group, const auto &nodes) {
      group.blocks[0].tags.push_back(++tag);
      group.blocks[0].nodes.insert(group.blocks[0].nodes.end(), nodes.begin(), nodes.end());
    };
    for (const HexMesh::Hexahedron &hexahedron : mesh.hexahedra)
      add(gmsh_mesh.groups[mesh.surface_names.size() + hexahedron.volume], hexahedron.nodes);
    for (const HexMesh::Quadrilateral &quadrilateral : mesh.quadrilaterals)
      add(gmsh_mesh.groups[quadrilateral.surface], quadrilateral.nodes);

    // Gmsh chooses the format by the name, so the temporary name ends in .msh
    const std::string temporary = file + "." + std::to_string(::getpid()) + ".part.msh";
    std::error_code   failure;
    if (!std::ofstream(temporary))
      throw FileError("The mesh could not be written", file, "check that the directory exists and is writable");
    try
      {
        GmshSession session;
        session.load(gmsh_mesh);
        session.write(temporary);
      }
    catch (const GmshError &error)
      {
        std::filesystem::remove(temporary, failure);
        throw FileError(error.what(), file, "check free space");
      }
    // Gmsh does not tell whether there was room for the file.
    if (!file_ends_with(temporary, "$EndElements"))
      {
        std::filesystem::remove(temporary, failure);
        throw FileError("The mesh could not be written to its end", file, "check free space");
      }
    std::filesystem::rename(temporary, file, failure);
    if (failure)
      {
        const std::string reason = failure.message();
        std::filesystem::remove(temporary, failure);
        throw FileError("The mesh could not be moved to its place: " + reason, file, "check that nothing else has this name");
      }
  }
} // namespace Squeal
