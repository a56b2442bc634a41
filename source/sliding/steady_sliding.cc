#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/linear_algebra/replicate.h>
#include <squeal/linear_algebra/sparse.h>
#include <squeal/sliding/floating_disc.h>
#include <squeal/sliding/steady_sliding.h>

#include <Epetra_Comm.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace Squeal
{
  namespace
  {
    using Vector3 = std::array<double, 3>;

    double dot(const Vector3 &a, const Vector3 &b)
    {
      return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }

    /// Number of the pin called @p name among the components; throws ParameterError naming all pins.
    unsigned int pin_number(const Model &model, const std::string &name, const char *parameter)
    {
      const auto &names = model.component_names();
      for (unsigned int k = 1; k < names.size(); ++k)
        if (names[k] == name)
          return k;
      std::string known;
      for (unsigned int k = 1; k < names.size(); ++k)
        known += (k == 1 ? "" : ", ") + names[k];
      throw ParameterError("there is no pin `" + name + "`", std::string("parameter ") + parameter, "name one of " + known);
    }

    /// Extent of each component along the disc's axis [m].
    std::vector<double> heights(const Model &model)
    {
      const std::size_t   n = model.component_names().size();
      std::vector<double> lowest(n, std::numeric_limits<double>::max()), highest(n, -std::numeric_limits<double>::max()), result;
      for (const Node &node : model.nodes())
        {
          lowest[node.component]  = std::min(lowest[node.component], node.position[2]);
          highest[node.component] = std::max(highest[node.component], node.position[2]);
        }
      for (std::size_t k = 0; k < n; ++k)
        result.push_back(highest[k] - lowest[k]);
      return result;
    }

    /// Centre of the contact face of each component [m].
    std::vector<Vector3> face_centres(const Model &model, const ContactInterface &interface)
    {
      std::vector<Vector3> centres(model.component_names().size(), Vector3{{0., 0., 0.}});
      std::vector<double>  areas(centres.size(), 0.);
      for (const ContactNode &node : interface)
        {
          areas[node.pin] += node.area;
          for (unsigned int k = 0; k < 3; ++k)
            centres[node.pin][k] += node.area * node.position[k];
        }
      for (std::size_t pin = 0; pin < centres.size(); ++pin)
        if (areas[pin] > 0.)
          for (double &x : centres[pin])
            x /= areas[pin];
      return centres;
    }

    /// Distances of a node from the centre of its face, along t and outwards [m].
    std::pair<double, double> offsets(const ContactNode &node, const Vector3 &centre)
    {
      const Vector3 offset = {{node.position[0] - centre[0], node.position[1] - centre[1], node.position[2] - centre[2]}};
      return {dot(offset, node.sliding), node.axis_distance() - std::hypot(centre[0], centre[1])};
    }

    /// Gap of each node along the axis before the backplates move [m].
    std::vector<double> axial_gaps(const Model &model, const ContactInterface &interface, const SlidingParameters &parameters)
    {
      std::vector<PinGap> of_pin(model.component_names().size(), PinGap{"", 0.});
      for (const PinGap &gap : parameters.gaps)
        of_pin[pin_number(model, gap.pin, "Steady sliding/Gaps")] = gap;
      const auto          centres = face_centres(model, interface);
      std::vector<double> result;
      for (const ContactNode &node : interface)
        {
          const PinGap &gap            = of_pin[node.pin];
          const auto [along, outwards] = offsets(node, centres[node.pin]);
          result.push_back(gap.gap + gap.sliding_taper * along + gap.radial_taper * outwards);
        }
      return result;
    }

    /// Backplate of each contact node, numbered from 0, and the load on each; none of the latter where the way is given.
    struct Backplates
    {
      std::vector<int>    of_node;
      std::vector<double> loads;
      int                 n;
    };

    Backplates backplates(const Model               &model,
                          const ContactInterface    &interface,
                          const OperationParameters &operation,
                          const SlidingParameters   &parameters)
    {
      const bool per_pin = parameters.control == BackplateControl::load_per_pin;
      // A backplate is known by its pin, or by its side
      std::map<int, int>                         numbers;
      std::map<int, std::map<unsigned int, int>> pins_of_side;
      Backplates                                 result{{}, {}, 0};
      for (const ContactNode &node : interface)
        {
          const int key = per_pin ? static_cast<int>(node.pin) : node.side();
          if (numbers.count(key) == 0)
            numbers[key] = result.n++;
          result.of_node.push_back(numbers[key]);
          pins_of_side[node.side()][node.pin] = numbers[key];
        }
      if (parameters.control == BackplateControl::displacement)
        return result;
      result.loads.assign(result.n, operation.load_per_side);
      if (!per_pin)
        return result;

      for (const auto &[side, pins] : pins_of_side)
        for (const auto &[pin, number] : pins)
          result.loads[number] = operation.load_per_side / pins.size();
      for (const PinLoad &load : parameters.pin_loads)
        {
          const unsigned int pin = pin_number(model, load.pin, "Steady sliding/Loads");
          if (numbers.count(pin) > 0)
            result.loads[numbers[pin]] = load.load;
        }
      for (const double load : result.loads)
        if (!(load > 0.))
          throw ParameterError("a pin that Steady sliding/Loads does not list has no load", "parameter Operation/Load per side",
                               "give a positive load, or list every pin");
      return result;
    }

    double largest(const std::vector<double> &values)
    {
      double result = -std::numeric_limits<double>::max();
      for (const double value : values)
        result = std::max(result, value);
      return result;
    }
  } // namespace

  void check_sliding(const Model               &model,
                     const ContactInterface    &interface,
                     const OperationParameters &operation,
                     const SlidingParameters   &parameters)
  {
    const auto height = heights(model);
    const auto gaps   = axial_gaps(model, interface, parameters);
    for (const PinLoad &load : parameters.pin_loads)
      pin_number(model, load.pin, "Steady sliding/Loads");

    const Backplates    plates = backplates(model, interface, operation, parameters);
    std::vector<double> smallest(plates.n, std::numeric_limits<double>::max());
    for (std::size_t c = 0; c < interface.size(); ++c)
      {
        const std::string &pin = model.component_names()[interface[c].pin];
        if (std::abs(gaps[c]) >= height[interface[c].pin])
          throw ParameterError("the gap of " + exact_text(gaps[c]) + " m is larger than the height of the pin, " +
                                 exact_text(height[interface[c].pin]) + " m",
                               "parameter Steady sliding/Gaps, pin " + pin, "gaps are given in metres: 1e-5 is 10 micrometres");
        smallest[plates.of_node[c]] = std::min(smallest[plates.of_node[c]], gaps[c]);
      }
    if (parameters.control == BackplateControl::displacement)
      for (const double gap : smallest)
        if (gap >= parameters.displacement)
          throw ParameterError("the displacement of " + exact_text(parameters.displacement) +
                                 " m closes no gap on one side, where the smallest is " + exact_text(gap) + " m",
                               "parameters Steady sliding/Displacement and Gaps", "raise the displacement or lower the gaps");
  }

  SlidingResponses sliding_responses(const ContactOperators &contact, const StaticResponse &response)
  {
    const auto attachment = [&](const SparseMatrix &P) { return response.solve(transpose_times(P, unit_vectors(P.RowMap()))); };
    return {attachment(*contact.normal), attachment(*contact.tangential)};
  }

  SlidingState steady_sliding(const Model               &model,
                              const ContactInterface    &interface,
                              const ContactOperators    &contact,
                              const SecondOrderSystem   &system,
                              const StaticResponse      &response,
                              const OperationParameters &operation,
                              const SlidingParameters   &parameters)
  {
    return steady_sliding(model, interface, contact, system, response, sliding_responses(contact, response), operation, parameters);
  }

  SlidingState steady_sliding(const Model               &model,
                              const ContactInterface    &interface,
                              const ContactOperators    &contact,
                              const SecondOrderSystem   &system,
                              const StaticResponse      &response,
                              const SlidingResponses    &responses,
                              const OperationParameters &operation,
                              const SlidingParameters   &parameters)
  {
    check_sliding(model, interface, operation, parameters);
    const int        n_c    = interface.size();
    const double     mu     = operation.friction_coefficient;
    const Backplates plates = backplates(model, interface, operation, parameters);
    const bool       moves  = !plates.loads.empty();

    // Free motions of the disc
    const MultiVector &Psi_n = responses.normal, &Psi_t = responses.tangential;
    const auto         motions  = balanced_disc_motions(model, contact, system, response, mu);
    const int          n_plates = moves ? plates.n : 0, n_z = n_plates + (motions ? motions->NumVectors() : 0);

    ContactProblem problem{replicate(*contact.normal * Psi_n), replicate(*contact.normal * Psi_t), mu,           {},
                           DenseMatrix::Zero(n_c, n_z),        DenseMatrix::Zero(n_z, n_c),        plates.loads, {}};
    const auto     gaps = axial_gaps(model, interface, parameters);
    for (int c = 0; c < n_c; ++c)
      {
        const ContactNode &node = interface[c];
        const double       a    = std::abs(node.normal[2]);
        problem.initial_gap.push_back(a * ((moves ? 0. : parameters.displacement) - gaps[c]));
        if (moves)
          {
            problem.motions(c, plates.of_node[c]) = a;
            problem.balance(plates.of_node[c], c) = -node.side() * (node.normal[2] + mu * node.sliding[2]);
          }
      }
    if (motions)
      {
        const DenseMatrix B_n = replicate(*contact.normal * *motions), B_t = replicate(*contact.tangential * *motions);
        problem.forces.resize(n_z, 0.);
        // −L = (P_n + μ P_t) N: work of the contact forces on the motion
        problem.motions.rightCols(n_z - n_plates)  = B_n;
        problem.balance.bottomRows(n_z - n_plates) = -(B_n + mu * B_t).transpose();
      }

    if (motions && moves)
      hold_undetermined_motion(problem, n_plates);

    const ContactSolution solution = solve_contact(problem);
    SlidingState          state{solution.reactions,
                       solution.gaps,
                       solution.closed,
                       std::vector<double>(model.component_names().size(), 0.),
                       nullptr,
                       nullptr,
                       {},
                       contact_uniqueness(problem, solution),
                       solution.n_steps};

    // Displacements
    const DenseMatrix r_dense = as_column(state.reactions);
    const MultiVector r       = distribute(r_dense, contact.normal->RowMap());
    MultiVector       u       = Psi_n * r_dense;
    multiply_add(mu, Psi_t, r_dense, 1., u);
    if (motions)
      multiply_add(1., *motions, as_column(solution.motions).tail(motions->NumVectors()), 1., u);
    for (int c = 0; c < n_c; ++c)
      state.approach[interface[c].pin] = moves ? solution.motions[plates.of_node[c]] : parameters.displacement;
    std::vector<double> side(model.component_names().size(), 0.);
    for (const ContactNode &node : interface)
      side[node.pin] = node.side();
    MultiVector total = u;
    for (const Node &node : model.nodes())
      if (const int dof = node.dofs[2]; dof >= 0 && total.Map().MyGID(dof))
        total.SumIntoGlobalValue(dof, 0, -side[node.component] * state.approach[node.component]);

    // Certificate: everything once more from the displacements of the full model
    MultiVector  forces      = transpose_times(*contact.normal, r);
    const double normal_size = column_norms(forces)[0];
    forces.Update(mu, transpose_times(*contact.tangential, r), 1.);
    if (const MultiVector *N = response.rigid_body_modes()) // the moment that the drive takes
      multiply_add(-1., *system.mass * *N, gram(*N, forces), 1., forces);
    MultiVector rest = *system.stiffness * u;
    rest.Update(-1., forces, 1.);
    SlidingCertificate &certificate = state.certificate;
    certificate.residual            = normal_size > 0. ? column_norms(rest)[0] / normal_size : 0.;

    std::vector<double> loads(plates.n, 0.);
    for (int c = 0; c < n_c; ++c)
      loads[plates.of_node[c]] -= interface[c].side() * (interface[c].normal[2] + mu * interface[c].sliding[2]) * state.reactions[c];
    const double load = largest(loads);
    certificate.load  = 0.;
    for (std::size_t k = 0; k < plates.loads.size(); ++k)
      certificate.load = std::max(certificate.load, std::abs(loads[k] - plates.loads[k]) / plates.loads[k]);

    const DenseMatrix relative = replicate(*contact.normal * u);
    double            way      = 0.;
    for (int c = 0; c < n_c; ++c)
      way = std::max(way, std::abs(relative(c, 0)));
    certificate.tension         = largest(state.reactions) / load;
    certificate.overlap         = -std::numeric_limits<double>::max();
    certificate.complementarity = 0.;
    for (int c = 0; c < n_c; ++c)
      {
        const double g              = relative(c, 0) + std::abs(interface[c].normal[2]) * (state.approach[interface[c].pin] - gaps[c]);
        certificate.overlap         = std::max(certificate.overlap, g / way);
        certificate.complementarity = std::max(certificate.complementarity, std::abs(g * state.reactions[c]) / (way * load));
      }

    // Supports: K w, w a rigid-body motion of a component, holds forces next to its mount or clamp only
    double arm = 0.;
    for (const ContactNode &node : interface)
      arm = std::max(arm, node.axis_distance());
    for (unsigned int component = 0; component < model.component_names().size(); ++component)
      {
        const MultiVector W       = rigid_motions(model, component);
        const DenseMatrix support = gram(*system.stiffness * W, u), applied = gram(W, forces);
        for (int k = 0; k < 6; ++k)
          {
            double &balance = k < 3 ? certificate.force_balance : certificate.moment_balance;
            balance         = std::max(balance, std::abs(support(k, 0) - applied(k, 0)) / (k < 3 ? load : load * arm));
          }
      }

    state.displacement       = std::make_shared<MultiVector>(u);
    state.total_displacement = std::make_shared<MultiVector>(total);
    return state;
  }

  std::vector<PinContact> pin_contacts(const Model               &model,
                                       const ContactInterface    &interface,
                                       const std::vector<double> &reactions,
                                       const std::vector<double> &gaps,
                                       const std::vector<double> &approach,
                                       const OperationParameters &operation)
  {
    const auto              centres = face_centres(model, interface);
    const auto              c_b = radial_dissipation(interface, reactions, operation), c_t = sliding_dissipation(reactions, operation);
    std::vector<PinContact> result;
    for (unsigned int pin = 1; pin < model.component_names().size(); ++pin)
      {
        PinContact entry{model.component_names()[pin], 0, 0, 0, 0., 0., 0., 0., 0., 0., 0., approach.empty() ? 0. : approach[pin], 0.};
        for (std::size_t c = 0; c < interface.size(); ++c)
          if (const ContactNode &node = interface[c]; node.pin == pin)
            {
              const double force           = -reactions[c];
              const auto [along, outwards] = offsets(node, centres[pin]);
              entry.side                   = node.side();
              ++entry.n_nodes;
              entry.n_open += force == 0.;
              entry.load += force;
              entry.sliding_offset += force * along;
              entry.radial_offset += force * outwards;
              entry.largest_pressure = std::max(entry.largest_pressure, force / node.area);
              entry.radial_damping += c_b[c];
              entry.sliding_damping += c_t[c];
              if (!gaps.empty())
                entry.largest_gap = std::max(entry.largest_gap, -gaps[c]);
            }
        if (entry.n_nodes == 0)
          continue;
        if (entry.load > 0.)
          {
            entry.sliding_offset /= entry.load;
            entry.radial_offset /= entry.load;
          }
        entry.sliding_speed = operation.rotation_speed * (std::hypot(centres[pin][0], centres[pin][1]) + entry.radial_offset);
        result.push_back(entry);
      }
    return result;
  }
} // namespace Squeal
