#include <squeal/base/exceptions.h>
#include <squeal/model/curved_boundaries.h>
#include <squeal/model/model.h>

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/grid_tools.h>

#include <boost/algorithm/string/join.hpp>

#include <algorithm>
#include <sstream>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    /// Gmsh numbers the vertices of a quadrilateral around it, deal.II lexicographically.
    constexpr std::array<unsigned int, 8> gmsh_vertex = {{0, 1, 3, 2, 4, 5, 7, 6}};
  } // namespace

  Model::Model(const HexMesh &mesh, const Element element, MPI_Comm communicator)
    : components(mesh.volume_names)
    , surfaces(mesh.surface_names)
    , element_type(element)
    , tria(communicator,
           Triangulation<3>::none,
           false, // every process knows every cell: pairing and output need no exchange
           parallel::shared::Triangulation<3>::partition_metis)
    , fe(FE_Q<3>(degree_of(element)), 3)
    , geometry_mapping(degree_of(element))
    , dofs(tria)
  {
    create_triangulation(mesh);
    if (element == Element::quadratic)
      follow_cylinders(*this, tria);
    distribute_dofs();
  }

  void Model::create_triangulation(const HexMesh &mesh)
  {
    std::vector<Point<3>> vertices = mesh.points;

    std::vector<CellData<3>> cells;
    for (const auto &hexahedron : mesh.hexahedra)
      {
        CellData<3> cell;
        for (unsigned int v = 0; v < 8; ++v)
          cell.vertices[v] = hexahedron.nodes[gmsh_vertex[v]];
        cell.material_id = hexahedron.volume;
        cells.push_back(cell);
      }

    SubCellData faces;
    for (const auto &quadrilateral : mesh.quadrilaterals)
      {
        CellData<2> face;
        for (unsigned int v = 0; v < 4; ++v)
          face.vertices[v] = quadrilateral.nodes[gmsh_vertex[v]];
        face.boundary_id = quadrilateral.surface + 1; // 0: faces without a name
        faces.boundary_quads.push_back(face);
      }

    try
      {
        GridTools::delete_unused_vertices(vertices, cells, faces);
        GridTools::invert_all_negative_measure_cells(vertices, cells);
        GridTools::consistently_order_cells(cells);
        tria.create_triangulation(vertices, cells, faces);
      }
    catch (const ExceptionBase &exception)
      {
        std::ostringstream text;
        exception.print_info(text);
        throw MeshError("deal.II refuses the mesh: " + text.str(), "mesh", "check the orientation and connectivity of the hexahedra");
      }
  }

  void Model::distribute_dofs()
  {
    dofs.distribute_dofs(fe);

    // Clamped dofs: all three directions on the clamped surface
    free_numbers.assign(dofs.n_dofs(), 0);
    for (const auto dof : DoFTools::extract_boundary_dofs(dofs, ComponentMask(), {surface_id(PhysicalNames::pin_clamp)}))
      free_numbers[dof] = -1;

    // Numbers of the others: deal.II's order, so that ownership stays contiguous
    int n_free = 0, n_own = 0;
    for (types::global_dof_index dof = 0; dof < dofs.n_dofs(); ++dof)
      if (free_numbers[dof] == 0)
        {
          free_numbers[dof] = n_free++;
          n_own += dofs.locally_owned_dofs().is_element(dof);
        }
    map = RowMap::contiguous(n_own, communicator());

    // Nodes: the dofs of the three directions at each support point
    constexpr unsigned int               none = -1;
    std::vector<types::global_dof_index> cell_dofs(fe.n_dofs_per_cell());
    std::vector<Point<3>>                support(dofs.n_dofs());
    DoFTools::map_dofs_to_support_points(geometry_mapping, dofs, support);
    dof_nodes.assign(dofs.n_dofs(), none);
    for (const auto &cell : dofs.active_cell_iterators())
      {
        cell->get_dof_indices(cell_dofs);
        for (unsigned int i = 0; i < fe.base_element(0).n_dofs_per_cell(); ++i)
          {
            const auto first = cell_dofs[fe.component_to_system_index(0, i)];
            if (dof_nodes[first] != none)
              continue;
            Node node;
            node.component = cell->material_id();
            for (unsigned int c = 0; c < 3; ++c)
              {
                const auto dof   = cell_dofs[fe.component_to_system_index(c, i)];
                node.dofs[c]     = free_numbers[dof];
                node.position[c] = support[first][c];
                dof_nodes[dof]   = node_table.size();
              }
            node_table.push_back(node);
          }
      }
  }

  const Triangulation<3> &Model::triangulation() const
  {
    return tria;
  }

  const DoFHandler<3> &Model::dof_handler() const
  {
    return dofs;
  }

  const Mapping<3> &Model::mapping() const
  {
    return geometry_mapping;
  }

  Element Model::element() const
  {
    return element_type;
  }

  unsigned int Model::degree() const
  {
    return fe.degree;
  }

  MPI_Comm Model::communicator() const
  {
    return tria.get_communicator();
  }

  const std::vector<std::string> &Model::component_names() const
  {
    return components;
  }

  const std::vector<Node> &Model::nodes() const
  {
    return node_table;
  }

  unsigned int Model::node_of_dof(const types::global_dof_index dof) const
  {
    return dof_nodes[dof];
  }

  types::boundary_id Model::surface_id(const std::string &name) const
  {
    const auto it = std::find(surfaces.begin(), surfaces.end(), name);
    if (it == surfaces.end())
      throw MeshError("the mesh has no surface named `" + name + "`", "mesh",
                      "name such a surface in the geometry, or use one of: " + boost::algorithm::join(surfaces, ", "));
    return it - surfaces.begin() + 1;
  }

  bool Model::has_surface(const std::string &name) const
  {
    return std::find(surfaces.begin(), surfaces.end(), name) != surfaces.end();
  }

  const RowMap &Model::free_map() const
  {
    return map;
  }

  int Model::free_dof(const types::global_dof_index dof) const
  {
    return free_numbers[dof];
  }

  unsigned int Model::n_dofs() const
  {
    return dofs.n_dofs();
  }
} // namespace Squeal
