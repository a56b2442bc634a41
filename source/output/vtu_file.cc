// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/tasks.h>
#include <squeal/output/vtu_file.h>

#include <zlib.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <sstream>
#include <tuple>
#include <type_traits>

namespace Squeal
{
  namespace
  {
    /// zlib levels from 1 (fast) to 9; fields are compressed for every file, a mesh only once.
    constexpr int level_of_fields = 1, level_of_meshes = 9;

    template <typename Number>
    constexpr const char *type_name()
    {
      return std::is_same_v<Number, float> ? "Float32" : std::is_same_v<Number, std::uint8_t> ? "UInt8" : "Int32";
    }

    /// One block of @p size bytes in VTK's format: number of blocks, block size, size of a shorter last block, compressed sizes, then the
    /// compressed block.
    std::string compressed(const void *values, const std::size_t size, const int level)
    {
      uLongf        length = compressBound(size);
      std::string   result(4 * sizeof(std::uint64_t) + length, '\0');
      std::uint64_t head[4] = {1, size, 0, 0};
      if (compress2(reinterpret_cast<Bytef *>(result.data()) + sizeof(head), &length, static_cast<const Bytef *>(values), size, level) !=
          Z_OK)
        throw std::bad_alloc(); // lack of memory is the only possible cause
      head[3] = length;
      result.replace(0, sizeof(head), reinterpret_cast<const char *>(head), sizeof(head));
      result.resize(sizeof(head) + length);
      return result;
    }

    /// Field data with a string as character codes, which require no escape sequences.
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

    /// Writes the text of process 0, then the texts received from the other processes.
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
    std::vector<float> points;
    for (const Node &node : mesh.nodes)
      points.insert(points.end(), node.position.begin(), node.position.end());
    const auto add = [&](const char *place, const std::string &name, const auto &values, const unsigned int n_columns = 1) {
      arrays.push_back(array(place, name, values, n_columns, level_of_meshes));
    };
    add("CellData", "component", mesh.components);
    if (!mesh.volumes.empty())
      add("CellData", "volume", mesh.volumes);
    add("Points", "points", points, 3);
    add("Cells", "connectivity", mesh.corners);
    add("Cells", "offsets", mesh.ends);
    add("Cells", "types", mesh.types);
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

  namespace
  {
    struct Part
    {
      Shape                     shape;
      std::vector<unsigned int> nodes;
    };

    /// Divides an element of degree 2 into half-size cells at the corners, and cells for the remainder.
    std::vector<Part> halves(const Shape shape)
    {
      const auto       &corners = topology(shape).corners;
      const auto        nodes   = reference_nodes(shape, 2);
      std::vector<Part> result;
      for (const auto &corner : corners)
        {
          result.push_back({shape, {}});
          for (const auto &other : corners)
            for (unsigned int i = 0; i < nodes.size(); ++i)
              if (nodes[i].distance(corner + 0.5 * (other - corner)) < 1e-6)
                result.back().nodes.push_back(i);
        }
      std::vector<Part> middle;
      if (shape == Shape::triangle)
        middle = {{shape, {3, 4, 5}}};
      if (shape == Shape::tetrahedron) // the remainder is an octahedron, which is divided along one diagonal
        middle = {{shape, {4, 5, 6, 8}}, {shape, {4, 6, 7, 8}}, {shape, {4, 7, 9, 8}}, {shape, {4, 9, 5, 8}}};
      if (shape == Shape::wedge)
        middle = {{shape, {6, 9, 7, 15, 17, 16}}, {shape, {15, 17, 16, 12, 14, 13}}};
      if (shape == Shape::pyramid)
        middle = {{shape, {7, 12, 11, 9, 13}},
                  {Shape::tetrahedron, {5, 13, 7, 9}},
                  {Shape::tetrahedron, {8, 13, 9, 11}},
                  {Shape::tetrahedron, {10, 13, 11, 12}},
                  {Shape::tetrahedron, {6, 13, 12, 7}}};
      result.insert(result.end(), middle.begin(), middle.end());
      return result;
    }

    /// Linear cells of an element with corners in VTK's order, which is Gmsh's order except that the first triangle of a wedge faces
    /// outwards.
    std::vector<Part> parts_of(const Shape shape, const unsigned int degree)
    {
      std::vector<Part> result = degree == 2 ? halves(shape) : std::vector<Part>{{shape, {}}};
      if (degree == 1)
        for (unsigned int i = 0; i < topology(shape).corners.size(); ++i)
          result.front().nodes.push_back(i);
      for (Part &part : result)
        if (part.shape == Shape::wedge)
          {
            std::swap(part.nodes[1], part.nodes[2]);
            std::swap(part.nodes[4], part.nodes[5]);
          }
      return result;
    }

