// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/parameters/design_plan.h>
#include <squeal/sensitivity/mesh_motions.h>
#include <squeal/studies/sensitivity/sensitivity_results.h>
#include <squeal/studies/steps/system_family.h>
#include <squeal/studies/steps/written_system.h>
#include <squeal/studies/updating/updating.h>

#include <deal.II/base/utilities.h>

#include <boost/algorithm/string/predicate.hpp>

#include <cmath>

namespace Squeal
{
  extern const Study stability_study;

  namespace
  {
    /// Half step of the difference quotients, as a fraction of the range [-].
    constexpr double step_of_rates = 1e-4;

    constexpr const char *where_fitted = "parameter Designs/Variables";

    /// Part of the model that a parameter changes.
    enum class Action
    {
      factor,   ///< coefficients of terms
      matrices, ///< matrices of the bodies, on the same mesh
      mesh
    };

    [[noreturn]] void refuse_fit(const std::string &what, const std::string &change)
    {
      throw ParameterError(what, where_fitted, change);
    }

    /// Parameters for a solution at full order.
    Parameters solved_parameters(Parameters parameters)
    {
      parameters.study    = &stability_study;
      parameters.designs  = {};
      parameters.updating = {};
      parameters.output   = {};
      return parameters;
    }

    /// (p2 − p1)/h of lists of numbers; a missing entry counts as zero.
    ParameterValues difference_quotient(const ParameterValues &before, const ParameterValues &after, const double h)
    {
      ParameterValues result;
      for (const auto *values : {&before, &after})
        for (const auto &[name, list] : *values)
          {
            const double         sign  = values == &after ? 1. / h : -1. / h;
            std::vector<double> &rates = result[name];
            rates.resize(std::max(rates.size(), list.size()), 0.);
            for (std::size_t i = 0; i < list.size(); ++i)
              rates[i] += sign * list[i];
          }
      for (auto rate = result.begin(); rate != result.end();)
        if (std::all_of(rate->second.begin(), rate->second.end(), [](const double value) { return value == 0.; }))
          rate = result.erase(rate);
        else
          ++rate;
      return result;
    }

    /// (after − before)/h for the matrices of merged terms; a missing matrix counts as zero.
    std::vector<Term> difference_quotient(const std::vector<Term> &before, const std::vector<Term> &after, const double h)
    {
      const auto counterpart = [](const Term &term, const std::vector<Term> &others) {
        return std::find_if(others.begin(), others.end(),
                            [&](const Term &other) { return other.power == term.power && other.symmetry == term.symmetry; });
      };
      std::vector<Term> result;
      for (const Term &term : after)
        {
          const auto former = counterpart(term, before);
          result.push_back(term);
          result.back().matrix =
            former == before.end() ? add(1. / h, *term.matrix, 0., *term.matrix) : add(1. / h, *term.matrix, -1. / h, *former->matrix);
        }
      for (const Term &term : before)
        if (counterpart(term, after) == after.end())
          {
            result.push_back(term);
            result.back().matrix = add(-1. / h, *term.matrix, 0., *term.matrix);
          }
      return result;
    }

    /// A meshed model with variable values of the fitted parameters.
    class ChangingScene
    {
    public:
      ChangingScene(Scene &scene, const std::vector<FittedParameter> &parameters, const MeasuredModes &measured, Run &run)
        : scene(scene)
        , parameters(parameters)
        , measured(measured)
        , run(run)
        , base(solved_parameters(run.parameters))
        , meshed(text_without_coefficients(base))
      {
        const bool is_complex = measured.has(MeasuredState::complex);
        if (is_complex && !base.damping.modal_ratios.empty())
          refuse_fit("derivatives of complex modes are not available with modal damping",
                     "clear Damping/Modal damping ratio, or fit to component and coupled modes only");
        if (is_complex && base.needs_steady_sliding() && base.has_contact_damping())
          refuse_fit("derivatives of complex modes are not available with contact damping about steady sliding",
                     "set Steady sliding/Contact state = equal load, or fit to component and coupled modes only");
        for (std::size_t p = 0; p < parameters.size(); ++p)
          {
            actions.push_back(action_of(p));
            if (actions.back() == Action::mesh)
              for (const MeshMotion &motion : motions_of(p, base.geometry))
                if (is_complex && motion.moves_contact)
                  refuse_fit("derivatives of complex modes with respect to " + in_quotes(parameters[p].name) +
                               " are not available, because this parameter moves contact nodes",
                             "remove this parameter or the complex modes from the fit");
          }
      }

