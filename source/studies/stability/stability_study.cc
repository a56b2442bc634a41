// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/geometry/mesh_file.h>
#include <squeal/linear_algebra/matrix_market.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/studies/stability/mode_tables.h>
#include <squeal/studies/stability/strain_energy.h>
#include <squeal/studies/steps/imported_modes.h>
#include <squeal/studies/steps/mode_results.h>
#include <squeal/studies/steps/written_system.h>

#include <boost/range/irange.hpp>

#include <ostream>

namespace Squeal
{
  namespace
  {
    /// Component modes below ω² = @p largest_eigenvalue.
    Table component_table(const FrictionlessModes &modes, const double largest_eigenvalue)
    {
      using Row = ListedComponentMode;
      return Table(Columns<Row>{{"component", "", &Row::component},
                                {"contact", "", &Row::contact},
                                {"label", "", &Row::label},
                                {"frequency", "Hz", [](const Row &row) { return row.frequency(); }, 2},
                                {"residual", "-", [](const Row &row) { return row.set->residuals[row.number]; }, 1, true}},
                   listed_component_modes(modes, largest_eigenvalue));
    }

    /// Columns for the travelling waves in disc modes.
    Columns<int> wave_columns(const std::vector<std::optional<WaveShares>> &waves)
    {
      const auto wave = [&waves](double WaveShares::*share) {
        return [waves, share](const int j) { return waves[j] ? std::make_optional(*waves[j].*share) : std::nullopt; };
      };
      return {{"wave with rotation", "-", wave(&WaveShares::positive), 3}, {"wave against rotation", "-", wave(&WaveShares::negative), 3}};
    }

    /// Additional columns of the table of complex modes for estimated discretisation errors: the errors, whether they are within the limits
    /// of a goal, and the verdict.
    Columns<int> mesh_error_columns(const std::vector<DiscretisationError> &errors, const AccuracyGoal goal)
    {
      const auto known = [&errors](const double DiscretisationError::*error) {
        return [&errors, error](const int j) {
          return errors[j].has_counterpart ? std::make_optional(100. * (errors[j].*error)) : std::nullopt;
        };
      };
      const auto counterpart = [&errors](const int j) {
        return !errors[j].has_counterpart ? "none" : errors[j].in_cluster ? "in a cluster" : "by shape";
      };
      Columns<int> columns = {{"estimated frequency error by the mesh", "%", known(&DiscretisationError::frequency), 1, true},
                              {"estimated divergence rate error by the mesh", "%", known(&DiscretisationError::divergence), 1, true},
                              {"counterpart on the coarser mesh", "", counterpart}};
      if (goal != AccuracyGoal::as_given)
        columns.push_back({"converged", "-", [&errors, limits = limits_of(goal)](const int j) {
                             return errors[j].is_within(limits.frequency, limits.divergence);
                           }});
      columns.push_back({"verdict", "", [&errors](const int j) { return to_string(errors[j].verdict); }});
      return columns;
    }

    /// Contribution of a body to the divergence rate of a mode [-].
    struct PowerRow
    {
      int                   mode;
      std::string           body;
      std::optional<double> friction, into_disc, into_pin, radial, sliding; ///< contributions of pins
      double                damping;                                        ///< contribution of the material, or of modal damping

      double sum() const
      {
        return friction.value_or(0.) + radial.value_or(0.) + sliding.value_or(0.) + damping;
      }
    };

    std::vector<PowerRow> rows_of(const int mode, const PowerBalance &balance, const Linearisation &linearisation)
    {
      const std::vector<std::string> &names = linearisation.scene->model->component_names();
      std::vector<PowerRow>           rows{{mode, names.front(), {}, {}, {}, {}, {}, balance.bodies.front()}};
      for (std::size_t pin = 1; pin < names.size(); ++pin)
        rows.push_back({mode, names[pin], 0., 0., 0., 0., 0., balance.bodies[pin]});
      for (std::size_t node = 0; node < linearisation.interface.size(); ++node)
        {
          PowerRow &row = rows[linearisation.interface[node].pin];
          *row.into_disc += balance.into_disc[node];
          *row.into_pin += balance.into_pins[node];
          *row.friction += balance.into_disc[node] + balance.into_pins[node];
          *row.radial += balance.radial_damping[node];
          *row.sliding += balance.sliding_damping[node];
        }
      if (balance.modal_damping != 0.)
        rows.push_back({mode, "all (modal damping)", {}, {}, {}, {}, {}, balance.modal_damping});
      return rows;
    }

    /// Balances of all growing modes; records the largest difference between the sum of a balance and ξ.
    PowerBalances power_balances(const Linearisation &linearisation, const FrictionModes &friction, Run &run)
    {
      const Scene  &scene = *linearisation.scene;
      PowerBalances result;
      double        imbalance = 0.;
      for (std::size_t j = 0; j < friction.labels.size(); ++j)
        if (friction.unstable[j])
          {
            const int                  column = static_cast<int>(j);
            const std::complex<double> lambda = friction.modes.lambda[j];
            const PowerBalance         balance =
              power_balance(scene.system, *scene.model, linearisation.coupled, linearisation.interface, linearisation.damping,
                            run.parameters.operation.friction_coefficient, lambda, view(*friction.modes.real_part, column, 1),
                            view(*friction.modes.imaginary_part, column, 1));
            imbalance      = std::max(imbalance, std::abs(balance.sum() - modal_quantities(lambda).divergence_rate));
            result[column] = balance;
          }
      if (!result.empty())
        run.measure("largest difference of a divergence rate from the sum of its contributions [-]", imbalance);
      return result;
    }

