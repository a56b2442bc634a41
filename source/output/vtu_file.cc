#include <squeal/base/tasks.h>
#include <squeal/output/vtu_file.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_tools.h>
#include <zlib.h>

#include <cstdint>
#include <sstream>
#include <type_traits>

namespace Squeal
{
  namespace
  {
    /// Of 1 to 9: fields differ in every file, a mesh is compressed once for all.
    constexpr int level_of_fields = 1, level_of_meshes = 9;

    /// Types of cells in files of VTK.
    constexpr std::uint8_t quadrilateral = 9, hexahedron = 12;

    template <typename Number>
    constexpr const char *type_name()
    {
      return std::is_same_v<Number, float> ? "Float32" : std::is_same_v<Number, std::uint8_t> ? "UInt8" : "Int32";
    }

    /// One block of @p size bytes as VTK's readers want it: the number of blocks, their size, that of a shorter last one, and the compressed sizes;
    /// then the block.
    std::string compressed(const void *values, const std::size_t size, const int level)
    {
      uLongf        length = compressBound(size);
      std::string   result(4 * sizeof(std::uint64_t) + length, '\0');
      std::uint64_t head[4] = {1, size, 0, 0};
      if (compress2(reinterpret_cast<Bytef *>(result.data()) + sizeof(head), &length, static_cast<const Bytef *>(values), size, level) !=
          Z_OK)
        throw std::bad_alloc(); // the only cause there is
      head[3] = length;
      result.replace(0, sizeof(head), reinterpret_cast<const char *>(head), sizeof(head));
      result.resize(sizeof(head) + length);
      return result;
    }

    /// A text in the field data of a file, as codes of its characters, which need no escapes.
    std::string field_data(const std::string &text)
    {
      std::ostringstream stream;
      stream << "<FieldData>\n<DataArray type=\"String\" Name=\"mode\" NumberOfTuples=\"1\" format=\"ascii\">\n";
      for (const char c : text)
        stream << int(static_cast<unsigned char>(c)) << ' ';
      stream << "0\n</DataArray>\n</FieldData>\n";
      return stream.str();
    }

    void send(const std::string &text, const MPI_Comm communicator)
    {
      const auto size = static_cast<int>(text.size());
      MPI_Send(&size, 1, MPI_INT, 0, 0, communicator);
      MPI_Send(text.data(), size, MPI_CHAR, 0, 0, communicator);
    }

    /// On process 0: its own text, and what all others send().
    void write_all(std::ostream &stream, const std::string &own, const MPI_Comm communicator)
    {
      int n_processes;
      MPI_Comm_size(communicator, &n_processes);
      stream << own;
      for (int process = 1; process < n_processes; ++process)
        {
          int size;
          MPI_Recv(&size, 1, MPI_INT, process, 0, communicator, MPI_STATUS_IGNORE);
          std::string other(size, ' ');
          MPI_Recv(other.data(), size, MPI_CHAR, process, 0, communicator, MPI_STATUS_IGNORE);
          stream << other;
        }
    }
  } // namespace

  template <typename Number>
  VtuPiece::Array VtuPiece::array(const char                *place,
                                  const std::string         &name,
                                  const std::vector<Number> &values,
                                  const unsigned int         n_columns,
                                  const int                  level)
  {
    return {place, name, type_name<Number>(), n_columns, compressed(values.data(), values.size() * sizeof(Number), level)};
  }

  VtuPiece::VtuPiece(const FieldMesh &mesh)
    : n_points(mesh.nodes.size())
    , n_cells(mesh.components.size())
  {
    std::vector<float>        points;
    std::vector<std::int32_t> ends;
    for (const Node &node : mesh.nodes)
      points.insert(points.end(), node.position.begin(), node.position.end());
    for (std::size_t cell = 1; cell <= n_cells; ++cell)
      ends.push_back(static_cast<std::int32_t>(cell * mesh.corners));
    const std::vector<std::uint8_t> types(n_cells, mesh.corners == 4 ? quadrilateral : hexahedron);
    arrays = {array("CellData", "component", mesh.components, 1, level_of_meshes), array("Points", "points", points, 3, level_of_meshes),
              array("Cells", "connectivity", mesh.cells, 1, level_of_meshes), array("Cells", "offsets", ends, 1, level_of_meshes),
              array("Cells", "types", types, 1, level_of_meshes)};
  }

