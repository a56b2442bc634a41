#include <squeal/base/exceptions.h>
#include <squeal/estimates/point_location.h>

#include <deal.II/base/geometry_info.h>

#include <boost/algorithm/string/join.hpp>

#include <algorithm>
#include <limits>
#include <optional>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    /// Cells that are tried: a point is in the box of about three, in irregular corners of a plan of ten.
    constexpr unsigned int n_candidates = 16;

    /// How far reference coordinates of a point inside may be beyond [0, 1] by rounding.
    constexpr double beyond_by_rounding = 1e-10;

    /// Reference coordinates of a point, also of one outside; nothing where the iteration for them fails.
    std::optional<Point<3>> reference_coordinates(const Mapping<3>                          &mapping,
                                                  const DoFHandler<3>::active_cell_iterator &cell,
                                                  const Point<3>                            &point)
    {
      try
        {
          return mapping.transform_real_to_unit_cell(cell, point);
        }
      catch (const Mapping<3>::ExcTransformationFailed &)
        {
          return {};
        }
    }
  } // namespace

  PointLocation::PointLocation(const Model &model)
    : model(model)
  {
    std::vector<std::vector<Leaf>> leaves(model.component_names().size());
    for (const auto &cell : model.dof_handler().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          leaves[cell->material_id()].emplace_back(model.mapping().get_bounding_box(cell), cells.size());
          cells.push_back(cell);
        }
    for (const auto &of_body : leaves)
      trees.push_back(pack_rtree(of_body));
  }

  unsigned int PointLocation::body(const std::string &name) const
  {
    const auto &names = model.component_names();
    const auto  it    = std::find(names.begin(), names.end(), name);
    if (it == names.end())
      throw MeshError("the mesh has no body named `" + name + "`", "displacements at the points of another mesh",
                      "compare meshes of the same bodies; this one has " + boost::algorithm::join(names, ", "));
    return it - names.begin();
  }

  PointInCell PointLocation::find(const unsigned int body, const Point<3> &point, const PointSearch search) const
  {
    PointInCell nearest{{}, {}, std::numeric_limits<double>::infinity()};
    const auto  query = boost::geometry::index::nearest(point, n_candidates);
    for (auto leaf = trees[body].qbegin(query); leaf != trees[body].qend(); ++leaf)
      {
        // Boxes that hold the point come first
        if (search == PointSearch::inside && !leaf->first.point_inside(point))
          break;
        const Cell &cell      = cells[leaf->second];
        const auto  reference = reference_coordinates(model.mapping(), cell, point);
        if (!reference)
          continue;
        const Point<3> inside = GeometryInfo<3>::project_to_unit_cell(*reference);
        if (inside.distance(*reference) < beyond_by_rounding)
          return {cell, inside, 0.};
        const double from_cell = model.mapping().transform_unit_to_real_cell(cell, inside).distance(point);
        if (search == PointSearch::nearest && from_cell < nearest.distance)
          nearest = {cell, inside, from_cell};
      }
    return nearest;
  }
} // namespace Squeal
