// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/studies/steps/mode_results.h>

namespace Squeal
{
  namespace
  {
    /// Maximum number of modes listed in a warning.
    constexpr std::size_t n_named = 5;

    /// Warns of unstable modes that are not converged; lists the first ones as "A0-4 at 2315 Hz (0.3 %, 0.05 points)".
    void warn_of_unconverged(const std::vector<DiscretisationError> &errors,
                             const FrictionModes                    &friction,
                             const AccuracyLimits                   &limits,
                             Run                                    &run)
    {
      std::string names;
      std::size_t n = 0;
      for (std::size_t j = 0; j < errors.size(); ++j)
        if (friction.unstable[j] && !errors[j].is_within(limits.frequency, limits.divergence) && ++n <= n_named)
          names += text(n > 1 ? ", " : "", to_string(friction.labels[j]), " at ",
                        decimal_text(modal_quantities(friction.modes.lambda[j]).frequency), " Hz (",
                        errors[j].has_counterpart ?
                          text(decimal_text(100. * errors[j].frequency), " %, ", decimal_text(100. * errors[j].divergence), " points") :
                          "no counterpart",
                        ")");
      if (n > 0)
        run.warn(text(counted(n, "unstable mode has", "unstable modes have"), " not converged on this mesh to within ",
                      100. * limits.frequency, " % in frequency and ", 100. * limits.divergence, " percentage points in divergence rate: ",
                      names, n > n_named ? ", ..." : "", "; refine the mesh to confirm the instability"));
    }

    /// File name of a mode: type, row in the table from 1, and label.
    std::string file_name(const std::string &kind, const std::size_t row, const ModeLabel &label)
    {
      std::ostringstream name;
      name << kind << "_" << std::setw(3) << std::setfill('0') << row + 1 << "_" << file_text(label);
      return name.str();
    }

    std::string real_mode_title(const std::string &what, const ModeLabel &label, const double frequency)
    {
      return text(what, " ", to_string(label), ", ", decimal_text(frequency), " Hz");
    }

    /// Local rows of a displacement on the dofs of the uncoupled bodies, n_free × 1.
    std::vector<double> rows_here(const MultiVector &displacement)
    {
      return {displacement.col(0).begin(), displacement.col(0).end()};
    }

    /// Contributions of friction and damping at each contact node to ξ, per area [1/m²]; zero at open nodes.
    std::vector<double> energy_input(const Linearisation &linearisation, const PowerBalance &balance)
    {
      std::vector<double> result(linearisation.scene->interface.size(), 0.);
      for (std::size_t node = 0; node < linearisation.closed.size(); ++node)
        result[linearisation.closed[node]] = balance.at(node) / linearisation.interface[node].area;
      return result;
    }

    /// Field of the complex mode in a column.
    using FieldOfMode = std::function<ModeField(int column)>;

    void write_complex_modes(const FrictionModes &friction, const FieldOfMode &field_of, FieldWriter &writer, Run &run)
    {
      const OutputParameters &output = run.parameters.output;
      const ComplexModes     &modes  = friction.modes;
      std::vector<ListedMode> list;
      std::vector<ModeField>  animated;
      double                  highest = 0.; // largest divergence rate of the animated modes
      run.progress.begin("Mode shapes");
      for (std::size_t j = 0; j < friction.labels.size(); ++j)
        {
          if (output.fields != FieldSelection::all && !friction.unstable[j])
            continue;
          const ModeLabel &label     = friction.labels[j];
          const double     frequency = modal_quantities(modes.lambda[j]).frequency;
          run.progress.update(text(to_string(label), ", ", frequency, " Hz"));
          ModeField field = field_of(static_cast<int>(j));
          field.name      = file_name("complex", j, label);
          field.title     = mode_title(label, modes.lambda[j]);
          writer.write_mode(field);
          list.push_back({field.name, frequency});
          if (friction.unstable[j] && output.animation_frames > 0)
            {
              animated.push_back(field);
              highest = std::max(highest, modal_quantities(modes.lambda[j]).divergence_rate);
            }
        }
      if (!list.empty())
        writer.write_list("modes", list);
      if (!animated.empty())
        writer.write_animation("unstable_modes", animated, animation_options(output));
      std::string growth; // the amplitude grows by e^{2π ξ n} in n periods
      if (const double exponent = 2. * M_PI * highest; output.animation_growth && highest > 0.)
        growth = text("; during the animation, the mode with the largest divergence rate grows by a factor of ",
                      std::exp(exponent * output.animation_periods), ", or by a factor of e in ", 1. / exponent, " periods");
      run.progress.finish(text(counted(list.size(), "mode"), ", ", animated.size(), " animated", growth));
    }

