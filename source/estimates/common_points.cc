#include <squeal/base/exceptions.h>
#include <squeal/estimates/common_points.h>
#include <squeal/model/model.h>

#include <boost/algorithm/string/join.hpp>
#include <boost/serialization/utility.hpp>
#include <deal.II/base/geometry_info.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/numerics/rtree.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    /// A point in the reference cell of a cell.
    struct PointInCell
    {
      DoFHandler<3>::active_cell_iterator cell;
      Point<3>                            reference; ///< in [0, 1]³
      double                              distance;  ///< zero inside; infinite where no cell of this process is near [m]
    };

    /// Where a point is looked for.
    enum class PointSearch
    {
      inside, ///< in cells whose box by their vertices holds it
      nearest ///< in the nearest cells, and beside them
    };

    /// Finds points in the cells of this process, those of one body at a time: the faces of disc and pins coincide, so that a place alone
    /// does not say in which body it is.
    class PointLocation
    {
    public:
      /// @param model must outlive it
      explicit PointLocation(const Model &model);

      /// Number of a body in the mesh; throws MeshError naming those that there are.
      unsigned int body(const std::string &name) const;

      /// The cell of a body that holds a point; with PointSearch::nearest, of a point beside the body, as between two outlines by polygons,
      /// the nearest point among those of the nearest cells with their reference coordinates cut to [0, 1].
      PointInCell find(unsigned int body, const Point<3> &point, PointSearch search) const;

    private:
      using Cell = DoFHandler<3>::active_cell_iterator;
      using Leaf = std::pair<BoundingBox<3>, unsigned int>;

      const Model             &model;
      std::vector<Cell>        cells;
      std::vector<RTree<Leaf>> trees; ///< of each body
    };

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

    /// Where every row of E is: body, number of the point there, direction.
    struct Row
    {
      unsigned int body, point, direction;
    };

    /// Points in a cell.
    struct CellPoints
    {
      types::coarse_cell_id cell;
      unsigned int          body;
      std::vector<Point<3>> points;
      std::vector<double>   masses;

      template <class Archive>
      void serialize(Archive &archive, const unsigned int /*version*/)
      {
        archive &cell &body &points &masses;
      }
    };

    std::vector<Row> all_rows(const CommonPoints &points)
    {
      std::vector<Row> rows;
      for (unsigned int body = 0; body < points.bodies.size(); ++body)
        for (unsigned int point = 0; point < points.bodies[body].points.size(); ++point)
          for (unsigned int direction = 0; direction < 3; ++direction)
            rows.push_back({body, point, direction});
      return rows;
    }

    /// Unit vector along a component of the displacement of a point.
    Tensor<1, 3> unit_vector(const Point<3> &point, const unsigned int direction, const Directions directions)
    {
      Tensor<1, 3> result;
      const double radius = std::hypot(point[0], point[1]);
      if (directions == Directions::cartesian || direction == 2 || radius == 0.)
        result[direction] = 1.;
      else
        {
          const double cosine = point[0] / radius, sine = point[1] / radius;
          result[0] = direction == 0 ? cosine : -sine;
          result[1] = direction == 0 ? sine : cosine;
        }
      return result;
    }
  } // namespace

  int CommonPoints::n() const
  {
    std::size_t sum = 0;
    for (const Body &body : bodies)
      sum += body.points.size();
    return static_cast<int>(sum);
  }

  CommonPoints common_points(const Model &model, const MaterialParameters &materials, const unsigned int points_per_direction)
  {
    CommonPoints        result;
    std::vector<double> densities;
    for (const std::string &name : model.component_names())
      {
        result.bodies.push_back({name, {}, {}});
        densities.push_back(materials.of(name).density);
      }
    FEValues<3>             values(model.mapping(), model.dof_handler().get_fe(), QGauss<3>(points_per_direction),
                                   update_quadrature_points | update_JxW_values);
    std::vector<CellPoints> here;
    for (const auto &cell : model.dof_handler().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          values.reinit(cell);
          CellPoints of_cell{cell->id().get_coarse_cell_id(), cell->material_id(), {}, {}};
          for (const unsigned int q : values.quadrature_point_indices())
            {
              of_cell.points.push_back(values.quadrature_point(q));
              of_cell.masses.push_back(densities[cell->material_id()] * values.JxW(q));
            }
          here.push_back(of_cell);
        }
    // In the order of the cells, however they are distributed
    std::vector<CellPoints> all;
    for (const auto &part : Utilities::MPI::all_gather(model.communicator(), here))
      all.insert(all.end(), part.begin(), part.end());
    std::sort(all.begin(), all.end(), [](const CellPoints &x, const CellPoints &y) { return x.cell < y.cell; });
    for (const CellPoints &of_cell : all)
      {
        CommonPoints::Body &body = result.bodies[of_cell.body];
        body.points.insert(body.points.end(), of_cell.points.begin(), of_cell.points.end());
        body.masses.insert(body.masses.end(), of_cell.masses.begin(), of_cell.masses.end());
      }
    return result;
  }

  namespace
  {
    /// Entries of a row of E, which the process that has the cell of its point sends to the one that has the row.
    struct RowEntries
    {
      int               number;
      SparseMatrix::Row entries;

      template <class Archive>
      void serialize(Archive &archive, const unsigned int /*version*/)
      {
        archive &number &entries;
      }
    };

    /// Points in the cells of this process, and which process has each of them in a cell, or nearest to one: of several the first.
    std::pair<std::vector<PointInCell>, std::vector<int>> located(const CommonPoints              &points,
                                                                  const std::vector<unsigned int> &bodies,
                                                                  const PointLocation             &location,
                                                                  const MPI_Comm                   communicator)
    {
      std::vector<PointInCell> found;
      std::vector<double>      distances;
      for (unsigned int body = 0; body < bodies.size(); ++body)
        for (const Point<3> &point : points.bodies[body].points)
          {
            found.push_back(location.find(bodies[body], point, PointSearch::inside));
            distances.push_back(found.back().distance);
          }
      std::vector<double> nearest(distances.size());
      Utilities::MPI::min(distances, communicator, nearest);
      std::size_t i = 0;
      for (unsigned int body = 0; body < bodies.size(); ++body)
        for (const Point<3> &point : points.bodies[body].points)
          {
            if (nearest[i] > 0.)
              {
                found[i]     = location.find(bodies[body], point, PointSearch::nearest);
                distances[i] = found[i].distance;
              }
            ++i;
          }

      Utilities::MPI::min(distances, communicator, nearest);
      std::vector<int> process;
      for (i = 0; i < nearest.size(); ++i)
        {
          if (nearest[i] == std::numeric_limits<double>::infinity())
            throw MeshError("no cell is near a point of another mesh", "displacements at the points of another mesh",
                            "compare meshes of the same geometry");
          process.push_back(distances[i] == nearest[i] ? static_cast<int>(Utilities::MPI::this_mpi_process(communicator)) :
                                                         std::numeric_limits<int>::max());
        }
      Utilities::MPI::min(process, communicator, process);
      return {std::move(found), std::move(process)};
    }
  } // namespace

  std::unique_ptr<const SparseMatrix> displacements_at(const CommonPoints &points, const Model &model, const Directions directions)
  {
    const PointLocation       location(model);
    std::vector<unsigned int> numbers; // of the bodies in this mesh
    for (const CommonPoints::Body &body : points.bodies)
      numbers.push_back(location.body(body.name));

    const auto                          &fe           = model.dof_handler().get_fe();
    const MPI_Comm                       communicator = model.communicator();
    const std::vector<Row>               rows         = all_rows(points);
    const RowMap                         map          = RowMap::even(rows.size(), communicator);
    std::vector<types::global_dof_index> cell_dofs(fe.n_dofs_per_cell());
    const auto [found, processes] = located(points, numbers, location, communicator);

    // Rows whose points are in cells of this process
    std::map<unsigned int, std::vector<RowEntries>> sent;
    const int                                       me = map.rank();
    for (std::size_t number = 0; number < rows.size(); ++number)
      if (processes[number / 3] == me)
        {
          const Row                 row   = rows[number];
          const CommonPoints::Body &body  = points.bodies[row.body];
          const PointInCell        &place = found[number / 3];
          const Tensor<1, 3> factors = std::sqrt(body.masses[row.point]) * unit_vector(body.points[row.point], row.direction, directions);
          RowEntries         result{static_cast<int>(number), {}};
          place.cell->get_dof_indices(cell_dofs);
          for (unsigned int component = 0; component < 3; ++component)
            if (factors[component] != 0.)
              for (unsigned int i = 0; i < fe.base_element(0).n_dofs_per_cell(); ++i)
                if (const int dof = model.free_dof(cell_dofs[fe.component_to_system_index(component, i)]); dof >= 0)
                  result.entries.emplace_back(dof, factors[component] * fe.base_element(0).shape_value(i, place.reference));
          sent[map.owner(number)].push_back(result);
        }
    std::vector<SparseMatrix::Row> own(map.n_local());
    for (auto &[process, part] : Utilities::MPI::some_to_some(communicator, sent))
      for (const RowEntries &row : part)
        own[map.place(row.number)] = row.entries;
    return std::make_unique<const SparseMatrix>(map, model.free_map(),
                                                [&](const int place, SparseMatrix::Row &entries) { entries = own[place]; });
  }

  ModesAtPoints at_points(const SparseMatrix &displacements, const SparseMatrix &kernel, const ComplexModes &modes)
  {
    return {modes.lambda, displacements * (kernel * *modes.real_part), displacements * (kernel * *modes.imaginary_part)};
  }
} // namespace Squeal
