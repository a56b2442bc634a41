#include <squeal/model/cylinders.h>

#include <deal.II/base/tensor.h>
#include <deal.II/grid/manifold_lib.h>

#include <cmath>
#include <map>
#include <optional>
#include <set>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    struct Cylinder
    {
      Point<3> axis_point;
      double   radius;
    };

    /// Largest distance of a vertex from its cylinder, relative to the radius.
    constexpr double roundness = 1e-6;

    /// Points closer than this are taken for the same [m], far below any element size.
    constexpr double grid = 1e-7;

    /// Circle through the points in the x-y plane by linear least squares, x² + y² = 2 a x + 2 b y + c.
    std::optional<Cylinder> fit_cylinder(const std::vector<Point<3>> &points)
    {
      // Four corners of a square lie on a circle as well: only six directions or more are taken for one.
      std::set<std::pair<long, long>> plan;
      for (const auto &p : points)
        plan.insert({std::lround(p[0] / grid), std::lround(p[1] / grid)});
      if (plan.size() < 6)
        return {};
      // About the centroid the normal equations are well scaled.
      Point<3> centre;
      for (const auto &p : points)
        centre += p / static_cast<double>(points.size());
      Tensor<2, 3> normal;
      Tensor<1, 3> rhs;
      for (const auto &p : points)
        {
          const Tensor<1, 3> d = p - centre, row({2. * d[0], 2. * d[1], 1.});
          normal += outer_product(row, row);
          rhs += (d[0] * d[0] + d[1] * d[1]) * row;
        }
      if (std::abs(determinant(normal)) < 1e-14 * std::pow(normal.norm(), 3))
        return {}; // a plane surface
      const Tensor<1, 3> solution = invert(normal) * rhs;
      const double       radius   = std::sqrt(solution[2] + solution[0] * solution[0] + solution[1] * solution[1]);

      Cylinder cylinder{centre + Point<3>(solution[0], solution[1], 0.), radius};
      for (const auto &p : points)
        if (std::abs(std::hypot(p[0] - cylinder.axis_point[0], p[1] - cylinder.axis_point[1]) - radius) > roundness * radius)
          return {};
      return cylinder;
    }

    /// A key that is equal for coincident mid-points of edges.
    std::array<long, 3> edge_key(const Point<3> &p)
    {
      return {{std::lround(p[0] / grid), std::lround(p[1] / grid), std::lround(p[2] / grid)}};
    }
  } // namespace

  void attach_cylinders(const Model &model, Triangulation<3> &triangulation)
  {
    // Vertices of each candidate surface, component by component
    using Patch = std::pair<types::boundary_id, types::material_id>;
    std::map<types::boundary_id, bool> candidates;
    for (const char *name : {PhysicalNames::disc_bore, PhysicalNames::disc_rim, PhysicalNames::pin_side})
      if (model.has_surface(name))
        candidates[model.surface_id(name)] = true;
    std::map<Patch, std::vector<Point<3>>> patches;
    for (const auto &cell : triangulation.active_cell_iterators())
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary() && candidates.count(face->boundary_id()))
          for (const unsigned int v : face->vertex_indices())
            patches[{face->boundary_id(), cell->material_id()}].push_back(face->vertex(v));

    // One manifold for each patch that is a cylinder
    std::map<Patch, types::manifold_id> manifolds;
    for (const auto &[patch, points] : patches)
      if (const auto cylinder = fit_cylinder(points))
        {
          const types::manifold_id id = manifolds.size() + 1;
          manifolds[patch]            = id;
          triangulation.set_manifold(id, CylindricalManifold<3>(Tensor<1, 3>({0., 0., 1.}), cylinder->axis_point));
        }

    // Faces and edges of the cylinders; their rims are remembered
    std::map<std::array<long, 3>, types::manifold_id> curved_edges;
    for (const auto &cell : triangulation.active_cell_iterators())
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary())
          if (const auto it = manifolds.find({face->boundary_id(), cell->material_id()}); it != manifolds.end())
            {
              face->set_all_manifold_ids(it->second);
              for (unsigned int l = 0; l < face->n_lines(); ++l)
                {
                  // An edge along the axis is straight and lies on no rim.
                  const auto line = face->line(l);
                  if (std::hypot(line->vertex(0)[0] - line->vertex(1)[0], line->vertex(0)[1] - line->vertex(1)[1]) > grid)
                    curved_edges[edge_key(0.5 * (line->vertex(0) + line->vertex(1)))] = it->second;
                }
            }

    // The same rims on both sides of the contact: a pin's outline on the disc, the disc's rim or bore on a pad that ends there
    const std::set<types::boundary_id> contact = {model.surface_id(PhysicalNames::disc_contact),
                                                  model.surface_id(PhysicalNames::pin_contact)};
    for (const auto &cell : triangulation.active_cell_iterators())
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary() && contact.count(face->boundary_id()))
          for (unsigned int l = 0; l < face->n_lines(); ++l)
            {
              const auto line = face->line(l);
              const auto it   = curved_edges.find(edge_key(0.5 * (line->vertex(0) + line->vertex(1))));
              if (it != curved_edges.end())
                line->set_manifold_id(it->second);
            }
  }
} // namespace Squeal
