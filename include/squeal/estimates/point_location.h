#pragma once

#include <squeal/model/model.h>

#include <deal.II/numerics/rtree.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// A point in the reference cell of a cell.
  struct PointInCell
  {
    dealii::DoFHandler<3>::active_cell_iterator cell;
    dealii::Point<3>                            reference; ///< in [0, 1]³
    double                                      distance;  ///< zero inside; infinite where no cell of this process is near [m]
  };

  /// Where a point is looked for.
  enum class PointSearch
  {
    inside, ///< in cells whose box by their vertices holds it
    nearest ///< in the nearest cells, and beside them
  };

  /**
   * Finds points in the cells of this process, those of one body at a time: the faces of disc and pins coincide, so that a place alone does not say
   * in which body it is.
   */
  class PointLocation
  {
  public:
    /// @param model must outlive it
    explicit PointLocation(const Model &model);

    /// Number of a body in the mesh; throws MeshError naming those that there are.
    unsigned int body(const std::string &name) const;

    /**
     * The cell of a body that holds a point; with PointSearch::nearest, of a point beside the body, as between two outlines by polygons, the nearest
     * point among those of the nearest cells with their reference coordinates cut to [0, 1].
     */
    PointInCell find(unsigned int body, const dealii::Point<3> &point, PointSearch search) const;

  private:
    using Cell = dealii::DoFHandler<3>::active_cell_iterator;
    using Leaf = std::pair<dealii::BoundingBox<3>, unsigned int>;

    const Model                     &model;
    std::vector<Cell>                cells;
    std::vector<dealii::RTree<Leaf>> trees; ///< of each body
  };
} // namespace Squeal
