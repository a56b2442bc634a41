#include <squeal/geometry/polygon.h>
#include <squeal/model/curved_boundaries.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/grid/tria_accessor.h>
#include <deal.II/grid/tria_iterator.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    using MeshCell = Triangulation<3>::active_cell_iterator;
    using Face     = Triangulation<3>::face_iterator;

    constexpr types::material_id disc = 0;

    /// Largest difference between the distances of a face's vertices from the axis, relative to these.
    constexpr double roundness = 1e-6;

    /// Points closer than this are taken for the same [m]: far below any element size, in any unit of length.
    double resolution(const std::vector<Point<3>> &vertices)
    {
      const auto [lower, upper] = BoundingBox<3>(vertices).get_boundary_points();
      return 1e-7 * lower.distance(upper);
    }

    /// Gives faces the manifolds of cylinders.
    class CylinderFaces
    {
    public:
      CylinderFaces(const Model &model, Triangulation<3> &triangulation)
        : model(model)
        , triangulation(triangulation)
        , grid(resolution(triangulation.get_vertices()))
      {}

      /// Surfaces that are cylinders, component by component.
      void find()
      {
        std::map<Patch, std::vector<Point<2>>> patches; // vertices, seen along z
        for (const auto &cell : triangulation.active_cell_iterators())
          for (const auto &face : cell->face_iterators())
            for (const char *name : candidates)
              if (is_on(face, name))
                for (const unsigned int v : face->vertex_indices())
                  patches[{name, cell->material_id()}].emplace_back(face->vertex(v)[0], face->vertex(v)[1]);
        for (const auto &[patch, points] : patches)
          if (const auto circle = circle_through(points))
            {
              const Cylinder cylinder{types::manifold_id(cylinders.size() + 1), {{circle->centre[0], circle->centre[1]}}};
              cylinders.emplace(patch, cylinder);
            }
      }

      /// The cylinders themselves, then the rings behind them.
      void attach()
      {
        std::vector<RingFace> rings;
        for (const auto &cell : triangulation.active_cell_iterators())
          for (const unsigned int f : cell->face_indices())
            if (const auto cylinder = cylinder_of(cell, f))
              {
                attach(cell->face(f), cylinder->id);
                if (cell->material_id() != disc)
                  add_rings(cell, f, *cylinder, rings);
              }
        std::map<CellId, unsigned int> faces_of_cell;
        for (const RingFace &ring : rings)
          ++faces_of_cell[ring.behind->id()];
        for (const RingFace &ring : rings)
          if (faces_of_cell.at(ring.behind->id()) == 1)
            attach(ring.face, ring.id);
      }

      /// The same rims on both sides of the contact: a pin's outline and rings on the disc, the disc's rim or bore on a pad that ends there.
      void attach_other_side() const
      {
        for (const auto &cell : triangulation.active_cell_iterators())
          for (const auto &face : cell->face_iterators())
            if (is_on(face, PhysicalNames::disc_contact) || is_on(face, PhysicalNames::pin_contact))
              for (unsigned int l = 0; l < face->n_lines(); ++l)
                if (const auto it = curved_edges.find(key(face->line(l))); it != curved_edges.end())
                  face->line(l)->set_manifold_id(it->second);
      }

      std::vector<Cylinder> all() const
      {
        std::vector<Cylinder> result;
        for (const auto &[patch, cylinder] : cylinders)
          result.push_back(cylinder);
        return result;
      }

    private:
      using Patch = std::pair<std::string, types::material_id>; ///< surface, component
      using Line  = Triangulation<3>::line_iterator;
      using Key   = std::array<long, 3>; ///< equal for coincident mid-points of edges

      /// A face between two rings, or between the innermost one and what is inside.
      struct RingFace
      {
        Face               face;
        MeshCell           behind; ///< on the side of the axis
        types::manifold_id id;
      };

      const Model                      &model;
      Triangulation<3>                 &triangulation;
      const double                      grid;
      std::map<Patch, Cylinder>         cylinders;
      std::map<Key, types::manifold_id> curved_edges;

      static constexpr const char *candidates[] = {PhysicalNames::disc_bore, PhysicalNames::disc_rim, PhysicalNames::pin_side};

      bool is_on(const Face &face, const char *surface) const
      {
        return face->at_boundary() && model.has_surface(surface) && model.surface_ids(surface).count(face->boundary_id()) > 0;
      }

      std::optional<Cylinder> cylinder_of(const MeshCell &cell, const unsigned int f) const
      {
        for (const char *name : candidates)
          if (is_on(cell->face(f), name))
            if (const auto it = cylinders.find({name, cell->material_id()}); it != cylinders.end())
              return it->second;
        return {};
      }

      bool is_round(const Face &face, const std::array<double, 2> &axis) const
      {
        double least = std::numeric_limits<double>::max(), most = 0.;
        for (const unsigned int v : face->vertex_indices())
          {
            const double r = std::hypot(face->vertex(v)[0] - axis[0], face->vertex(v)[1] - axis[1]);
            least          = std::min(least, r);
            most           = std::max(most, r);
          }
        return most - least <= roundness * most;
      }

      /// Follows a stack of cells from face @p f of @p cell inwards as long as their faces are round.
      void add_rings(MeshCell cell, unsigned int f, const Cylinder &cylinder, std::vector<RingFace> &rings) const
      {
        while (true)
          {
            const unsigned int opposite = GeometryInfo<3>::opposite_face[f];
            if (cell->face(opposite)->at_boundary() || !is_round(cell->face(opposite), cylinder.axis))
              return;
            const MeshCell behind = cell->neighbor(opposite);
            rings.push_back({cell->face(opposite), behind, cylinder.id});
            f    = cell->neighbor_of_neighbor(opposite);
            cell = behind;
          }
      }

      Key key(const Line &line) const
      {
        const Point<3> p = 0.5 * (line->vertex(0) + line->vertex(1));
        return {{std::lround(p[0] / grid), std::lround(p[1] / grid), std::lround(p[2] / grid)}};
      }

      /// Of a face and its edges, which are remembered but for those along the axis: they are straight and lie on no rim.
      void attach(const Face &face, const types::manifold_id id)
      {
        face->set_all_manifold_ids(id);
        for (unsigned int l = 0; l < face->n_lines(); ++l)
          if (const Line line = face->line(l);
              std::hypot(line->vertex(0)[0] - line->vertex(1)[0], line->vertex(0)[1] - line->vertex(1)[1]) > grid)
            curved_edges[key(line)] = id;
      }
    };
  } // namespace

  std::vector<Cylinder> follow_cylinders(const Model &model, Triangulation<3> &triangulation)
  {
    CylinderFaces faces(model, triangulation);
    faces.find();
    faces.attach();
    faces.attach_other_side();
    return faces.all();
  }
} // namespace Squeal
