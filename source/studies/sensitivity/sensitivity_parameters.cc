// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/contact/travel.h>
#include <squeal/sensitivity/mesh_motions.h>
#include <squeal/studies/steps/material_numbers.h>
#include <squeal/studies/sensitivity/sensitivity_results.h>

namespace Squeal
{
  namespace
  {
    /// Step of Poisson's ratio relative to the distance from its limits, and of orthotropic constants relative to their value, or to 1 for
    /// ratios [-]. The relative error of a central difference is about the square of this step.
    constexpr double relative_step = 1e-4;

    /// A constant of an orthotropic material that is not a factor of terms. E1 is a factor: all moduli are proportional to it.
    struct OrthotropicConstant
    {
      const char *name;
      double Orthotropy::*value; ///< null: ν_12
      bool                is_ratio = false;
    };

    const OrthotropicConstant orthotropic_constants[] = {
      {"E2", &Orthotropy::E2},           {"E3", &Orthotropy::E3},   {"nu12", nullptr, true},   {"nu13", &Orthotropy::nu13, true},
      {"nu23", &Orthotropy::nu23, true}, {"G12", &Orthotropy::G12}, {"G13", &Orthotropy::G13}, {"G23", &Orthotropy::G23}};

    SensitivityParameter of_material(const std::string              &section,
                                     const Material                 &material,
                                     const MaterialNumber           &number,
                                     const std::vector<std::string> &volumes,
                                     const std::string              &single = "")
    {
      const bool           is_scale = material.orthotropy && number.value == &Material::young_modulus;
      SensitivityParameter result{
        section + "/" + (is_scale ? "E1 with all moduli in proportion" : number.name), single, number.unit, material.*number.value, {}, {}};
      for (const std::string &volume : volumes)
        result.body_rates[number.parameter(volume)] = {1.};
      return result;
    }

    /// Derivative (X(c + h) − X(c − h)) / 2h of the stiffness of some volumes, and of their stiffness-proportional damping, with respect to
    /// a material constant c.
    SensitivityParameter of_constant(SensitivityParameter                       result,
                                     const Scene                               &scene,
                                     const Material                            &material,
                                     const std::function<double &(Material &)> &constant,
                                     const double                               h,
                                     const std::vector<std::string>            &volumes)
    {
      Material less = material, more = material;
      result.value = constant(less);
      constant(less) -= h;
      constant(more) += h;
      for (unsigned int v = 0; v < scene.model->volume_names().size(); ++v)
        if (const std::string &volume = scene.model->volume_names()[v]; std::count(volumes.begin(), volumes.end(), volume) > 0)
          {
            const std::vector<Term> before = volume_terms(*scene.model, v, less), after = volume_terms(*scene.model, v, more);
            for (std::size_t k = 0; k < after.size(); ++k)
              if (after[k].coefficient.contains(BodyParameter::young_modulus(volume)))
                {
                  result.derivative.push_back(after[k]);
                  result.derivative.back().matrix = add(0.5 / h, *after[k].matrix, -0.5 / h, *before[k].matrix);
                }
          }
      return result;
    }

    SensitivityParameter of_poisson_ratio(const std::string              &section,
                                          const Scene                    &scene,
                                          const Material                 &material,
                                          const std::vector<std::string> &volumes,
                                          const std::string              &single = "")
    {
      const double h = relative_step * std::min(0.5 - material.poisson_ratio, 1. + material.poisson_ratio);
      return of_constant(
        {section + "/Poisson ratio", single, "-", 0., {}, {}}, scene, material,
        [](Material &changed) -> double & { return changed.poisson_ratio; }, h, volumes);
    }

    SensitivityParameter of_orthotropic_constant(const Scene               &scene,
                                                 const Material            &material,
                                                 const OrthotropicConstant &number,
                                                 const std::string         &volume)
    {
      const auto constant = [&number](Material &changed) -> double & {
        return number.value ? *changed.orthotropy.*number.value : changed.poisson_ratio;
      };
      Material     copy = material;
      const double h    = relative_step * (number.is_ratio ? 1. : constant(copy));
      return of_constant({std::string("Materials/Orthotropic:/") + number.name, volume, number.is_ratio ? "-" : "Pa", 0., {}, {}}, scene,
                         material, constant, h, {volume});
    }

    /// Largest displacement of a node in a step, relative to the radius of the disc [-].
    constexpr double motion_step = 3e-6;

    /// The bodies and all contact nodes on a mesh with displaced nodes.
    struct MovedScene
    {
      BodyTerms        bodies;
      ContactInterface interface;
    };

