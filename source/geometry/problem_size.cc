#include <squeal/base/exceptions.h>
#include <squeal/base/memory_limit.h>
#include <squeal/base/text.h>
#include <squeal/geometry/problem_size.h>

#include <cmath>
#include <set>

namespace Squeal
{
  namespace
  {
    constexpr double pi = 3.14159265358979323846;

    // Fit of ProblemSize::memory() [byte]
    constexpr double program            = 1.7e8;
    constexpr double per_dof            = 1e4; ///< at reference_dofs; sparse factors grow a little faster than their matrices
    constexpr double reference_dofs     = 3e4;
    constexpr double growth             = 0.15;
    constexpr double quadratic_elements = 2.; ///< rows of their matrices are longer
    constexpr double vectors_per_node = 2., vectors_per_mode = 3.;

    /// Layers of nodes share those of neighbouring layers.
    double nodes_of_stack(const double plan_nodes, const double layers)
    {
      return plan_nodes * (layers + 1.);
    }
  } // namespace

  double ProblemSize::memory(const unsigned int degree, const double n_modes) const
  {
    const double matrices = per_dof * std::pow(std::max(dofs / reference_dofs, 1.), growth) * (degree > 1 ? quadratic_elements : 1.);
    return program + dofs * (matrices + sizeof(double) * (vectors_per_node * contact_nodes + vectors_per_mode * n_modes));
  }

  ProblemSize expected_size(const GeometryParameters &parameters)
  {
    const auto   squared      = [](const double x) { return x * x; };
    const double n_pins       = parameters.top.radii.size() + parameters.bottom.radii.size();
    const double annulus      = pi * (squared(parameters.disc_outer_radius) - squared(parameters.disc_inner_radius));
    const double plan_nodes   = annulus / squared(parameters.element_size);
    const double pin_nodes    = parameters.nodes_per_pin_face;
    const double disc_nodes   = nodes_of_stack(plan_nodes, parameters.disc_layers);
    const double nodes_of_pin = nodes_of_stack(pin_nodes, parameters.pin_layers);
    return {plan_nodes * parameters.disc_layers + n_pins * pin_nodes * parameters.pin_layers, 3. * (disc_nodes + n_pins * nodes_of_pin),
            n_pins * pin_nodes};
  }

  ProblemSize expected_size(const Plan &plan, const GeometryParameters &parameters)
  {
    ProblemSize size{double(plan.faces.size()) * parameters.disc_layers, 3. * nodes_of_stack(plan.points.size(), parameters.disc_layers),
                     0.};
    for (const Plan::Pin &pin : plan.pins)
      {
        const double n_nodes = nodes_of(plan.faces_of(pin)).size();
        size.hexahedra += double(pin.faces.size()) * parameters.pin_layers;
        size.dofs += 3. * nodes_of_stack(n_nodes, parameters.pin_layers);
        size.contact_nodes += n_nodes;
      }
    return size;
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

  void check_memory(const ProblemSize &size, const unsigned int degree, const double n_modes, const std::string &where)
  {
    const double needed = size.memory(degree, n_modes), available = available_memory();
    if (!(needed > available))
      return;
    throw MeshError(text("The scene has about ", size.hexahedra, " hexahedra and ", size.dofs, " dofs, which need about ", needed / 1e9,
                         " GB of memory; ", available / 1e9, " GB are available"),
                    where,
                    "raise Geometry/Element size, lower Geometry/Disc layers, Geometry/Pin layers or Geometry/Nodes per pin face, or lower "
                    "Band/Maximum frequency");
  }
} // namespace Squeal
