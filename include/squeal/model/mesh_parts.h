#pragma once

#include <deal.II/grid/tria_description.h>

#include <array>
#include <map>
#include <utility>
#include <vector>

namespace Squeal
{
  /// The hexahedra of all bodies with what deal.II needs to know of them.
  struct CellLists
  {
    std::vector<dealii::Point<3>>    vertices;
    std::vector<dealii::CellData<3>> cells; ///< with their material ids
    dealii::SubCellData              faces; ///< named surfaces, by boundary id
  };

  /// Manifolds of the edges and faces of a cell.
  struct CellManifolds
  {
    std::array<dealii::types::manifold_id, 12> lines;
    std::array<dealii::types::manifold_id, 6>  quads;
  };

  /**
   * A mesh in parts, one for each process: cells that it owns, in parts of equal size with few faces between them (METIS), and those that
   * share a vertex with them.
   */
  class MeshParts
  {
  public:
    /**
     * @param manifolds of those cells that have any, by their numbers
     *
     * Throws dealii::ExceptionBase if more than two cells share a face, or a named face lies inside a body.
     */
    MeshParts(CellLists lists, std::map<unsigned int, CellManifolds> manifolds, unsigned int n_parts);

    /// What the process @p number builds its triangulation from; numbers of cells over all parts are those in the lists.
    dealii::TriangulationDescription::Description<3, 3> part(unsigned int number, MPI_Comm communicator) const;

  private:
    using NamedFace = std::pair<unsigned int, dealii::types::boundary_id>; ///< number in its cell, surface

    /// Finds neighbours and named faces; returns pairs of cells that share a face.
    std::vector<std::pair<unsigned int, unsigned int>> find_faces(const dealii::SubCellData &faces);

    const std::vector<dealii::Point<3>>            vertices;
    const std::vector<dealii::CellData<3>>         cells;
    const std::map<unsigned int, CellManifolds>    manifolds;
    std::map<unsigned int, std::vector<NamedFace>> named_faces; ///< of each cell that has any
    std::vector<unsigned int>                      owners;      ///< of the cells
  };
} // namespace Squeal
