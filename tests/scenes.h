// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/model/elasticity.h>
#include <squeal/contact/coupled_system.h>
#include <squeal/contact/travel.h>
#include <squeal/geometry/plan.h>
#include <squeal/geometry/pin_grid.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/model/model.h>

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace Squeal::Testing
{
  /// M, C and K of the bodies, the sums of body_terms(); C is null if no material is damped.
  inline SecondOrderSystem assemble(const Model &model, const MaterialParameters &materials)
  {
    const BodyTerms bodies = body_terms(model, materials);
    return sparse_matrices(bodies.terms, bodies.values);
  }

  using Point3 = std::array<double, 3>;

  // ------------------------------------------------------------------- plans

  /// A pin over a block of sectors and rings of a polar plan.
  struct PolarPin
  {
    Plan::Side side;
    int        sector, n_sectors, ring, n_rings;
  };

  /**
   * An annulus of @p n_rings × @p n_sectors quadrilaterals. Sector 0 begins at
   * the x axis, about which sector -1 - j is the mirror image of sector j.
   * Boundary curves are called @p bore and @p rim; with names other than disc_bore
   * and disc_rim, they remain polygons for quadratic elements.
   */
  inline Plan polar_plan(const double                 inner,
                         const double                 outer,
                         const int                    n_rings,
                         const int                    n_sectors,
                         const std::vector<PolarPin> &pins,
                         const std::string           &bore = "disc_bore",
                         const std::string           &rim  = "disc_rim")
  {
    Plan       plan;
    const auto point = [&](const int ring, const int sector) {
      return static_cast<unsigned int>(ring * n_sectors + (sector % n_sectors + n_sectors) % n_sectors);
    };
    const auto face = [&](const int ring, const int sector) { return point(ring, sector); };
    for (int i = 0; i <= n_rings; ++i)
      for (int j = 0; j < n_sectors; ++j)
        {
          // Compute bitwise mirror images
          const int    k     = std::min(j, n_sectors - j);
          const double r     = inner + (outer - inner) * i / n_rings;
          const double angle = 2. * M_PI * k / n_sectors;
          plan.points.push_back({r * std::cos(angle), (j == k ? r : -r) * std::sin(angle)});
        }
    for (int i = 0; i < n_rings; ++i)
      for (int j = 0; j < n_sectors; ++j)
        plan.faces.push_back({{point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)}});
    for (const PolarPin &pin : pins)
      {
        Plan::Pin part{(pin.side == Plan::Side::top ? "pin_top_" : "pin_bottom_") + std::to_string(plan.pins.size() + 1), pin.side, {}, {}};
        for (int i = pin.ring; i < pin.ring + pin.n_rings; ++i)
          for (int j = pin.sector; j < pin.sector + pin.n_sectors; ++j)
            part.faces.push_back(face(i, j));
        std::sort(part.faces.begin(), part.faces.end());
        plan.pins.push_back(part);
      }
    Plan::Curve inside{bore, {}}, outside{rim, {}};
    for (int j = 0; j < n_sectors; ++j)
      {
        inside.edges.push_back({{point(0, j + 1), point(0, j)}});
        outside.edges.push_back({{point(n_rings, j), point(n_rings, j + 1)}});
      }
    plan.curves = {inside, outside};
    return plan;
  }

  /// A round plate with 6 k boundary nodes and an O-grid, completely covered by a pin, with the axis at (@p distance, 0).
  inline Plan round_plan(const double distance, const double radius, const int k)
  {
    Plan                      plan;
    std::vector<unsigned int> loop;
    Plan::Curve               rim{"disc_rim", {}};
    for (int j = 0; j < 6 * k; ++j)
      {
        const double angle = M_PI * j / (3 * k);
        plan.points.push_back({distance + radius * std::cos(angle), radius * std::sin(angle)});
        loop.push_back(j);
        rim.edges.push_back({{static_cast<unsigned int>(j), static_cast<unsigned int>((j + 1) % (6 * k))}});
      }
    plan.faces  = fill_with_o_grid(loop, plan.points);
    plan.curves = {rim};
    Plan::Pin pin{"pin_top_1", Plan::Side::top, {}, {}};
    for (unsigned int face = 0; face < plan.faces.size(); ++face)
      pin.faces.push_back(face);
    plan.pins = {pin};
    return plan;
  }

  // ------------------------------------------------------------------ meshes

  /// The mesh with all points mapped.
  inline Mesh mapped(Mesh mesh, const std::function<Point3(const Point3 &)> &map)
  {
    for (auto &point : mesh.points)
      {
        const Point3 moved = map({{point[0], point[1], point[2]}});
        point              = {moved[0], moved[1], moved[2]};
      }
    return mesh;
  }

  /// Maps a disc about z = 0 to a ring of radius 0.25 m: upper pins become shoes outside the ring, lower pins shoes inside it.
  inline Mesh turned_to_rims(const Mesh &disc)
  {
    return mapped(disc, [](const Point3 &p) {
      const double r = std::hypot(p[0], p[1]), factor = (0.25 + p[2]) / r;
      return Point3{{factor * p[0], factor * p[1], 0.2 - r}};
    });
  }

  /// The mirror image about the plane y = 0.
  inline Mesh mirrored(Mesh mesh)
  {
    for (auto &point : mesh.points)
      point[1] = -point[1];
    for (auto &hexahedron : mesh.cells)
      {
        std::swap(hexahedron.nodes[1], hexahedron.nodes[3]);
        std::swap(hexahedron.nodes[5], hexahedron.nodes[7]);
      }
    for (auto &quadrilateral : mesh.faces)
      std::swap(quadrilateral.nodes[1], quadrilateral.nodes[3]);
    return mesh;
  }

  /// Default geometry with the given numbers of layers.
  inline GeometryParameters layers(const int disc_layers, const int pin_layers)
  {
    GeometryParameters parameters;
    parameters.disc_layers = disc_layers;
    parameters.pin_layers  = pin_layers;
    return parameters;
  }

  /// Volume of the trilinear hexahedra of one component, by the two-point Gauss rule, which is exact.
  inline double volume(const Mesh &mesh, const unsigned int component)
  {
    constexpr int corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    double        sum          = 0.;
    for (const auto &hexahedron : mesh.cells)
      if (hexahedron.volume == component)
        for (int q = 0; q < 8; ++q)
          {
            double x[3], J[3][3] = {};
            for (int d = 0; d < 3; ++d)
              x[d] = 0.5 + ((q >> d) & 1 ? 0.5 : -0.5) / std::sqrt(3.);
            for (int v = 0; v < 8; ++v)
              for (int e = 0; e < 3; ++e)
                {
                  double gradient = corner[v][e] ? 1. : -1.;
                  for (int d = 0; d < 3; ++d)
                    if (d != e)
                      gradient *= corner[v][d] ? x[d] : 1. - x[d];
                  for (int d = 0; d < 3; ++d)
                    J[d][e] += mesh.points[hexahedron.nodes[v]][d] * gradient;
                }
            sum += (J[0][0] * (J[1][1] * J[2][2] - J[1][2] * J[2][1]) - J[0][1] * (J[1][0] * J[2][2] - J[1][2] * J[2][0]) +
                    J[0][2] * (J[1][0] * J[2][1] - J[1][1] * J[2][0])) /
                   8.;
          }
    return sum;
  }

  // ------------------------------------------------------------------ scenes

  /// Couples bodies given by symmetric matrices.
  inline CoupledSystem couple(const SecondOrderSystem &bodies, const ContactOperators &contact, const ContactDamping &damping = {})
  {
    std::vector<Term> terms = {sparse_term("stiffness of the bodies", 0, {}, bodies.stiffness),
                               sparse_term("mass of the bodies", 2, {}, bodies.mass)};
    if (bodies.damping)
      terms.push_back(sparse_term("damping of the bodies", 1, {}, bodies.damping));
    return Squeal::couple(terms, contact, damping);
  }

  /// A model with its contact interface, matrices and coupled system.
  struct Scene
  {
    Scene(const Mesh                &mesh,
          const MaterialParameters  &materials,
          const OperationParameters &operation,
          const Element              element      = Element::trilinear,
          const MPI_Comm             communicator = MPI_COMM_WORLD)
      : mesh(mesh)
      , operation(operation)
      , model(mesh, element, communicator)
      , interface(contact_nodes(model, ContactParameters().pairs, operation, 1e-6).interface)
      , contact(contact_operators(model, interface))
      , system(assemble(model, materials))
      , damping{radial_dissipation(interface, equal_load_shares(model, interface, operation), operation), {}}
      , contact_damping(Squeal::contact_damping(contact, damping))
      , coupled(couple(system, contact, damping))
    {}

    Mesh                                mesh;
    OperationParameters                 operation;
    Model                               model;
    ContactInterface                    interface;
    ContactOperators                    contact;
    SecondOrderSystem                   system;
    ContactDamping                      damping;         ///< c_b
    std::shared_ptr<const SparseMatrix> contact_damping; ///< C_b
    CoupledSystem                       coupled;
  };

  /// Default materials with the given mounts.
  inline MaterialParameters mounted(const std::vector<Mount> &mounts = {{"disc_bore", 0., 7.80e10, 1.88e10}})
  {
    MaterialParameters materials;
    materials.mounts = mounts;
    return materials;
  }

  /// The materials with different Rayleigh damping of disc and pins.
  inline MaterialParameters damped(MaterialParameters materials)
  {
    materials.disc.rayleigh_alpha = 20.;
    materials.disc.rayleigh_beta  = 1e-7;
    materials.pin.rayleigh_alpha  = 50.;
    materials.pin.rayleigh_beta   = 1e-6;
    return materials;
  }

  inline OperationParameters operating(const RadialDissipation dissipation = RadialDissipation::none,
                                       const Rotation          rotation    = Rotation::positive)
  {
    OperationParameters operation;
    operation.radial_dissipation = dissipation;
    operation.rotation           = rotation;
    return operation;
  }

  /// Free dofs of a displacement field that is zero outside the given component.
  inline MultiVector displacements(const Model &model, const unsigned int component, const std::function<Point3(const Point3 &)> &u)
  {
    MultiVector result(model.free_map(), 1);
    for (const Node &node : model.nodes())
      if (node.component == component)
        {
          const Point3 value = u(node.position);
          for (unsigned int k = 0; k < 3; ++k)
            if (const int i = result.map().place(node.dofs[k]); i >= 0)
              result(i, 0) = value[k];
        }
    return result;
  }

  /// uᵀ A v of single vectors.
  inline double product(const MultiVector &u, const SparseMatrix &A, const MultiVector &v)
  {
    return gram(u, A * v)(0, 0);
  }
} // namespace Squeal::Testing
