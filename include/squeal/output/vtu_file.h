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
  /// Mesh of a field file on this process: cells or faces with shared vertices. All nodes are vertices; elements of degree 2 are divided
  /// into linear cells. Normals of faces point out of the body.
  struct FieldMesh
  {
    std::vector<Node>         nodes;
    std::vector<std::uint8_t> types;      ///< VTK cell type of each cell
    std::vector<std::int32_t> corners;    ///< vertex indices, cell by cell in VTK order
    std::vector<std::int32_t> ends;       ///< for each cell, the end of its range in corners
    std::vector<std::int32_t> components; ///< component of each cell, see Node::component
    std::vector<std::int32_t> volumes;    ///< volume of each cell, see Cell::volume; empty for faces, or if every body has only one volume
  };

  /// Mesh of all bodies, or of one component.
  FieldMesh body_mesh(const Model &model, const std::optional<Component> &component);

  FieldMesh surface_mesh(const Model &model);

  /// Mesh of the contact faces of the pins.
  FieldMesh contact_face_mesh(const Model &model);

  /// Points, each as a single cell.
  FieldMesh point_mesh(const std::vector<Node> &points);

  /// Values at the vertices of a mesh, vertex by vertex.
  struct VertexField
  {
    std::string        name;
    unsigned int       n_columns; ///< number of values per vertex: 1, or 3 for a vector
    std::vector<float> values;
  };

  /// Piece of a VTK file (.vtu) on this process: mesh, cell field `component` (also `volume` if a body has several volumes) and vertex
  /// fields, compressed by zlib. Copy a piece without fields to compress the mesh of several files only once.
  class VtuPiece
  {
  public:
    explicit VtuPiece(const FieldMesh &mesh);

    void add(const std::vector<VertexField> &fields);

    /// Writes the pieces of all processes as one file, with a @p title unless it is empty. Collective; process 0 stores one piece at a
    /// time. Throws FileError on process 0 with the cause if the file cannot be written.
    void write(const ResultFolder &folder, const std::string &name, const std::string &title, MPI_Comm communicator) const;

  private:
    struct Array
    {
      std::string  place; ///< PointData, CellData, Points or Cells
      std::string  name, type;
      unsigned int n_columns;
      std::string  data; ///< block sizes and compressed data
    };

    template <typename Number>
    static Array array(const char *place, const std::string &name, const std::vector<Number> &values, unsigned int n_columns, int level);

    /// XML description of this piece, whose data begin at @p offset in the appended data.
    std::string description(std::size_t offset) const;

    std::size_t        n_points, n_cells;
    std::vector<Array> arrays;
  };
} // namespace Squeal
