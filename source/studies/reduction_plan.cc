#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/studies/parameter_usage.h>
#include <squeal/studies/reduction_plan.h>

#include <algorithm>

namespace Squeal
{
  namespace
  {
    bool is_named(const std::vector<std::string> &names, const BasisRecipe &recipe)
    {
      return std::find(names.begin(), names.end(), recipe.name) != names.end();
    }

    void refuse_unknown(const std::vector<std::string> &names)
    {
      for (const std::string &name : names)
        {
          std::string known;
          for (const BasisRecipe &recipe : basis_recipes())
            known += (known.empty() ? "" : ", ") + std::string(recipe.name);
          if (std::none_of(basis_recipes().begin(), basis_recipes().end(), [&](const BasisRecipe &recipe) { return recipe.name == name; }))
            throw ParameterError("there is no basis `" + name + "`", "parameter Reduction/Bases", "choose among " + known);
        }
    }

    // ---------------------------------------------------------------- in use

    /// Whether a basis may be measured for which @p fits holds.
    template <typename Predicate>
    bool measures(const Parameters &p, const Predicate &fits)
    {
      const auto &names = p.reduction.bases;
      return std::any_of(basis_recipes().begin(), basis_recipes().end(), [&](const BasisRecipe &recipe) {
        return (names.empty() ? p.has_friction() || !recipe.needs_friction : is_named(names, recipe)) && fits(recipe);
      });
    }

    bool measures(const Parameters &p, const BasisSource source)
    {
      return measures(p, [source](const BasisRecipe &recipe) { return recipe.rests_on(source); });
    }

    bool has_real_modes(const BasisRecipe &recipe)
    {
      return std::any_of(recipe.parts.begin(), recipe.parts.end(), [](const BasisPart *part) { return part->count == &BasisCounts::real; });
    }

    Reason no_snapshots(const Parameters &p)
    {
      return unless(measures(p, BasisSource::snapshots), "the basis POD is not measured");
    }

    Reason no_krylov(const Parameters &p)
    {
      return unless(measures(p, BasisSource::snapshots) || p.solves_by(ComplexSolver::krylov), "of the solver Krylov");
    }
  } // namespace

  bool ReductionPlan::rests_on(const BasisSource source) const
  {
    return std::any_of(recipes.begin(), recipes.end(), [source](const BasisRecipe *recipe) { return recipe->rests_on(source); });
  }

  bool ReductionPlan::any_connected() const
  {
    return std::any_of(recipes.begin(), recipes.end(), [](const BasisRecipe *recipe) { return recipe->is_connected(); });
  }

  ReductionPlan reduction_plan(const Parameters &parameters)
  {
    const OperationParameters &operation   = parameters.operation;
    const MaterialParameters  &materials   = parameters.materials;
    const auto                &names       = parameters.reduction.bases;
    const bool                 friction    = parameters.has_friction();
    const bool                 has_damping = operation.radial_dissipation != RadialDissipation::none || operation.friction_slope != 0. ||
                             materials.disc.is_damped() || materials.pin.is_damped();
    refuse_unknown(names);

    ReductionPlan plan;
    plan.has_friction               = friction;
    plan.friction_coefficient       = friction ? operation.friction_coefficient : 0.;
    plan.largest_circular_frequency = circular_frequency(parameters.discretization.maximum_frequency);
    for (const BasisRecipe &recipe : basis_recipes())
      {
        const bool fits = (friction || !recipe.needs_friction) && (has_damping || !recipe.needs_damping);
        if (!names.empty() && is_named(names, recipe) && !fits)
          throw ParameterError(std::string("the basis `") + recipe.name + "` " +
                                 (friction ? "needs damping, and there is none" : "belongs to the problem with friction"),
                               "parameter Reduction/Bases",
                               friction ? "switch a damping on, or leave the basis out" :
                                          "set Reduction/Problem = friction, or leave it out");
        if (names.empty() ? fits : is_named(names, recipe))
          plan.recipes.push_back(&recipe);
      }
    if (plan.rests_on(BasisSource::snapshots) && parameters.reduction.snapshots.empty())
      throw ParameterError("the basis POD has no snapshots", "parameter Reduction/Snapshots", "give at least one friction coefficient");
    return plan;
  }

  std::vector<UsageRule> reduction_usage()
  {
    return {{"Operation/Rotation speed", no_sliding_speed},
            {"Reduction/Component modes",
             [](const Parameters &p) {
               const auto is_connected = [](const BasisRecipe &recipe) { return recipe.is_connected(); };
               return unless(measures(p, is_connected), "no basis of component modes is measured");
             }},
            {"Reduction/Coupled frequency",
             [](const Parameters &p) { return unless(measures(p, has_real_modes), "no basis of real modes is measured"); }},
            {"Reduction/Grown tolerances",
             [](const Parameters &p) { return unless(measures(p, BasisSource::residuals), "no residual-grown basis is measured"); }},
            {"Reduction/Snapshots", no_snapshots},
            {"Reduction/POD tolerance", no_snapshots},
            {"Complex modes/Shift inverse", no_krylov},
            {"Complex modes/Tolerance", no_krylov},
            {"Complex modes/Maximum basis", [](const Parameters &p) {
               return unless(measures(p, BasisSource::residuals) || p.solves_by(ComplexSolver::residual_iteration),
                             "of the solver residual iteration");
             }}};
  }
} // namespace Squeal
