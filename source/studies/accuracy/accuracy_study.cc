// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/estimates/mode_pairing.h>
#include <squeal/parameters/geometry.h>
#include <squeal/studies/accuracy/accuracy.h>
#include <squeal/studies/steps/parameter_usage.h>
#include <squeal/studies/steps/reduction_sets.h>

#include <ostream>

namespace Squeal
{
  namespace
  {
    constexpr double percent = 100.;

    /// Columns of the error contributions, in per cent.
    template <typename Row>
    Columns<Row> kinds(const std::string &what, const std::string &unit, const std::function<std::optional<ErrorKinds>(const Row &)> &get)
    {
      Columns<Row> columns;
      for (const auto &[name, kind] :
           {std::make_pair("", &ErrorKinds::total), std::make_pair("discretisation ", &ErrorKinds::discretisation),
            std::make_pair("reduction ", &ErrorKinds::reduction), std::make_pair("algebraic ", &ErrorKinds::algebraic)})
        columns.push_back({name + what, unit,
                           [get, kind = kind](const Row &row) -> Entry {
                             const std::optional<ErrorKinds> error = get(row);
                             return error ? Entry(percent * (*error).*kind) : Entry();
                           },
                           2, true});
      return columns;
    }

    template <typename Row>
    Columns<Row> operator+(Columns<Row> a, const Columns<Row> &b)
    {
      a.insert(a.end(), b.begin(), b.end());
      return a;
    }

    template <typename Row>
    Columns<Row> mesh_columns(const std::function<const MeshAndElement &(const Row &)> &of)
    {
      return {
        {"element", "", [of](const Row &row) { return of(row).element; }},
        {"outlines", "",
         [of](const Row &row) { return of(row).element == Element::quadratic ? std::string("curved") : to_string(of(row).outlines); }},
        {"mesh factor", "-", [of](const Row &row) { return of(row).factor; }, 2}};
    }

    template <typename Row>
    Columns<Row> identity(const std::function<const ComparedMethod &(const Row &)> &of)
    {
      return mesh_columns<Row>([of](const Row &row) -> const MeshAndElement & { return of(row).mesh->mesh; }) +
             Columns<Row>{{"method", "", [of](const Row &row) { return of(row).method->method; }}};
    }

    const ComparedMethod &itself(const ComparedMethod &method)
    {
      return method;
    }

    struct ModeRow
    {
      const ComparedMethod *method;
      const ModeErrors     *mode;
    };

    /// A value of the counterpart of a mode; empty if there is none.
    template <typename Function>
    auto if_found(const Function &value)
    {
      return [value](const ModeRow &row) { return row.mode->number >= 0 ? Entry(value(*row.mode)) : Entry(); };
    }

    std::string counterpart(const ModeRow &row)
    {
      return row.mode->number < 0 ? "none" : row.mode->in_cluster ? "in a cluster" : "by shape";
    }

    /// One row for each mesh, element and method.
    Table accuracy_table(const std::vector<ComparedMethod> &methods)
    {
      using Row                 = ComparedMethod;
      const Columns<Row> sizes  = {{"dofs", "-", [](const Row &row) { return row.mesh->n_dofs; }},
                                   {"contact nodes", "-", [](const Row &row) { return row.mesh->n_contact_nodes; }},
                                   {"unknowns", "-", [](const Row &row) { return row.method->size; }},
                                   {"wall time", "s", [](const Row &row) { return row.method->cost.seconds; }, 2},
                                   {"CPU time", "s", [](const Row &row) { return row.method->cost.cpu_seconds; }, 2},
                                   {"memory", "GB", [](const Row &row) { return row.method->cost.peak_memory / 1e9; }, 2},
                                   {"Pareto front", "", [](const Row &row) { return row.on_front ? "yes" : "no"; }},
                                   {"rms frequency error", "%", [](const Row &row) { return percent * row.rms_frequency; }, 2, true}};
      const Columns<Row> counts = {{"modes", "-", [](const Row &row) { return row.modes.size(); }},
                                   {"modes in clusters", "-", &Row::n_in_cluster},
                                   {"modes without counterpart", "-", &Row::n_lost}};
      return Table(identity<Row>(itself) + sizes +
                     kinds<Row>("frequency error", "%", [](const Row &row) { return row.largest_frequency; }) +
                     kinds<Row>("divergence error", "percentage points", [](const Row &row) { return row.largest_divergence; }) + counts,
                   methods);
    }

