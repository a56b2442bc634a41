// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/geometry/mesh_file.h>
#include <squeal/geometry/second_order.h>
#include <squeal/parameters/materials.h>

#include <deal.II/base/bounding_box.h>

#include <boost/algorithm/string/join.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <ostream>
#include <sstream>

namespace Squeal
{
  namespace
  {
    constexpr unsigned int not_numbered = static_cast<unsigned int>(-1);

    struct ElementType
    {
      const char  *name;
      int          number; ///< number of the type in a .msh file
      Shape        shape;
      unsigned int degree;
      bool         is_complete = true; ///< false for serendipity elements, which have no nodes inside faces and cells
    };

    constexpr ElementType element_types[] = {{"Triangle 3", 2, Shape::triangle, 1},
                                             {"Quadrilateral 4", 3, Shape::quadrilateral, 1},
                                             {"Tetrahedron 4", 4, Shape::tetrahedron, 1},
                                             {"Hexahedron 8", 5, Shape::hexahedron, 1},
                                             {"Prism 6", 6, Shape::wedge, 1},
                                             {"Pyramid 5", 7, Shape::pyramid, 1},
                                             {"Triangle 6", 9, Shape::triangle, 2},
                                             {"Quadrilateral 9", 10, Shape::quadrilateral, 2},
                                             {"Tetrahedron 10", 11, Shape::tetrahedron, 2},
                                             {"Hexahedron 27", 12, Shape::hexahedron, 2},
                                             {"Prism 18", 13, Shape::wedge, 2},
                                             {"Pyramid 14", 14, Shape::pyramid, 2},
                                             {"Quadrilateral 8", 16, Shape::quadrilateral, 2, false},
                                             {"Hexahedron 20", 17, Shape::hexahedron, 2, false},
                                             {"Prism 15", 18, Shape::wedge, 2, false},
                                             {"Pyramid 13", 19, Shape::pyramid, 2, false}};

    struct GroupElement
    {
      const ElementType *type;
      Mesh::Nodes        nodes;
      unsigned int       group;
    };

    /// Elements by tag; write_msh() uses tags in the order of the mesh.
    using TaggedElements = std::multimap<std::size_t, GroupElement>;

    void add_group(TaggedElements &all, const GmshMesh::Group &group, std::vector<std::string> &names, const std::string &where)
    {
      for (const auto &[name, elements] : group.elements)
        {
          const auto type = std::find_if(std::begin(element_types), std::end(element_types),
                                         [&, &wanted = name](const ElementType &known) { return known.name == wanted; });
          if (type == std::end(element_types))
            throw MeshError("'" + group.name + "' has elements of the unsupported type '" + name +
                              "' (number: " + std::to_string(elements.size()) + ")",
                            where, "mesh the volumes with tetrahedra, pyramids, prisms or hexahedra of first or second order");
          for (const GmshMesh::Element &element : elements)
            all.emplace(element.tag, GroupElement{type, Mesh::Nodes(element.nodes.begin(), element.nodes.end()),
                                                  static_cast<unsigned int>(names.size())});
        }
      names.push_back(group.name);
    }

    /// Groups of volumes, the disc first.
    std::vector<const GmshMesh::Group *> volumes(const GmshMesh &mesh)
    {
      std::vector<const GmshMesh::Group *> result;
      for (const GmshMesh::Group &group : mesh.groups)
        if (group.dimension == 3)
          result.push_back(&group);
      std::stable_partition(result.begin(), result.end(), [](const GmshMesh::Group *group) { return is_of_disc(group->name); });
      return result;
    }

    void add_surfaces(TaggedElements                 &all,
                      const GmshMesh                 &mesh,
                      const std::vector<std::string> &additional_surfaces,
                      std::vector<std::string>       &names,
                      const std::string              &where)
    {
      std::vector<std::string> known = {PhysicalNames::disc_contact, PhysicalNames::pin_contact, PhysicalNames::pin_clamp,
                                        PhysicalNames::pin_side,     PhysicalNames::disc_bore,   PhysicalNames::disc_rim};
      for (const std::string &name : additional_surfaces)
        if (std::find(known.begin(), known.end(), name) == known.end())
          known.push_back(name);
      for (const GmshMesh::Group &group : mesh.groups)
        if (group.dimension == 2)
          {
            if (std::find(known.begin(), known.end(), group.name) == known.end())
              throw MeshError(
                "Physical surface '" + group.name + "' is not used", where,
                "add it to Contact/Pairs, Contact/Tied or Mounts/Elastic mounts, or remove this physical surface; known names: " +
                  boost::algorithm::join(known, ", "));
            add_group(all, group, names, where);
          }
    }

    unsigned int common_degree(const TaggedElements &cells, const TaggedElements &faces, const std::string &where)
    {
      const ElementType *first = nullptr;
      for (const TaggedElements *elements : {&cells, &faces})
        for (const auto &[tag, element] : *elements)
          {
            first = first == nullptr ? element.type : first;
            if (element.type->degree != first->degree)
              throw MeshError(std::string("The mesh has elements of different orders: '") + first->name + "' and '" + element.type->name +
                                "'",
                              where, "mesh all volumes and surfaces with elements of the same order (in Gmsh: Mesh.ElementOrder)");
          }
      return first == nullptr ? 1 : first->degree;
    }

