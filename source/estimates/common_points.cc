// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/estimates/common_points.h>
#include <squeal/model/element_values.h>

#include <boost/algorithm/string/join.hpp>
#include <boost/serialization/utility.hpp>
#include <deal.II/base/bounding_box.h>
#include <deal.II/base/mpi.h>
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
    struct PointInCell
    {
      const Cell *cell;
      Point<3>    reference; ///< coordinates in the cell
      double      distance;  ///< zero inside; infinite if this process has no cell of the body [m]
    };

    enum class PointSearch
    {
      inside, ///< search only cells whose bounding box contains the point
      nearest ///< search the nearest cells; the point is clipped to the cell
    };

    /// Finds points in the cells of this process, separately for each body, because a position on the common face of disc and pin does not
    /// determine the body.
    class PointLocation
    {
    public:
      /// @param model must outlive this object
      explicit PointLocation(const Model &model);

      /// Index of a body in the mesh; throws MeshError listing the bodies.
      unsigned int body(const std::string &name) const;

      /// Cell of a body that contains a point. For a point outside the body, for example between two polygonal outlines,
      /// PointSearch::nearest returns an approximately closest point in the nearest cells, with reference coordinates clipped to the cell.
      PointInCell find(unsigned int body, const Point<3> &point, PointSearch search) const;

    private:
      using Leaf = std::pair<BoundingBox<3>, const Cell *>;

      std::vector<Leaf> candidates(unsigned int body, const Point<3> &point, PointSearch search) const;

      const Model             &model;
      std::vector<RTree<Leaf>> trees; ///< search trees of the cells of each body
    };

    /// Number of nearby cells that are searched in addition to the cells whose boxes contain the point.
    constexpr unsigned int n_beside = 16;

    /// Tolerance of reference coordinates for points inside a cell, for rounding errors [-].
    constexpr double beyond_by_rounding = 1e-10;

    Point<3> cut_to(const Shape shape, Point<3> x)
    {
      if (shape == Shape::pyramid)
        {
          x[2] = std::clamp(x[2], 0., 1.);
          for (unsigned int d = 0; d < 2; ++d)
            x[d] = std::clamp(x[d], x[2] - 1., 1. - x[2]);
          return x;
        }
      const unsigned int n_of_simplex = shape == Shape::tetrahedron ? 3 : shape == Shape::wedge ? 2 : 0;
      double             sum          = 0.;
      for (unsigned int d = 0; d < 3; ++d)
        x[d] = std::clamp(x[d], 0., 1.);
      for (unsigned int d = 0; d < n_of_simplex; ++d)
        sum += x[d];
      for (unsigned int d = 0; d < n_of_simplex; ++d)
        x[d] /= std::max(1., sum);
      return x;
    }

    std::vector<Point<3>> places_of_nodes(const Model &model, const Cell &cell)
    {
      std::vector<Point<3>> result;
      for (const unsigned int node : cell.nodes)
        {
          const auto &x = model.nodes()[node].position;
          result.emplace_back(x[0], x[1], x[2]);
        }
      return result;
    }

    PointLocation::PointLocation(const Model &model)
      : model(model)
    {
      std::vector<std::vector<Leaf>> leaves(model.component_names().size());
      for (const Cell &cell : model.cells())
        if (cell.is_own)
          leaves[cell.component].emplace_back(BoundingBox<3>(places_of_nodes(model, cell)), &cell);
      for (const auto &of_body : leaves)
        trees.push_back(pack_rtree(of_body));
    }

    unsigned int PointLocation::body(const std::string &name) const
    {
      const auto &names = model.component_names();
      const auto  it    = std::find(names.begin(), names.end(), name);
      if (it == names.end())
        throw MeshError("the mesh has no body named `" + name + "`", "displacements at the points of another mesh",
                        "compare only meshes with the same bodies; the bodies of this mesh are " + boost::algorithm::join(names, ", "));
      return it - names.begin();
    }

    std::vector<PointLocation::Leaf> PointLocation::candidates(const unsigned int body,
                                                               const Point<3>    &point,
                                                               const PointSearch  search) const
    {
      std::vector<Leaf> result;
      trees[body].query(boost::geometry::index::intersects(point), std::back_inserter(result));
      if (search == PointSearch::nearest)
        {
          const unsigned int n = result.size() + n_beside;
          result.clear();
          trees[body].query(boost::geometry::index::nearest(point, n), std::back_inserter(result));
        }
      return result;
    }

    PointInCell PointLocation::find(const unsigned int body, const Point<3> &point, const PointSearch search) const
    {
      PointInCell nearest{{}, {}, std::numeric_limits<double>::infinity()};
      const auto  is_nearer = [&](const Point<3> &x, const Point<3> &y) { return x.distance(point) < y.distance(point); };
      for (const Leaf &leaf : candidates(body, point, search))
        {
          const Cell &cell      = *leaf.second;
          const auto  nodes     = places_of_nodes(model, cell);
          const auto  reference = reference_coordinates(cell.shape, model.degree(), nodes, point);
          Point<3>    inside    = reference ? cut_to(cell.shape, *reference) : Point<3>();
          if (reference && inside.distance(*reference) < beyond_by_rounding)
            return {&cell, inside, 0.};
          if (search == PointSearch::inside)
            continue;
          if (!reference) // Newton's method fails for a distant cell: use its nearest node
            inside = reference_nodes(cell.shape, model.degree())[std::min_element(nodes.begin(), nodes.end(), is_nearer) - nodes.begin()];
          const auto &functions = ShapeFunctions::of(cell.shape, model.degree());
          Point<3>    place;
          for (unsigned int i = 0; i < nodes.size(); ++i)
            place += functions.value(i, inside) * nodes[i];
          if (const double distance = place.distance(point); distance < nearest.distance)
            nearest = {&cell, inside, distance};
        }
      return nearest;
    }

    /// Body, index of the point and direction of a row of E.
    struct Row
    {
      unsigned int body, point, direction;
    };

    /// Common points in a cell, with their masses.
    struct CellPoints
    {
      std::int64_t          cell;
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

    /// Unit vector along a displacement component at a point.
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

  CommonPoints common_points(const Model &model, const MaterialParameters &materials, const unsigned int degree)
  {
    CommonPoints result;
    for (const std::string &name : model.component_names())
      result.bodies.push_back({name, {}, {}});
    std::vector<double> densities;
    for (const std::string &name : model.volume_names())
      densities.push_back(materials.of(name).density);
    ElementValues           values(model, degree);
    std::vector<CellPoints> here;
    for (const Cell &cell : model.cells())
      if (cell.is_own)
        {
          values.reinit(cell);
          CellPoints of_cell{cell.number, cell.component, {}, {}};
          for (unsigned int q = 0; q < values.n_points(); ++q)
            {
              of_cell.points.push_back(values.point(q));
              of_cell.masses.push_back(densities[cell.volume] * values.JxW(q));
            }
          here.push_back(of_cell);
        }
    // Sort by the cell number, so that the order does not depend on the distribution of the cells
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
    /// Entries of a row of E. The process that has the cell of the point sends them to the owner of the row.
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

    /// Positions of the points in the cells of this process, and for each point the first process whose cells contain it or are closest to
    /// it.
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
        process.push_back(distances[i] == nearest[i] ? static_cast<int>(Utilities::MPI::this_mpi_process(communicator)) :
                                                       std::numeric_limits<int>::max());
      Utilities::MPI::min(process, communicator, process);
      return {std::move(found), std::move(process)};
    }
  } // namespace

  std::unique_ptr<const SparseMatrix> displacements_at(const CommonPoints &points, const Model &model, const Directions directions)
  {
    const PointLocation       location(model);
    std::vector<unsigned int> numbers; // numbers of the bodies in this mesh
    for (const CommonPoints::Body &body : points.bodies)
      numbers.push_back(location.body(body.name));

    const MPI_Comm         communicator = model.communicator();
    const std::vector<Row> rows         = all_rows(points);
    const RowMap           map          = RowMap::even(rows.size(), communicator);
    const auto [found, processes]       = located(points, numbers, location, communicator);

    // Compute the rows whose points are in cells of this process
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
          const auto        &functions = ShapeFunctions::of(place.cell->shape, model.degree());
          for (unsigned int i = 0; i < functions.n(); ++i)
            for (unsigned int component = 0; component < 3; ++component)
              if (const double factor = factors[component] * functions.value(i, place.reference); factors[component] != 0.)
                model.nodes()[place.cell->nodes[i]].for_each_dof(
                  component, [&](const int dof, const double weight) { result.entries.emplace_back(dof, factor * weight); });
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