      std::vector<ComputedMode> at(const std::vector<double> &values)
      {
        Parameters design = base;
        for (std::size_t p = 0; p < parameters.size(); ++p)
          design = with_value(design, p, values[p]);
        design.check();
        Progress silent;
        Run      quiet(design, run, silent);
        assemble(design, quiet);
        std::optional<SlidingState> sliding;
        if (design.needs_steady_sliding())
          sliding = solve_sliding(scene, design.operation, design.sliding, quiet);
        const FrictionlessModes    modes = frictionless_modes(linearise(scene, sliding, design.operation), quiet);
        std::vector<EquationRates> rates;
        for (std::size_t p = 0; p < parameters.size(); ++p)
          rates.push_back(rates_of(p, values[p], design, sliding));

        if (!measured.sensors.shapes.empty())
          sensors = measured.sensors.rows(displacements_of_nodes(*scene.model));
        std::vector<ComputedMode> result;
        add_real_modes(modes, rates, design, result);
        if (measured.has(MeasuredState::complex))
          add_complex_modes(modes, rates, design, quiet, result);
        return result;
      }

    private:
      Parameters with_value(const Parameters &others, const std::size_t p, const double value) const
      {
        return with_design(others, {parameters[p].name}, {exact_text(value)});
      }

      Action action_of(const std::size_t p) const
      {
        const FittedParameter &parameter = parameters[p];
        const std::string      lower     = text_without_coefficients(with_value(base, p, parameter.lower)),
                          upper          = text_without_coefficients(with_value(base, p, parameter.upper));
        // Compare with the start value, because parameters joined by + may have different values in the parameter file
        if (lower == upper && lower == text_without_coefficients(with_value(base, p, parameter.start)))
          return Action::factor;
        for (const char *section : {"Disc material/", "Pin material/", "Materials/", "Mounts/"})
          if (boost::starts_with(parameter.name, section))
            return Action::matrices;
        if (motions_of(p, base.geometry).empty())
          refuse_fit(in_quotes(parameter.name) + " cannot be fitted, because derivatives of modes with respect to it are not available",
                     "fit material constants, mounts, lengths and angles of disc_pins.geo, the friction coefficient, or load, speed and "
                     "friction slope in ranges that exclude zero");
        return Action::mesh;
      }

      /// Mesh motions due to a parameter, one for each joined name; empty if a name has no motion.
      std::vector<MeshMotion> motions_of(const std::size_t p, const GeometryParameters &geometry) const
      {
        if (geometry.file != GeometryParameters().file)
          return {};
        const std::vector<MeshMotion> known = mesh_motions(scene.mesh, geometry);
        std::vector<MeshMotion>       result;
        for (const std::string &name : dealii::Utilities::split_string_list(parameters[p].name, '+'))
          {
            const auto        bracket = name.find('[');
            const std::string path = name.substr(0, bracket), number = bracket == std::string::npos ? "" : name.substr(bracket + 1);
            const auto        found = std::find_if(known.begin(), known.end(), [&](const MeshMotion &motion) {
              return motion.parameter == path && (motion.pin.empty() ? number.empty() : boost::ends_with(motion.pin + "]", "_" + number));
            });
            if (found == known.end())
              return {};
            result.push_back(*found);
          }
        return result;
      }