    /// VTK cell types, in the order of the shapes.
    constexpr std::array<std::uint8_t, 6> vtk_types = {{5, 9, 10, 14, 13, 12}};

    /// Elements owned by this process, sorted by angle about z, radius and height of the mean of their corners, because cells with common
    /// nodes in succession improve the compression.
    template <typename Element>
    std::multimap<std::tuple<long, long, double>, const Element *> in_columns(const Model                        &model,
                                                                              const std::vector<const Element *> &elements)
    {
      constexpr double                                               together = 1e-6; // resolution of angles [rad] and radii [m]
      std::multimap<std::tuple<long, long, double>, const Element *> result;
      for (const Element *element : elements)
        if (element->is_own)
          {
            const std::size_t     n = topology(element->shape).corners.size();
            std::array<double, 3> x = {};
            for (std::size_t i = 0; i < n; ++i)
              for (unsigned int d = 0; d < 3; ++d)
                x[d] += model.nodes()[element->nodes[i]].position[d] / n;
            result.emplace(
              std::make_tuple(std::lround(std::atan2(x[1], x[0]) / together), std::lround(std::hypot(x[0], x[1]) / together), x[2]),
              element);
          }
      return result;
    }

    /// Mesh of the @p elements that this process owns; vertices are numbered in the order of the elements.
    template <typename Element>
    FieldMesh mesh_of(const Model &model, const std::vector<const Element *> &elements)
    {
      std::array<std::vector<Part>, vtk_types.size()> parts;
      for (unsigned int shape = 0; shape < parts.size(); ++shape)
        parts[shape] = parts_of(static_cast<Shape>(shape), model.degree());
      std::vector<std::int32_t> numbers(model.nodes().size(), -1);
      FieldMesh                 mesh;
      for (const auto &[place, element] : in_columns(model, elements))
        {
          for (const Part &part : parts[static_cast<unsigned int>(element->shape)])
            {
              for (const unsigned int i : part.nodes)
                {
                  const unsigned int node = element->nodes[i];
                  if (numbers[node] < 0)
                    {
                      numbers[node] = static_cast<std::int32_t>(mesh.nodes.size());
                      mesh.nodes.push_back(model.nodes()[node]);
                    }
                  mesh.corners.push_back(numbers[node]);
                }
              mesh.types.push_back(vtk_types[static_cast<unsigned int>(part.shape)]);
              mesh.ends.push_back(static_cast<std::int32_t>(mesh.corners.size()));
            }
          mesh.components.resize(mesh.ends.size(), static_cast<std::int32_t>(element->component));
          if constexpr (std::is_same_v<Element, Cell>)
            if (model.volume_names().size() != model.component_names().size())
              mesh.volumes.resize(mesh.ends.size(), static_cast<std::int32_t>(element->volume));
        }
      return mesh;
    }
  } // namespace

  FieldMesh body_mesh(const Model &model, const std::optional<Component> &component)
  {
    std::vector<const Cell *> cells;
    for (const Cell &cell : model.cells())
      if (!component || (cell.component == 0) == (*component == Component::disc))
        cells.push_back(&cell);
    return mesh_of(model, cells);
  }

  FieldMesh surface_mesh(const Model &model)
  {
    std::vector<const Face *> faces;
    for (const Face &face : model.faces())
      faces.push_back(&face);
    return mesh_of(model, faces);
  }

  FieldMesh point_mesh(const std::vector<Node> &points)
  {
    constexpr std::uint8_t vtk_vertex = 1;
    FieldMesh              mesh;
    mesh.nodes = points;
    for (const Node &point : points)
      {
        mesh.corners.push_back(static_cast<std::int32_t>(mesh.corners.size()));
        mesh.ends.push_back(static_cast<std::int32_t>(mesh.corners.size()));
        mesh.types.push_back(vtk_vertex);
        mesh.components.push_back(static_cast<std::int32_t>(point.component));
      }
    return mesh;
  }

  FieldMesh contact_face_mesh(const Model &model)
  {
    return mesh_of(model, model.faces_of(PhysicalNames::pin_contact));
  }
} // namespace Squeal
