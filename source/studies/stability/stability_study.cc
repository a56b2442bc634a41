#include <squeal/base/conventions.h>
#include <squeal/geometry/mesh_file.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/studies/stability/strain_energy.h>
#include <squeal/studies/steps/mode_results.h>

#include <boost/range/irange.hpp>

#include <ostream>

namespace Squeal
{
  namespace
  {
    /// Component modes below ω² = @p largest_eigenvalue: component, contact, label, frequency, residual.
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

    /// Real coupled modes: label, share, frequency, residual.
    Table real_table(const FrictionlessModes &modes)
    {
      return Table(Columns<int>{{"label", "", [&](const int j) { return modes.labels[j]; }},
                                {"share", "-", [&](const int j) { return modes.labels[j].participation; }, 3},
                                {"frequency", "Hz", [&](const int j) { return hertz(std::sqrt(modes.real.eigenvalues[j])); }, 3},
                                {"residual", "-", [&](const int j) { return modes.real.residuals[j]; }, 1, true}},
                   boost::irange<int>(0, modes.labels.size()));
    }

    /// A column of modes with friction, known by their numbers, of what modal_quantities() says of them.
    Column<int> column_of(const FrictionModes &friction,
                          const std::string   &name,
                          const std::string   &unit,
                          double ModalQuantities::*quantity,
                          const int                digits)
    {
      const double factor = unit == "%" ? 100. : 1.;
      return {name, unit,
              [&friction, quantity, factor](const int j) { return factor * (modal_quantities(friction.modes.lambda[j]).*quantity); },
              digits};
    }

    /// Complex modes: label, share, frequency, growth and divergence rate, damping ratio, residuals, whether they are unstable, how they
    /// travel, where their energy is, estimates where there are any, and columns @p more by the numbers of the modes.
    Table complex_table(const FrictionModes                          &friction,
                        const std::vector<std::optional<WaveShares>> &waves,
                        const Columns<int>                           &energies,
                        const Columns<int>                           &more)
    {
      const ComplexModes &modes = friction.modes;
      const auto          wave  = [&waves](double WaveShares::*share) {
        return [&waves, share](const int j) { return waves[j] ? std::make_optional(*waves[j].*share) : std::nullopt; };
      };
      Columns<int> columns = {{"label", "", [&](const int j) { return friction.labels[j]; }},
                              {"share", "-", [&](const int j) { return friction.labels[j].participation; }, 3},
                              column_of(friction, "frequency", "Hz", &ModalQuantities::frequency, 3),
                              column_of(friction, "growth rate", "1/s", &ModalQuantities::growth_rate, 4),
                              column_of(friction, "divergence rate", "%", &ModalQuantities::divergence_rate, 4),
                              column_of(friction, "effective damping ratio -2R/omega", "%", &ModalQuantities::damping_ratio, 4),
                              {"residual", "-", [&](const int j) { return modes.residuals[j]; }, 1, true},
                              {"eps_res", "-", [&](const int j) { return modes.energy_residuals[j]; }, 1, true},
                              {"unstable", "-", [&](const int j) { return bool(friction.unstable[j]); }},
                              {"wave with rotation", "-", wave(&WaveShares::positive), 3},
                              {"wave against rotation", "-", wave(&WaveShares::negative), 3}};
      columns.insert(columns.end(), energies.begin(), energies.end());
      if (!modes.estimated_errors.empty())
        columns.push_back({"estimated error of lambda", "-", [&](const int j) { return modes.estimated_errors[j]; }, 1, true});
      if (more.empty()) // else the error of the mesh is in the verdict
        columns.push_back({"verdict", "", [&](const int j) { return to_string(friction.verdicts[j]); }});
      columns.insert(columns.end(), more.begin(), more.end());
      return Table(columns, boost::irange<int>(0, friction.labels.size()));
    }

    /// Columns that estimated errors of the mesh add to complex_table(): those, with a goal whether they are within its limits, and the
    /// verdict.
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

    /// The modes that grow, the largest divergence rate first: label, frequency, growth and divergence rate, share. At most @p n_largest
    /// rows.
    Table unstable_table(const FrictionModes &friction, const std::size_t n_largest)
    {
      std::vector<int> growing;
      for (std::size_t j = 0; j < friction.unstable.size(); ++j)
        if (friction.unstable[j])
          growing.push_back(static_cast<int>(j));
      const auto rate = [&](const int j) { return modal_quantities(friction.modes.lambda[j]).divergence_rate; };
      std::stable_sort(growing.begin(), growing.end(), [&](const int a, const int b) { return rate(a) > rate(b); });
      growing.resize(std::min(growing.size(), n_largest));
      return Table(Columns<int>{{"unstable mode", "", [&](const int j) { return friction.labels[j]; }},
                                column_of(friction, "frequency", "Hz", &ModalQuantities::frequency, 1),
                                column_of(friction, "growth rate", "1/s", &ModalQuantities::growth_rate, 2),
                                column_of(friction, "divergence rate", "%", &ModalQuantities::divergence_rate, 4),
                                {"share", "-", [&](const int j) { return friction.labels[j].participation; }, 3}},
                   growing);
    }

    /// What a body of a mode adds to its divergence rate [-].
    struct PowerRow
    {
      int                   mode;
      std::string           body;
      std::optional<double> friction, into_disc, into_pin, radial, sliding; ///< of pins
      double                damping;                                        ///< of the material or of the modes

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

    /// The balances of all growing modes; how far the largest is from adding up to ξ goes to the run record.
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
        run.measure("largest difference of a divergence rate from what its powers add up to [-]", imbalance);
      return result;
    }

