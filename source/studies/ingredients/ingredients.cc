#include <squeal/base/text.h>
#include <squeal/studies/ingredients/ingredients.h>

#include <algorithm>

namespace Squeal
{
  namespace
  {
    /// Real modes of a basis that has upper modes go up to (1 + this) times the end of the band.
    constexpr double upper_modes = 0.5;
    /// End of a shorter band, as a part of the end of the band.
    constexpr double shorter_band = 0.5;

    // What ingredients are called ------------------------------------------------

    template <RadialDissipation dissipation>
    std::string dissipation_name(const Parameters &)
    {
      return to_string(dissipation);
    }

    std::string dissipation_here(const Parameters &p)
    {
      return to_string(p.operation.radial_dissipation);
    }

    std::string state_here(const Parameters &p)
    {
      return to_string(p.sliding.state);
    }

    std::string element_here(const Parameters &p)
    {
      return to_string(p.discretization.element);
    }

    std::string outlines_here(const Parameters &p)
    {
      return to_string(p.geometry.outlines);
    }

    std::string slope_text(const double slope)
    {
      return slope == 0. ? "none" : exact_text(slope) + " s/m";
    }

    bool has_rayleigh_damping(const Parameters &p)
    {
      return p.materials.disc.is_damped() || p.materials.pin.is_damped();
    }

    std::string modal_here(const Parameters &p)
    {
      return p.damping.modal_ratios.empty() ? "none" : "as given";
    }

    std::string on_or_off(const bool is_on)
    {
      return is_on ? "on" : "off";
    }

    std::string hertz_text(const double frequency)
    {
      return exact_text(frequency) + " Hz";
    }

    std::string nothing(const Parameters &)
    {
      return "none";
    }

    // Why a scene cannot have them -----------------------------------------------

    Reason no_sliding(const Parameters &p, const std::optional<SlidingState> &)
    {
      return p.operation.load_per_side > 0. && p.operation.rotation_speed > 0. ? nullptr :
                                                                                 "nothing presses or slides: no load or no rotation speed";
    }

    Reason no_open_node(const Parameters &, const std::optional<SlidingState> &state)
    {
      if (!state)
        return "equal shares of the load close all nodes; see contact state";
      return std::count(state->closed.begin(), state->closed.end(), false) > 0 ? nullptr : "no node lifts off";
    }

    template <Element element>
    bool has_element(const Parameters &p)
    {
      return p.discretization.element == element;
    }

    template <Element element>
    std::string element_name(const Parameters &)
    {
      return to_string(element);
    }

    template <Element element>
    void take_element(Variation &v)
    {
      v.parameters.discretization.element = element;
    }

    Reason no_polygon(const Parameters &p, const std::optional<SlidingState> &)
    {
      if (has_element<Element::quadratic>(p))
        return "edges of quadratic elements follow the circles";
      return unless(p.geometry.is_plan(), "the geometry is a solid, whose outlines are as it has them");
    }

    template <const char *reduced_basis>
    void reduce(Variation &v)
    {
      v.basis = reduced_basis;
    }

    constexpr char real_modes[] = "real", first_order[] = "real + 1st-ord.";
  } // namespace

