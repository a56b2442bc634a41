// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/studies/steps/parameter_usage.h>

#include <boost/algorithm/string.hpp>

namespace Squeal
{
  namespace
  {
    // --------------------------------------------------------------------- rules

    const auto no_damping = [](const Parameters &p) { return unless(p.has_friction(), "the frictionless problem has no damping"); };
    const auto no_krylov  = [](const Parameters &p) {
      return unless(p.solves_by(ComplexSolver::krylov), "only for Complex modes/Solver = Krylov");
    };
    const auto no_complex_shapes = [](const Parameters &p) {
      return unless(p.output.fields != FieldSelection::none, "Output/Mode shapes = none");
    };
    const auto no_friction = [](const Parameters &p) {
      return unless(p.has_friction() || p.needs_steady_sliding(), "the problem is frictionless");
    };
    const auto no_iteration = [](const Parameters &p) {
      return unless(p.solves_by(ComplexSolver::residual_iteration), "only for Complex modes/Solver = residual iteration");
    };
    const auto no_steady_sliding = [](const Parameters &p) {
      return unless(p.needs_steady_sliding(), "Steady sliding/Contact state = equal load");
    };
    const auto no_frames = [](const Parameters &p) {
      return p.output.animation_frames == 0 ? "Output/Animation frames = 0" : no_complex_shapes(p);
    };

    /// Rules for studies that have no rule of their own for a parameter.
    const std::vector<UsageRule> &general_rules()
    {
      static const std::vector<UsageRule> table = {
        {"Geometry/Outlines",
         [](const Parameters &p) -> Reason {
           return p.discretization.element == Element::quadratic ? "quadratic elements follow the circles" :
                                                                   unless(p.geometry.is_plan(), "the geometry is a solid model");
         }},

        {"Disc material/Rayleigh alpha", no_damping},
        {"Disc material/Rayleigh beta", no_damping},
        {"Pin material/Rayleigh alpha", no_damping},
        {"Pin material/Rayleigh beta", no_damping},
        {"Damping/", no_damping},

        {"Operation/Friction coefficient", no_friction},
        {"Operation/Rotation", no_friction},
        {"Operation/Sliding direction", no_friction},
        {"Operation/Rotation speed",
         // Tables of the steady sliding state contain the sliding speed
         [](const Parameters &p) { return p.needs_steady_sliding() ? nullptr : no_sliding_speed(p); }},
        {"Operation/Gyroscopic forces",
         [](const Parameters &p) { return unless(p.has_friction(), "the frictionless problem does not include rotation"); }},
        {"Operation/Load per side",
         [](const Parameters &p) {
           // The load per side is used by pins that have no entry in Steady sliding/Loads
           const bool is_shared = p.needs_steady_sliding() && p.sliding.control == BackplateControl::load_per_pin;
           return unless(is_shared || (p.uses_load_per_side() && (p.has_friction() || p.needs_steady_sliding())),
                         p.needs_steady_sliding() ? "Steady sliding/Control = displacement" : "no contact damping");
         }},
        {"Operation/Radial dissipation", no_damping},
        {"Operation/Friction slope", no_damping},

        {"Steady sliding/Control", no_steady_sliding},
        {"Steady sliding/Displacement", no_steady_sliding},
        {"Steady sliding/Loads", no_steady_sliding},
        {"Steady sliding/Pressed faces", no_steady_sliding},
        {"Steady sliding/Gaps", no_steady_sliding},

        {"Band/Maximum rate",
         [](const Parameters &p) -> Reason {
           const bool by_reduced_models =
             (p.study->has("Designs/") && !p.study->has("Search/")) || (p.study->has("Sensitivity/") && !p.system);
           return by_reduced_models ? "the study uses reduced models" : no_damping(p);
         }},
        {"Complex modes/Solver", [](const Parameters &p) { return unless(p.has_friction(), "the problem is frictionless"); }},
        {"Complex modes/Shift inverse", no_krylov},
        {"Complex modes/Tolerance", no_krylov},
        {"Complex modes/Iteration tolerance", no_iteration},
        {"Complex modes/Maximum basis", no_iteration},

        {"Output/Animation frames",
         // The value 0 has an effect even without animation
         [](const Parameters &p) { return p.output.animation_frames == 0 ? nullptr : no_complex_shapes(p); }},
        {"Output/Animation periods", no_frames},
        {"Output/Animation growth", no_frames}};
      return table;
    }