    /// The Pareto-optimal methods, the fastest first.
    Table pareto_table(const std::vector<ComparedMethod> &methods)
    {
      using Row = ComparedMethod;
      std::vector<Row> front;
      std::copy_if(methods.begin(), methods.end(), std::back_inserter(front), [](const Row &row) { return row.on_front; });
      std::sort(front.begin(), front.end(),
                [](const Row &a, const Row &b) { return a.method->cost.cpu_seconds < b.method->cost.cpu_seconds; });
      return Table(
        identity<Row>(itself) +
          Columns<Row>{{"dofs", "-", [](const Row &row) { return row.mesh->n_dofs; }},
                       {"CPU time", "s", [](const Row &row) { return row.method->cost.cpu_seconds; }, 1},
                       {"memory", "GB", [](const Row &row) { return row.method->cost.peak_memory / 1e9; }, 2},
                       {"frequency error", "%", [](const Row &row) { return percent * row.largest_frequency.total; }, 3},
                       {"divergence error", "percentage points", [](const Row &row) { return percent * row.largest_divergence.total; }, 4}},
        front);
    }

    /// One row for each mode, mesh and method, with the reference.
    Table accuracy_mode_table(const std::vector<ComparedMethod> &methods)
    {
      std::vector<ModeRow> rows;
      for (const ComparedMethod &method : methods)
        for (const ModeErrors &mode : method.modes)
          rows.push_back({&method, &mode});
      using Row        = ModeRow;
      const auto found = [](ErrorKinds ModeErrors::*error) {
        return [error](const Row &row) { return row.mode->number >= 0 ? std::make_optional(row.mode->*error) : std::nullopt; };
      };
      const Columns<Row> values = {
        {"label", "", [](const Row &row) { return to_string(row.mode->reference->label); }},
        {"counterpart", "", counterpart},
        {"overlap", "-", if_found([](const ModeErrors &mode) { return mode.overlap; }), 4},
        {"extrapolated frequency", "Hz", [](const Row &row) { return row.mode->reference->frequency.value; }, 2},
        {"frequency", "Hz", if_found([](const ModeErrors &mode) { return mode.frequency; }), 2},
        {"extrapolated divergence rate", "%", [](const Row &row) { return percent * row.mode->reference->divergence.value; }, 4},
        {"divergence rate", "%", if_found([](const ModeErrors &mode) { return percent * mode.divergence; }), 4}};
      return Table(identity<Row>([](const Row &row) -> const ComparedMethod & { return *row.method; }) + values +
                     kinds<Row>("frequency error", "%", found(&ModeErrors::frequency_error)) +
                     kinds<Row>("divergence error", "percentage points", found(&ModeErrors::divergence_error)),
                   rows);
    }

    // --------------------------------------------------------------------- orders

    /// Orders of convergence and limits of every mode up to a frequency [Hz], for every family of meshes, compared with the reference.
    Table accuracy_order_table(const std::vector<ConvergedFamily> &families,
                               const ConvergedFamily              &reference,
                               const double                        maximum_frequency)
    {
      struct Row
      {
        const ConvergedFamily *family;
        const ConvergedMode   *mode;
        const ConvergedMode   *counterpart; ///< counterpart in the reference; null if there is none
      };
      std::vector<Row> rows;
      for (const ConvergedFamily &family : families)
        {
          const ModePairing pairing = pair_modes(family.members.back()->modes, reference.members.back()->modes);
          for (std::size_t j = 0; j < family.modes.size(); ++j)
            if (family.modes[j].frequency.value <= maximum_frequency)
              {
                const int partner = pairing.coarse[j].partner;
                rows.push_back({&family, &family.modes[j], partner >= 0 ? &reference.modes[partner] : nullptr});
              }
        }
      // Observed order of convergence, which requires three meshes; empty if there is none
      const auto order = [](const std::optional<Extrapolation> &sequence) {
        return sequence && !sequence->observed_orders.empty() ? Entry(sequence->observed_orders.back()) : Entry();
      };
      return Table(Columns<Row>{{"family", "", [](const Row &row) { return row.family->name; }},
                                {"reference", "", [&](const Row &row) { return row.family == &reference ? "yes" : "no"; }},
                                {"label", "", [](const Row &row) { return to_string(row.mode->label); }},
                                {"meshes", "-", [](const Row &row) { return row.family->members.size(); }},
                                {"cluster", "", [](const Row &row) { return row.mode->in_cluster ? "yes" : "no"; }},
                                {"order of frequency", "-", [&](const Row &row) { return order(row.mode->frequency.sequence); }, 2},
                                {"frequency", "Hz", [](const Row &row) { return row.mode->frequency.value; }, 3},
                                {"uncertainty of frequency", "Hz", [](const Row &row) { return row.mode->frequency.uncertainty; }, 3},
                                {"frequency relative to reference", "%",
                                 [](const Row &row) {
                                   return row.counterpart ?
                                            Entry(percent * (row.mode->frequency.value / row.counterpart->frequency.value - 1.)) :
                                            Entry();
                                 },
                                 3},
                                {"order of divergence rate", "-", [&](const Row &row) { return order(row.mode->divergence.sequence); }, 2},
                                {"divergence rate", "%", [](const Row &row) { return percent * row.mode->divergence.value; }, 4},
                                {"uncertainty of divergence rate", "percentage points",
                                 [](const Row &row) { return percent * row.mode->divergence.uncertainty; }, 4},
                                {"divergence rate relative to reference", "percentage points",
                                 [](const Row &row) {
                                   return row.counterpart ?
                                            Entry(percent * (row.mode->divergence.value - row.counterpart->divergence.value)) :
                                            Entry();
                                 },
                                 4}},
                   rows);
    }