  const std::vector<Ingredient> &ingredients()
  {
    using P                                    = const Parameters &;
    static const std::vector<Ingredient> table = {
      // ------------------------------------------------------------------- contact
      {"radial dissipation", dissipation_here, dissipation_name<RadialDissipation::none>,
       [](P p) { return p.operation.radial_dissipation == RadialDissipation::none; },
       [](Variation &v) { v.parameters.operation.radial_dissipation = RadialDissipation::none; }, ChangeKind::removes, Departure::friction},
      {"radial dissipation", dissipation_here, dissipation_name<RadialDissipation::consistent>,
       [](P p) { return p.operation.radial_dissipation != RadialDissipation::none; },
       [](Variation &v) { v.parameters.operation.radial_dissipation = RadialDissipation::consistent; }, ChangeKind::adds,
       Departure::friction, no_sliding},
      {"contact state", state_here, [](P) { return to_string(ContactState::equal_load); },
       [](P p) { return p.sliding.state == ContactState::equal_load; },
       [](Variation &v) { v.parameters.sliding.state = ContactState::equal_load; }, ChangeKind::removes, Departure::contact},
      {"contact state", state_here, [](P) { return to_string(ContactState::steady_sliding); },
       [](P p) { return p.sliding.state == ContactState::steady_sliding; },
       [](Variation &v) { v.parameters.sliding.state = ContactState::steady_sliding; }, ChangeKind::adds, Departure::contact, no_sliding},
      {"lift-off", [](P p) { return on_or_off(p.sliding.state == ContactState::steady_sliding); }, [](P) { return on_or_off(false); },
       [](P) { return false; }, [](Variation &v) { v.without_lift_off = true; }, ChangeKind::shows, Departure::contact, no_open_node},
      {"friction slope", [](P p) { return slope_text(p.operation.friction_slope); }, nothing,
       [](P p) { return p.operation.friction_slope == 0.; }, [](Variation &v) { v.parameters.operation.friction_slope = 0.; },
       ChangeKind::removes, Departure::friction},
      {"friction slope", [](P p) { return slope_text(p.operation.friction_slope); },
       [](P p) { return slope_text(p.ingredients.trial_slope); }, [](P p) { return p.operation.friction_slope != 0.; },
       [](Variation &v) { v.parameters.operation.friction_slope = v.parameters.ingredients.trial_slope; }, ChangeKind::adds,
       Departure::friction,
       [](P p, const std::optional<SlidingState> &state) {
         return p.ingredients.trial_slope == 0. ? "the scene has none, and Ingredients/Trial friction slope gives none to try" :
                                                  no_sliding(p, state);
       }},

      // ------------------------------------------------------------------- bodies
      {"Rayleigh damping", [](P p) { return has_rayleigh_damping(p) ? std::string("as given") : "none"; }, nothing, [](P) { return false; },
       [](Variation &v) {
         for (Material *material : {&v.parameters.materials.disc, &v.parameters.materials.pin})
           material->rayleigh_alpha = material->rayleigh_beta = 0.;
       },
       ChangeKind::removes, Departure::mesh,
       [](P p, const std::optional<SlidingState> &) { return unless(has_rayleigh_damping(p), "the materials have none"); }},
      {"modal damping", modal_here, nothing, [](P p) { return p.damping.modal_ratios.empty(); },
       [](Variation &v) { v.parameters.damping.modal_ratios.clear(); }, ChangeKind::removes, Departure::friction},
      {"modal damping", modal_here, [](P p) { return exact_text(p.ingredients.trial_damping_ratio); },
       [](P p) { return !p.damping.modal_ratios.empty(); },
       [](Variation &v) {
         v.parameters.damping.modal_ratios = {{0., v.parameters.ingredients.trial_damping_ratio}};
       },
       ChangeKind::adds, Departure::friction,
       [](P p, const std::optional<SlidingState> &) {
         return unless(p.ingredients.trial_damping_ratio > 0., "the scene has none, and Ingredients/Trial damping ratio gives none to try");
       }},
      {"rotation of the disc", [](P p) { return on_or_off(p.operation.rotating_disc); }, [](P) { return on_or_off(false); },
       [](P p) { return !p.operation.rotating_disc; }, [](Variation &v) { v.parameters.operation.rotating_disc = false; },
       ChangeKind::removes, Departure::mesh},
      {"rotation of the disc", [](P p) { return on_or_off(p.operation.rotating_disc); }, [](P) { return on_or_off(true); },
       [](P p) { return p.operation.rotating_disc; }, [](Variation &v) { v.parameters.operation.rotating_disc = true; }, ChangeKind::adds,
       Departure::mesh},

      // ------------------------------------------------------------- discretisation
      {"element", element_here, element_name<Element::trilinear>, has_element<Element::trilinear>, take_element<Element::trilinear>,
       ChangeKind::speeds, Departure::mesh},
      {"element", element_here, element_name<Element::incompatible_modes>, [](P p) { return !has_element<Element::quadratic>(p); },
       take_element<Element::incompatible_modes>, ChangeKind::speeds, Departure::mesh},
      {"element", element_here, element_name<Element::incompatible_modes>, [](P p) { return !has_element<Element::trilinear>(p); },
       take_element<Element::incompatible_modes>, ChangeKind::adds, Departure::mesh},
      {"element", element_here, element_name<Element::quadratic>, has_element<Element::quadratic>, take_element<Element::quadratic>,
       ChangeKind::adds, Departure::mesh},
      {"outlines", outlines_here, [](P) { return to_string(Outlines::inscribed); },
       [](P p) { return p.geometry.outlines == Outlines::inscribed; },
       [](Variation &v) { v.parameters.geometry.outlines = Outlines::inscribed; }, ChangeKind::shows, Departure::mesh, no_polygon},
      {"outlines", outlines_here, [](P) { return to_string(Outlines::true_area); },
       [](P p) { return p.geometry.outlines == Outlines::true_area; },
       [](Variation &v) { v.parameters.geometry.outlines = Outlines::true_area; }, ChangeKind::adds, Departure::mesh, no_polygon},

      // -------------------------------------------------------------------- modes
      {"complex modes", [](P p) { return to_string(p.solvers.complex_solver); }, [](P) { return to_string(ComplexSolver::krylov); },
       [](P p) { return p.solvers.complex_solver == ComplexSolver::krylov; },
       [](Variation &v) { v.parameters.solvers.complex_solver = ComplexSolver::krylov; }, ChangeKind::speeds, Departure::friction},
      {"complex modes", [](P p) { return to_string(p.solvers.complex_solver); },
       [](P) { return to_string(ComplexSolver::residual_iteration); },
       [](P p) { return p.solvers.complex_solver == ComplexSolver::residual_iteration; },
       [](Variation &v) { v.parameters.solvers.complex_solver = ComplexSolver::residual_iteration; }, ChangeKind::speeds,
       Departure::friction},
      {"complex modes", [](P p) { return to_string(p.solvers.complex_solver); }, [](P) { return std::string("real modes alone"); },
       [](P) { return false; }, reduce<real_modes>, ChangeKind::shows, Departure::friction},
      {"complex modes", [](P p) { return to_string(p.solvers.complex_solver); },
       [](P p) { return "real modes to " + hertz_text((1. + upper_modes) * p.discretization.maximum_frequency); }, [](P) { return false; },
       [](Variation &v) {
         v.basis  = real_modes;
         v.margin = upper_modes;
       },
       ChangeKind::shows, Departure::friction},
      {"complex modes", [](P p) { return to_string(p.solvers.complex_solver); }, [](P) { return std::string("real modes + 1st order"); },
       [](P) { return false; }, reduce<first_order>, ChangeKind::shows, Departure::friction},
      {"band", [](P p) { return "to " + hertz_text(p.discretization.maximum_frequency); },
       [](P p) { return "to " + hertz_text(shorter_band * p.discretization.maximum_frequency); }, [](P) { return false; },
       [](Variation &v) { v.parameters.discretization.maximum_frequency *= shorter_band; }, ChangeKind::shows, Departure::modes}};
    return table;
  }

  std::vector<const Ingredient *> ingredients_to_try(const Parameters &parameters)
  {
    std::vector<const Ingredient *> result;
    for (const Ingredient &ingredient : ingredients())
      if (!ingredient.is_present(parameters))
        result.push_back(&ingredient);
    return result;
  }

  Variation combined(const Parameters &parameters, const std::vector<const Ingredient *> &changed)
  {
    Variation result;
    result.parameters = parameters;
    for (const Ingredient *ingredient : changed)
      {
        ingredient->change(result);
        result.departure = std::min(result.departure, ingredient->departure);
      }
    return result;
  }
} // namespace Squeal