    /// Writes `energy.csv`: contributions of disc, pins, friction and damping to the divergence rate of each growing mode. Writes nothing
    /// if no mode grows.
    void write_power_table(const Linearisation &linearisation, const FrictionModes &friction, const PowerBalances &balances, Run &run)
    {
      if (balances.empty())
        return;
      std::vector<PowerRow> rows;
      for (const auto &[mode, balance] : balances)
        for (const PowerRow &row : rows_of(mode, balance, linearisation))
          rows.push_back(row);
      const auto part = [](std::optional<double> PowerRow::*share) {
        return [share](const PowerRow &row) { return row.*share ? std::make_optional(100. * *(row.*share)) : std::nullopt; };
      };
      const auto              quantity = [&](const PowerRow &row) { return modal_quantities(friction.modes.lambda[row.mode]); };
      const Columns<PowerRow> columns  = {
         {"mode", "-", [](const PowerRow &row) { return row.mode + 1; }},
         {"label", "", [&](const PowerRow &row) { return friction.labels[row.mode]; }},
         {"frequency", "Hz", [&](const PowerRow &row) { return quantity(row).frequency; }},
         {"divergence rate", "%", [&](const PowerRow &row) { return 100. * quantity(row).divergence_rate; }},
         {"body", "", &PowerRow::body},
         {"total", "%", [](const PowerRow &row) { return 100. * row.sum(); }},
         {"friction", "%", part(&PowerRow::friction)},
         {"friction into the disc", "%", part(&PowerRow::into_disc)},
         {"friction into the pin", "%", part(&PowerRow::into_pin)},
         {"radial dissipation", "%", part(&PowerRow::radial)},
         {"friction slope", "%", part(&PowerRow::sliding)},
         {"damping", "%", [](const PowerRow &row) { return 100. * row.damping; }}};
      run.store_table("energy", Table(columns, rows));
    }

    // ---------------------------------------------------------------- matrices

    void write_matrices(const Linearisation &linearisation, Run &run)
    {
      const Scene             &scene     = *linearisation.scene;
      const Model             &model     = *scene.model;
      const ContactInterface  &interface = linearisation.interface;
      const ContactOperators  &contact   = linearisation.contact;
      const SecondOrderSystem &system    = scene.system;
      const ResultFolder      &folder    = run.folder();
      const auto               damping   = contact_damping(contact, linearisation.damping);
      run.progress.begin("Matrix files");
      const auto write = [&](const SparseMatrix &matrix, const char *name, const MatrixMarketSymmetry symmetry) {
        const std::string content = matrix_market(matrix, symmetry);
        folder.write(text("matrices/", name, ".mtx"), [&](std::ostream &stream) { stream << content; });
      };
      write(*system.mass, "M", MatrixMarketSymmetry::symmetric);
      write(*system.stiffness, "K", MatrixMarketSymmetry::symmetric);
      // Write an empty matrix if there is no damping, so that readers need no special case
      const SparseMatrix zero(model.free_map(), model.free_map(), [](int, SparseMatrix::Row &) {});
      const Term        *symmetric = nullptr;
      for (const Term &term : scene.bodies)
        if (term.symmetry == Symmetry::skew)
          write(*term.matrix, "G", MatrixMarketSymmetry::general);
        else if (term.power == 1)
          symmetric = &term;
      write(symmetric ? *symmetric->matrix : zero, "C", MatrixMarketSymmetry::symmetric);
      write(damping ? *damping : zero, "C_b", MatrixMarketSymmetry::symmetric);
      write(*contact.normal, "P_n", MatrixMarketSymmetry::general);
      write(*contact.tangential, "P_t", MatrixMarketSymmetry::general);
      write(*contact.radial, "P_b", MatrixMarketSymmetry::general);
      write(*contact.kernel, "T_c", MatrixMarketSymmetry::general);
      const RowMap &contact_rows = contact.normal->rows();
      write(SparseMatrix(contact_rows, contact_rows,
                         [&](const int i, SparseMatrix::Row &row) {
                           const ContactNode &node = interface[contact_rows.number(i)];
                           row.emplace_back(contact_rows.number(i), node.stiffness * node.area);
                         }),
            "K_n", MatrixMarketSymmetry::general);

      const std::vector<Node> nodes = model.gathered_nodes();
      // Node coordinates with the rows of their dofs in M and K
      folder.write("matrices/nodes.csv", [&](std::ostream &stream) {
        stream << "x [m],y [m],z [m],component,row x,row y,row z\n" << std::setprecision(17);
        for (const Node &node : nodes)
          {
            stream << node.position[0] << ',' << node.position[1] << ',' << node.position[2] << ','
                   << csv_field(model.component_names()[node.component]);
            for (const int dof : node.dofs)
              stream << ',' << dof + (dof >= 0);
            stream << '\n';
          }
      });
      folder.write("matrices/contact_nodes.csv", [&](std::ostream &stream) {
        stream << "x [m],y [m],z [m],pin,n_x,n_y,n_z,t_x,t_y,t_z,b_x,b_y,b_z,area [m^2]\n" << std::setprecision(17);
        for (const ContactNode &node : interface)
          {
            stream << node.position[0] << ',' << node.position[1] << ',' << node.position[2] << ','
                   << csv_field(model.component_names()[node.pin]);
            for (const auto *vector : {&node.normal, &node.sliding, &node.radial})
              for (const double component : *vector)
                stream << ',' << component;
            stream << ',' << node.area << '\n';
          }
      });
      run.progress.finish("matrices in Matrix Market format");
    }

  } // namespace

