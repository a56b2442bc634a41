// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/studies/ingredients/ingredients.h>

namespace Squeal
{
  namespace
  {
    /// Relative margin above the band of the real modes in a basis with upper modes [-].
    constexpr double upper_modes = 0.5;
    /// End of the narrower band, as a fraction of the end of the given band [-].
    constexpr double shorter_band = 0.5;

    // Names of values ------------------------------------------------------------

    const auto on_or_off  = [](const bool is_on) -> std::string { return is_on ? "on" : "off"; };
    const auto nothing    = [](const Parameters &) { return "none"; };
    const auto modal_here = [](const Parameters &p) { return p.damping.modal_ratios.empty() ? "none" : "as given"; };
    const auto slope_text = [](const double slope) { return slope == 0. ? "none" : exact_text(slope) + " s/m"; };
    const auto hertz_text = [](const double frequency) { return exact_text(frequency) + " Hz"; };

    const auto has_rayleigh_damping = [](const Parameters &p) { return p.materials.is_damped(); };

    // Obstacles ------------------------------------------------------------------

    Reason no_sliding(const Parameters &p, const std::optional<SlidingState> &)
    {
      return p.operation.load_per_side > 0. && p.operation.rotation_speed > 0. ? nullptr : "requires a load and a rotation speed";
    }

    Reason no_open_node(const Parameters &, const std::optional<SlidingState> &state)
    {
      if (!state)
        return "all nodes are closed, because Steady sliding/Contact state = equal load";
      return std::count(state->closed.begin(), state->closed.end(), false) > 0 ? nullptr : "no node lifts off";
    }

    Reason no_polygon(const Parameters &p, const std::optional<SlidingState> &)
    {
      if (p.discretization.element == Element::quadratic)
        return "edges of quadratic elements follow the circles";
      return unless(p.geometry.is_plan(), "the geometry is a solid model with given outlines");
    }

    using P = const Parameters &;

    /// Ingredient that sets the parameter returned by @p member to @p value. It is present if @p is_present is true or, by default, if the
    /// parameter has this value.
    template <typename Member, typename Value>
    Ingredient option(const char                                    *name,
                      const Member                                  &member,
                      const Value                                    value,
                      const ChangeKind                               kind,
                      const Departure                                departure,
                      const decltype(Ingredient::obstacle)           obstacle   = nullptr,
                      const std::function<bool(const Parameters &)> &is_present = nullptr)
    {
      const auto text = [](const Value shown) {
        if constexpr (std::is_same_v<Value, bool>)
          return on_or_off(shown);
        else
          return to_string(shown);
      };
      return {name,
              [=](P p) { return text(member(p)); },
              [=](P) { return text(value); },
              is_present ? is_present : [=](P p) { return member(p) == value; },
              [=](Variation &v) { member(v.parameters) = value; },
              kind,
              departure,
              obstacle};
    }

    /// Ingredient that computes complex modes from a reduced basis instead of at full order.
    Ingredient from_basis(const std::function<std::string(const Parameters &)> &tried, const char *basis, const double margin = 0.)
    {
      return {"complex modes",
              [](P p) { return to_string(p.solvers.complex_solver); },
              tried,
              [](P) { return false; },
              [=](Variation &v) {
                v.basis  = basis;
                v.margin = margin;
              },
              ChangeKind::shows,
              Departure::friction};
    }
  } // namespace