    /// `energy.csv`: of each growing mode what disc and pins, friction and damping add to its divergence rate. Nothing without a growing mode.
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
         {"all of it", "%", [](const PowerRow &row) { return 100. * row.sum(); }},
         {"friction", "%", part(&PowerRow::friction)},
         {"friction into the disc", "%", part(&PowerRow::into_disc)},
         {"friction into the pin", "%", part(&PowerRow::into_pin)},
         {"radial dissipation", "%", part(&PowerRow::radial)},
         {"slope of friction", "%", part(&PowerRow::sliding)},
         {"damping", "%", [](const PowerRow &row) { return 100. * row.damping; }}};
      run.store_table("energy", Table(columns, rows));
    }

    /// Unstable modes that the screen shows.
    constexpr std::size_t n_shown_modes = 20;

    // ------------------------------------------------------------------ tables

    /// Real eigenvalues, fastest growth first: growth rate, kind.
    Table real_eigenvalue_table(std::vector<double> values)
    {
      std::reverse(values.begin(), values.end());
      return Table(Columns<double>{{"growth rate", "1/s", [](const double value) { return value; }, 4},
                                   {"kind", "", [](const double value) { return value > 0. ? "static divergence" : "decay"; }}},
                   values);
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
      // A matrix without entries where there is no damping, so that readers need no special case
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
      run.progress.finish("M, C, K, C_b, P_n, P_t, P_b, K_n, T_c in Matrix Market form");
    }

    // ----------------------------------------------------------------- the answer

    /// Verdict and unstable modes, which is what most users want to know.
    void report(const FrictionlessModes                &frictionless,
                const FrictionModes                    &friction,
                const std::vector<DiscretisationError> &mesh_errors,
                Run                                    &run)
    {
      const Parameters &parameters = run.parameters;
      run.screen << '\n';
      for (const std::string &line :
           verdict(friction, parameters.operation.friction_coefficient, parameters.discretization.maximum_frequency))
        run.progress.note(line);
      if (!mesh_errors.empty())
        report_mesh_errors(mesh_errors, friction, run);
      if (friction.n_unstable() > 0)
        {
          run.screen << '\n';
          unstable_table(friction, n_shown_modes).print(run.screen);
          if (friction.n_unstable() > n_shown_modes)
            run.progress.note(text("    and ", friction.n_unstable() - n_shown_modes, " more, see complex_modes.csv"));
        }
      run.screen << '\n';
      if (const std::string note = note_on_count(friction, frictionless.real.eigenvalues.size()); !note.empty())
        run.progress.note(note);
      if (const std::string note = note_on_weak_damping(frictionless.linearisation.coupled, friction); !note.empty())
        run.progress.note(note);
    }
  } // namespace

  /// `Study = stability`: component modes, real coupled modes and complex modes at one friction coefficient, about equal shares of the load
  /// or about steady sliding, with their tables and mode shapes; with an accuracy asked for or a coarser mesh, their errors by the mesh. A dry run makes,
  /// checks and counts the mesh, and writes nothing.
  static void run_stability_study(Scene &scene, Run &run)
  {
    const Parameters          &parameters = run.parameters;
    const OperationParameters &operation  = parameters.operation;
    const double               omega_max  = circular_frequency(parameters.discretization.maximum_frequency);

    // Process 0 writes the mesh; the others have their parts in the model, and need no more than names
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
    const SolverParameters              &solvers       = parameters.solvers;
    record_conditioning(frictionless.linearisation.coupled, friction.modes, friction.conditioning,
                        solvers.complex_solver == ComplexSolver::krylov ? solvers.complex_tolerance : solvers.iteration_tolerance, run);
    run.count("complex modes", friction.modes.lambda.size());
    run.count("unstable modes", friction.n_unstable());
    run.count("undecided modes", friction.n_of(Verdict::undecided));
    run.count("real eigenvalues", friction.modes.real_values.size());
    run.count("growing real eigenvalues", friction.n_growing_real());
    if (friction.n_growing_real() > 0)
      run.measure("largest growth rate of a real eigenvalue [1/s]", friction.modes.real_values.back());

    // ----------------------------------------------------------------- results
    const auto errors = coarser ? mesh_errors(*coarser, frictionless, friction, parameters.goal) : std::vector<DiscretisationError>();
    report(frictionless, friction, errors, run);
    if (sliding)
      write_sliding_tables(scene, *sliding, operation, run);
    run.store_table("complex_modes", complex_table(friction, waves_with_rotation(frictionless, friction, operation),
                                                   strain_energy_columns(linearisation, friction.modes, parameters.materials),
                                                   coarser ? mesh_error_columns(errors, parameters.goal) : Columns<int>()));
    run.store_table("real_modes", real_table(frictionless));
    run.store_table("component_modes", component_table(frictionless, omega_max * omega_max));
    if (!friction.modes.real_values.empty())
      run.store_table("real_eigenvalues", real_eigenvalue_table(friction.modes.real_values));
    const PowerBalances balances = power_balances(linearisation, friction, run);
    write_power_table(linearisation, friction, balances, run);

    if (sliding && parameters.output.fields != FieldSelection::none)
      write_sliding_fields(linearisation, run);
    write_mode_shapes(frictionless, friction, balances, run);
    if (parameters.output.write_matrices)
      write_matrices(linearisation, run);
    run.folder().write("mesh.msh", [&](std::ostream &stream) { write_msh(scene.mesh, stream); });
    run.finish();
  }

  extern const Study stability_study{
    "stability",
    run_stability_study,
    {"Discretization/Coarser mesh", "Output/Write matrices", "Output/Component mode shapes", "Output/Real mode shapes"}};
} // namespace Squeal