    /// Renumbers the nodes of cells in the order of Gmsh's node tags and updates the cells; returns the new numbers.
    std::vector<unsigned int> number_nodes(TaggedElements           &cells,
                                           const GmshMesh           &mesh,
                                           std::vector<Mesh::Point> &points,
                                           const std::string        &where)
    {
      std::vector<unsigned int> new_index(mesh.points.size(), not_numbered);
      for (const auto &[tag, cell] : cells)
        for (const unsigned int node : cell.nodes)
          new_index[node] = 0;
      for (std::size_t node = 0; node < new_index.size(); ++node)
        if (new_index[node] != not_numbered)
          {
            new_index[node] = points.size();
            points.emplace_back(mesh.points[node][0], mesh.points[node][1], mesh.points[node][2]);
            if (!std::isfinite(points.back().norm()))
              throw MeshError("A node has a coordinate that is not a finite number", where,
                              "correct the geometry or export the mesh again");
          }
      for (auto &[tag, cell] : cells)
        for (unsigned int &node : cell.nodes)
          node = new_index[node];
      return new_index;
    }
  } // namespace

  Mesh make_mesh(const GmshMesh &gmsh, const std::vector<std::string> &additional_surfaces, const std::string &where)
  {
    if (gmsh.n_unnamed_volume_elements > 0)
      throw MeshError("Volume elements without a physical volume: " + std::to_string(gmsh.n_unnamed_volume_elements), where,
                      "assign every meshed volume to a physical volume: the disc to 'disc', other bodies to any other name");
    Mesh           result;
    TaggedElements cells, faces;
    for (const GmshMesh::Group *group : volumes(gmsh))
      add_group(cells, *group, result.volume_names, where);
    add_surfaces(faces, gmsh, additional_surfaces, result.surface_names, where);
    result.degree                             = common_degree(cells, faces, where);
    const std::vector<unsigned int> new_index = number_nodes(cells, gmsh, result.points, where);

    for (const auto &[tag, cell] : cells)
      {
        if (const unsigned int first = cells.lower_bound(tag)->second.group; first != cell.group)
          throw MeshError(
            "An element belongs to physical volumes '" + result.volume_names[first] + "' and '" + result.volume_names[cell.group] + "'",
            where, "assign every volume to one physical group; in a mesh file, use a separate elementary tag (entity) for each group");
        result.cells.push_back({cell.type->shape, cell.nodes, cell.group});
        result.element_tags.push_back(tag);
      }
    for (auto &[tag, face] : faces)
      {
        if (const Topology &parts = topology(face.type->shape); result.degree == 2)
          face.nodes.resize(parts.corners.size() + parts.edges.size()); // drop centre nodes, which serendipity cells lack
        for (unsigned int &node : face.nodes)
          if ((node = new_index[node]) == not_numbered)
            throw MeshError("Surface '" + result.surface_names[face.group] + "' has a face that is not a face of any element", where,
                            "name only outer faces of the disc and the pins");
        result.faces.push_back({face.type->shape, face.nodes, face.group});
      }
    if (const std::size_t n = result.degree == 2 ? add_centres(result) : 0; n > 0)
      result.notes.push_back("nodes added at the centres of faces and cells: " + std::to_string(n) +
                             "; serendipity elements are treated as full quadratic elements");
    find_bodies(result);
    return result;
  }

  void write_msh(const Mesh &mesh, std::ostream &stream)
  {
    const std::size_t n_surfaces = mesh.surface_names.size(), n_volumes = mesh.volume_names.size();
    const std::size_t n_nodes = mesh.points.size(), n_elements = mesh.cells.size() + mesh.faces.size();
    stream.precision(std::numeric_limits<double>::max_digits10);

    // One entity for each physical name, with the same number
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

    std::vector<unsigned int> volumes(n_nodes, 0);
    for (const Mesh::Cell &cell : mesh.cells)
      for (const unsigned int node : cell.nodes)
        volumes[node] = cell.volume;
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

    // Element tags are indices in the mesh, which preserve the order of the elements
    struct Block
    {
      std::size_t n_elements = 0;
      std::string lines;
    };
    std::map<std::array<std::size_t, 3>, Block> blocks; // blocks of elements by dimension, entity and type
    const auto add_element = [&](const int dimension, const std::size_t tag, const Shape shape, const Mesh::Nodes &nodes,
                                 const std::size_t part) {
      const auto type  = std::find_if(std::begin(element_types), std::end(element_types), [&](const ElementType &known) {
        return known.shape == shape && known.degree == mesh.degree && known.is_complete;
      });
      auto &[n, lines] = blocks[{{static_cast<std::size_t>(dimension), part + 1, static_cast<std::size_t>(type->number)}}];
      lines += std::to_string(tag);
      for (const unsigned int node : nodes)
        lines += ' ' + std::to_string(node + 1);
      lines += '\n';
      ++n;
    };
    for (std::size_t c = 0; c < mesh.cells.size(); ++c)
      add_element(3, c + 1, mesh.cells[c].shape, mesh.cells[c].nodes, mesh.cells[c].volume);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
      add_element(2, mesh.cells.size() + f + 1, mesh.faces[f].shape, mesh.faces[f].nodes, mesh.faces[f].surface);
    stream << "$Elements\n" << blocks.size() << ' ' << n_elements << " 1 " << n_elements << '\n';
    for (const auto &[of, block] : blocks)
      stream << of[0] << ' ' << of[1] << ' ' << of[2] << ' ' << block.n_elements << '\n' << block.lines;
    stream << "$EndElements\n";
  }
} // namespace Squeal
