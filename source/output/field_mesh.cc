#include <squeal/output/field_mesh.h>

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_tools.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <boost/serialization/vector.hpp>

#include <algorithm>
#include <map>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    using ActiveCell = DoFHandler<3>::active_cell_iterator;
    using Dof        = types::global_dof_index;

    /// Nodes on a grid of cells of degree p, (p + 1)^dim of them, x fastest, by their dofs along x.
    class CellNodes
    {
    public:
      explicit CellNodes(const Model &model)
        : order(FETools::lexicographic_to_hierarchic_numbering<3>(model.degree()))
        , dofs(model.dof_handler().get_fe().n_dofs_per_cell())
        , nodes(order.size())
      {}

      const std::vector<Dof> &of(const ActiveCell &cell)
      {
        cell->get_dof_indices(dofs);
        for (unsigned int i = 0; i < nodes.size(); ++i)
          nodes[i] = dofs[cell->get_fe().component_to_system_index(0, order[i])];
        return nodes;
      }

    private:
      const std::vector<unsigned int> order;
      std::vector<Dof>                dofs, nodes;
    };

    /// Corners of a square in the order of VTK.
    constexpr unsigned int square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

    /// Appends the p³ hexahedra of a cell.
    void add_hexahedra(const std::vector<Dof> &nodes, const unsigned int degree, std::vector<Dof> &cells)
    {
      const unsigned int n = degree + 1;
      for (unsigned int z = 0; z < degree; ++z)
        for (unsigned int y = 0; y < degree; ++y)
          for (unsigned int x = 0; x < degree; ++x)
            for (unsigned int up = 0; up < 2; ++up)
              for (const auto &[right, back] : square)
                cells.push_back(nodes[x + right + n * (y + back + n * (z + up))]);
    }

    /// Appends the p² quadrilaterals of a face of a cell, numbered like those of deal.II.
    void add_quadrilaterals(const std::vector<Dof> &nodes, const unsigned int degree, const unsigned int face, std::vector<Dof> &cells)
    {
      const unsigned int n       = degree + 1;
      const unsigned int step[3] = {1, n, n * n};
      const unsigned int normal = face / 2, along = step[(normal + 1) % 3], across = step[(normal + 2) % 3];
      const unsigned int origin = face % 2 == 0 ? 0 : degree * step[normal];
      for (unsigned int j = 0; j < degree; ++j)
        for (unsigned int i = 0; i < degree; ++i)
          for (const auto &[right, back] : square)
            cells.push_back(nodes[origin + (i + right) * along + (j + back) * across]);
    }
    /// Numbers of vertices of other processes, from those of the own ones, by their dofs along x.
    class VertexNumbers
    {
    public:
      explicit VertexNumbers(const Model &model)
      {
        const DoFHandler<3> &dofs = model.dof_handler();
        IndexSet             relevant;
        DoFTools::extract_locally_relevant_dofs(dofs, relevant);
        numbers.reinit(dofs.locally_owned_dofs(), relevant, model.communicator()); // exact up to 2^53
      }

      void set(const Dof node, const std::size_t number)
      {
        numbers(node) = static_cast<double>(number);
      }

      void exchange()
      {
        numbers.update_ghost_values();
      }

      std::int32_t operator()(const Dof node) const
      {
        return static_cast<std::int32_t>(numbers(node));
      }

    private:
      LinearAlgebra::distributed::Vector<double> numbers;
    };

    /// Cells of a file from one of the mesh.
    struct CellRows
    {
      types::coarse_cell_id     cell;
      std::int32_t              component;
      std::vector<std::int32_t> corners;

      template <class Archive>
      void serialize(Archive &archive, const unsigned int /*version*/)
      {
        archive &cell &component &corners;
      }
    };

    /// Of cells in any order, as their corners and components lie in a file.
    void append_sorted(FieldMesh &mesh, std::vector<CellRows> cells)
    {
      std::stable_sort(cells.begin(), cells.end(), [](const CellRows &a, const CellRows &b) { return a.cell < b.cell; });
      for (const CellRows &cell : cells)
        {
          mesh.cells.insert(mesh.cells.end(), cell.corners.begin(), cell.corners.end());
          mesh.components.resize(mesh.cells.size() / mesh.corners, cell.component);
        }
    }

    /// Which process writes the item with this number, of @p n numbers that are split evenly.
    unsigned int writer(const std::int64_t number, const std::int64_t n, const unsigned int n_processes)
    {
      return static_cast<unsigned int>(number * n_processes / n);
    }

    /// Brings the vertices of this process to those that write them; returns their places in the file.
    std::vector<int> place_vertices(FieldMesh &mesh, const std::int64_t n_numbers, const MPI_Comm communicator)
    {
      const unsigned int                        n_processes = Utilities::MPI::n_mpi_processes(communicator);
      std::map<unsigned int, std::vector<Node>> sent;
      for (const Node &node : mesh.own)
        sent[writer(node.number, n_numbers, n_processes)].push_back(node);
      const auto received = Utilities::MPI::some_to_some(communicator, sent);
      for (const auto &[process, nodes] : received)
        mesh.nodes.insert(mesh.nodes.end(), nodes.begin(), nodes.end());
      std::sort(mesh.nodes.begin(), mesh.nodes.end(), [](const Node &a, const Node &b) { return a.number < b.number; });

      // Places, which those that sent the vertices get back in the same order
      const int n_here = static_cast<int>(mesh.nodes.size());
      int       first  = 0;
      MPI_Exscan(&n_here, &first, 1, MPI_INT, MPI_SUM, communicator);
      const auto place = [&](const std::int64_t number) {
        const auto it = std::lower_bound(mesh.nodes.begin(), mesh.nodes.end(), number,
                                         [](const Node &node, const std::int64_t other) { return node.number < other; });
        return first + static_cast<int>(it - mesh.nodes.begin());
      };
      std::map<unsigned int, std::vector<int>> replies;
      for (const auto &[process, nodes] : received)
        for (const Node &node : nodes)
          replies[process].push_back(place(node.number));
      const auto                          places = Utilities::MPI::some_to_some(communicator, replies);
      std::map<unsigned int, std::size_t> next;
      std::vector<int>                    result;
      for (const Node &node : mesh.own)
        {
          const unsigned int process = writer(node.number, n_numbers, n_processes);
          result.push_back(places.at(process)[next[process]++]);
        }
      mesh.n_all_nodes = Utilities::MPI::sum(mesh.nodes.size(), communicator);
      mesh.delivery    = std::make_shared<const RowDelivery>(result, first, n_here, communicator);
      return result;
    }

    /// Brings cells to the processes that write them.
    void place_cells(FieldMesh &mesh, const std::vector<CellRows> &own, const std::int64_t n_cells, const MPI_Comm communicator)
    {
      const unsigned int                            n_processes = Utilities::MPI::n_mpi_processes(communicator);
      std::map<unsigned int, std::vector<CellRows>> sent;
      std::vector<CellRows>                         here;
      for (const CellRows &cell : own)
        sent[writer(cell.cell, n_cells, n_processes)].push_back(cell);
      for (const auto &[process, cells] : Utilities::MPI::some_to_some(communicator, sent))
        here.insert(here.end(), cells.begin(), cells.end());
      append_sorted(mesh, std::move(here));
      mesh.n_all_cells = Utilities::MPI::sum(mesh.components.size(), communicator);
    }
  } // namespace

  std::vector<float> FieldMesh::delivered(const DenseMatrix &values) const
  {
    DenseMatrix here(nodes.size(), values.cols());
    delivery->deliver(values.data(), values.rows(), here.data(), here.rows(), static_cast<int>(values.cols()));
    std::vector<float> result;
    result.reserve(here.size());
    for (Eigen::Index i = 0; i < here.rows(); ++i)
      for (Eigen::Index j = 0; j < here.cols(); ++j)
        result.push_back(static_cast<float>(here(i, j)));
    return result;
  }

  FieldMesh body_mesh(const Model &model, const std::optional<Component> &component)
  {
    const IndexSet   &own = model.dof_handler().locally_owned_dofs();
    FieldMesh         mesh;
    CellNodes         cell_nodes(model);
    std::vector<bool> is_known(own.n_elements(), false);
    std::vector<Dof>  vertices; // of mesh.own
    std::size_t       n_corners = 0;
    mesh.corners                = 8;
    // Corners of the cells of a file from each cell that this process has
    const auto for_cells = [&](const auto &action) {
      for (const auto &cell : model.dof_handler().active_cell_iterators())
        if (!cell->is_artificial() && (!component || (cell->material_id() == 0) == (*component == Component::disc)))
          {
            std::vector<Dof> corners;
            add_hexahedra(cell_nodes.of(cell), model.degree(), corners);
            n_corners = corners.size();
            action(cell, corners);
          }
    };
    // In the order in which all cells have them: cells of a process ascend, and all that meet at an own vertex are among them
    for_cells([&](const ActiveCell &cell, const std::vector<Dof> &corners) {
      for (std::size_t c = 0; c < corners.size(); ++c)
        if (const Dof node = corners[c]; own.is_element(node) && !is_known[own.index_within_set(node)])
          {
            is_known[own.index_within_set(node)] = true;
            vertices.push_back(node);
            mesh.own.push_back(model.nodes()[model.node_of_dof(node)]);
            mesh.own.back().number = static_cast<std::int64_t>(cell->id().get_coarse_cell_id() * corners.size() + c);
          }
    });
    const std::int64_t     n_cells   = model.triangulation().n_global_active_cells();
    const std::int64_t     n_numbers = n_cells * Utilities::MPI::max(n_corners, model.communicator());
    const std::vector<int> places    = place_vertices(mesh, n_numbers, model.communicator());

    VertexNumbers numbers(model);
    for (std::size_t i = 0; i < vertices.size(); ++i)
      numbers.set(vertices[i], places[i]);
    numbers.exchange();
    std::vector<CellRows> cells;
    for_cells([&](const ActiveCell &cell, const std::vector<Dof> &corners) {
      if (!cell->is_locally_owned())
        return;
      cells.push_back({cell->id().get_coarse_cell_id(), static_cast<std::int32_t>(cell->material_id()), {}});
      for (const Dof node : corners)
        cells.back().corners.push_back(numbers(node));
    });
    place_cells(mesh, cells, n_cells, model.communicator());
    return mesh;
  }

  FieldMesh contact_face_mesh(const Model &model, const ContactInterface &interface)
  {
    std::map<std::int64_t, std::int32_t> pairs; // by the numbers of the pins' nodes
    for (unsigned int c = 0; c < interface.size(); ++c)
      pairs[interface[c].pin_node.number] = c;

    CellNodes             cell_nodes(model);
    const auto           &ids = model.surface_ids(PhysicalNames::pin_contact);
    std::vector<CellRows> here, all;
    for (const auto &cell : model.dof_handler().active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int face : cell->face_indices())
          if (cell->face(face)->at_boundary() && ids.count(cell->face(face)->boundary_id()) > 0)
            {
              std::vector<Dof> corners;
              add_quadrilaterals(cell_nodes.of(cell), model.degree(), face, corners);
              here.push_back({cell->id().get_coarse_cell_id(), static_cast<std::int32_t>(cell->material_id()), {}});
              for (const Dof node : corners)
                here.back().corners.push_back(pairs.at(model.nodes()[model.node_of_dof(node)].number));
            }
    for (const auto &part : Utilities::MPI::gather(model.communicator(), here))
      all.insert(all.end(), part.begin(), part.end());

    FieldMesh mesh;
    mesh.corners = 4;
    append_sorted(mesh, std::move(all));
    if (model.free_map().rank() == 0)
      for (const ContactNode &pair : interface)
        mesh.nodes.push_back(pair.pin_node);
    mesh.n_all_nodes = interface.size();
    mesh.n_all_cells = Utilities::MPI::sum(mesh.components.size(), model.communicator());
    return mesh;
  }
} // namespace Squeal