  void VtuPiece::add(const std::vector<VertexField> &fields)
  {
    const std::size_t n_before = arrays.size();
    arrays.resize(n_before + fields.size());
    run_tasks(static_cast<int>(fields.size()), [&](const int i) {
      arrays[n_before + i] = array("PointData", fields[i].name, fields[i].values, fields[i].n_columns, level_of_fields);
    });
  }

  std::string VtuPiece::description(std::size_t offset) const
  {
    if (n_cells == 0)
      return {};
    std::map<std::string, std::string> parts;
    for (const Array &array : arrays)
      {
        std::ostringstream line;
        line << "<DataArray type=\"" << array.type << "\" Name=\"" << array.name << "\" NumberOfComponents=\"" << array.n_columns
             << "\" format=\"appended\" offset=\"" << offset << "\"/>\n";
        parts[array.place] += line.str();
        offset += array.data.size();
      }
    std::ostringstream result;
    result << "<Piece NumberOfPoints=\"" << n_points << "\" NumberOfCells=\"" << n_cells << "\">\n";
    for (const char *place : {"PointData", "CellData", "Points", "Cells"})
      result << '<' << place << ">\n" << parts[place] << "</" << place << ">\n";
    result << "</Piece>\n";
    return result.str();
  }

  void VtuPiece::write(const ResultFolder &folder, const std::string &name, const std::string &title, const MPI_Comm communicator) const
  {
    std::string data;
    if (n_cells > 0)
      for (const Array &array : arrays)
        data += array.data;
    const std::uint64_t size   = data.size();
    std::uint64_t       offset = 0;
    int                 rank;
    MPI_Exscan(&size, &offset, 1, MPI_UINT64_T, MPI_SUM, communicator);
    MPI_Comm_rank(communicator, &rank);
    const std::string piece = description(rank == 0 ? 0 : offset);
    if (rank != 0)
      {
        send(piece, communicator);
        send(data, communicator);
        return;
      }
    folder.write(name, [&](std::ostream &stream) {
      stream
        << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
           "compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n";
      if (!title.empty())
        stream << field_data(title);
      write_all(stream, piece, communicator);
      stream << "</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
      write_all(stream, data, communicator);
      stream << "\n</AppendedData>\n</VTKFile>\n";
    });
  }

  using namespace dealii;

  namespace
  {
    using ActiveCell = DoFHandler<3>::active_cell_iterator;
    using Places     = std::vector<unsigned int>; // of nodes among those of the model

    /// Corners of a square in the order of VTK.
    constexpr unsigned int square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

    /// Appends the p³ hexahedra of a cell.
    void add_hexahedra(const Places &nodes, const unsigned int degree, Places &corners)
    {
      const unsigned int n = degree + 1;
      for (unsigned int z = 0; z < degree; ++z)
        for (unsigned int y = 0; y < degree; ++y)
          for (unsigned int x = 0; x < degree; ++x)
            for (unsigned int up = 0; up < 2; ++up)
              for (const auto &[right, back] : square)
                corners.push_back(nodes[x + right + n * (y + back + n * (z + up))]);
    }

