#include <squeal/assembly/elasticity.h>
#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/bases/component_modes.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/geometry/generate_mesh.h>
#include <squeal/geometry/mesh_check.h>
#include <squeal/geometry/mesh_file.h>
#include <squeal/linear_algebra/blas_threads.h>
#include <squeal/linear_algebra/replicate.h>
#include <squeal/linear_algebra/sparse.h>
#include <squeal/output/mode_fields.h>
#include <squeal/output/run_record.h>
#include <squeal/output/table.h>
#include <squeal/stability/krylov_modes.h>
#include <squeal/stability/residual_iteration.h>
#include <squeal/studies/paper_table.h>
#include <squeal/studies/stability_study.h>

#include <Epetra_Vector.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>
#include <sstream>

namespace Squeal
{
  namespace
  {
    /// Component modes are found somewhat beyond the band: they label the coupled modes at its end.
    constexpr double label_band = 1.2;

    /// Divergence rates below this are rounding errors of a neutral mode of the Krylov solver [-].
    constexpr double negligible_divergence = 1e-8;

    /// Divergence rates that the least structural damping outweighs [-].
    constexpr double weak_divergence = 1e-4;

    /// The largest of the estimated errors of λ may be that much too small.
    constexpr double estimate_safety = 3.;

    template <typename... Parts>
    std::string text(const Parts &...parts)
    {
      std::ostringstream stream;
      stream << std::setprecision(4);
      (stream << ... << parts);
      return stream.str();
    }

    // ------------------------------------------------------------------ tables

    std::vector<std::string> with_doublets(std::vector<std::string> labels)
    {
      mark_doublets(labels);
      return labels;
    }

    /// Component modes inside the band.
    std::size_t n_in_band(const ComponentModes &modes, const double largest_eigenvalue)
    {
      return std::upper_bound(modes.eigenvalues.begin(), modes.eigenvalues.end(), largest_eigenvalue) - modes.eigenvalues.begin();
    }

    struct ComponentSet
    {
      const char           *component, *boundary;
      const ComponentModes *modes;
    };

    Table component_table(const std::vector<ComponentSet> &sets, const double largest_eigenvalue)
    {
      Table table({{"component", ""}, {"contact", ""}, {"label", ""}, {"frequency", "Hz", 2}, {"residual", "-", 1, true}});
      for (const ComponentSet &set : sets)
        {
          const std::size_t n = n_in_band(*set.modes, largest_eigenvalue);
          const auto        labels =
            with_doublets({set.modes->labels.begin(), set.modes->labels.begin() + static_cast<std::ptrdiff_t>(n)});
          for (std::size_t j = 0; j < n; ++j)
            table.add_row({std::string(set.component), std::string(set.boundary), labels[j],
                           hertz(std::sqrt(set.modes->eigenvalues[j])), set.modes->residuals[j]});
        }
      return table;
    }

    Table real_table(const SymmetricModes &modes, const std::vector<std::string> &labels, const std::vector<ModeIdentity> &identities)
    {
      Table table({{"label", ""}, {"share", "-", 3}, {"frequency", "Hz", 3}, {"residual", "-", 1, true}});
      for (std::size_t j = 0; j < labels.size(); ++j)
        table.add_row({labels[j], identities[j].share, hertz(std::sqrt(modes.eigenvalues[j])), modes.residuals[j]});
      return table;
    }

    Table complex_table(const ComplexModes &modes, const std::vector<std::string> &labels, const std::vector<ModeIdentity> &identities)
    {
      std::vector<Column> columns = {{"label", ""},
                                     {"share", "-", 3},
                                     {"frequency", "Hz", 3},
                                     {"growth rate", "1/s", 4},
                                     {"divergence rate", "%", 4},
                                     {"damping ratio", "%", 4},
                                     {"residual", "-", 1, true},
                                     {"eps_res", "-", 1, true}};
      const bool has_estimates = !modes.estimated_errors.empty();
      if (has_estimates)
        columns.push_back({"estimated error of lambda", "-", 1, true});
      Table table(columns);
      for (std::size_t j = 0; j < labels.size(); ++j)
        {
          const ModalQuantities   mode = modal_quantities(modes.lambda[j]);
          std::vector<Cell> cells = {labels[j],
                                     identities[j].share,
                                     mode.frequency,
                                     mode.growth_rate,
                                     100. * mode.divergence_rate,
                                     100. * mode.damping_ratio,
                                     modes.residuals[j],
                                     modes.energy_residuals[j]};
          if (has_estimates)
            cells.emplace_back(modes.estimated_errors[j]);
          table.add_row(std::move(cells));
        }
      return table;
    }

