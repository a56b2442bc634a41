#include <squeal/bases/reduced_basis.h>
#include <squeal/geometry/geometry_usage.h>
#include <squeal/parameters/catalogue.h>
#include <squeal/studies/parameter_usage.h>

#include <algorithm>

namespace Squeal
{
  namespace
  {
    /// Why a run does not use something; null if it does.
    using Reason = const char *;

    /// When a parameter, or all of a section, is of no use.
    struct UsageRule
    {
      const char *path; ///< "Section/Name", or "Section/" for all of it
      Reason (*why_unused)(const Parameters &);

      bool concerns(const std::string &parameter) const
      {
        const std::string subject = path;
        return subject.back() == '/' ? parameter.rfind(subject, 0) == 0 : parameter == subject;
      }
    };

    // -------------------------------------------------------------- what runs do

    Reason unless(const bool is_used, const Reason reason)
    {
      return is_used ? nullptr : reason;
    }

    /// Whether a study of reduced bases measures one for which @p fits holds.
    template <typename Predicate>
    bool measures_basis(const Parameters &p, const Predicate &fits)
    {
      const auto &names = p.reduction.bases;
      return std::any_of(EnumTable<BasisKind>::names.begin(), EnumTable<BasisKind>::names.end(), [&](const auto &entry) {
        const bool is_chosen = names.empty() ? p.has_friction() || !needs_friction(entry.value) :
                                               std::find(names.begin(), names.end(), entry.name) != names.end();
        return is_chosen && fits(entry.value);
      });
    }

    bool measures_basis(const Parameters &p, const BasisKind kind)
    {
      return p.study == Study::reduction && measures_basis(p, [kind](const BasisKind other) { return other == kind; });
    }

    bool has_real_modes(const BasisKind kind)
    {
      const auto parts = basis_parts(kind);
      return std::find(parts.begin(), parts.end(), BasisPart::real) != parts.end();
    }

    /// Complex modes of full order at one friction coefficient, by the solver that the parameters choose.
    bool solves_for_complex_modes(const Parameters &p)
    {
      return p.study != Study::sweep && p.has_friction();
    }

    bool uses_krylov(const Parameters &p)
    {
      return (solves_for_complex_modes(p) && p.solvers.complex_solver == ComplexSolver::krylov) || measures_basis(p, BasisKind::pod);
    }

    bool iterates_by_residuals(const Parameters &p)
    {
      return solves_for_complex_modes(p) && p.solvers.complex_solver == ComplexSolver::residual_iteration;
    }

    /// Why no mode shape is written; null if some are.
    Reason no_mode_shapes(const Parameters &p)
    {
      if (p.study == Study::sweep)
        return unless(!p.sweep.mode_shapes.empty(), "a sweep writes mode shapes for Sweep/Mode shapes at");
      return unless(p.study == Study::stability, "the study writes no mode shapes");
    }

    // --------------------------------------------------------------------- rules

    Reason no_damping(const Parameters &p)
    {
      return unless(p.has_friction(), "the frictionless problem has no damping");
    }

    Reason map_axis(const Parameters &p)
    {
      return unless(p.sweep.map_parameter != MapParameter::none, "Sweep/Map parameter = none");
    }