    /// Appends the p² quadrilaterals of a face of a cell, numbered like those of deal.II.
    void add_quadrilaterals(const Places &nodes, const unsigned int degree, const unsigned int face, Places &corners)
    {
      const unsigned int n       = degree + 1;
      const unsigned int step[3] = {1, n, n * n};
      const unsigned int normal = face / 2, is_far = face % 2;
      const unsigned int origin = is_far * degree * step[normal];
      const unsigned int along = step[(normal + 2 - is_far) % 3], across = step[(normal + 1 + is_far) % 3];
      for (unsigned int j = 0; j < degree; ++j)
        for (unsigned int i = 0; i < degree; ++i)
          for (const auto &[right, back] : square)
            corners.push_back(nodes[origin + (i + right) * along + (j + back) * across]);
    }

    /// Cells of this process, sorted by angle about z, radius and height.
    std::multimap<std::tuple<long, long, double>, ActiveCell> in_columns(const Model &model)
    {
      constexpr double                                          together = 1e-6; // [rad], [m]
      std::multimap<std::tuple<long, long, double>, ActiveCell> cells;
      for (const auto &cell : model.dof_handler().active_cell_iterators())
        if (cell->is_locally_owned())
          {
            const Point<3> x = cell->center();
            cells.emplace(
              std::make_tuple(std::lround(std::atan2(x[1], x[0]) / together), std::lround(std::hypot(x[0], x[1]) / together), x[2]), cell);
          }
      return cells;
    }

    /// Numbers vertices in the order of the cells. @p add(cell, nodes, corners) appends the corners of what a file has of a cell, from its
    /// (p + 1)³ nodes, x fastest.
    template <typename Add>
    FieldMesh mesh_of(const Model &model, const unsigned int n_corners, const Add &add)
    {
      const auto                           order = FETools::lexicographic_to_hierarchic_numbering<3>(model.degree());
      std::vector<types::global_dof_index> dofs(model.dof_handler().get_fe().n_dofs_per_cell());
      std::vector<std::int32_t>            numbers(model.nodes().size(), -1);
      FieldMesh                            mesh{n_corners, {}, {}, {}};
      for (const auto &[place, cell] : in_columns(model))
        {
          Places nodes, corners;
          cell->get_dof_indices(dofs);
          for (const unsigned int i : order)
            nodes.push_back(model.node_of_dof(dofs[cell->get_fe().component_to_system_index(0, i)]));
          add(cell, nodes, corners);
          for (const unsigned int node : corners)
            {
              if (numbers[node] < 0)
                {
                  numbers[node] = static_cast<std::int32_t>(mesh.nodes.size());
                  mesh.nodes.push_back(model.nodes()[node]);
                }
              mesh.cells.push_back(numbers[node]);
            }
          mesh.components.resize(mesh.cells.size() / n_corners, static_cast<std::int32_t>(cell->material_id()));
        }
      return mesh;
    }

    /// Of faces at the boundary whose id is @p wanted.
    template <typename Wanted>
    FieldMesh face_mesh(const Model &model, const Wanted &wanted)
    {
      return mesh_of(model, 4, [&](const ActiveCell &cell, const Places &nodes, Places &corners) {
        for (const unsigned int face : cell->face_indices())
          if (cell->face(face)->at_boundary() && wanted(cell->face(face)->boundary_id()))
            add_quadrilaterals(nodes, model.degree(), face, corners);
      });
    }
  } // namespace

  FieldMesh body_mesh(const Model &model, const std::optional<Component> &component)
  {
    return mesh_of(model, 8, [&](const ActiveCell &cell, const Places &nodes, Places &corners) {
      if (!component || (cell->material_id() == 0) == (*component == Component::disc))
        add_hexahedra(nodes, model.degree(), corners);
    });
  }

  FieldMesh surface_mesh(const Model &model)
  {
    return face_mesh(model, [](types::boundary_id) { return true; });
  }

  FieldMesh contact_face_mesh(const Model &model)
  {
    const auto &ids = model.surface_ids(PhysicalNames::pin_contact);
    return face_mesh(model, [&](const types::boundary_id id) { return ids.count(id) > 0; });
  }
} // namespace Squeal
