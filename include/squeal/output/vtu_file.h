#pragma once

#include <squeal/output/field_mesh.h>
#include <squeal/output/result_folder.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// Values of the vertices of a mesh, vertex by vertex.
  struct VertexField
  {
    std::string        name;
    unsigned int       n_columns; ///< 1, or 3 for a vector
    std::vector<float> values;
  };

  /**
   * What a process has of a file of VTK (.vtu): a mesh with the cell field `component`, and fields, all compressed by zlib. Copies share
   * nothing, so that files on one mesh begin with a copy of a piece without fields.
   */
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
