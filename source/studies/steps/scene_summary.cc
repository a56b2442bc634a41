// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/memory.h>
#include <squeal/geometry/cell_volume.h>
#include <squeal/geometry/mesh_topology.h>
#include <squeal/geometry/scene_size.h>
#include <squeal/studies/steps/scene.h>

#include <deal.II/base/bounding_box.h>

namespace Squeal
{
  namespace
  {
    // Plausible ranges for model discs to large machines, and for rubber to beryllium
    constexpr Range disc_radii = {5e-3, 5.};    ///< [m]
    constexpr Range heights    = {1e-5, 1.};    ///< [m]
    constexpr Range densities  = {50., 25000.}; ///< [kg/m³]
    constexpr Range bar_speeds = {20., 20000.}; ///< [m/s]

    constexpr double alike = 1e-3; ///< relative difference below which pins count as equal

    /// Number of modes assumed for the memory estimate, which depends on it only slightly.
    constexpr double typical_modes = 70.;

    /// Summary of the disc, or of equal pins.
    struct Body
    {
      std::vector<std::string> names;
      double                   inner_radius = std::numeric_limits<double>::infinity(), outer_radius = 0.; ///< of its nodes about z [m]
      double                   height = 0., contact_area = 0., volume = 0.; ///< height along z [m], area [m²], volume [m³]
      double                   mass           = 0.;                         ///< mass of each body [kg]
      double                   bar_speed      = 0.;                         ///< √(E/ρ), speed of longitudinal waves in a bar [m/s]
      bool                     is_orthotropic = false;                      ///< if true, the bar lies along material axis 1

      bool is_like(const Body &other) const
      {
        const auto close = [](const double x, const double y) { return std::abs(x - y) <= alike * std::max(std::abs(x), std::abs(y)); };
        return close(height, other.height) && close(contact_area, other.contact_area) && close(volume, other.volume) &&
               close(mass, other.mass) && close(bar_speed, other.bar_speed) && is_orthotropic == other.is_orthotropic;
      }
    };

    double bar_speed(const Material &material)
    {
      return std::sqrt(material.young_modulus / material.density);
    }

    /// Volumes, starting with the disc; volumes with equal height, contact area, volume and material are combined.
    std::vector<Body> summarise_bodies(const Mesh &mesh, const MaterialParameters &materials)
    {
      std::vector<Body>                     bodies(mesh.volume_names.size());
      std::vector<std::vector<Mesh::Point>> points(bodies.size());
      std::vector<unsigned int>             volume_of_node(mesh.points.size());
      for (const Mesh::Cell &cell : mesh.cells)
        {
          Body &body = bodies[cell.volume];
          body.volume += volume_of(mesh, cell);
          for (const unsigned int node : cell.nodes)
            {
              const double radius  = std::hypot(mesh.points[node][0], mesh.points[node][1]);
              body.inner_radius    = std::min(body.inner_radius, radius);
              body.outer_radius    = std::max(body.outer_radius, radius);
              volume_of_node[node] = cell.volume;
              points[cell.volume].push_back(mesh.points[node]);
            }
        }
      for (const Mesh::Face &face : mesh.faces)
        if (const std::string &name = mesh.surface_names[face.surface];
            name == PhysicalNames::pin_contact || name == PhysicalNames::disc_contact)
          bodies[volume_of_node[face.nodes[0]]].contact_area += face_geometry(mesh, face).area_normal.norm();

      std::vector<Body> result;
      for (std::size_t b = 0; b < bodies.size(); ++b)
        {
          const Material material = materials.of(mesh.volume_names[b]);
          Body          &body     = bodies[b];
          body.height             = dealii::BoundingBox<3>(points[b]).side_length(2);
          body.mass               = body.volume * material.density;
          body.bar_speed          = bar_speed(material);
          body.is_orthotropic     = material.orthotropy.has_value();
          auto same = std::find_if(result.begin() + !result.empty(), result.end(), [&](const Body &other) { return other.is_like(body); });
          if (same == result.end())
            same = result.insert(same, body);
          same->names.push_back(mesh.volume_names[b]);
        }
      return result;
    }

