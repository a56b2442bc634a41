// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/linear_algebra/multivector.h>
#include <squeal/studies/sensitivity/sensitivity_results.h>

namespace Squeal
{
  namespace
  {
    /// Relative step of central differences with respect to operation parameters [-].
    constexpr double operation_step = 1e-4;

    /// Minimum reference value of these steps, for small friction coefficients [-] and slopes [s/m].
    constexpr double least_of_operation = 1e-2;

    /// f' = −K' u + μ (P_t')ᵀ r of reaction_rates() for each parameter, n × parameters. If the disc is held only by its drive, inertia
    /// balances the friction moment. The change in this inertia load is neglected, because torsion of a body of revolution moves no contact
    /// node along its normal.
    MultiVector force_rates(const SlidingModel                      &sliding,
                            const SlidingState                      &state,
                            const double                             mu,
                            const std::vector<SensitivityParameter> &parameters,
                            const std::vector<BodyRates>            &rates)
    {
      const ContactOperators &contact = sliding.contact;
      const MultiVector      &u       = *state.displacement;
      const MultiVector       r       = distribute(as_column(state.reactions), contact.normal->rows());

      MultiVector result(u.map(), static_cast<int>(parameters.size()));
      for (std::size_t p = 0; p < parameters.size(); ++p)
        {
          const SensitivityParameter &parameter = parameters[p];
          MultiVector                 f         = view(result, static_cast<int>(p), 1);
          for (const auto &[factor, matrix] : rates[p].stiffness)
            f += -factor * (*matrix * u);
          if (parameter.contact)
            {
              const ContactMotion &motion = *parameter.contact;
              f += mu / motion.step *
                   (transpose_times(*motion.operators_after.tangential, r) - transpose_times(*motion.operators_before.tangential, r));
            }
        }
      return result;
    }
  } // namespace

  SensitivityProducts SensitivityModel::products(const ChartPoint &point, const std::vector<int> &modes) const
  {
    const ReducedModel &reduced = sweep.reduced->reduced();
    const auto          shapes  = [&](const ComplexDenseMatrix &X) {
      return reduced.basis() * halves(with_rows(X(Eigen::placeholders::all, modes), reduced.size()));
    };
    Eigentriples triples{{}, shapes(point.right), shapes(point.left)};
    for (const int mode : modes)
      triples.lambda.push_back(point.lambda[mode]);

    const double          mu      = point.friction_coefficient;
    const CoupledSystem  &coupled = sweep.frictionless.linearisation.coupled;
    const ParameterValues values  = coupled.at(mu, sweep.plan.point(main_line, mu, sweep.regime.closed).values);
    const Eigentriples    apart   = on_bodies(sweep.frictionless.linearisation.contact, mu, triples);
    const TermProducts    of_contact(coupled.terms, triples), of_bodies(bodies.terms, apart);

    const Eigentriples alone = on_bodies(sweep.frictionless.linearisation.contact, 0., triples); // left vectors without friction
    const auto         k     = static_cast<int>(modes.size());
    const auto         r_n   = normal_reactions(coupled, triples.lambda, view(triples.right, 0, k), view(triples.right, k, k));

    // C_m acts on coupled coordinates and does not affect the reactions
    const auto of_damped_modes = modal_damping ? modal_damping->along(body_rates(), triples) : std::vector<ComplexDenseMatrix>();

    const std::vector<ParameterValues> &by_reactions = damping_rates(mu);

    SensitivityProducts result{triples.lambda, of_contact.by_lambda(values), {}};
    for (const SensitivityParameter &parameter : parameters)
      {
        ComplexDenseMatrix N = of_bodies.along(bodies.values, parameter.body_rates);
        if (!parameter.derivative.empty())
          N += TermProducts(parameter.derivative, apart).pencil(bodies.values);
        if (parameter.operation != nullptr)
          N += of_contact.along(values, contact_rates(parameter, mu));
        if (parameter.contact)
          N += by_moved_contact(*parameter.contact, mu, alone, r_n);
        if (!by_reactions.empty())
          N += of_contact.along(values, by_reactions[result.N.size()]);
        if (modal_damping)
          N += of_damped_modes[result.N.size()] * as_column(triples.lambda).asDiagonal();
        if (!parameter.spring_rates.empty())
          N += of_contact.along(values, parameter.spring_rates);
        if (parameter.modal_ratio >= 0)
          N += of_contact.along(values, {{SystemParameter::modal_damping, modal_damping->rates_of_ratio(parameter.modal_ratio)}});
        result.N.push_back(std::move(N));
      }
    return result;
  }