    /// @param shapes matrix from coupled dofs to displacements
    void write_real_modes(const FrictionlessModes &modes, const SparseMatrix &shapes, FieldWriter &writer, Run &run)
    {
      std::vector<ListedMode> list;
      run.progress.begin("Real mode shapes");
      for (std::size_t j = 0; j < modes.labels.size(); ++j)
        {
          const double      frequency = hertz(std::sqrt(modes.real.eigenvalues[j]));
          const std::string name      = file_name("real", j, modes.labels[j]);
          const MultiVector shape     = shapes * view(*modes.real.vectors, static_cast<int>(j), 1);
          run.progress.update(name);
          writer.write_mode({name, real_mode_title("real mode", modes.labels[j], frequency), rows_here(shape), {}});
          list.push_back({name, frequency});
        }
      writer.write_list("real_modes", list);
      run.progress.finish(counted(list.size(), "mode"));
    }

    /// Points of this process. The component of a point is the group of the dof with the largest weight in its displacement; for points
    /// without a group, it is the number of groups.
    std::vector<Node> nodes_of(const ShapePoints &points, const std::vector<DofGroup> &groups)
    {
      const SparseMatrix       &displacements = *points.displacements;
      const auto                none          = static_cast<unsigned int>(groups.size());
      std::vector<unsigned int> group_of(displacements.n_columns(), none);
      for (unsigned int g = none; g-- > 0;)
        for (const auto &[first, last] : groups[g].ranges)
          std::fill(group_of.begin() + first, group_of.begin() + last + 1, g);

      std::vector<Node> result;
      SparseMatrix::Row row;
      for (int i = 0; i < displacements.rows().n_local(); i += 3)
        {
          const int    first = displacements.rows().number(i), point = first / 3;
          unsigned int component = none;
          double       largest   = 0.;
          for (int d = 0; d < 3; ++d)
            {
              displacements.get_row(i + d, row);
              for (const auto &[dof, weight] : row)
                if (std::abs(weight) > largest)
                  {
                    largest   = std::abs(weight);
                    component = group_of[dof];
                  }
            }
          const auto x = points.positions.row(point);
          Node       node{{{x[0], x[1], x[2]}}, {{first, first + 1, first + 2}}, component, point, true, {}};
          result.push_back(std::move(node));
        }
      return result;
    }

    void write_component_modes(const FrictionlessModes &modes, FieldWriter &writer, Run &run)
    {
      const double omega_max = circular_frequency(run.parameters.discretization.maximum_frequency);
      const auto   listed    = listed_component_modes(modes, omega_max * omega_max);
      // Write a list for each set, because disc and pins have different meshes
      std::map<std::string, std::vector<ListedMode>> lists;
      run.progress.begin("Component mode shapes");
      for (std::size_t row = 0; row < listed.size(); ++row)
        {
          const ListedComponentMode &mode    = listed[row];
          const bool                 is_disc = mode.set == &modes.disc;
          const std::string          set     = is_disc ? "disc" : text("pins_", mode.contact);
          const std::string          name    = file_name("component_" + set, row, mode.label);
          run.progress.update(name);
          writer.write_mode({name, real_mode_title(is_disc ? "free disc" : text(mode.contact, " pins"), mode.label, mode.frequency()),
                             rows_here(view(*mode.set->vectors, mode.number, 1)), is_disc ? Component::disc : Component::pins});
          lists["component_modes_" + set].push_back({name, mode.frequency()});
        }
      for (const auto &[name, list] : lists)
        writer.write_list(name, list);
      run.progress.finish(counted(listed.size(), "mode"));
    }
  } // namespace