    std::vector<std::string> labels_of(const std::vector<ModeIdentity> &identities, const int n_rigid_body = 0)
    {
      std::vector<std::string> labels;
      for (const ModeIdentity &identity : identities)
        labels.push_back(identity.label);
      std::fill(labels.begin(), labels.begin() + n_rigid_body, "RB");
      return with_doublets(labels);
    }

    /**
     * Which modes grow beyond what their accuracy leaves open. The largest of
     * the estimated errors counts for all: that of a single mode can be much too
     * small by chance.
     */
    std::vector<bool> unstable_modes(const ComplexModes &modes)
    {
      double uncertainty = negligible_divergence;
      for (const double error : modes.estimated_errors)
        uncertainty = std::max(uncertainty, estimate_safety * error);
      std::vector<bool> result;
      for (const auto &lambda : modes.lambda)
        result.push_back(modal_quantities(lambda).divergence_rate > uncertainty);
      return result;
    }

    // ----------------------------------------------------------------- verdict

    std::string verdict(const ComplexModes             &modes,
                        const std::vector<bool>        &unstable,
                        const std::vector<std::string> &labels,
                        const Parameters               &parameters)
    {
      const double mu = parameters.operation.friction_coefficient;
      std::size_t  n_unstable = 0, n_weak = 0, leading = 0;
      for (std::size_t j = 0; j < labels.size(); ++j)
        if (unstable[j])
          {
            const double rate = modal_quantities(modes.lambda[j]).divergence_rate;
            if (n_unstable++ == 0 || rate > modal_quantities(modes.lambda[leading]).divergence_rate)
              leading = j;
            n_weak += rate < weak_divergence;
          }
      if (n_unstable == 0)
        return text("  stable: no unstable mode below ", parameters.discretization.maximum_frequency, " Hz at mu = ", mu);
      const ModalQuantities mode = modal_quantities(modes.lambda[leading]);
      return text("  squeal: ", n_unstable, n_unstable == 1 ? " unstable mode" : " unstable modes", " at mu = ", mu, ", led by ",
                  labels[leading], " at ", mode.frequency, " Hz with a divergence rate of ", 100. * mode.divergence_rate, " %",
                  n_weak > 0 ? text("; ", n_weak, " below ", 100. * weak_divergence, " %") : "");
    }

    // ------------------------------------------------------------------ fields

    /// File name of a mode: its place in the table and its label without blanks and signs.
    std::string file_name(const std::size_t number, std::string label)
    {
      for (const auto &[sign, word] : {std::make_pair(" -", "_minus"), std::make_pair(" +", "_plus")})
        if (const auto place = label.find(sign); place != std::string::npos)
          label.replace(place, 2, word);
      std::ostringstream name;
      name << "complex_" << std::setw(3) << std::setfill('0') << number + 1 << "_" << label;
      return name.str();
    }

    void write_fields(const Parameters               &parameters,
                      const Model                    &model,
                      const ContactInterface         &interface,
                      const CoupledSystem            &system,
                      const ComplexModes             &modes,
                      const std::vector<std::string> &labels,
                      const std::vector<bool>        &unstable,
                      const ResultFolder             &folder,
                      Progress                       &progress)
    {
      progress.begin("Mode shapes");
      std::vector<std::size_t> chosen;
      for (std::size_t j = 0; j < labels.size(); ++j)
        if (parameters.output.fields == FieldSelection::all || unstable[j])
          chosen.push_back(j);

      const ModeFieldWriter writer(model, interface, folder);
      DenseMatrix           reaction_re, reaction_im;
      if (!labels.empty())
        normal_reactions(system, modes.lambda, *modes.real_part, *modes.imaginary_part, reaction_re, reaction_im);

      unsigned int n_animations = 0;
      for (const std::size_t j : chosen)
        {
          progress.update(text(labels[j], ", ", modal_quantities(modes.lambda[j]).frequency, " Hz"));
          const DenseMatrix re = replicate(*system.kernel * view(*modes.real_part, j, 1));
          const DenseMatrix im = replicate(*system.kernel * view(*modes.imaginary_part, j, 1));
          ModeField         field{file_name(j, labels[j]), modes.lambda[j], {}, {}};
          for (int i = 0; i < re.n_rows(); ++i)
            field.displacement.emplace_back(re(i, 0), im(i, 0));
          for (int c = 0; c < reaction_re.n_rows(); ++c)
            field.reactions.emplace_back(reaction_re(c, j), reaction_im(c, j));
          writer.write_mode(field);
          if (unstable[j] && parameters.output.animation_frames > 0)
            {
              writer.write_animation(field, parameters.output.animation_frames);
              ++n_animations;
            }
        }
      progress.finish(text(chosen.size(), " modes, ", n_animations, " animations"));
    }