    Table left_out_table(const std::vector<LeftOut> &meshes)
    {
      return Table(mesh_columns<LeftOut>([](const LeftOut &row) -> const MeshAndElement & { return row.mesh; }) +
                     Columns<LeftOut>{{"reason", "", &LeftOut::reason}},
                   meshes);
    }

    /// Describes the reference and its reliability.
    void report(const ConvergedFamily &reference, const double maximum_frequency, Run &run)
    {
      int n = 0, n_orders = 0, n_in_cluster = 0;
      for (const ConvergedMode &mode : reference.modes)
        if (mode.frequency.value <= maximum_frequency)
          {
            ++n;
            n_in_cluster += mode.in_cluster;
            const auto &sequence = mode.frequency.sequence;
            n_orders += sequence && !sequence->observed_orders.empty() && sequence->observed_orders.back();
          }
      run.count("modes of the reference", n);
      run.count("modes of the reference with an observed order", n_orders);
      run.measure("error of the finest mesh of the reference, rms [-]", reference.error);
      run.screen << '\n';
      run.progress.note(text("  reference: ", reference.name, ", extrapolated from ", reference.members.size(), " meshes with up to ",
                             reference.members.back()->n_dofs, " dofs; error of its finest mesh about ",
                             decimal_text(100. * reference.error), " % (rms)"));
      run.progress.note(text("  ", counted(n, "mode"), ": ", n_orders, " with an observed order of convergence of the frequency, ",
                             n_in_cluster, " in clusters whose modes mix differently on each mesh"));
    }
    Reason no_grown_basis(const Parameters &p)
    {
      const auto &bases = p.accuracy.bases;
      return unless(std::any_of(bases.begin(), bases.end(),
                                [](const std::string &name) {
                                  const BasisRecipe *recipe = find_recipe(name);
                                  return recipe != nullptr && recipe->rests_on(BasisSource::residuals);
                                }),
                    "only for residual-grown bases");
    }
  } // namespace

  /// `Study = accuracy`: solves the model on several meshes, with the requested elements, at full order and with reduced bases. Reports
  /// costs and, relative to the extrapolated modes of the best family, the errors of the modes and their contributions.
  static void run_accuracy_study(Scene &, Run &run)
  {
    const double       maximum_frequency = run.parameters.discretization.maximum_frequency;
    const SolvedMeshes solutions         = solve_meshes(run);

    const std::vector<ConvergedFamily> families  = converged_families(solutions.meshes, maximum_frequency);
    const ConvergedFamily             &reference = best_family(families);
    const std::vector<ComparedMethod>  methods   = compare(solutions.meshes, reference, maximum_frequency);

    // ----------------------------------------------------------------- results
    run.store_table("accuracy", accuracy_table(methods));
    run.store_table("accuracy_modes", accuracy_mode_table(methods));
    run.store_table("accuracy_orders", accuracy_order_table(families, reference, maximum_frequency));
    if (!solutions.left_out.empty())
      run.store_table("accuracy_left_out", left_out_table(solutions.left_out));
    report(reference, maximum_frequency, run);
    run.screen << "\n  Pareto front of CPU time and largest frequency error\n\n";
    pareto_table(methods).print(run.screen);
    run.screen << '\n';
    run.finish();
  }

  extern const Study accuracy_study = [] {
    Study study{"accuracy", run_accuracy_study, {"Accuracy study/"}};
    study.rules = {{"Output/", [](const Parameters &) { return "not written by Study = accuracy"; }},
                   {"Discretization/Element", [](const Parameters &) { return "the study compares elements"; }},
                   {"Geometry/Outlines", [](const Parameters &) { return "the study compares outlines"; }},
                   {"Accuracy study/Grown tolerance", no_grown_basis},
                   {"Complex modes/Maximum basis",
                    [](const Parameters &p) { return p.solves_by(ComplexSolver::residual_iteration) ? nullptr : no_grown_basis(p); }}};
    study.check = [](const Parameters &p) {
      for (const double factor : p.accuracy.factors)
        refined(p.geometry, factor);
      Parameters reduced      = p;
      reduced.reduction.bases = p.accuracy.bases;
      reduction_plan(reduced);
    };
    return study;
  }();
} // namespace Squeal