  ModesAtPoints modes_at(const CommonPoints &points, const FrictionlessModes &frictionless, const FrictionModes &friction)
  {
    const Linearisation &linearisation = frictionless.linearisation;
    return at_points(*displacements_at(points, *linearisation.scene->model), *linearisation.coupled.kernel, friction.modes);
  }

  std::optional<CoarserSolution> solve_on_coarser_mesh(Run &run)
  {
    if (run.parameters.goal == AccuracyGoal::as_given && run.parameters.discretization.coarser_mesh.empty())
      return {};
    run.progress.begin("Coarser mesh");
    const Parameters        parameters = with_coarser_mesh(run.parameters);
    Progress                silent;
    Run                     part(parameters, run, silent);
    Scene                   scene        = mesh_scene(part);
    const FrictionlessModes frictionless = damped_modes(scene, part);
    const FrictionModes     friction     = friction_modes(frictionless, parameters.operation.friction_coefficient, part);
    const CommonPoints      points       = common_points(*scene.model, parameters.materials);
    CoarserSolution         result{points, modes_at(points, frictionless, friction)};
    run.count("dofs of the coarser mesh", scene.model->free_map().n());
    run.progress.finish(text(scene.model->free_map().n(), " dofs, ", counted(friction.modes.lambda.size(), "complex mode"), ", ",
                             friction.n_unstable(), " unstable, to estimate the discretisation error"));
    return result;
  }

  std::vector<DiscretisationError> mesh_errors(const CoarserSolution   &coarser,
                                               const FrictionlessModes &frictionless,
                                               const FrictionModes     &friction,
                                               const AccuracyGoal       goal)
  {
    auto result = discretisation_errors(coarser.modes, modes_at(coarser.points, frictionless, friction), error_by_difference(goal),
                                        friction.modes.estimated_errors);
    // Modes that are undecided without the discretisation error remain undecided
    for (std::size_t j = 0; j < result.size(); ++j)
      if (friction.verdicts[j] == Verdict::undecided)
        result[j].verdict = Verdict::undecided;
    return result;
  }

  void report_mesh_errors(const std::vector<DiscretisationError> &errors, const FrictionModes &friction, Run &run)
  {
    double     frequency = 0., divergence = 0.;
    long       n_lost = 0, n_in_cluster = 0;
    const auto count = [&](const Verdict verdict) {
      return std::count_if(errors.begin(), errors.end(), [verdict](const DiscretisationError &error) { return error.verdict == verdict; });
    };
    for (const DiscretisationError &error : errors)
      {
        frequency  = std::max(frequency, error.frequency);
        divergence = std::max(divergence, error.divergence);
        n_lost += !error.has_counterpart;
        n_in_cluster += error.in_cluster;
      }
    run.measure("largest estimated error of a frequency by the mesh [-]", frequency);
    run.measure("largest estimated error of a divergence rate by the mesh [-]", divergence);
    run.count("modes without counterpart on the coarser mesh", n_lost);
    run.count("modes in clusters that mix from mesh to mesh", n_in_cluster);
    for (const Verdict verdict : {Verdict::unstable, Verdict::stable, Verdict::undecided})
      run.count("modes " + to_string(verdict) + " with the error of the mesh", count(verdict));
    const bool has_goal = run.parameters.goal != AccuracyGoal::as_given;
    run.progress.note(
      text(has_goal ? text("  accuracy: ", to_string(run.parameters.goal), " requested; errors estimated from a coarser mesh") :
                      "  discretisation errors are differences from the coarser mesh, not extrapolated",
           ": frequencies within ", decimal_text(100. * frequency), " %, divergence rates within ", decimal_text(100. * divergence),
           " percentage points", n_lost > 0 ? text(", ", counted(n_lost, "mode"), " without counterpart excluded") : ""));
    std::string converged;
    if (has_goal)
      {
        const AccuracyLimits limits = limits_of(run.parameters.goal);
        const auto           n      = std::count_if(errors.begin(), errors.end(), [&](const DiscretisationError &error) {
          return error.is_within(limits.frequency, limits.divergence);
        });
        run.count("modes converged on the mesh", n);
        converged = text("; ", n, " of ", errors.size(), " converged");
        warn_of_unconverged(errors, friction, limits, run);
      }
    run.progress.note(text("  verdicts with the discretisation error: ", count(Verdict::unstable), " unstable, ", count(Verdict::stable),
                           " stable, ", count(Verdict::undecided), " undecided", converged));
  }