    // ---------------------------------------------------------------- matrices

    void write_matrices(const Model                               &model,
                        const ContactInterface                    &interface,
                        const SecondOrderSystem                   &system,
                        const ContactOperators                    &contact,
                        const std::shared_ptr<const SparseMatrix> &damping,
                        const ResultFolder                        &folder,
                        Progress                                  &progress)
    {
      progress.begin("Matrix files");
      const auto write = [&](const SparseMatrix &matrix, const char *name, const MatrixMarketSymmetry symmetry) {
        write_matrix_market(matrix, folder.path(text("matrices/", name, ".mtx")), symmetry);
      };
      write(*system.mass, "M", MatrixMarketSymmetry::symmetric);
      write(*system.stiffness, "K", MatrixMarketSymmetry::symmetric);
      if (damping)
        write(*damping, "C_b", MatrixMarketSymmetry::symmetric);
      else
        {
          // A matrix without entries, so that readers need no special case
          SparseMatrix zero(Copy, model.free_map(), 0);
          zero.FillComplete();
          write(zero, "C_b", MatrixMarketSymmetry::symmetric);
        }
      write(*contact.normal, "P_n", MatrixMarketSymmetry::general);
      write(*contact.tangential, "P_t", MatrixMarketSymmetry::general);
      write(*contact.radial, "P_b", MatrixMarketSymmetry::general);
      write(*contact.kernel, "T_c", MatrixMarketSymmetry::general);

      // Node coordinates with the rows of their dofs in M and K
      folder.write("matrices/nodes.csv", [&](std::ostream &stream) {
        stream << "x [m],y [m],z [m],component,row x,row y,row z\n" << std::setprecision(17);
        for (const Node &node : model.nodes())
          {
            stream << node.position[0] << ',' << node.position[1] << ',' << node.position[2] << ','
                   << model.component_names()[node.component];
            for (const int dof : node.dofs)
              stream << ',' << dof + (dof >= 0);
            stream << '\n';
          }
      });
      folder.write("matrices/contact_nodes.csv", [&](std::ostream &stream) {
        stream << "x [m],y [m],z [m],pin,n_x,n_y,n_z,t_x,t_y,t_z,b_x,b_y,b_z,area [m^2]\n" << std::setprecision(17);
        for (const ContactNode &node : interface)
          {
            stream << node.position[0] << ',' << node.position[1] << ',' << node.position[2] << ',' << model.component_names()[node.pin];
            for (const auto *vector : {&node.normal, &node.sliding, &node.radial})
              for (const double component : *vector)
                stream << ',' << component;
            stream << ',' << node.area << '\n';
          }
      });
      progress.finish("M, K, C_b, P_n, P_t, P_b, T_c in Matrix Market form");
    }
  } // namespace