      /// Assembles the bodies of a design; remeshes if anything other than coefficients of terms has changed.
      void assemble(const Parameters &design, Run &quiet)
      {
        const std::string matrices = text_without_coefficients(design);
        if (matrices != meshed)
          {
            scene  = mesh_scene(quiet);
            bodies = {};
            meshed = matrices;
          }
        if (bodies.terms.empty())
          bodies = assemble_scene(scene, quiet);
        bodies.values        = values_of(*scene.model, design);
        scene.elastic.values = bodies.values;
        scene.bodies         = merged(bodies.terms, bodies.values);
        scene.system         = sparse_matrices(scene.bodies, bodies.values);
      }

      static ParameterValues values_of(const Model &model, const Parameters &design)
      {
        ParameterValues values = body_values(model, design.materials);
        if (design.operation.rotating_disc)
          values[BodyParameter::angular_velocity] = {design.operation.angular_velocity()};
        return values;
      }

      static std::vector<Term> merged_bodies(const Model &model, const Parameters &design)
      {
        BodyTerms result = body_terms(model, design.materials);
        if (design.operation.rotating_disc)
          add_rotation(result, model, design.operation.angular_velocity());
        return merged(result.terms, result.values);
      }

      /// Difference quotients within the range; exact for quantities that are linear in the parameter.
      EquationRates rates_of(const std::size_t                  p,
                             const double                       value,
                             const Parameters                  &design,
                             const std::optional<SlidingState> &sliding) const
      {
        const FittedParameter &parameter = parameters[p];
        const double           h         = step_of_rates * (parameter.upper - parameter.lower);
        const double           first = std::max(value - h, parameter.lower), last = std::min(value + h, parameter.upper);
        const Parameters       before = with_value(design, p, first), after = with_value(design, p, last);
        EquationRates          result;
        switch (actions[p])
          {
            case Action::factor:
              result.bodies = difference_quotient(values_of(*scene.model, before), values_of(*scene.model, after), last - first);
              break;
            case Action::matrices:
              result.terms = difference_quotient(merged_bodies(*scene.model, before), merged_bodies(*scene.model, after), last - first);
              break;
            case Action::mesh:
              result.terms = difference_quotient(merged_bodies(moved_model(p, first - value, design), before),
                                                 merged_bodies(moved_model(p, last - value, design), after), last - first);
          }
        if (measured.has(MeasuredState::complex) && actions[p] == Action::factor)
          {
            const auto of_contact = [&](const Parameters &changed) {
              const StateOfContact state       = state_of_contact(*scene.model, scene.interface, sliding, changed.operation);
              ParameterValues      found       = selected(state.damping, state.closed).values();
              found[SystemParameter::friction] = {changed.operation.friction_coefficient};
              return found;
            };
            result.contact = difference_quotient(of_contact(before), of_contact(after), last - first);
          }
        return result;
      }

      /// Model on the mesh with nodes displaced by a change in a parameter.
      Model moved_model(const std::size_t p, const double change, const Parameters &design) const
      {
        Mesh mesh = scene.mesh;
        for (const MeshMotion &motion : motions_of(p, design.geometry))
          mesh = moved(std::move(mesh), motion, change);
        return Model(mesh, design.discretization.element, run.communicator);
      }