  std::string mode_title(const ModeLabel &label, const std::complex<double> &lambda)
  {
    const ModalQuantities mode = modal_quantities(lambda);
    return text(to_string(label), ", ", decimal_text(mode.frequency), " Hz, divergence rate ", 100. * mode.divergence_rate, " %",
                verdict_of(lambda) == Verdict::unstable ? ", unstable" : "");
  }

  AnimationOptions animation_options(const OutputParameters &output)
  {
    return {output.animation_frames, output.animation_periods, output.animation_growth};
  }

  void write_mode_shapes(const FrictionlessModes &frictionless, const FrictionModes &friction, const PowerBalances &balances, Run &run)
  {
    const OutputParameters &output        = run.parameters.output;
    const Linearisation    &linearisation = frictionless.linearisation;
    const Scene            &scene         = *linearisation.scene;
    FieldWriter             writer(*scene.model, scene.interface, linearisation.closed, run.folder());
    const auto              field_of = [&](const int j) {
      const ComplexModes &modes = friction.modes;
      ModeField field = mode_field(linearisation, "", modes.lambda[j], view(*modes.real_part, j, 1), view(*modes.imaginary_part, j, 1));
      if (const auto balance = balances.find(j); balance != balances.end())
        field.energy_input = energy_input(linearisation, balance->second);
      return field;
    };
    if (output.fields != FieldSelection::none)
      write_complex_modes(friction, field_of, writer, run);
    if (output.real_fields)
      write_real_modes(frictionless, *linearisation.coupled.kernel, writer, run);
    if (output.component_fields)
      write_component_modes(frictionless, writer, run);
  }

  void write_mode_shapes(const SystemFile &file, const FrictionlessModes &frictionless, const FrictionModes &friction, Run &run)
  {
    const OutputParameters &output = run.parameters.output;
    if (!file.points)
      {
        if (output.real_fields)
          run.warn("no mode shape is written, because " + file.path + " has no `positions`: add `positions` and `displacements`");
        return;
      }
    const SparseMatrix &displacements = *file.points->displacements;
    const auto          shapes        = multiply(displacements, *frictionless.linearisation.coupled.kernel);
    FieldWriter         writer(nodes_of(*file.points, file.groups), displacements.rows(), run.folder());
    const auto          field_of = [&](const int j) {
      const ComplexModes &modes = friction.modes;
      const MultiVector   re = *shapes * view(*modes.real_part, j, 1), im = *shapes * view(*modes.imaginary_part, j, 1);
      ModeField           field{"", modes.lambda[j], {}, {}};
      for (int i = 0; i < re.n_local_rows(); ++i)
        field.displacement.emplace_back(re(i, 0), im(i, 0));
      return field;
    };
    if (output.fields != FieldSelection::none)
      write_complex_modes(friction, field_of, writer, run);
    if (output.real_fields && !frictionless.labels.empty())
      write_real_modes(frictionless, *shapes, writer, run);
  }
} // namespace Squeal