  void run_stability_study(const Parameters &parameters,
                           const RunOptions &options,
                           MPI_Comm          communicator,
                           Progress         &progress,
                           std::ostream     &screen)
  {
    int rank, n_processes;
    MPI_Comm_rank(communicator, &rank);
    MPI_Comm_size(communicator, &n_processes);
    RunRecord record{options.command, n_processes, set_blas_threads(parameters.solvers.blas_threads), {}, {}};
    const auto count = [&](const char *name, const long value) { record.counts.emplace_back(name, value); };

    std::unique_ptr<ResultFolder> folder;
    if (!options.dry_run)
      folder = std::make_unique<ResultFolder>(options.output, rank == 0);

    // ------------------------------------------------------------------- mesh
    progress.begin("Mesh");
    const HexMesh     mesh    = generate_mesh(parameters.geometry, parameters.materials.mounted_surfaces());
    const MeshQuality quality = check_mesh(mesh);
    count("elements", mesh.hexahedra.size());
    record.quantities.emplace_back("worst scaled Jacobian [-]", quality.worst_scaled_jacobian);
    progress.finish(text(mesh.hexahedra.size(), " hexahedra, ", mesh.volume_names.size() - 1, " pins, worst scaled Jacobian ",
                         quality.worst_scaled_jacobian));

    progress.begin("Contact");
    const Model            model(mesh, parameters.discretization.degree, communicator);
    const ContactInterface interface =
      pair_contact_nodes(model, parameters.operation.rotation, parameters.geometry.pairing_tolerance);
    const ContactOperators contact = contact_operators(model, interface);
    count("dofs, clamped included", model.n_dofs());
    count("dofs", model.free_map().NumGlobalElements());
    count("contact nodes", interface.size());
    count("coupled dofs", contact.kernel->NumGlobalCols());
    progress.finish(text(interface.size(), " contact nodes, ", model.free_map().NumGlobalElements(), " dofs, ",
                         contact.kernel->NumGlobalCols(), " coupled"));
    if (options.dry_run)
      {
        progress.note("  dry run: nothing was computed or written");
        return;
      }

    // ----------------------------------------------------------------- system
    progress.begin("Assembly");
    const SecondOrderSystem system = assemble(model, parameters.materials);
    const auto              damping =
      contact_damping(contact, radial_dissipation_of_equal_shares(interface, parameters.operation));
    const CoupledSystem coupled = couple(system, contact, damping);
    progress.finish(text(coupled.frictionless.stiffness->NumGlobalNonzeros(), " entries in K_c, radial dissipation ",
                         to_string(parameters.operation.radial_dissipation)));

    // -------------------------------------------------------- component modes
    const double          omega_max = circular_frequency(parameters.discretization.maximum_frequency);
    const double          limit     = omega_max * omega_max;
    SymmetricModesOptions real_options;
    real_options.solver    = parameters.solvers.real_solver;
    real_options.tolerance = parameters.solvers.real_tolerance;
    real_options.library   = parameters.solvers.library;
    const double shift     = stabilizing_shift(model, coupled, omega_max);

    const auto components = [&](const Component component, const ContactBoundary boundary, const char *name, const double band) {
      SymmetricModesOptions component_options = real_options;
      component_options.what                  = name;
      progress.update(name);
      component_options.shift                 = component == Component::disc ? shift * shift : 0.;
      // Pins are alike: every mode of one comes once for each of them, bending modes twice, and a block finds the members
      // of such a cluster together.
      if (component == Component::pins)
        component_options.block_size = std::max<int>(8, 2 * (mesh.volume_names.size() - 1));
      return component_modes(model, interface, system, component, boundary, band * band * limit, component_options);
    };
    progress.begin("Component modes");
    const ComponentModes disc         = components(Component::disc, ContactBoundary::free, "modes of the disc", label_band);
    const ComponentModes pins_free    = components(Component::pins, ContactBoundary::free, "modes of the free pins", 1.);
    const ComponentModes pins_sliding = components(Component::pins, ContactBoundary::sliding, "modes of the sliding pins", label_band);
    count("disc modes", n_in_band(disc, limit));
    count("free pin modes", n_in_band(pins_free, limit));
    count("sliding pin modes", n_in_band(pins_sliding, limit));
    progress.finish(text("disc ", n_in_band(disc, limit), ", pins free ", n_in_band(pins_free, limit), ", pins sliding ",
                         n_in_band(pins_sliding, limit), " below ", parameters.discretization.maximum_frequency, " Hz"));

    // ------------------------------------------------------ real coupled modes
    progress.begin("Factorisation");
    UpdatedInverse inverse(coupled, shift, parameters.solvers.library);
    record.quantities.emplace_back("entries of the Cholesky factor", inverse.frictionless().n_factor_entries());
    progress.finish(text(inverse.frictionless().n_factor_entries() / 1e6, " million entries",
                         shift > 0. ? ", shifted: the disc can move as a rigid body" : ""));

    progress.begin("Real modes");
    real_options.what         = "real modes of the coupled system";
    real_options.shift        = shift * shift;
    // The factor at hand serves here too, unless the shift brought damping into it.
    if (shift == 0. || !coupled.frictionless.damping)
      real_options.inverse = &inverse.frictionless();
    const SymmetricModes real = symmetric_modes(*coupled.frictionless.stiffness, *coupled.frictionless.mass, limit, real_options);
    if (real.eigenvalues.empty())
      throw SolverError("no mode of the coupled system lies in the band", "real modes", "raise Band/Maximum frequency");
    count("real modes", real.eigenvalues.size());
    count("rigid-body modes", real.n_rigid_body);
    progress.finish(text(real.eigenvalues.size(), " found, ", real.n_counted, " counted by inertia",
                         real.n_rigid_body > 0 ? text(", ", real.n_rigid_body, " of a rigid body") : ""));

    // ---------------------------------------------------------- complex modes
    const double mu = parameters.operation.friction_coefficient;
    progress.begin("Complex modes");
    ComplexModes modes;
    if (parameters.solvers.complex_solver == ComplexSolver::krylov)
      modes = krylov_modes(coupled, inverse, shift, mu, omega_max, real.eigenvalues.size(), parameters.solvers, progress);
    else
      {
        ResidualIterationOptions iteration;
        iteration.largest_frequency = omega_max;
        iteration.tolerance         = parameters.solvers.iteration_tolerance;
        iteration.maximum_basis     = parameters.solvers.maximum_basis;
        modes                       = residual_iteration(coupled, inverse, *real.vectors, mu, iteration, progress);
      }
    if (modes.lambda.empty())
      throw SolverError("no oscillating mode lies in the band", "complex modes", "raise Band/Maximum frequency");
    // Neither friction nor damping moves K φ = 0; with damping, λ = 0 need not be a double eigenvalue.
    modes.n_rigid_body = real.n_rigid_body;

    const std::vector<bool> unstable   = unstable_modes(modes);
    const std::size_t       n_unstable = std::count(unstable.begin(), unstable.end(), true);
    count("complex modes", modes.lambda.size());
    count("unstable modes", n_unstable);
    progress.finish(text(modes.lambda.size(), " found, ", n_unstable, " unstable at mu = ", mu,
                         modes.n_rigid_body > 0 ? text(", ", modes.n_rigid_body, " of a rigid body") : "", "; ", modes.summary));

    // ----------------------------------------------------------------- results
    const auto identify_modes = [&](const MultiVector &re, const MultiVector *im) {
      const MultiVector u_re = *coupled.kernel * re;
      const MultiVector u_im = im ? *coupled.kernel * *im : u_re;
      return identify({&disc, &pins_sliding}, *system.mass, u_re, im ? &u_im : nullptr);
    };
    const auto real_identities    = identify_modes(*real.vectors, nullptr);
    const auto complex_identities = identify_modes(*modes.real_part, modes.imaginary_part.get());
    const auto real_labels        = labels_of(real_identities, real.n_rigid_body);
    const auto complex_labels     = labels_of(complex_identities);

    TableOneResults results{{}, {}, real_labels, {}, complex_labels, modes.lambda};
    for (const ComponentModes *set : {&disc, &pins_sliding})
      {
        const auto labels = with_doublets(set->labels);
        for (std::size_t j = 0; j < labels.size(); ++j)
          {
            results.component_labels.push_back(labels[j]);
            results.component_frequencies.push_back(hertz(std::sqrt(set->eigenvalues[j])));
          }
      }
    for (const double eigenvalue : real.eigenvalues)
      results.coupled_frequencies.push_back(hertz(std::sqrt(eigenvalue)));
    Agreement agreement;

    const std::vector<std::pair<std::string, Table>> tables = {
      {"component_modes", component_table({{"disc", "free", &disc}, {"pins", "sliding", &pins_sliding}, {"pins", "free", &pins_free}}, limit)},
      {"real_modes", real_table(real, real_labels, real_identities)},
      {"complex_modes", complex_table(modes, complex_labels, complex_identities)},
      {"table1", table_one(results, parameters.operation.radial_dissipation, agreement)}};
    for (const auto &[name, table] : tables)
      {
        screen << "\n  " << name << ".csv\n\n";
        table.print(screen);
        folder->write(name + ".csv", [&table = table](std::ostream &stream) { table.write_csv(stream); });
      }
    screen << '\n';
    progress.note(text("  beside the paper's Table 1: component frequencies ", 100. * agreement.component, " % rms (", agreement.n_component,
                       "), coupled ", 100. * agreement.coupled, " % rms (", agreement.n_coupled, ")"));
    if (modes.lambda.size() + modes.n_rigid_body != real.eigenvalues.size())
      progress.note(text("  note: ", real.eigenvalues.size(), " real but ", modes.lambda.size() + modes.n_rigid_body,
                         " complex modes lie in the band: with friction a mode crossed its end"));

    if (parameters.output.fields != FieldSelection::none)
      write_fields(parameters, model, interface, coupled, modes, complex_labels, unstable, *folder, progress);
    if (parameters.output.write_matrices)
      write_matrices(model, interface, system, contact, damping, *folder, progress);

    // ------------------------------------------------------------------ record
    if (rank == 0)
      write_msh(mesh, folder->path("mesh.msh"));
    folder->write("parameters.prm", [&](std::ostream &stream) { parameters.print(stream, false); });
    folder->write(ResultFolder::run_record, [&](std::ostream &stream) { write_run_record(stream, record, progress); });
    folder->commit();

    progress.note(verdict(modes, unstable, complex_labels, parameters));
    progress.note(text("  results in ", folder->name(), ", ", std::round(10. * progress.elapsed()) / 10., " s"));
  }
} // namespace Squeal