  const std::vector<Ingredient> &ingredients()
  {
    const auto dissipation = [](auto &p) -> decltype(auto) { return (p.operation.radial_dissipation); };
    const auto state       = [](auto &p) -> decltype(auto) { return (p.sliding.state); };
    const auto rotation    = [](auto &p) -> decltype(auto) { return (p.operation.rotating_disc); };
    const auto element     = [](auto &p) -> decltype(auto) { return (p.discretization.element); };
    const auto outlines    = [](auto &p) -> decltype(auto) { return (p.geometry.outlines); };
    const auto solver      = [](auto &p) -> decltype(auto) { return (p.solvers.complex_solver); };

    static const std::vector<Ingredient> table = {
      // ------------------------------------------------------------------- contact
      option("radial dissipation", dissipation, RadialDissipation::none, ChangeKind::removes, Departure::friction),
      option("radial dissipation", dissipation, RadialDissipation::consistent, ChangeKind::adds, Departure::friction, no_sliding,
             [](P p) { return p.operation.radial_dissipation != RadialDissipation::none; }),
      option("contact state", state, ContactState::equal_load, ChangeKind::removes, Departure::contact),
      option("contact state", state, ContactState::steady_sliding, ChangeKind::adds, Departure::contact, no_sliding),
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
         return p.ingredients.trial_slope == 0. ? "Ingredients/Trial friction slope = 0" : no_sliding(p, state);
       }},

      // ------------------------------------------------------------------- bodies
      {"Rayleigh damping", [](P p) { return has_rayleigh_damping(p) ? std::string("as given") : "none"; }, nothing, [](P) { return false; },
       [](Variation &v) {
         for (Material *material : v.parameters.materials.each())
           material->rayleigh_alpha = material->rayleigh_beta = 0.;
       },
       ChangeKind::removes, Departure::mesh,
       [](P p, const std::optional<SlidingState> &) { return unless(has_rayleigh_damping(p), "the materials have no Rayleigh damping"); }},
      {"modal damping", modal_here, nothing, [](P p) { return p.damping.modal_ratios.empty(); },
       [](Variation &v) { v.parameters.damping.modal_ratios.clear(); }, ChangeKind::removes, Departure::friction},
      {"modal damping", modal_here, [](P p) { return exact_text(p.ingredients.trial_damping_ratio); },
       [](P p) { return !p.damping.modal_ratios.empty(); },
       [](Variation &v) {
         v.parameters.damping.modal_ratios = {{0., v.parameters.ingredients.trial_damping_ratio}};
       },
       ChangeKind::adds, Departure::friction,
       [](P p, const std::optional<SlidingState> &) {
         return unless(p.ingredients.trial_damping_ratio > 0., "Ingredients/Trial damping ratio = 0");
       }},
      option("rotation of the disc", rotation, false, ChangeKind::removes, Departure::mesh),
      option("rotation of the disc", rotation, true, ChangeKind::adds, Departure::mesh,
             [](P p, const std::optional<SlidingState> &) {
               return unless(SlidingVelocity(p.operation).turns_about_z(), "the disc does not turn about the z axis");
             }),

      // ------------------------------------------------------------- discretisation
      option("element", element, Element::trilinear, ChangeKind::speeds, Departure::mesh),
      option("element", element, Element::incompatible_modes, ChangeKind::speeds, Departure::mesh, nullptr,
             [](P p) { return p.discretization.element != Element::quadratic; }),
      option("element", element, Element::incompatible_modes, ChangeKind::adds, Departure::mesh, nullptr,
             [](P p) { return p.discretization.element != Element::trilinear; }),
      option("element", element, Element::quadratic, ChangeKind::adds, Departure::mesh),
      option("outlines", outlines, Outlines::inscribed, ChangeKind::shows, Departure::mesh, no_polygon),
      option("outlines", outlines, Outlines::true_area, ChangeKind::adds, Departure::mesh, no_polygon),

      // -------------------------------------------------------------------- modes
      option("complex modes", solver, ComplexSolver::krylov, ChangeKind::speeds, Departure::friction),
      option("complex modes", solver, ComplexSolver::residual_iteration, ChangeKind::speeds, Departure::friction),
      from_basis([](P) { return "real modes alone"; }, "real"),
      from_basis([](P p) { return "real modes to " + hertz_text((1. + upper_modes) * p.discretization.maximum_frequency); }, "real",
                 upper_modes),
      from_basis([](P) { return "real modes + 1st order"; }, "real + 1st-ord."),
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