    /// Warns if dimensions or materials suggest other units.
    void warn_of_units(const std::vector<Body> &bodies, const MaterialParameters &materials, Run &run)
    {
      if (!disc_radii.contains(bodies[0].outer_radius))
        run.warn(text("the disc has an outer radius of ", bodies[0].outer_radius, " m: check that lengths are in metres"));
      for (const Body &body : bodies)
        if (!heights.contains(body.height))
          run.warn(text(body.names[0], " extends ", body.height, " m along z: check that lengths are in metres"));
      const auto range_text = [](const Range &range, const char *unit) { return text(range.least, " to ", range.greatest, " ", unit); };
      for (const auto &[section, material] : materials.all())
        {
          if (!densities.contains(material.density))
            run.warn(text(section, "/Density is ", material.density, " kg/m^3, outside the range of solids, ",
                          range_text(densities, "kg/m^3"), ": check its unit"));
          if (const double speed = bar_speed(material); !bar_speeds.contains(speed))
            run.warn(text(section, ": sqrt(E/rho) is ", speed, " m/s, outside the range of solids, ", range_text(bar_speeds, "m/s"),
                          ": check that moduli are in Pa and densities in kg/m^3"));
        }
    }

    std::string describe(const Body &body, const bool is_disc)
    {
      const std::string waves = text("bar waves ", body.is_orthotropic ? "along axis 1 " : "", body.bar_speed, " m/s");
      if (is_disc)
        return text("    disc: radii ", body.inner_radius, " and ", body.outer_radius, " m about z, ", body.height, " m thick, ",
                    body.volume, " m^3, ", body.mass, " kg; ", waves);
      const std::string names =
        body.names.size() == 1 ?
          body.names[0] :
          text(body.names.size(), body.names[0].rfind(PhysicalNames::pin_prefix, 0) == 0 ? " pins like " : " volumes like ", body.names[0]);
      return text("    ", names, ": ", body.height, " m high, ", body.contact_area, " m^2 on the disc, ", body.volume, " m^3, ", body.mass,
                  " kg", body.names.size() == 1 ? "; " : " each; ", waves);
    }
  } // namespace

  void summarise_scene(const Mesh &mesh, Run &run)
  {
    const Parameters &parameters = run.parameters;

    const std::vector<Body> bodies = summarise_bodies(mesh, parameters.materials);
    double                  pins   = 0.;
    for (std::size_t b = 0; b < bodies.size(); ++b)
      {
        run.progress.note(describe(bodies[b], b == 0));
        pins += b == 0 ? 0. : bodies[b].names.size() * bodies[b].mass;
      }
    run.measure("disc outer radius [m]", bodies[0].outer_radius);
    run.measure("disc thickness [m]", bodies[0].height);
    run.measure("disc mass [kg]", bodies[0].mass);
    run.measure("pins mass [kg]", pins);

    ProblemSize size = expected_size(mesh, degree_of(parameters.discretization.element));
    if (parameters.solves_by(ComplexSolver::residual_iteration))
      size.contact_nodes = 0.; // no attachment modes
    const double bytes = size.memory(typical_modes);
    run.progress.note(text("    expected: ", size.dofs, " dofs, ", bytes / 1e9, " GB of memory; ", available_memory(run.communicator) / 1e9,
                           " GB are available"));
    run.measure("expected memory [byte]", bytes);

    const bool turns = SlidingVelocity(parameters.operation).turns_about_z();
    if (turns && !is_round_about_z(mesh, parameters.geometry.path()))
      run.warn("the disc turns about the z axis, but is not a body of revolution about this axis: check the geometry and "
               "Operation/Sliding direction");
    for (const MaterialAxes &axes : parameters.materials.axes)
      if (turns && is_of_disc(axes.volume))
        run.warn("the axes of " + axes.volume +
                 " in Materials/Axes do not turn with the disc: remove this entry to use radial, tangential and axial directions");
    warn_of_units(bodies, parameters.materials, run);
    if (const UnnamedContact contact = find_unnamed_contact(mesh); contact.n_nodes > 0)
      run.warn(text(counted(contact.n_nodes, "pair of nodes of different bodies coincides", "pairs of nodes of different bodies coincide"),
                    " outside disc_contact and pin_contact, the first one of ", contact.body, " and ", contact.other, " at (",
                    contact.place[0], ", ", contact.place[1], ", ", contact.place[2], ") m: the bodies touch there, but are not coupled"));
    check_memory(size, typical_modes, parameters.geometry.path(), run.communicator);
  }
} // namespace Squeal