    /// True if a run for a system file uses the parameter.
    bool is_used_with_system(const std::string &path, const Parameters &parameters)
    {
      for (const char *used : {"System", "System values", "Study", "Band/", "Real modes/", "Complex modes/", "Linear algebra/",
                               "Output/Write system", "Designs/", "Search/", "Robustness/", "Updating/"})
        if (concerns(used, path))
          return true;
      for (const char *shapes : {"Output/Mode shapes", "Output/Real mode shapes", "Output/Animation frames", "Output/Animation periods",
                                 "Output/Animation growth"})
        if (path == shapes)
          return parameters.study->has("Output/Real mode shapes");
      for (const char *of_study :
           {"Sweep/Parameter", "Sweep/Second parameter", "Sweep/First friction coefficient", "Sweep/Last friction coefficient",
            "Sweep/Number of friction coefficients", "Sweep/Tolerance", "Sweep/Maximum basis", "Sweep/Threshold tolerance",
            "Sweep/Complex plane at", "Sweep/Count modes at", "Reduction/Bases", "Reduction/Coupled frequency", "Reduction/Rank tolerance",
            "Reduction/Grown tolerances", "Reduction/Snapshots", "Reduction/POD tolerance"})
        if (path == of_study)
          return parameters.study->run_of_system != nullptr &&
                 (parameters.study->has("Sweep/Parameter") || parameters.study->has("Reduction/"));
      return false;
    }

    /// Reason why a run does not use a parameter, apart from variables of geometry scripts; empty if the run uses it.
    std::string why_unused(const std::string &path, const Parameters &parameters)
    {
      if (parameters.system && !is_used_with_system(path, parameters))
        return "the system comes from a file";
      if (!parameters.system)
        for (const char *of_system : {"System values", "Sweep/Parameter", "Sweep/Second parameter"})
          if (path == of_system)
            return "System is empty";
      for (const Study *other : studies())
        if (other->has(path) && !parameters.study->has(path))
          return std::string("a parameter of Study = ") + other->name;
      for (const auto *table : {&parameters.study->rules, &general_rules()})
        for (const UsageRule &rule : *table)
          if (concerns(rule.path, path))
            if (const Reason reason = rule.why_unused(parameters); reason == nullptr || *reason != '\0')
              return reason == nullptr ? "" : reason;
      return "";
    }

    // ------------------------------------------------------------------ geometry

    /// Script variable of a parameter: pin_height for "Geometry/Pin height".
    std::string script_variable(const std::string &path)
    {
      const std::string section = "Geometry/";
      return boost::starts_with(path, section) ? boost::replace_all_copy(boost::to_lower_copy(path.substr(section.size())), " ", "_") : "";
    }
  } // namespace

  std::vector<std::string> changed_parameters(Parameters parameters)
  {
    Parameters   defaults;
    Declarations known, present;
    defaults.declare(known);
    parameters.declare(present);
    std::vector<std::string> changed;
    for (const DeclaredParameter &parameter : present.parameters())
      if (const DeclaredParameter *other = known.find(parameter.path); other == nullptr || other->print() != parameter.print())
        changed.push_back(parameter.path);
    return changed;
  }

  Reason no_sliding_speed(const Parameters &parameters)
  {
    return unless(parameters.has_friction() && (parameters.has_contact_damping() || parameters.operation.rotating_disc),
                  "the problem has neither contact damping nor gyroscopic forces");
  }

  std::vector<UnusedParameter> unused_among(const std::vector<std::string> &paths, const Parameters &parameters)
  {
    const auto                           variables = parameters.geometry.script_variables();
    std::optional<std::set<std::string>> used; // computed only if needed
    std::vector<UnusedParameter>         unused;
    for (const std::string &path : paths)
      {
        std::string reason = why_unused(path, parameters);
        if (const std::string variable = script_variable(path); variables.count(variable) > 0)
          {
            if (!used)
              used = parameters.geometry.used_variables();
            if (used->count(variable) == 0)
              reason = "not used by the geometry";
          }
        if (!reason.empty())
          unused.push_back({path, reason});
      }
    return unused;
  }

  std::vector<UnusedParameter> unused_parameters(const Parameters &parameters)
  {
    return unused_among(changed_parameters(parameters), parameters);
  }

  std::string unused_parameters_note(const Parameters &parameters)
  {
    std::string note;
    for (const UnusedParameter &parameter : unused_parameters(parameters))
      note += (note.empty() ? "  note: unused parameters: " : ", ") + parameter.path + " (" + parameter.why + ")";
    for (const std::string &path : parameters.replaced)
      note += (note.empty() ? "  note: unused parameters: " : ", ") + path + " (set by Accuracy = " + to_string(parameters.goal) + ")";
    return note;
  }
} // namespace Squeal