      void add_real_modes(const FrictionlessModes          &modes,
                          const std::vector<EquationRates> &rates,
                          const Parameters                 &design,
                          std::vector<ComputedMode>        &result) const
      {
        std::vector<BodyRates> of_bodies;
        for (const EquationRates &rate : rates)
          {
            of_bodies.emplace_back();
            of_bodies.back().add_along(bodies.terms, bodies.values, rate.bodies);
            of_bodies.back().add(rate.terms, bodies.values);
          }
        const auto add = [&](const MeasuredState state, const std::string &label, const double square, const auto &derivatives,
                             const Eigen::VectorXcd &responses) {
          result.push_back({state, label, {0., std::sqrt(square)}, derivatives, responses});
        };
        const double omega_max = circular_frequency(design.discretization.maximum_frequency), largest = omega_max * omega_max;
        if (measured.has(MeasuredState::component))
          {
            std::map<const ComponentModes *, std::vector<std::vector<std::complex<double>>>> derivatives;
            std::map<const ComponentModes *, ComplexDenseMatrix>                             responses;
            for (const ComponentModes *set : modes.references())
              if (set->vectors)
                {
                  derivatives[set] = real_mode_derivatives(set->eigenvalues, *set->vectors, of_bodies);
                  responses[set]   = at_sensors(sensors, *set->vectors);
                }
            for (const ListedComponentMode &mode : listed_component_modes(modes, largest))
              if (const auto found = derivatives.find(mode.set); found != derivatives.end())
                add(MeasuredState::component, to_string(mode.label), mode.set->eigenvalues[mode.number], found->second[mode.number],
                    responses[mode.set].col(mode.number));
          }
        if (measured.has(MeasuredState::coupled))
          {
            const SymmetricModes    &real        = modes.real;
            const MultiVector        shapes      = *modes.linearisation.coupled.kernel * *real.vectors;
            const auto               derivatives = real_mode_derivatives(real.eigenvalues, shapes, of_bodies);
            const ComplexDenseMatrix responses   = at_sensors(sensors, shapes);
            for (std::size_t j = 0; j < n_in_band(real.eigenvalues, largest); ++j)
              add(MeasuredState::coupled, to_string(modes.labels[j]), real.eigenvalues[j], derivatives[j],
                  responses.col(static_cast<Eigen::Index>(j)));
          }
      }

      void add_complex_modes(const FrictionlessModes          &modes,
                             const std::vector<EquationRates> &rates,
                             const Parameters                 &design,
                             Run                              &quiet,
                             std::vector<ComputedMode>        &result) const
      {
        const double                    mu       = design.operation.friction_coefficient;
        const CoupledSystem            &coupled  = modes.linearisation.coupled;
        const FrictionModes             friction = left_and_right_modes(modes, mu, quiet);
        const Eigentriples              triples = eigentriples(friction.modes), apart = on_bodies(modes.linearisation.contact, mu, triples);
        const TermProducts              of_contact(coupled.terms, triples), of_bodies(bodies.terms, apart);
        const ParameterValues           values = coupled.at(mu);
        std::vector<ComplexDenseMatrix> N;
        for (const EquationRates &rate : rates)
          {
            N.push_back(of_bodies.along(bodies.values, rate.bodies) + of_contact.along(values, rate.contact));
            if (!rate.terms.empty())
              N.back() += TermProducts(rate.terms, apart).pencil(bodies.values);
          }
        const auto              &lambda      = friction.modes.lambda;
        const auto               derivatives = complex_mode_derivatives(lambda, N, of_contact.by_lambda(values));
        const SparseMatrix      &kernel      = *coupled.kernel;
        const MultiVector        re = kernel * *friction.modes.real_part, im = kernel * *friction.modes.imaginary_part;
        const ComplexDenseMatrix responses = at_sensors(sensors, re, &im);
        for (std::size_t j = 0; j < lambda.size(); ++j)
          result.push_back({MeasuredState::complex, to_string(friction.labels[j]), lambda[j], derivatives[j],
                            responses.col(static_cast<Eigen::Index>(j))});
      }

      Scene                              &scene;
      const std::vector<FittedParameter> &parameters;
      const MeasuredModes                &measured;
      Run                                &run;
      const Parameters                    base;
      std::string                         meshed; ///< text_without_coefficients() of the parameters of the mesh
      BodyTerms                           bodies;
      std::vector<Action>                 actions;
      std::shared_ptr<const SparseMatrix> sensors; ///< matrix from dofs to responses of the sensors; null without sensors
    };
  } // namespace

  ModesAtValues modes_of_scene(Scene &scene, const std::vector<FittedParameter> &parameters, const MeasuredModes &measured, Run &run)
  {
    const auto changing = std::make_shared<ChangingScene>(scene, parameters, measured, run);
    return [changing](const std::vector<double> &values) { return changing->at(values); };
  }
} // namespace Squeal
