#include <squeal/convergence/common_points.h>
#include <squeal/convergence/point_location.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <cmath>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    /// Where every row of E is: body, number of the point there, direction.
    struct Row
    {
      unsigned int body, point, direction;
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
    FEValues<3> values(model.mapping(), model.dof_handler().get_fe(), QGauss<3>(points_per_direction),
                       update_quadrature_points | update_JxW_values);
    for (const auto &cell : model.dof_handler().active_cell_iterators())
      {
        values.reinit(cell);
        CommonPoints::Body &body = result.bodies[cell->material_id()];
        for (const unsigned int q : values.quadrature_point_indices())
          {
            body.points.push_back(values.quadrature_point(q));
            body.masses.push_back(densities[cell->material_id()] * values.JxW(q));
          }
      }
    return result;
  }

  std::unique_ptr<const SparseMatrix> displacements_at(const CommonPoints &points, const Model &model, const Directions directions)
  {
    const PointLocation       location(model);
    std::vector<unsigned int> numbers; // of the bodies in this mesh
    for (const CommonPoints::Body &body : points.bodies)
      numbers.push_back(location.body(body.name));

    const auto                          &fe   = model.dof_handler().get_fe();
    const std::vector<Row>               rows = all_rows(points);
    const RowMap                         map  = RowMap::even(rows.size(), model.communicator());
    std::vector<types::global_dof_index> cell_dofs(fe.n_dofs_per_cell());
    PointInCell                          found; // of the row before, mostly one of the same point
    const auto                           is_new = [&](const int place) { return place == 0 || rows[map.number(place)].direction == 0; };
    return std::make_unique<const SparseMatrix>(map, model.free_map(), [&](const int place, SparseMatrix::Row &entries) {
      const Row                 row  = rows[map.number(place)];
      const CommonPoints::Body &body = points.bodies[row.body];
      if (is_new(place))
        found = location.find(numbers[row.body], body.points[row.point]);
      const Tensor<1, 3> factors = std::sqrt(body.masses[row.point]) * unit_vector(body.points[row.point], row.direction, directions);
      found.cell->get_dof_indices(cell_dofs);
      for (unsigned int component = 0; component < 3; ++component)
        if (factors[component] != 0.)
          for (unsigned int i = 0; i < fe.base_element(0).n_dofs_per_cell(); ++i)
            if (const int dof = model.free_dof(cell_dofs[fe.component_to_system_index(component, i)]); dof >= 0)
              entries.emplace_back(dof, factors[component] * fe.base_element(0).shape_value(i, found.reference));
    });
  }

  ModesAtPoints at_points(const SparseMatrix &displacements, const SparseMatrix &kernel, const ComplexModes &modes)
  {
    return {modes.lambda, displacements * (kernel * *modes.real_part), displacements * (kernel * *modes.imaginary_part)};
  }
} // namespace Squeal
