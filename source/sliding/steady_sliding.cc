// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/contact/travel.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/sliding/floating_disc.h>
#include <squeal/sliding/pressed_faces.h>
#include <squeal/sliding/steady_sliding.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Squeal
{
  namespace
  {
    /// Centre of the contact face of each component [m].
    std::vector<Eigen::Vector3d> face_centres(const Model &model, const ContactInterface &interface)
    {
      std::vector<Eigen::Vector3d> centres(model.component_names().size(), Eigen::Vector3d::Zero());
      std::vector<double>          areas(centres.size(), 0.);
      for (const ContactNode &node : interface)
        {
          areas[node.pin] += node.area;
          centres[node.pin] += node.area * node.position;
        }
      for (std::size_t pin = 0; pin < centres.size(); ++pin)
        if (areas[pin] > 0.)
          centres[pin] /= areas[pin];
      return centres;
    }

    /// Distances of a node from the centre of its face [m]: along t, and outwards. The second distance is along the axis for contact with a
    /// rim, and along b if the disc does not rotate about z.
    std::pair<double, double> offsets(const ContactNode &node, const Eigen::Vector3d &centre, const Travel &travel)
    {
      return {node.sliding.dot(node.position - centre), !node.turns      ? node.radial.dot(node.position - centre) :
                                                        travel.side == 0 ? node.position[2] - centre[2] :
                                                                           node.axis_distance() - std::hypot(centre[0], centre[1])};
    }

    /// Travel and backplate of each component, and the load of each backplate; the loads are empty if the travel is prescribed or if there
    /// are no backplates.
    struct Backplates
    {
      std::vector<Travel> travels;
      std::vector<int>    of_pin;
      std::vector<double> loads;
      int                 n;
    };

    Backplates backplates(const Model               &model,
                          const ContactInterface    &interface,
                          const OperationParameters &operation,
                          const SlidingParameters   &parameters)
    {
      const bool per_pin = parameters.control == BackplateControl::load_per_pin;
      Backplates result{travels(model, interface), {}, {}, 0};
      result.of_pin = backplate_numbers(result.travels, per_pin);
      result.n      = 1 + *std::max_element(result.of_pin.begin(), result.of_pin.end());
      if (parameters.control == BackplateControl::displacement || parameters.control == BackplateControl::pressure)
        return result;
      result.loads.assign(result.n, operation.load_per_side);
      if (!per_pin)
        return result;

      // Divide the load of each side equally between its pins
      const std::vector<int> shared = backplate_numbers(result.travels, false);
      for (std::size_t pin = 0; pin < shared.size(); ++pin)
        if (const int number = result.of_pin[pin]; number >= 0)
          result.loads[number] = operation.load_per_side / std::count(shared.begin(), shared.end(), shared[pin]);
      for (const PinLoad &load : parameters.pin_loads)
        if (const int number = result.of_pin[pin_number(model.component_names(), load.pin, "Steady sliding/Loads")]; number >= 0)
          result.loads[number] = load.load;
      for (const double load : result.loads)
        if (!(load > 0.))
          throw ParameterError("a pin that is not listed in Steady sliding/Loads has no load", "parameter Operation/Load per side",
                               "set a positive load per side, or list every pin");
      return result;
    }

    /// Problem condensed to the contact nodes. Its motions are the travel of the backplates, followed by the free @p motions;
    /// @p pressing: forces of a pressure.
    ContactProblem contact_problem(const SlidingModel               &sliding,
                                   const Backplates                 &plates,
                                   const Eigen::VectorXd            &gaps,
                                   const std::optional<MultiVector> &motions,
                                   const std::optional<MultiVector> &pressing,
                                   const double                      displacement,
                                   const double                      mu)
    {
      const SparseMatrix &P_n   = *sliding.contact.normal;
      const bool          moves = !plates.loads.empty();
      const int           n_c = gaps.size(), n_plates = moves ? plates.n : 0, n_z = n_plates + (motions ? motions->n_columns() : 0);
      ContactProblem      problem{replicate(P_n * sliding.normal), replicate(P_n * sliding.tangential), mu,           {},
                             DenseMatrix::Zero(n_c, n_z),     DenseMatrix::Zero(n_z, n_c),         plates.loads, {}};
      for (int c = 0; c < n_c; ++c)
        {
          const ContactNode &node   = sliding.interface[c];
          const Travel      &travel = plates.travels[node.pin];
          const double       a      = travel.closing(node);
          if (!node.is_rigid())
            problem.normal_flexibility(c, c) += 1. / (node.stiffness * node.area);
          problem.initial_gap.push_back(a * ((moves ? 0. : displacement) - gaps[c]));
          if (moves)
            {
              problem.motions(c, plates.of_pin[node.pin]) = a;
              problem.balance(plates.of_pin[node.pin], c) = travel.force(node, mu);
            }
        }
      if (pressing) // adds P_n K⁻¹ f_p, computed from the normal attachment modes
        Eigen::Map<Eigen::VectorXd>(problem.initial_gap.data(), n_c) += gram(sliding.normal, *pressing);
      if (motions)
        {
          const DenseMatrix B_n = replicate(P_n * *motions), B_t = replicate(*sliding.contact.tangential * *motions);
          problem.forces.resize(n_z, 0.);
          // −L is the transpose of (P_n + μ P_t) N: the work of unit contact forces on the motions
          problem.motions.rightCols(n_z - n_plates)  = B_n;
          problem.balance.bottomRows(n_z - n_plates) = -(B_n + mu * B_t).transpose();
          if (pressing)
            Eigen::Map<Eigen::VectorXd>(problem.forces.data(), n_z).tail(n_z - n_plates) = gram(*motions, *pressing);
          if (moves || pressing)
            hold_undetermined_motion(problem, n_plates);
        }
      return problem;
    }

    /// The contact problem and the data from which it was built.
    struct CondensedSliding
    {
      Backplates                 plates;
      Eigen::VectorXd            gaps;     ///< gaps along the travel [m]
      std::optional<MultiVector> motions;  ///< free motions of the bodies
      std::optional<MultiVector> pressing; ///< forces f_p of a pressure
      ContactProblem             problem;
    };

    CondensedSliding condensed(const SlidingModel &sliding, const OperationParameters &operation, const SlidingParameters &parameters)
    {
      const Model               &model     = sliding.model;
      const ContactInterface    &interface = sliding.interface;
      const Backplates           plates    = backplates(model, interface, operation, parameters);
      const Eigen::VectorXd      gaps      = initial_gaps(model, interface, parameters);
      std::optional<MultiVector> pressing;
      if (parameters.control == BackplateControl::pressure)
        pressing = pressing_forces(model, interface, parameters, operation.load_per_side);
      const auto motions =
        balanced_motions(model, sliding.contact, sliding.system, sliding.free_motions, operation, pressing ? &*pressing : nullptr);
      return {plates, gaps, motions, pressing,
              contact_problem(sliding, plates, gaps, motions, pressing, parameters.displacement, operation.friction_coefficient)};
    }

    /// u including the displacement of the backplates of the pins.
    MultiVector with_backplates(const SlidingModel &sliding, MultiVector u, const std::vector<Eigen::Vector3d> &backplates)
    {
      for (const Node &node : sliding.model.nodes())
        for (unsigned int k = 0; k < 3; ++k)
          if (const int i = u.map().place(node.dofs[k]); i >= 0)
            u(i, 0) += backplates[node.component][k];
      return u;
    }

    /// Recomputes all equations from the displacements @p u of the full model.
    SlidingChecks checks(const SlidingModel        &sliding,
                         const Backplates          &plates,
                         const Eigen::VectorXd     &gaps,
                         const SlidingState        &state,
                         const MultiVector         *pressing,
                         const OperationParameters &operation)
    {
      const double            mu        = operation.friction_coefficient;
      const ContactInterface &interface = sliding.interface;
      const SparseMatrix     &P_n = *sliding.contact.normal, &P_t = *sliding.contact.tangential, &K = *sliding.system.stiffness;
      const MultiVector      &u         = *state.displacement;
      const Eigen::VectorXd   reactions = as_column(state.reactions);
      const MultiVector       r         = distribute(reactions, P_n.rows());
      SlidingChecks           result{};

      MultiVector  forces      = transpose_times(P_n, r);
      const double normal_size = column_norms(forces)[0];
      forces.local() += mu * transpose_times(P_t, r).local();
      if (pressing)
        forces += *pressing;
      if (const MultiVector *N = sliding.response.rigid_body_modes()) // subtracts the moment that the drive balances
        multiply_add(-1., *sliding.system.mass * *N, gram(*N, forces), 1., forces);
      MultiVector rest = K * u;
      rest.local() -= forces.local();
      result.residual = normal_size > 0. ? column_norms(rest)[0] / normal_size : 0.;

      Eigen::VectorXd loads = Eigen::VectorXd::Zero(plates.n), gap = replicate(P_n * u).col(0);
      const double    travel = pressing ? largest_of_processes(u.communicator(), max_norm(u.local())) : max_norm(gap);
      double          arm    = 0.;
      for (std::size_t c = 0; c < interface.size(); ++c)
        {
          const ContactNode &node = interface[c];
          const Travel      &path = plates.travels[node.pin];
          loads[plates.of_pin[node.pin]] += path.force(node, mu) * reactions[c];
          gap[c] += path.closing(node) * (state.approach[node.pin] - gaps[c]);
          if (!node.is_rigid())
            gap[c] += reactions[c] / (node.stiffness * node.area);
          arm = std::max(arm, node.axis_distance());
        }
      const double load = pressing ? operation.load_per_side : loads.maxCoeff();
      if (!plates.loads.empty())
        result.load = max_norm((loads - as_column(plates.loads)).cwiseQuotient(as_column(plates.loads)));
      result.tension         = reactions.maxCoeff() / load;
      result.overlap         = gap.maxCoeff() / travel;
      result.complementarity = max_norm(gap.cwiseProduct(reactions)) / (travel * load);

      // Balance with the supports: for a rigid-body motion w of a component, K w has forces only at its mount or clamp
      for (unsigned int component = 0; component < sliding.model.component_names().size(); ++component)
        {
          const MultiVector     W     = rigid_motions(sliding.model, component);
          const Eigen::VectorXd error = gram(K * W, u) - gram(W, forces);
          result.force_balance        = std::max(result.force_balance, max_norm(error.head(3)) / load);
          result.moment_balance       = std::max(result.moment_balance, max_norm(error.tail(3)) / (load * arm));
        }
      return result;
    }
    std::vector<std::optional<MultiVector>> motions_of_bodies(const Model &model, const SecondOrderSystem &system)
    {
      std::vector<std::optional<MultiVector>> result;
      for (unsigned int body = 0; body < model.component_names().size(); ++body)
        result.push_back(free_motions(model, system, body));
      return result;
    }

    std::optional<MultiVector> all_motions(const std::vector<std::optional<MultiVector>> &of_bodies)
    {
      std::vector<MultiVector> result;
      for (const auto &motions : of_bodies)
        if (motions)
          result.push_back(*motions);
      if (result.empty())
        return {};
      return join_all(result);
    }
  } // namespace

  Eigen::VectorXd initial_gaps(const Model &model, const ContactInterface &interface, const SlidingParameters &parameters)
  {
    std::vector<PinGap> of_pin(model.component_names().size(), PinGap{"", 0.});
    for (const PinGap &gap : parameters.gaps)
      of_pin[pin_number(model.component_names(), gap.pin, "Steady sliding/Gaps")] = gap;
    const auto      centres    = face_centres(model, interface);
    const auto      directions = travels(model, interface);
    Eigen::VectorXd result(interface.size());
    for (std::size_t c = 0; c < interface.size(); ++c)
      {
        const unsigned int pin       = interface[c].pin;
        const PinGap      &gap       = of_pin[pin];
        const auto [along, outwards] = offsets(interface[c], centres[pin], directions[pin]);
        result[c]                    = gap.gap + gap.sliding_taper * along + gap.radial_taper * outwards;
      }
    return result;
  }

  void check_sliding(const Model               &model,
                     const ContactInterface    &interface,
                     const OperationParameters &operation,
                     const SlidingParameters   &parameters)
  {
    const Backplates                 plates = backplates(model, interface, operation, parameters);
    const Eigen::VectorXd            gaps   = initial_gaps(model, interface, parameters);
    std::vector<Eigen::AlignedBox1d> extents(model.component_names().size()); // extents of the pins along their travel
    for (const Node &node : model.nodes())
      extents[node.component].extend(
        Eigen::Matrix<double, 1, 1>(plates.travels[node.component].direction.dot(Eigen::Vector3d::Map(node.position.data()))));
    std::vector<double> heights;
    for (const auto &extent : extents)
      heights.push_back(largest_of_processes(model.communicator(), extent.max()[0]) +
                        largest_of_processes(model.communicator(), -extent.min()[0]));
    if (parameters.control == BackplateControl::pressure)
      pressing_forces(model, interface, parameters, operation.load_per_side); // throws for invalid faces
    for (const PinLoad &load : parameters.pin_loads)
      pin_number(model.component_names(), load.pin, "Steady sliding/Loads");

    std::vector<double> smallest(plates.n, std::numeric_limits<double>::max());
    for (std::size_t c = 0; c < interface.size(); ++c)
      {
        const unsigned int pin    = interface[c].pin;
        const double       height = heights[pin];
        if (std::abs(gaps[c]) >= height)
          throw ParameterError("the gap of " + exact_text(gaps[c]) + " m is not smaller in magnitude than the height of the pin, " +
                                 exact_text(height) + " m",
                               "parameter Steady sliding/Gaps, pin " + model.component_names()[pin],
                               "give smaller gaps or tapers, in metres (1e-5 is 10 micrometres)");
        double &of_plate = smallest[plates.of_pin[pin]];
        of_plate         = std::min(of_plate, gaps[c]);
      }
    if (parameters.control == BackplateControl::displacement)
      for (const double gap : smallest)
        if (gap >= parameters.displacement)
          throw ParameterError("the displacement of " + exact_text(parameters.displacement) +
                                 " m does not close the smallest gap of one backplate, " + exact_text(gap) + " m",
                               "parameters Steady sliding/Displacement and Gaps", "raise the displacement or lower the gaps");
  }

  SlidingModel::SlidingModel(const Model               &model,
                             const ContactInterface    &interface,
                             const ContactOperators    &contact,
                             const SecondOrderSystem   &system,
                             const double               largest_circular_frequency,
                             const FactorizationLibrary library)
    : model(model)
    , interface(interface)
    , contact(contact)
    , system(system)
    , free_motions(motions_of_bodies(model, system))
    , response(system.stiffness,
               system.mass,
               all_motions(free_motions),
               largest_circular_frequency,
               library,
               "stiffness of disc and pins without contact")
    , normal(attachment_modes(response, *contact.normal))
    , tangential(attachment_modes(response, *contact.tangential))
  {}

  SlidingState steady_sliding(const SlidingModel &sliding, const OperationParameters &operation, const SlidingParameters &parameters)
  {
    check_sliding(sliding.model, sliding.interface, operation, parameters);
    const auto [plates, gaps, motions, pressing, problem] = condensed(sliding, operation, parameters);
    const ContactSolution solution                        = solve_contact(problem);

    SlidingState state;
    state.reactions  = solution.reactions;
    state.gaps       = solution.gaps;
    state.closed     = solution.closed;
    state.n_steps    = solution.n_steps;
    state.uniqueness = contact_uniqueness(problem, solution);
    for (std::size_t k = 0; k < plates.travels.size(); ++k)
      {
        const int plate = plates.of_pin[k];
        state.approach.push_back(plate < 0 ? 0. : plates.loads.empty() ? parameters.displacement : solution.motions[plate]);
      }

    const DenseMatrix r = as_column(state.reactions);
    MultiVector       u = sliding.normal * r;
    multiply_add(operation.friction_coefficient, sliding.tangential, r, 1., u);
    if (pressing)
      u += sliding.response.solve(*pressing);
    if (motions)
      multiply_add(1., *motions, as_column(solution.motions).tail(motions->n_columns()), 1., u);
    state.displacement = std::make_shared<MultiVector>(u);
    state.total_displacement =
      std::make_shared<MultiVector>(with_backplates(sliding, u, backplate_displacements(plates.travels, state.approach)));
    state.checks = checks(sliding, plates, gaps, state, pressing ? &*pressing : nullptr, operation);
    return state;
  }

  DenseMatrix reaction_rates(const SlidingModel        &sliding,
                             const OperationParameters &operation,
                             const SlidingParameters   &parameters,
                             const SlidingState        &state,
                             const MultiVector         &force_rates,
                             const DenseMatrix         &gap_rates)
  {
    const CondensedSliding scene    = condensed(sliding, operation, parameters);
    const int              n_plates = scene.problem.forces.size() - (scene.motions ? scene.motions->n_columns() : 0);
    DenseMatrix            gaps = gram(sliding.normal, force_rates), forces = DenseMatrix::Zero(scene.problem.forces.size(), gaps.cols());
    for (Eigen::Index c = 0; c < gaps.rows(); ++c)
      gaps.row(c) -= scene.plates.travels[sliding.interface[c].pin].closing(sliding.interface[c]) * gap_rates.row(c);
    if (scene.motions)
      forces.bottomRows(forces.rows() - n_plates) = gram(*scene.motions, force_rates);
    return reaction_rates(scene.problem, state.closed, gaps, forces);
  }

  std::vector<PinContact> pin_contacts(const Model               &model,
                                       const ContactInterface    &interface,
                                       const SlidingState        &state,
                                       const OperationParameters &operation)
  {
    const auto            centres    = face_centres(model, interface);
    const auto            directions = travels(model, interface);
    const SlidingVelocity velocity(operation);
    const auto            c_b = radial_dissipation(interface, state.reactions, operation),
               c_t            = sliding_dissipation(interface, state.reactions, operation);
    std::vector<PinContact> result;
    for (unsigned int pin = 1; pin < model.component_names().size(); ++pin)
      {
        PinContact entry{model.component_names()[pin], directions[pin].side, 0, 0, 0., 0., 0., 0., 0., 0., 0., state.approach[pin], 0.};
        double     lever = 0.;
        for (std::size_t c = 0; c < interface.size(); ++c)
          if (const ContactNode &node = interface[c]; node.pin == pin)
            {
              const double force           = -state.reactions[c];
              const auto [along, outwards] = offsets(node, centres[pin], directions[pin]);
              ++entry.n_nodes;
              entry.n_open += force == 0.;
              entry.load += force;
              entry.sliding_offset += force * along;
              entry.radial_offset += force * outwards;
              lever += force * node.lever;
              entry.largest_pressure = std::max(entry.largest_pressure, force / node.area);
              entry.radial_damping += c_b[c];
              entry.sliding_damping += c_t[c];
              entry.largest_gap = std::max(entry.largest_gap, -state.gaps[c]);
            }
        if (entry.n_nodes == 0)
          continue;
        if (entry.load > 0.)
          {
            entry.sliding_offset /= entry.load;
            entry.radial_offset /= entry.load;
            lever /= entry.load;
          }
        else
          lever = velocity.lever(centres[pin]);
        entry.sliding_speed = operation.rotation_speed * lever;
        result.push_back(entry);
      }
    return result;
  }
} // namespace Squeal
