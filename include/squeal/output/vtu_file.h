// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/contact/contact_operators.h>
#include <squeal/model/model.h>
#include <squeal/output/result_folder.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// Cells of this process, or faces of them, with shared vertices, as a file of fields has them. All nodes are vertices: elements of
  /// degree 2 are divided into linear cells on their nodes. Normals of faces point out of the body.
  struct FieldMesh
  {
    std::vector<Node>         nodes;      ///< vertices
    std::vector<std::uint8_t> types;      ///< of each cell, number of VTK
    std::vector<std::int32_t> corners;    ///< places among the vertices, cell by cell in the order of VTK
    std::vector<std::int32_t> ends;       ///< of each cell, behind its last corner
    std::vector<std::int32_t> components; ///< of each cell, see Node
    std::vector<std::int32_t> volumes;    ///< of each cell, see Cell; empty where every body is one volume, and for faces
  };

  /// All bodies, or those of a component.
  FieldMesh body_mesh(const Model &model, const std::optional<Component> &component);

  /// The surface of all bodies.
  FieldMesh surface_mesh(const Model &model);

  /// The pins' contact faces.
  FieldMesh contact_face_mesh(const Model &model);

  /// Points alone, each a cell of its own.
  FieldMesh point_mesh(const std::vector<Node> &points);

  /// Values of the vertices of a mesh, vertex by vertex.
  struct VertexField
  {
    std::string        name;
    unsigned int       n_columns; ///< 1, or 3 for a vector
    std::vector<float> values;
  };

  /// What a process has of a file of VTK (.vtu): a mesh with the cell field `component`, where a body has several volumes `volume`, and
  /// fields, all compressed by zlib. Copies share nothing, so that files on one mesh begin with a copy of a piece without fields. Cells
  /// are sorted into columns along z: consecutive cells then share nodes, which compresses better.
  class VtuPiece
  {
  public:
    explicit VtuPiece(const FieldMesh &mesh);

    void add(const std::vector<VertexField> &fields);

    /// Writes the pieces of all processes, which all must call, as one file, and a @p title unless it is empty; process 0 has one piece
    /// at a time beside the file. Throws FileError, there, with the cause if it cannot be written.
    void write(const ResultFolder &folder, const std::string &name, const std::string &title, MPI_Comm communicator) const;

  private:
    /// An array of the file.
    struct Array
    {
      std::string  place; ///< PointData, CellData, Points or Cells
      std::string  name, type;
      unsigned int n_columns;
      std::string  data; ///< compressed, behind their sizes
    };

    template <typename Number>
    static Array array(const char *place, const std::string &name, const std::vector<Number> &values, unsigned int n_columns, int level);

    /// The description of this piece, whose data begin at @p offset among those of all.
    std::string description(std::size_t offset) const;

    std::size_t        n_points, n_cells;
    std::vector<Array> arrays;
  };
} // namespace Squeal