    /// The matrix without zero entries, which come from nodes that do not move.
    std::shared_ptr<const SparseMatrix> without_zeros(const SparseMatrix &A)
    {
      return std::make_shared<SparseMatrix>(A.rows(), A.columns(), [&](const int i, SparseMatrix::Row &row) {
        A.get_row(i, row);
        row.erase(std::remove_if(row.begin(), row.end(), [](const auto &entry) { return entry.second == 0.; }), row.end());
      });
    }

    bool couple_the_same_nodes(const ContactNode &a, const ContactNode &b)
    {
      const auto same = [](const WeightedNode &x, const WeightedNode &y) { return x.node.dofs == y.node.dofs; };
      return std::equal(a.on_disc.begin(), a.on_disc.end(), b.on_disc.begin(), b.on_disc.end(), same) &&
             std::equal(a.on_pin.begin(), a.on_pin.end(), b.on_pin.begin(), b.on_pin.end(), same);
    }

    MovedScene moved_scene(const Scene &scene, const MeshMotion &motion, const double change, const Run &run)
    {
      const Parameters &parameters = run.parameters;
      const Model       model(moved(scene.mesh, motion, change), parameters.discretization.element, run.communicator);
      MovedScene        result{
        body_terms(model, parameters.materials),
        contact_nodes(model, parameters.contact.pairs, parameters.operation, parameters.geometry.pairing_tolerance).interface};
      if (parameters.operation.rotating_disc)
        add_rotation(result.bodies, model, parameters.operation.angular_velocity());
      for (std::size_t c = 0; c < result.interface.size(); ++c)
        if (result.interface.size() != scene.interface.size() || !couple_the_same_nodes(result.interface[c], scene.interface[c]))
          throw MeshError("moving nodes of the mesh changed the contact nodes", "derivatives with respect to " + motion.parameter,
                          "set Sensitivity/Geometry = none");
      return result;
    }
  } // namespace

  std::vector<SensitivityParameter> sensitivity_parameters(const Scene &scene, const Parameters &parameters)
  {
    const MaterialParameters  &materials = parameters.materials;
    const OperationParameters &operation = parameters.operation;

    std::vector<std::vector<std::string>> shared(2); // for disc and pins: volumes with the common material
    std::vector<std::string>              single;    // volumes with their own material, and all pins
    for (const std::string &volume : scene.model->volume_names())
      {
        if (!materials.has_own(volume))
          shared[is_of_disc(volume) ? 0 : 1].push_back(volume);
        if (!is_of_disc(volume) || materials.has_own(volume))
          single.push_back(volume);
      }

    std::vector<SensitivityParameter> result;
    const char *const                 sections[] = {"Disc material", "Pin material"};
    for (const std::size_t m : {0, 1})
      if (!shared[m].empty())
        {
          for (const MaterialNumber &number : material_numbers)
            result.push_back(of_material(sections[m], materials.of(shared[m].front()), number, shared[m]));
          result.push_back(of_poisson_ratio(sections[m], scene, materials.of(shared[m].front()), shared[m]));
        }
    for (const std::string &volume : single)
      for (const MaterialNumber &number : material_numbers)
        if (const bool has_own = materials.has_own(volume);
            has_own || number.value == &Material::young_modulus || number.value == &Material::density)
          result.push_back(
            of_material(materials.section_of(volume) + (has_own ? ":" : ""), materials.of(volume), number, {volume}, volume));
    for (const VolumeMaterial &own : materials.volumes)
      result.push_back(of_poisson_ratio("Materials/Volumes:", scene, own, {own.volume}, own.volume));
    for (const VolumeMaterial &own : materials.orthotropic)
      for (const OrthotropicConstant &number : orthotropic_constants)
        result.push_back(of_orthotropic_constant(scene, materials.of(own.volume), number, own.volume));

    for (const MountParameter &mount : mount_parameters(materials))
      result.push_back({mount.path, "", mount.unit, mount.value, {{mount.name, {1.}}}, {}});

    // Omit contact stiffnesses in steady sliding with contact damping, because the damping would depend on them
    const auto &pairs = parameters.contact.pairs;
    for (unsigned int pair = 0; pair < pairs.size(); ++pair)
      if (pairs[pair].normal_stiffness > 0. && !(parameters.needs_steady_sliding() && parameters.has_contact_damping()))
        {
          result.push_back({text("Contact/Pairs: normal stiffness of ", pairs[pair].disc, " / ", pairs[pair].pin),
                            "",
                            "N/m^3",
                            pairs[pair].normal_stiffness,
                            {},
                            {}});
          result.back().spring_rates = {{contact_stiffness_parameter(pair), {1.}}};
        }

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