  ComplexDenseMatrix SensitivityModel::by_moved_contact(const ContactMotion      &motion,
                                                        const double              friction_coefficient,
                                                        const Eigentriples       &apart,
                                                        const ComplexDenseMatrix &reactions) const
  {
    const Scene              &scene     = *sweep.plan.scene;
    const OperationParameters operation = sweep.plan.lines[main_line].at(friction_coefficient);
    const auto                state     = sweep.plan.sliding_state(operation);
    const auto                k         = static_cast<Eigen::Index>(apart.lambda.size());
    ComplexDenseMatrix        result    = ComplexDenseMatrix::Zero(k, k);
    const bool                all       = sweep.regime.closed.size() == scene.interface.size();
    for (const bool is_after : {false, true})
      {
        const ContactInterface &interface = is_after ? motion.after : motion.before;
        const double            sign      = is_after ? 1. : -1.;
        ContactInterface        closed;
        for (const unsigned int c : sweep.regime.closed)
          closed.push_back(interface[c]);
        const ContactOperators contact = !all     ? contact_operators(*scene.model, closed) :
                                         is_after ? motion.operators_after :
                                                    motion.operators_before;
        // Friction −μ P_tᵀ r_n: the reactions of a mode are constant, because the normals are constant
        const ComplexDenseMatrix slip = from_halves(replicate(*contact.tangential * apart.left));
        result -= sign / motion.step * friction_coefficient * (slip.transpose() * reactions);
        const ContactDamping damping = selected(state_of_contact(*scene.model, interface, state, operation).damping, sweep.regime.closed);
        if (const auto C = contact_damping(contact, damping))
          {
            const ComplexDenseMatrix forms = product_of_halves(gram(apart.left, *C * apart.right));
            for (Eigen::Index j = 0; j < k; ++j)
              result.col(j) += sign / motion.step * apart.lambda[j] * forms.col(j);
          }
      }
    return result;
  }

  std::vector<BodyRates> SensitivityModel::body_rates() const
  {
    std::vector<BodyRates> result;
    for (const SensitivityParameter &parameter : parameters)
      {
        BodyRates rates;
        rates.add_along(bodies.terms, bodies.values, parameter.body_rates);
        rates.add(parameter.derivative, bodies.values);
        result.push_back(std::move(rates));
      }
    return result;
  }

  const std::vector<ParameterValues> &SensitivityModel::damping_rates(const double friction_coefficient) const
  {
    const auto [entry, is_new]              = known_damping_rates.try_emplace(friction_coefficient);
    std::vector<ParameterValues> &result    = entry->second;
    const SweepPlan              &plan      = sweep.plan;
    const OperationParameters     operation = plan.lines[main_line].at(friction_coefficient);
    if (!is_new || !plan.sliding || !operation.has_contact_damping())
      return result;

    const ContactInterface &interface = plan.scene->interface;
    const SlidingState      state     = *plan.sliding_state(operation);
    DenseMatrix             gaps      = DenseMatrix::Zero(interface.size(), parameters.size());
    for (std::size_t p = 0; p < parameters.size(); ++p)
      if (const auto &motion = parameters[p].contact)
        gaps.col(p) = (initial_gaps(*plan.scene->model, motion->after, plan.sliding_parameters) -
                       initial_gaps(*plan.scene->model, motion->before, plan.sliding_parameters)) /
                      motion->step;
    const DenseMatrix rates = reaction_rates(*plan.sliding, operation, plan.sliding_parameters, state,
                                             force_rates(*plan.sliding, state, friction_coefficient, parameters, body_rates()), gaps);

    // Evaluate both types of damping for r = −1 N, because they are proportional to |r| and r ≤ 0
    const std::vector<double> units(interface.size(), -1.);
    const ContactDamping      per_newton{radial_dissipation(interface, units, operation), sliding_dissipation(interface, units, operation)};
    for (std::size_t p = 0; p < parameters.size(); ++p)
      {
        ContactDamping of_parameter = per_newton;
        for (std::size_t c = 0; c < interface.size(); ++c)
          {
            of_parameter.radial[c] *= -rates(c, p);
            of_parameter.sliding[c] *= -rates(c, p);
          }
        result.push_back(selected(of_parameter, sweep.regime.closed).values());
      }
    return result;
  }

  ParameterValues SensitivityModel::contact_rates(const SensitivityParameter &parameter, const double friction_coefficient) const
  {
    const Scene              &scene     = *sweep.plan.scene;
    const OperationParameters operation = sweep.plan.lines[main_line].at(friction_coefficient);
    const double              step      = operation_step * std::max(std::abs(operation.*parameter.operation), least_of_operation);
    const auto                damping   = [&](const double change) {
      OperationParameters changed = operation;
      changed.*parameter.operation += change;
      const StateOfContact state = state_of_contact(*scene.model, scene.interface, sweep.plan.sliding_state(changed), changed);
      return selected(state.damping, sweep.regime.closed).values();
    };
    const ParameterValues after = damping(step);
    ParameterValues       rates = damping(-step);
    for (auto &[name, list] : rates)
      for (std::size_t c = 0; c < list.size(); ++c)
        list[c] = (after.at(name)[c] - list[c]) / (2. * step);
    if (parameter.operation == &OperationParameters::friction_coefficient)
      rates[SystemParameter::friction] = {1.};
    return rates;
  }

  ChartModel::ModesAt SensitivityModel::modes_at(const ChartPoint &point, const std::vector<int> &modes) const
  {
    return {sweep.plan.point(main_line, point.friction_coefficient, sweep.regime.closed), &point, modes};
  }

  std::string SensitivityModel::grow(const std::vector<std::vector<ChartModel::ModesAt>> &groups, const unsigned int maximum_basis)
  {
    ChartModel &reduced = *sweep.reduced;
    const int   size    = reduced.size();
    std::string obstacle;
    for (const std::vector<ChartModel::ModesAt> &group : groups)
      if (const auto vectors = reduced.new_vectors(group))
        {
          if (reduced.size() + vectors->n_columns() > static_cast<int>(maximum_basis))
            {
              obstacle = text("the basis would exceed ", maximum_basis, " vectors");
              break;
            }
          reduced.extend(*vectors);
        }
    // Discard points that were evaluated with a smaller basis
    if (reduced.size() > size)
      sweep.known.clear();
    else if (obstacle.empty())
      obstacle = "all new directions are rounding errors";
    return obstacle;
  }
} // namespace Squeal