    const std::vector<UsageRule> &rules()
    {
      static const std::vector<UsageRule> table = {
        {"Disc material/Rayleigh alpha", no_damping},
        {"Disc material/Rayleigh beta", no_damping},
        {"Pin material/Rayleigh alpha", no_damping},
        {"Pin material/Rayleigh beta", no_damping},
        {"Damping/", no_damping},

        {"Operation/Friction coefficient",
         [](const Parameters &p) {
           if (p.study == Study::sweep)
             return "a sweep goes from Sweep/First to Sweep/Last friction coefficient";
           return unless(p.has_friction() || p.needs_steady_sliding(), "the problem is frictionless");
         }},
        {"Operation/Rotation",
         [](const Parameters &p) { return unless(p.has_friction() || p.needs_steady_sliding(), "the problem is frictionless"); }},
        {"Operation/Rotation speed",
         [](const Parameters &p) {
           // Tables of the steady sliding state show the sliding speeds
           const bool is_shown = p.needs_steady_sliding() && (p.study == Study::stability || p.study == Study::dissipation);
           return unless(is_shown || (p.has_friction() && (p.has_contact_damping() || p.operation.rotating_disc)),
                         "neither contact damping nor gyroscopic forces");
         }},
        {"Operation/Gyroscopic forces",
         [](const Parameters &p) { return unless(p.has_friction(), "the frictionless problem leaves the rotation out"); }},
        {"Operation/Load per side",
         [](const Parameters &p) {
           // Pins without an entry in Steady sliding/Loads share it
           const bool is_shared = p.needs_steady_sliding() && p.sliding.control == BackplateControl::load_per_pin;
           return unless(is_shared || (p.uses_load_per_side() && (p.has_friction() || p.needs_steady_sliding())),
                         p.needs_steady_sliding() ? "Steady sliding/Control = displacement" : "no contact damping");
         }},
        {"Operation/Radial dissipation", no_damping},
        {"Operation/Friction slope", no_damping},

        {"Steady sliding/Contact state",
         [](const Parameters &p) { return unless(p.study != Study::dissipation, "the study compares both states"); }},
        {"Steady sliding/Control",
         [](const Parameters &p) { return unless(p.needs_steady_sliding(), "Steady sliding/Contact state = equal load"); }},
        {"Steady sliding/Displacement",
         [](const Parameters &p) { return unless(p.needs_steady_sliding(), "Steady sliding/Contact state = equal load"); }},
        {"Steady sliding/Loads",
         [](const Parameters &p) { return unless(p.needs_steady_sliding(), "Steady sliding/Contact state = equal load"); }},
        {"Steady sliding/Gaps",
         [](const Parameters &p) { return unless(p.needs_steady_sliding(), "Steady sliding/Contact state = equal load"); }},

        {"Reduction/", [](const Parameters &p) { return unless(p.study == Study::reduction, "of Study = reduction"); }},
        {"Reduction/Component modes",
         [](const Parameters &p) { return unless(measures_basis(p, is_connected), "no basis of component modes is measured"); }},
        {"Reduction/Coupled frequency",
         [](const Parameters &p) { return unless(measures_basis(p, has_real_modes), "no basis of real modes is measured"); }},
        {"Reduction/Grown tolerances",
         [](const Parameters &p) { return unless(measures_basis(p, BasisKind::residual_grown), "no residual-grown basis is measured"); }},
        {"Reduction/Snapshots",
         [](const Parameters &p) { return unless(measures_basis(p, BasisKind::pod), "the basis POD is not measured"); }},
        {"Reduction/POD tolerance",
         [](const Parameters &p) { return unless(measures_basis(p, BasisKind::pod), "the basis POD is not measured"); }},

        {"Sweep/", [](const Parameters &p) { return unless(p.study == Study::sweep, "of Study = sweep"); }},
        {"Sweep/First map value", map_axis},
        {"Sweep/Last map value", map_axis},
        {"Sweep/Number of map values", map_axis},
        {"Sweep/Map friction coefficients", map_axis},

        {"Complex modes/Solver",
         [](const Parameters &p) { return unless(solves_for_complex_modes(p), "the study solves reduced models, or no friction"); }},
        {"Complex modes/Shift inverse", [](const Parameters &p) { return unless(uses_krylov(p), "of the solver Krylov"); }},
        {"Complex modes/Tolerance", [](const Parameters &p) { return unless(uses_krylov(p), "of the solver Krylov"); }},
        {"Complex modes/Iteration tolerance",
         [](const Parameters &p) { return unless(iterates_by_residuals(p), "of the solver residual iteration"); }},
        {"Complex modes/Maximum basis",
         [](const Parameters &p) {
           return unless(iterates_by_residuals(p) || measures_basis(p, BasisKind::residual_grown), "of the solver residual iteration");
         }},

        {"Output/Mode shapes",
         // Who wants none gets none
         [](const Parameters &p) { return p.output.fields == FieldSelection::none ? nullptr : no_mode_shapes(p); }},
        {"Output/Animation frames",
         [](const Parameters &p) {
           if (p.output.animation_frames == 0)
             return Reason(nullptr);
           return p.output.fields == FieldSelection::none ? "Output/Mode shapes = none" : no_mode_shapes(p);
         }},
        {"Output/Write matrices",
         [](const Parameters &p) { return unless(p.study == Study::stability || !p.output.write_matrices, "of Study = stability"); }}};
      return table;
    }

    // ------------------------------------------------------------------ geometry

    /// Lengths, layouts and numbers of elements, which a geometry of the user's own may not use.
    bool is_of_the_geometry(const std::string &path)
    {
      for (const char *name : {"Disc inner radius", "Disc outer radius", "Disc thickness", "Pin diameter", "Pin height", "Top pin radii",
                               "Top pin angles", "Bottom pin radii", "Bottom pin angles", "Nodes per pin face", "Pin layers", "Disc layers",
                               "Element size"})
        if (path == std::string("Geometry/") + name)
          return true;
      return false;
    }

    std::string name_of(const std::string &path)
    {
      return path.substr(path.rfind('/') + 1);
    }

    // ------------------------------------------------------------------- changes

    std::vector<CataloguedParameter> catalogue_of(Parameters parameters)
    {
      dealii::ParameterHandler prm;
      parameters.add_parameters(prm);
      return catalogue(prm);
    }

    /// Paths of the parameters that differ from their defaults.
    std::vector<std::string> changed_parameters(const Parameters &parameters)
    {
      const auto               defaults = catalogue_of(Parameters());
      std::vector<std::string> changed;
      for (const CataloguedParameter &parameter : catalogue_of(parameters))
        if (std::none_of(defaults.begin(), defaults.end(), [&](const CataloguedParameter &other) {
              return other.path == parameter.path && other.value == parameter.value;
            }))
          changed.push_back(parameter.path);
      return changed;
    }
  } // namespace

  std::vector<UnusedParameter> unused_parameters(const Parameters &parameters)
  {
    std::optional<GeometryUsage> geometry; // read only where it matters
    std::vector<UnusedParameter> unused;
    for (const std::string &path : changed_parameters(parameters))
      {
        Reason reason = nullptr;
        for (const UsageRule &rule : rules())
          if (reason == nullptr && rule.concerns(path))
            reason = rule.why_unused(parameters);
        if (is_of_the_geometry(path))
          {
            if (!geometry)
              geometry.emplace(parameters.geometry);
            reason = unless(geometry->uses(name_of(path)), "the geometry does not use it");
          }
        if (reason != nullptr)
          unused.push_back({path, reason});
      }
    return unused;
  }

  std::string unused_parameters_note(const Parameters &parameters)
  {
    std::string text;
    for (const UnusedParameter &parameter : unused_parameters(parameters))
      text += (text.empty() ? "  note: not used here: " : ", ") + parameter.path + " (" + parameter.why + ")";
    return text;
  }

  std::vector<std::string> conditional_parameters()
  {
    std::vector<std::string> paths;
    for (const UsageRule &rule : rules())
      paths.emplace_back(rule.path);
    return paths;
  }
} // namespace Squeal
