#include <squeal/base/exceptions.h>
#include <squeal/model/curved_boundaries.h>
#include <squeal/model/model.h>

#include <deal.II/base/index_set.h>
#include <deal.II/base/mpi.h>
#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold_lib.h>
#include <deal.II/grid/tria_description.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <boost/algorithm/string/join.hpp>
#include <boost/serialization/set.hpp>
#include <boost/serialization/vector.hpp>

#include <algorithm>
#include <limits>
#include <map>
#include <sstream>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    using Description = TriangulationDescription::Description<3, 3>;

    /// The hexahedra of all bodies with what deal.II needs to know of them.
    struct CellLists
    {
      std::vector<Point<3>>    vertices;
      std::vector<CellData<3>> cells; ///< with their material ids
      SubCellData              faces; ///< named surfaces, by boundary id
    };

    /// Gmsh numbers the vertices of a quadrilateral around it, deal.II lexicographically.
    constexpr std::array<unsigned int, 8> gmsh_vertex = {{0, 1, 3, 2, 4, 5, 7, 6}};

    CellLists cell_lists(const HexMesh &mesh)
    {
      CellLists lists;
      lists.vertices = mesh.points;
      for (const auto &hexahedron : mesh.hexahedra)
        {
          CellData<3> cell;
          for (unsigned int v = 0; v < 8; ++v)
            cell.vertices[v] = hexahedron.nodes[gmsh_vertex[v]];
          cell.material_id = hexahedron.volume;
          lists.cells.push_back(cell);
        }
      return lists;
    }

    /// Adds the named faces, each once, with a boundary id for its combination of names; returns the ids of every surface.
    std::vector<std::set<unsigned int>> add_faces(const HexMesh &mesh, CellLists &lists)
    {
      std::map<std::array<unsigned int, 4>, std::pair<const HexMesh::Quadrilateral *, std::set<unsigned int>>> faces; // with all names
      for (const HexMesh::Quadrilateral &quadrilateral : mesh.quadrilaterals)
        {
          auto key = quadrilateral.nodes;
          std::sort(key.begin(), key.end());
          auto &[face, names] = faces[key];
          face                = &quadrilateral;
          names.insert(quadrilateral.surface);
        }
      std::map<std::set<unsigned int>, types::boundary_id> combinations;
      std::vector<std::set<unsigned int>>                  ids(mesh.surface_names.size());
      for (const auto &[key, entry] : faces)
        {
          const auto &[quadrilateral, names] = entry;
          CellData<2> face;
          for (unsigned int v = 0; v < 4; ++v)
            face.vertices[v] = quadrilateral->nodes[gmsh_vertex[v]];
          face.boundary_id = combinations.emplace(names, combinations.size() + 1).first->second; // 0: faces without a name
          lists.faces.boundary_quads.push_back(face);
          for (const unsigned int name : names)
            ids[name].insert(face.boundary_id);
        }
      return ids;
    }

    /// Does what may fail on one process; then all throw.
    template <typename Function>
    void together(const MPI_Comm communicator, const Function &action)
    {
      std::string problem;
      try
        {
          action();
        }
      catch (const ExceptionBase &exception)
        {
          std::ostringstream text;
          exception.print_info(text);
          problem = text.str().empty() ? "no reason is given" : text.str();
        }
      for (const std::string &text : Utilities::MPI::all_gather(communicator, problem))
        if (!text.empty())
          throw MeshError("deal.II refuses the mesh: " + text, "mesh", "check the orientation and connectivity of the hexahedra");
    }

    void send(const int process, const Description &part, const MPI_Comm communicator)
    {
      const std::vector<char> buffer = Utilities::pack(part, false);
      const unsigned long     size   = buffer.size();
      AssertThrow(size <= static_cast<unsigned long>(std::numeric_limits<int>::max()), ExcMessage("a part is too large for a message"));
      MPI_Send(&size, 1, MPI_UNSIGNED_LONG, process, 0, communicator);
      MPI_Send(buffer.data(), static_cast<int>(size), MPI_CHAR, process, 0, communicator);
    }

    Description receive(const MPI_Comm communicator)
    {
      unsigned long size;
      MPI_Recv(&size, 1, MPI_UNSIGNED_LONG, 0, 0, communicator, MPI_STATUS_IGNORE);
      std::vector<char> buffer(size);
      MPI_Recv(buffer.data(), static_cast<int>(size), MPI_CHAR, 0, 0, communicator, MPI_STATUS_IGNORE);
      auto part = Utilities::unpack<Description>(buffer, false);
      part.comm = communicator;
      return part;
    }

    /// A number, up to 2^53, for each dof of the cells that this process has, from the processes that own them.
    using DofNumbers = LinearAlgebra::distributed::Vector<double>;
  } // namespace

  struct Model::Discretisation
  {
    Discretisation(const unsigned int degree, const MPI_Comm communicator)
      : triangulation(communicator)
      , fe(FE_Q<3>(degree), 3)
      , mapping(degree)
      , dofs(triangulation)
    {}

    parallel::fullydistributed::Triangulation<3> triangulation;
    FESystem<3>                                  fe;
    MappingQ<3>                                  mapping;
    DoFHandler<3>                                dofs;
    IndexSet                                     relevant; ///< dofs of the cells that this process has
  };

  Model::Model(const HexMesh &mesh, const Element element, MPI_Comm communicator)
    : components(mesh.volume_names)
    , surfaces(mesh.surface_names)
    , element_type(element)
    , processes(communicator)
    , discretisation(std::make_unique<Discretisation>(degree_of(element), communicator))
  {
    create_triangulation(mesh);
    discretisation->dofs.distribute_dofs(discretisation->fe);
    DoFTools::extract_locally_relevant_dofs(discretisation->dofs, discretisation->relevant);
    number_free_dofs();
    find_nodes();
  }

  Model::~Model() = default;

  const DoFHandler<3> &Model::dof_handler() const
  {
    return discretisation->dofs;
  }

  const Mapping<3> &Model::mapping() const
  {
    return discretisation->mapping;
  }

  unsigned int Model::n_dofs() const
  {
    return discretisation->dofs.n_dofs();
  }

  void Model::create_triangulation(const HexMesh &mesh)
  {
    const unsigned int n_processes = Utilities::MPI::n_mpi_processes(communicator());
    const bool         is_root     = Utilities::MPI::this_mpi_process(communicator()) == 0;

    // Process 0 alone has all cells, and of the parts of other processes one at a time
    std::vector<Cylinder> cylinders;
    Triangulation<3>      all;
    together(communicator(), [&] {
      if (!is_root)
        return;
      CellLists lists = cell_lists(mesh);
      ids_of_surfaces = add_faces(mesh, lists);
      GridTools::delete_unused_vertices(lists.vertices, lists.cells, lists.faces);
      GridTools::invert_all_negative_measure_cells(lists.vertices, lists.cells);
      GridTools::consistently_order_cells(lists.cells);
      all.create_triangulation(lists.vertices, lists.cells, lists.faces);
      if (element_type == Element::quadratic)
        cylinders = follow_cylinders(*this, all);
      GridTools::partition_triangulation(n_processes, all);
    });
    ids_of_surfaces = Utilities::MPI::broadcast(communicator(), ids_of_surfaces);
    const auto part = [&](const unsigned int process) {
      return TriangulationDescription::Utilities::create_description_from_triangulation(all, communicator(),
                                                                                        TriangulationDescription::default_setting, process);
    };
    Description own;
    if (is_root)
      {
        for (unsigned int process = 1; process < n_processes; ++process)
          send(process, part(process), communicator());
        own = part(0);
        all.clear();
      }
    else
      own = receive(communicator());

    auto &triangulation = discretisation->triangulation;
    together(communicator(), [&] { triangulation.create_triangulation(own); });
    for (const Cylinder &cylinder : Utilities::MPI::broadcast(communicator(), cylinders))
      triangulation.set_manifold(cylinder.id,
                                 CylindricalManifold<3>(Tensor<1, 3>({0., 0., 1.}), Point<3>(cylinder.axis[0], cylinder.axis[1], 0.)));
  }

  void Model::number_free_dofs()
  {
    // Clamped dofs: all three directions on the clamped surface
    const DoFHandler<3> &dofs = discretisation->dofs;

    const IndexSet &own = dofs.locally_owned_dofs();
    IndexSet        clamped(dofs.n_dofs());
    // deal.II takes no ids for all boundaries
    if (has_surface(PhysicalNames::pin_clamp) && !surface_ids(PhysicalNames::pin_clamp).empty())
      clamped = DoFTools::extract_boundary_dofs(dofs, ComponentMask(), surface_ids(PhysicalNames::pin_clamp));

    // Numbers of the others: deal.II's order, so that ownership stays contiguous
    int n_own = 0;
    for (const auto dof : own)
      n_own += !clamped.is_element(dof);
    map               = RowMap(n_own, communicator());
    int        number = n_own > 0 ? map.number(0) : 0;
    DofNumbers numbers(own, discretisation->relevant, communicator());
    for (const auto dof : own)
      numbers(dof) = clamped.is_element(dof) ? -1 : number++;
    numbers.update_ghost_values();
    for (const auto dof : discretisation->relevant)
      free_numbers.push_back(static_cast<int>(numbers(dof)));
  }

  void Model::find_nodes()
  {
    const auto &[triangulation, fe, mapping, dofs, relevant] = *discretisation;

    constexpr unsigned int none = -1;
    const IndexSet        &own  = dofs.locally_owned_dofs();
    const unsigned int     n    = fe.base_element(0).n_dofs_per_cell();
    dof_nodes.assign(relevant.n_elements(), none);

    // Nodes: the dofs of the three directions at each support point
    std::map<types::global_dof_index, Point<3>> support;
    DoFTools::map_dofs_to_support_points(mapping, dofs, support);
    DofNumbers                           numbers(own, relevant, communicator());
    std::vector<types::global_dof_index> cell_dofs(fe.n_dofs_per_cell()), first_dofs;
    for (const auto &cell : dofs.active_cell_iterators())
      {
        if (cell->is_artificial())
          continue;
        cell->get_dof_indices(cell_dofs);
        for (unsigned int i = 0; i < n; ++i)
          {
            const auto first = cell_dofs[fe.component_to_system_index(0, i)];
            if (dof_nodes[relevant.index_within_set(first)] != none)
              continue;
            Node node;
            node.component = cell->material_id();
            node.is_own    = own.is_element(first);
            for (unsigned int c = 0; c < 3; ++c)
              {
                const auto place = relevant.index_within_set(cell_dofs[fe.component_to_system_index(c, i)]);
                node.dofs[c]     = free_numbers[place];
                node.position[c] = support.at(first)[c];
                dof_nodes[place] = node_table.size();
              }
            // The process that owns a node has all its cells, the first of which gives the number
            if (node.is_own)
              numbers(first) = static_cast<double>(cell->id().get_coarse_cell_id()) * n + i;
            node_table.push_back(node);
            first_dofs.push_back(first);
          }
      }
    numbers.update_ghost_values();
    for (std::size_t i = 0; i < node_table.size(); ++i)
      node_table[i].number = static_cast<std::int64_t>(numbers(first_dofs[i]));
  }

  std::vector<Node> Model::gathered_nodes() const
  {
    std::vector<Node> own, all;
    std::copy_if(node_table.begin(), node_table.end(), std::back_inserter(own), [](const Node &node) { return node.is_own; });
    for (const std::vector<Node> &part : Utilities::MPI::gather(communicator(), own))
      all.insert(all.end(), part.begin(), part.end());
    std::sort(all.begin(), all.end(), [](const Node &a, const Node &b) { return a.number < b.number; });
    return all;
  }

  unsigned int Model::node_of_dof(const std::size_t dof) const
  {
    return dof_nodes[discretisation->relevant.index_within_set(dof)];
  }

  const std::set<unsigned int> &Model::surface_ids(const std::string &name) const
  {
    const auto it = std::find(surfaces.begin(), surfaces.end(), name);
    if (it == surfaces.end())
      throw MeshError("the mesh has no surface named `" + name + "`", "mesh",
                      "name such a surface in the geometry, or use one of: " + boost::algorithm::join(surfaces, ", "));
    return ids_of_surfaces[it - surfaces.begin()];
  }

  bool Model::has_surface(const std::string &name) const
  {
    return std::find(surfaces.begin(), surfaces.end(), name) != surfaces.end();
  }

  int Model::free_dof(const std::size_t dof) const
  {
    return free_numbers[discretisation->relevant.index_within_set(dof)];
  }

} // namespace Squeal
