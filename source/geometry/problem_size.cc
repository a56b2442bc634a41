#include <squeal/base/exceptions.h>
#include <squeal/base/memory_limit.h>
#include <squeal/base/text.h>
#include <squeal/geometry/problem_size.h>
#include <squeal/parameters/pin_face.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace Squeal
{
  namespace
  {
    // Fit of ProblemSize::memory() [byte]
    constexpr double program            = 3.0e8;
    constexpr double per_dof            = 1.55e4; ///< at reference_dofs; sparse factors grow a little faster than their matrices
    constexpr double reference_dofs     = 3e4;
    constexpr double growth             = 0.03;
    constexpr double quadratic_elements = 2.; ///< rows of their matrices are longer
    constexpr double vectors_per_node = 1., vectors_per_mode = 3.;

    /// Of a plan with numbers of faces and nodes, and of those under all pins together. Layers of nodes share those of neighbouring layers.
    ProblemSize extruded(const double              faces,
                         const double              nodes,
                         const double              pin_faces,
                         const double              pin_nodes,
                         const GeometryParameters &parameters)
    {
      return {faces * parameters.disc_layers + pin_faces * parameters.pin_layers,
              3. * (nodes * (parameters.disc_layers + 1.) + pin_nodes * (parameters.pin_layers + 1.)), pin_nodes};
    }
  } // namespace

  double ProblemSize::memory(const unsigned int degree, const double n_modes) const
  {
    const double matrices = per_dof * std::pow(std::max(dofs / reference_dofs, 1.), growth) * (degree > 1 ? quadratic_elements : 1.);
    const double kept     = dofs * sizeof(double) * vectors_per_node * contact_nodes;
    const double of_nodes = kept <= largest_part_of_attachment_modes * available_memory() ? kept : 0.;
    return program + of_nodes + dofs * (matrices + sizeof(double) * vectors_per_mode * n_modes);
  }

  ProblemSize expected_size(const GeometryParameters &parameters)
  {
    const auto   squared    = [](const double x) { return x * x; };
    const double annulus    = dealii::numbers::PI * (squared(parameters.disc_outer_radius) - squared(parameters.disc_inner_radius));
    const double plan_nodes = annulus / squared(parameters.element_size);
    const double pin_face   = parameters.nodes_per_pin_face + parameters.pin_rings * 6. * blocks_of_pin_face(parameters.nodes_per_pin_face);
    const double pin_nodes  = pin_face * double(parameters.top.radii.size() + parameters.bottom.radii.size());
    return extruded(plan_nodes, plan_nodes, pin_nodes, pin_nodes, parameters);
  }

  ProblemSize expected_size(const Plan &plan, const GeometryParameters &parameters)
  {
    double pin_faces = 0., pin_nodes = 0.;
    for (const Plan::Pin &pin : plan.pins)
      {
        pin_faces += pin.faces.size();
        pin_nodes += nodes_of(plan.faces_of(pin)).size();
      }
    return extruded(plan.faces.size(), plan.points.size(), pin_faces, pin_nodes, parameters);
  }

  ProblemSize expected_size(const HexMesh &mesh, const unsigned int degree)
  {
    std::set<unsigned int> contact;
    for (const HexMesh::Quadrilateral &quadrilateral : mesh.quadrilaterals)
      if (mesh.surface_names[quadrilateral.surface] == PhysicalNames::disc_contact)
        contact.insert(quadrilateral.nodes.begin(), quadrilateral.nodes.end());

    // Of a large grid, each vertex has three edges, three faces and one cell of its own
    constexpr double nodes_per_vertex = 8., nodes_per_surface_vertex = 4.;
    const bool       is_quadratic = degree > 1;
    return {double(mesh.hexahedra.size()), 3. * mesh.points.size() * (is_quadratic ? nodes_per_vertex : 1.),
            contact.size() * (is_quadratic ? nodes_per_surface_vertex : 1.)};
  }

  void check_memory(const ProblemSize &size,
                    const unsigned int degree,
                    const double       n_modes,
                    const std::string &where,
                    const double       further,
                    const MPI_Comm     communicator)
  {
    const double needed = size.memory(degree, n_modes) + further, available = available_memory(communicator);
    if (!(needed > available))
      return;
    throw MeshError(text("The scene has about ", size.hexahedra, " hexahedra and ", size.dofs, " dofs, which need about ", needed / 1e9,
                         " GB of memory; ", available / 1e9, " GB are available"),
                    where,
                    "raise Geometry/Element size, lower Geometry/Disc layers, Geometry/Pin layers or Geometry/Nodes per pin face, or lower "
                    "Band/Maximum frequency");
  }
} // namespace Squeal