  /// `Study = stability`: component modes, real coupled modes and complex modes at one friction coefficient, with all contact nodes closed
  /// or for steady sliding. Writes tables and mode shapes; with an accuracy goal or a coarser mesh, also discretisation errors.
  static void run_stability_study(Scene &scene, Run &run)
  {
    const Parameters          &parameters = run.parameters;
    const OperationParameters &operation  = parameters.operation;
    const double               omega_max  = circular_frequency(parameters.discretization.maximum_frequency);

    // Keep the whole mesh only on process 0, which writes it; the model contains the parts of the other processes
    if (Mesh names; !run.is_root)
      {
        names.volume_names = scene.mesh.volume_names;
        names.body_names   = scene.mesh.body_names;
        scene.mesh         = names;
      }

    const std::optional<CoarserSolution> coarser       = solve_on_coarser_mesh(run);
    const FrictionlessModes              frictionless  = damped_modes(scene, run);
    const FrictionModes                  friction      = friction_modes(frictionless, operation.friction_coefficient, run);
    const Linearisation                 &linearisation = frictionless.linearisation;
    const std::optional<SlidingState>   &sliding       = linearisation.sliding;
    record_modes(frictionless, friction, run);

    // ----------------------------------------------------------------- results
    const auto errors = coarser ? mesh_errors(*coarser, frictionless, friction, parameters.goal) : std::vector<DiscretisationError>();
    report_modes(frictionless, friction, errors, run);
    if (sliding)
      write_sliding_tables(scene, *sliding, operation, run);
    Columns<int> columns  = wave_columns(waves_with_rotation(frictionless, friction, operation));
    const auto   energies = strain_energy_columns(linearisation, friction.modes, parameters.materials);
    columns.insert(columns.end(), energies.begin(), energies.end());
    store_mode_tables(frictionless, friction, columns, coarser ? mesh_error_columns(errors, parameters.goal) : Columns<int>(), run);
    run.store_table("component_modes", component_table(frictionless, omega_max * omega_max));
    const PowerBalances balances = power_balances(linearisation, friction, run);
    write_power_table(linearisation, friction, balances, run);

    if (sliding && parameters.output.fields != FieldSelection::none)
      write_sliding_fields(linearisation, run);
    write_mode_shapes(frictionless, friction, balances, run);
    if (parameters.output.write_matrices)
      write_matrices(linearisation, run);
    write_scene_system(linearisation, friction_parameter(parameters), "system/", run);
    run.folder().write("mesh.msh", [&](std::ostream &stream) { write_msh(scene.mesh, stream); });
    run.finish();
  }

  /// `Study = stability` for a system file: groups of dofs replace bodies, and shapes are written at the points of the file.
  static void run_stability_of_system(Run &run)
  {
    const GivenSystem given = given_system(run);
    FrictionlessModes frictionless;
    FrictionModes     friction;
    if (given.coupled.stiffness)
      {
        frictionless = imported_modes(given.coupled, given.coupled, run);
        friction     = friction_modes(frictionless, given.value, run);
        if (run.parameters.discretization.maximum_rate > 0.)
          count_modes(given, frictionless, friction, run);
      }
    else
      {
        frictionless.linearisation.coupled = given.coupled;
        friction                           = direct_solution(given, run);
      }
    record_modes(frictionless, friction, run);
    report_modes(frictionless, friction, {}, run);
    Columns<int>       columns = accuracy_columns(given, friction);
    const Columns<int> groups  = group_columns(given, friction.modes);
    columns.insert(columns.end(), groups.begin(), groups.end());
    store_mode_tables(frictionless, friction, columns, {}, run);
    write_mode_shapes(given.file, frictionless, friction, run);
    write_system_again(given.file, "system/", run);
    run.finish();
  }

  extern const Study stability_study{"stability",
                                     run_stability_study,
                                     {"Discretization/Coarser mesh", "Output/Write matrices", "Output/Write system",
                                      "Output/Component mode shapes", "Output/Real mode shapes"},
                                     {},
                                     nullptr,
                                     run_stability_of_system};
} // namespace Squeal
