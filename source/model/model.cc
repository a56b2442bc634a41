// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/geometry/second_order.h>
#include <squeal/geometry/tied_faces.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/model/model.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparsity_pattern.h>
#include <deal.II/lac/sparsity_tools.h>

#include <boost/algorithm/string/join.hpp>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    struct Part
    {
      std::vector<Node> nodes;
      std::vector<Cell> cells;
      std::vector<Face> faces;
      int               n_own_dofs = 0; ///< free dofs

      template <class Archive>
      void serialize(Archive &archive, const unsigned int /*version*/)
      {
        archive &nodes &n_own_dofs;
        serialize_elements(archive, cells, [&archive](Cell &cell) { archive &cell.volume; });
        serialize_elements(archive, faces, [&archive](Face &face) { archive &face.surfaces; });
      }

    private:
      template <class Archive, class Elements, class Rest>
      static void serialize_elements(Archive &archive, Elements &elements, const Rest &rest)
      {
        std::size_t n = elements.size();
        archive    &n;
        elements.resize(n);
        for (auto &element : elements)
          {
            std::size_t n_nodes = element.nodes.size();
            archive &element.shape &element.component &element.number &element.is_own &n_nodes;
            element.nodes.resize(n_nodes);
            for (unsigned int &node : element.nodes)
              archive &node;
            rest(element);
          }
      }
    };

    void send(const int process, const Part &part, const MPI_Comm communicator)
    {
      const std::vector<char> buffer = Utilities::pack(part, false);
      const unsigned long     size   = buffer.size();
      if (size > static_cast<unsigned long>(std::numeric_limits<int>::max()))
        throw MeshError("a part of the model exceeds 2 GB, the limit of an MPI message", "distribution of the mesh to the processes",
                        "run with more processes, or use a coarser mesh");
      MPI_Send(&size, 1, MPI_UNSIGNED_LONG, process, 0, communicator);
      MPI_Send(buffer.data(), static_cast<int>(size), MPI_CHAR, process, 0, communicator);
    }

    Part receive(const MPI_Comm communicator)
    {
      unsigned long size;
      MPI_Recv(&size, 1, MPI_UNSIGNED_LONG, 0, 0, communicator, MPI_STATUS_IGNORE);
      std::vector<char> buffer(size);
      MPI_Recv(buffer.data(), static_cast<int>(size), MPI_CHAR, 0, 0, communicator, MPI_STATUS_IGNORE);
      return Utilities::unpack<Part>(buffer, false);
    }

    /// The whole mesh on process 0, with numbered nodes and dofs, and its division into parts for the processes.
    class Division
    {
    public:
      Division(const Mesh &mesh, const SlaveRows &masters, const unsigned int n_processes)
        : mesh(mesh)
        , masters(masters)
        , process_of_cell(mesh.cells.size(), 0)
      {
        find_faces();
        if (n_processes > 1)
          distribute_cells(n_processes);
        number_nodes();
        number_dofs(n_processes);
      }

      Part part(const unsigned int process) const
      {
        Part              result;
        std::vector<int>  place(mesh.points.size(), -1);
        std::vector<bool> has_cell(mesh.cells.size());
        const auto        places = [&](const Mesh::Nodes &nodes) {
          Mesh::Nodes found;
          for (const unsigned int node : nodes)
            {
              if (place[node] < 0)
                {
                  place[node] = static_cast<int>(result.nodes.size());
                  result.nodes.push_back(nodes_of_mesh[node]);
                  result.nodes.back().is_own = process_of_node[node] == process;
                }
              found.push_back(place[node]);
            }
          return found;
        };
        for (std::size_t c = 0; c < mesh.cells.size(); ++c)
          {
            const Mesh::Cell &cell   = mesh.cells[c];
            const bool        is_own = process_of_cell[c] == process;
            has_cell[c]              = is_own || std::any_of(cell.nodes.begin(), cell.nodes.end(),
                                                             [&](const unsigned int node) { return has_dofs_of(node, process); });
            if (has_cell[c])
              result.cells.push_back(
                {{cell.shape, places(cell.nodes), mesh.body_of(cell), static_cast<std::int64_t>(c), is_own}, cell.volume});
          }
        for (std::size_t f = 0; f < faces.size(); ++f)
          if (const CellFace &face = faces[f].first; has_cell[face.cell])
            {
              const Mesh::Cell &cell = mesh.cells[face.cell];
              Mesh::Nodes       nodes;
              for (const unsigned int i : nodes_of_face(cell.shape, mesh.degree, face.number))
                nodes.push_back(cell.nodes[i]);
              result.faces.push_back({{shape_of_face(face.n_corners), places(nodes), face.body, static_cast<std::int64_t>(f),
                                       process_of_cell[face.cell] == process},
                                      faces[f].second});
            }
        result.n_own_dofs = n_dofs_of_process[process];
        return result;
      }

    private:
      const Mesh                                             &mesh;
      const SlaveRows                                        &masters;
      std::vector<std::pair<CellFace, std::vector<unsigned>>> faces; ///< outer faces with their surfaces
      std::vector<unsigned int>                               process_of_cell, process_of_node;
      std::vector<Node>                                       nodes_of_mesh;
      std::vector<int>                                        n_dofs_of_process;

      /// True if the displacement of a node contributes to rows of a process.
      bool has_dofs_of(const unsigned int node, const unsigned int process) const
      {
        const auto tied = masters.find(node);
        return tied == masters.end() ? process_of_node[node] == process :
                                       std::any_of(tied->second.begin(), tied->second.end(),
                                                   [&](const auto &master) { return process_of_node[master.first] == process; });
      }

      void find_faces()
      {
        std::map<std::array<unsigned int, 4>, std::set<unsigned int>> names;
        for (const Mesh::Face &face : mesh.faces)
          names[face_key(face)].insert(face.surface);
        for (const CellFace &face : outer_faces(mesh))
          {
            const auto it = names.find(face.key);
            faces.emplace_back(face,
                               it == names.end() ? std::vector<unsigned>() : std::vector<unsigned>(it->second.begin(), it->second.end()));
          }
        std::sort(faces.begin(), faces.end(), [](const auto &a, const auto &b) {
          return std::make_pair(a.first.cell, a.first.number) < std::make_pair(b.first.cell, b.first.number);
        });
      }

      /// Partitions the cells with METIS; cells that share a face are neighbours.
      void distribute_cells(const unsigned int n_processes)
      {
        DynamicSparsityPattern      neighbours(mesh.cells.size());
        const std::vector<CellFace> all = all_faces(mesh);
        for (std::size_t i = 1; i < all.size(); ++i)
          if (all[i - 1].key == all[i].key)
            {
              neighbours.add(all[i - 1].cell, all[i].cell);
              neighbours.add(all[i].cell, all[i - 1].cell);
            }
        SparsityPattern pattern;
        pattern.copy_from(neighbours);
        SparsityTools::partition(pattern, n_processes, process_of_cell);
      }

      /// Numbers nodes in the order of the cells; a node belongs to the lowest process that has a cell with this node.
      void number_nodes()
      {
        constexpr unsigned int nobody = -1;
        process_of_node.assign(mesh.points.size(), nobody);
        nodes_of_mesh.resize(mesh.points.size());
        std::int64_t number = 0;
        for (std::size_t c = 0; c < mesh.cells.size(); ++c)
          for (const unsigned int n : mesh.cells[c].nodes)
            {
              if (process_of_node[n] == nobody)
                nodes_of_mesh[n] = {{{mesh.points[n][0], mesh.points[n][1], mesh.points[n][2]}},
                                    {{0, 0, 0}},
                                    mesh.body_of(mesh.cells[c]),
                                    number++,
                                    false,
                                    {}};
              process_of_node[n] = std::min(process_of_node[n], process_of_cell[c]);
            }
      }

      void number_dofs(const unsigned int n_processes)
      {
        const auto clamp = std::find(mesh.surface_names.begin(), mesh.surface_names.end(), PhysicalNames::pin_clamp);
        for (const Mesh::Face &face : mesh.faces)
          if (face.surface == static_cast<std::size_t>(clamp - mesh.surface_names.begin()))
            for (const unsigned int node : face.nodes)
              nodes_of_mesh[node].dofs = {{-1, -1, -1}};
        for (const auto &[slave, row] : masters)
          {
            Node &node = nodes_of_mesh[slave];
            if (node.dofs[0] < 0)
              throw MeshError(text("the tied node at (", mesh.points[slave], ") m is clamped by pin_clamp"), "parameter Contact/Tied",
                              "exchange the two surfaces of the tie, or separate the tied faces from pin_clamp");
            node.dofs = {{-1, -1, -1}};
          }

        std::vector<unsigned int> order(mesh.points.size());
        std::iota(order.begin(), order.end(), 0);
        std::sort(order.begin(), order.end(), [this](const unsigned int a, const unsigned int b) {
          return std::make_pair(process_of_node[a], nodes_of_mesh[a].number) < std::make_pair(process_of_node[b], nodes_of_mesh[b].number);
        });
        int next = 0;
        n_dofs_of_process.assign(n_processes, 0);
        for (const unsigned int node : order)
          for (int &dof : nodes_of_mesh[node].dofs)
            if (dof >= 0)
              {
                dof = next++;
                ++n_dofs_of_process[process_of_node[node]];
              }
        for (const auto &[slave, row] : masters)
          for (const auto &[master, weight] : row)
            nodes_of_mesh[slave].masters.push_back({nodes_of_mesh[master].dofs, weight});
      }
    };
  } // namespace

  Model::Model(const Mesh &mesh, const Element element, MPI_Comm communicator)
    : components(mesh.body_names)
    , volumes(mesh.volume_names)
    , surfaces(mesh.surface_names)
    , component_of_volume(mesh.body_of_volume)
    , element_type(element)
    , processes(communicator)
    , n_all_dofs(0)
  {
    if (mesh.degree > degree())
      throw MeshError("the mesh is of second order, but the elements are of first order", "parameter Discretization/Element",
                      "set Discretization/Element = quadratic, or generate a mesh of first order");
    Part own;
    if (this_process(communicator) == 0)
      {
        // Create the parts of other processes one at a time on process 0, which has all cells
        const unsigned int n        = n_processes(communicator);
        const Mesh         with_all = degree() == 2 ? second_order(mesh) : mesh;
        const TiedNodes    tied     = tied_nodes(with_all);
        const Division     division(with_all, tied.masters, n);
        tied_notes = tied.notes;
        n_all_dofs = 3 * with_all.points.size();
        for (unsigned int process = 1; process < n; ++process)
          send(process, division.part(process), communicator);
        own = division.part(0);
      }
    else
      own = receive(communicator);
    agree(communicator, &n_all_dofs, 1);
    node_table = std::move(own.nodes);
    cell_table = std::move(own.cells);
    face_table = std::move(own.faces);
    map        = RowMap(own.n_own_dofs, communicator);
  }

  std::vector<unsigned int> Model::volumes_of(const unsigned int component) const
  {
    std::vector<unsigned int> result;
    for (unsigned int volume = 0; volume < volumes.size(); ++volume)
      if (component_of_volume[volume] == component)
        result.push_back(volume);
    return result;
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

  std::vector<const Face *> Model::faces_of(const std::string &surface) const
  {
    const auto it = std::find(surfaces.begin(), surfaces.end(), surface);
    if (it == surfaces.end())
      throw MeshError("the mesh has no surface named `" + surface + "`", "mesh",
                      "define a surface with this name in the geometry, or use one of: " + boost::algorithm::join(surfaces, ", "));
    std::vector<const Face *> result;
    for (const Face &face : face_table)
      if (std::count(face.surfaces.begin(), face.surfaces.end(), it - surfaces.begin()) > 0)
        result.push_back(&face);
    return result;
  }
} // namespace Squeal
