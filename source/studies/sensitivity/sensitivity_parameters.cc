#include <squeal/base/exceptions.h>
#include <squeal/contact/travel.h>
#include <squeal/sensitivity/mesh_motions.h>
#include <squeal/studies/sensitivity/sensitivity_results.h>

namespace Squeal
{
  namespace
  {
    /// Step of Poisson's ratio beside its distance from the ends of its range: the error of a central difference is about the square of it.
    constexpr double relative_step = 1e-4;

    /// A number of a material that the terms contain as a factor.
    struct MaterialNumber
    {
      const char *name, *unit;
      double Material::*value;
      std::string (*parameter)(const std::string &body);
      bool of_single_pins;
    };

    const MaterialNumber material_numbers[] = {{"Young modulus", "Pa", &Material::young_modulus, BodyParameter::young_modulus, true},
                                               {"Density", "kg/m^3", &Material::density, BodyParameter::density, true},
                                               {"Rayleigh alpha", "1/s", &Material::rayleigh_alpha, BodyParameter::rayleigh_alpha, false},
                                               {"Rayleigh beta", "s", &Material::rayleigh_beta, BodyParameter::rayleigh_beta, false}};

    SensitivityParameter of_material(const std::string              &section,
                                     const Material                 &material,
                                     const MaterialNumber           &number,
                                     const std::vector<std::string> &bodies,
                                     const std::string              &single = "")
    {
      SensitivityParameter result{section + "/" + number.name, single, number.unit, material.*number.value, {}, {}};
      for (const std::string &body : bodies)
        result.body_rates[number.parameter(body)] = {1.};
      return result;
    }

    /// (X(ν + h) − X(ν − h)) / 2h of the stiffness of some bodies, and of their damping by stiffness.
    SensitivityParameter of_poisson_ratio(const std::string        &section,
                                          const Scene              &scene,
                                          const MaterialParameters &materials,
                                          Material MaterialParameters::  *material,
                                          const std::vector<std::string> &bodies)
    {
      MaterialParameters less = materials, more = materials;
      const double       nu = (materials.*material).poisson_ratio, h = relative_step * std::min(0.5 - nu, 1. + nu);
      (less.*material).poisson_ratio -= h;
      (more.*material).poisson_ratio += h;
      SensitivityParameter    result{section + "/Poisson ratio", "", "-", nu, {}, {}};
      const std::vector<Term> before = body_terms(*scene.model, less).terms, after = body_terms(*scene.model, more).terms;
      for (std::size_t k = 0; k < after.size(); ++k)
        for (const std::string &body : bodies)
          if (after[k].coefficient.contains(BodyParameter::young_modulus(body)))
            {
              result.derivative.push_back(after[k]);
              result.derivative.back().matrix = add(0.5 / h, *after[k].matrix, -0.5 / h, *before[k].matrix);
            }
      return result;
    }

    /// Largest motion of a node by a step, over the radius of the disc.
    constexpr double motion_step = 3e-6;

    /// The bodies and all contact nodes on a mesh whose nodes have moved.
    struct MovedScene
    {
      BodyTerms        bodies;
      ContactInterface interface;
    };

    /// The matrix without entries that are zero: where no node moves, nothing changes.
    std::shared_ptr<const SparseMatrix> without_zeros(const SparseMatrix &A)
    {
      return std::make_shared<SparseMatrix>(A.rows(), A.columns(), [&](const int i, SparseMatrix::Row &row) {
        A.get_row(i, row);
        row.erase(std::remove_if(row.begin(), row.end(), [](const auto &entry) { return entry.second == 0.; }), row.end());
      });
    }

    MovedScene moved_scene(const Scene &scene, const MeshMotion &motion, const double change, const Run &run)
    {
      const Parameters &parameters = run.parameters;
      const Model       model(moved(scene.mesh, motion, change), parameters.discretization.element, run.communicator);
      MovedScene        result{body_terms(model, parameters.materials),
                        pair_contact_nodes(model, parameters.operation.rotation, parameters.geometry.pairing_tolerance)};
      if (parameters.operation.rotating_disc)
        add_rotation(result.bodies, model, parameters.operation.angular_velocity());
      for (std::size_t c = 0; c < result.interface.size(); ++c)
        if (result.interface.size() != scene.interface.size() || result.interface[c].disc_node.dofs != scene.interface[c].disc_node.dofs ||
            result.interface[c].pin_node.dofs != scene.interface[c].pin_node.dofs)
          throw MeshError("contact nodes have changed their numbers while they moved", "derivatives with respect to " + motion.parameter,
                          "set Sensitivity/Geometry = none");
      return result;
    }
  } // namespace

