#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/studies/steps/parameter_usage.h>
#include <squeal/studies/steps/reduction_plan.h>

#include <boost/algorithm/string/join.hpp>

#include <algorithm>
#include <functional>

namespace Squeal
{
  namespace
  {
    /// Whether a basis belongs to the problem.
    bool fits(const BasisRecipe &recipe, const Parameters &p)
    {
      const bool has_damping = p.operation.radial_dissipation != RadialDissipation::none || p.operation.friction_slope != 0. ||
                               p.materials.disc.is_damped() || p.materials.pin.is_damped();
      return (p.has_friction() || !recipe.needs_friction) && (has_damping || !recipe.needs_damping);
    }

    /// Bases that the parameters name; all that fit where they name none.
    std::vector<const BasisRecipe *> chosen_recipes(const Parameters &p)
    {
      const std::vector<std::string>  &names = p.reduction.bases;
      std::vector<const BasisRecipe *> result;
      for (const BasisRecipe &recipe : basis_recipes())
        if (names.empty() ? fits(recipe, p) : std::find(names.begin(), names.end(), recipe.name) != names.end())
          result.push_back(&recipe);
      return result;
    }

    void refuse_unknown(const std::vector<std::string> &names)
    {
      std::vector<std::string> known;
      for (const BasisRecipe &recipe : basis_recipes())
        known.emplace_back(recipe.name);
      for (const std::string &name : names)
        if (find_recipe(name) == nullptr)
          throw ParameterError("there is no basis `" + name + "`", "parameter Reduction/Bases",
                               "choose among " + boost::algorithm::join(known, ", "));
    }

    // ---------------------------------------------------------------- in use

    /// Whether a basis is measured for which @p fits holds.
    template <typename Predicate>
    bool measures(const Parameters &p, const Predicate &fits)
    {
      const auto recipes = chosen_recipes(p);
      return std::any_of(recipes.begin(), recipes.end(), [&](const BasisRecipe *recipe) { return fits(*recipe); });
    }

    bool measures(const Parameters &p, const BasisSource source)
    {
      return measures(p, [source](const BasisRecipe &recipe) { return recipe.rests_on(source); });
    }

    Reason no_snapshots(const Parameters &p)
    {
      return unless(measures(p, BasisSource::snapshots), "the basis POD is not measured");
    }

    Reason no_krylov_for_bases(const Parameters &p)
    {
      return unless(measures(p, BasisSource::snapshots) || p.solves_by(ComplexSolver::krylov), "of the solver Krylov");
    }
  } // namespace

  bool ReductionPlan::rests_on(const BasisSource source) const
  {
    return std::any_of(recipes.begin(), recipes.end(), [source](const BasisRecipe *recipe) { return recipe->rests_on(source); });
  }

  ReductionPlan reduction_plan(const Parameters &parameters)
  {
    const bool friction = parameters.has_friction();
    refuse_unknown(parameters.reduction.bases);
    ReductionPlan plan;
    plan.recipes                    = chosen_recipes(parameters);
    plan.has_friction               = friction;
    plan.friction_coefficient       = friction ? parameters.operation.friction_coefficient : 0.;
    plan.largest_circular_frequency = circular_frequency(parameters.discretization.maximum_frequency);
    for (const BasisRecipe *recipe : plan.recipes)
      if (!fits(*recipe, parameters))
        throw ParameterError(std::string("the basis `") + recipe->name + "` " +
                               (friction ? "needs damping, and there is none" : "belongs to the problem with friction"),
                             "parameter Reduction/Bases",
                             friction ? "switch a damping on, or leave the basis out" :
                                        "set Reduction/Problem = friction, or leave it out");
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
             [](const Parameters &p) {
               return unless(measures(p, std::mem_fn(&BasisRecipe::has_real_modes)), "no basis of real modes is measured");
             }},
            {"Reduction/Grown tolerances",
             [](const Parameters &p) { return unless(measures(p, BasisSource::residuals), "no residual-grown basis is measured"); }},
            {"Reduction/Snapshots", no_snapshots},
            {"Reduction/POD tolerance", no_snapshots},
            {"Complex modes/Shift inverse", no_krylov_for_bases},
            {"Complex modes/Tolerance", no_krylov_for_bases},
            {"Complex modes/Maximum basis", [](const Parameters &p) {
               return unless(measures(p, BasisSource::residuals) || p.solves_by(ComplexSolver::residual_iteration),
                             "of the solver residual iteration");
             }}};
  }
} // namespace Squeal
