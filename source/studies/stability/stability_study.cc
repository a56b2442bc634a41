#include <squeal/base/conventions.h>
#include <squeal/geometry/mesh_file.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/studies/steps/friction_modes.h>
#include <squeal/studies/steps/mesh_estimate.h>
#include <squeal/studies/steps/mode_results.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>

namespace Squeal
{
  namespace
  {
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
      run.progress.finish("M, C, K, C_b, P_n, P_t, P_b, T_c in Matrix Market form");
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

  /// Frees the points, cells and faces of a mesh, but not their names.
  static void release(HexMesh &mesh)
  {
    mesh.points         = std::vector<HexMesh::Point>();
    mesh.hexahedra      = std::vector<HexMesh::Hexahedron>();
    mesh.quadrilaterals = std::vector<HexMesh::Quadrilateral>();
  }

  /**
   * `Study = stability`: component modes, real coupled modes and complex modes
   * at one friction coefficient, about equal shares of the load or about steady
   * sliding, with their tables and mode shapes; with an accuracy asked for, their errors by the mesh. A dry run makes, checks and
   * counts the mesh, and writes nothing.
   */
  static void run_stability_study(Scene &scene, Run &run)
  {
    const Parameters          &parameters = run.parameters;
    const OperationParameters &operation  = parameters.operation;
    const double               omega_max  = circular_frequency(parameters.discretization.maximum_frequency);

    // Process 0 writes the mesh; the others have their parts in the model
    if (!run.is_root)
      release(scene.mesh);
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
    run.store_table("complex_modes", complex_table(friction, waves_with_rotation(frictionless, friction, operation.rotation),
                                                   coarser ? mesh_error_columns(errors, limits_of(parameters.goal)) : Columns<int>()));
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

  extern const Study stability_study{"stability",
                                     run_stability_study,
                                     {"Output/Write matrices", "Output/Component mode shapes", "Output/Real mode shapes"}};
} // namespace Squeal