  std::vector<SensitivityParameter> sensitivity_parameters(const Scene &scene, const Parameters &parameters)
  {
    const MaterialParameters       &materials  = parameters.materials;
    const OperationParameters      &operation  = parameters.operation;
    const std::vector<std::string> &components = scene.model->component_names();
    const std::vector<std::string>  disc       = {components.front()};
    std::vector<std::string>        alike, pins(components.begin() + 1, components.end()); // pins without a material of their own; all
    for (const std::string &pin : pins)
      if (std::none_of(materials.single_pins.begin(), materials.single_pins.end(),
                       [&](const PinMaterial &single) { return single.pin == pin; }))
        alike.push_back(pin);

    std::vector<SensitivityParameter> result;
    for (const MaterialNumber &number : material_numbers)
      result.push_back(of_material("Disc material", materials.disc, number, disc));
    result.push_back(of_poisson_ratio("Disc material", scene, materials, &MaterialParameters::disc, disc));
    // Single pins have the damping of all
    for (const MaterialNumber &number : material_numbers)
      if (const std::vector<std::string> &bodies = number.of_single_pins ? alike : pins; !bodies.empty())
        result.push_back(of_material("Pin material", materials.pin, number, bodies));
    if (!alike.empty())
      result.push_back(of_poisson_ratio("Pin material", scene, materials, &MaterialParameters::pin, alike));
    for (const std::string &pin : pins)
      for (const MaterialNumber &number : material_numbers)
        if (number.of_single_pins)
          {
            const bool is_alike = std::find(alike.begin(), alike.end(), pin) != alike.end();
            result.push_back(of_material(is_alike ? "Pin material" : "Pin material/Single pins", materials.of(pin), number, {pin}, pin));
            if (!is_alike)
              result.back().path = std::string("Pin material/Single pins: ") + number.name;
          }

    for (const MountParameter &mount : mount_parameters(materials))
      result.push_back({mount.path, "", mount.unit, mount.value, {{mount.name, {1.}}}, {}});

    const auto &ratios = parameters.damping.modal_ratios;
    for (std::size_t i = 0; i < ratios.size(); ++i)
      result.push_back({text("Damping/Modal damping ratio: ", exact_text(ratios[i].frequency), " Hz"),
                        "",
                        "-",
                        ratios[i].ratio,
                        {},
                        {},
                        nullptr,
                        {},
                        static_cast<int>(i)});

    result.push_back(
      {"Operation/Friction coefficient", "", "-", operation.friction_coefficient, {}, {}, &OperationParameters::friction_coefficient});
    const bool is_damped = parameters.has_contact_damping();
    if (is_damped && parameters.uses_load_per_side())
      result.push_back({"Operation/Load per side", "", "N", operation.load_per_side, {}, {}, &OperationParameters::load_per_side});
    if (is_damped || operation.rotating_disc)
      {
        result.push_back({"Operation/Rotation speed", "", "rad/s", operation.rotation_speed, {}, {}, &OperationParameters::rotation_speed});
        if (operation.rotating_disc)
          result.back().body_rates[BodyParameter::angular_velocity] = {operation.angular_velocity() < 0. ? -1. : 1.};
      }
    if (operation.load_per_side > 0. && have_travels(*scene.model, scene.interface))
      result.push_back({"Operation/Friction slope", "", "s/m", operation.friction_slope, {}, {}, &OperationParameters::friction_slope});
    return result;
  }

  std::vector<SensitivityParameter> geometry_sensitivity_parameters(const Scene &scene, const BodyTerms &bodies, Run &run)
  {
    const GeometryParameters         &geometry = run.parameters.geometry;
    const GeometrySensitivities       wanted   = run.parameters.sensitivity.geometry;
    std::vector<SensitivityParameter> result;
    if (wanted == GeometrySensitivities::none || geometry.file != GeometryParameters().file)
      return result;
    run.progress.begin("Moved meshes");
    for (const MeshMotion &motion : mesh_motions(scene.mesh, geometry))
      {
        if (!motion.pin.empty() && wanted != GeometrySensitivities::sizes_and_places)
          continue;
        run.progress.update(motion.parameter + " " + motion.pin);
        const double         step   = motion_step * geometry.disc_outer_radius / largest_velocity(motion);
        const MovedScene     before = moved_scene(scene, motion, -step, run), after = moved_scene(scene, motion, step, run);
        SensitivityParameter parameter{motion.parameter, motion.pin, motion.unit, motion.value, {}, {}};
        for (std::size_t k = 0; k < bodies.terms.size(); ++k)
          {
            const auto difference = add(0.5 / step, *after.bodies.terms[k].matrix, -0.5 / step, *before.bodies.terms[k].matrix);
            if (max_norm(*difference) > 0.)
              {
                parameter.derivative.push_back(bodies.terms[k]);
                parameter.derivative.back().matrix = difference;
              }
          }
        // One matrix of each kind instead of one for each body
        parameter.derivative = merged(parameter.derivative, bodies.values);
        for (Term &term : parameter.derivative)
          term.matrix = without_zeros(*term.matrix);
        if (motion.moves_contact)
          parameter.contact = std::make_shared<ContactMotion>(ContactMotion{before.interface, after.interface,
                                                                            contact_operators(*scene.model, before.interface),
                                                                            contact_operators(*scene.model, after.interface), 2. * step});
        result.push_back(std::move(parameter));
      }
    run.progress.finish(text(result.size(), " lengths and angles"));
    return result;
  }
} // namespace Squeal
