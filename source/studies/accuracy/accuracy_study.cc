#include <squeal/parameters/mesh_family.h>
#include <squeal/studies/accuracy/accuracy.h>
#include <squeal/studies/steps/parameter_usage.h>
#include <squeal/studies/steps/reduction_sets.h>

#include <algorithm>
#include <ostream>

namespace Squeal
{
  namespace
  {
    /// What the reference is, and how far it is to be believed.
    void report(const ConvergedFamily &reference, const double maximum_frequency, Run &run)
    {
      int n = 0, n_orders = 0, n_in_cluster = 0;
      for (const ConvergedMode &mode : reference.modes)
        if (mode.frequency <= maximum_frequency)
          {
            ++n;
            n_in_cluster += mode.in_cluster;
            n_orders += mode.frequencies && !mode.frequencies->observed_orders.empty() && mode.frequencies->observed_orders.back();
          }
      run.count("modes of the reference", n);
      run.count("modes of the reference with an observed order", n_orders);
      run.measure("error of the finest mesh of the reference, rms [-]", reference.error);
      run.screen << '\n';
      run.progress.note(text("  reference: ", reference.name, ", extrapolated from ", reference.members.size(), " meshes up to ",
                             reference.members.back()->n_dofs, " dofs; its finest mesh is off by some ",
                             decimal_text(100. * reference.error), " % (rms)"));
      run.progress.note(text("  ", n, " modes; the frequencies of ", n_orders, " converge with an observed order, ", n_in_cluster,
                             " are in clusters whose members the mesh decides"));
    }
    Reason no_grown_basis(const Parameters &p)
    {
      const auto &bases = p.accuracy.bases;
      return unless(std::any_of(bases.begin(), bases.end(),
                                [](const std::string &name) {
                                  const BasisRecipe *recipe = find_recipe(name);
                                  return recipe != nullptr && recipe->rests_on(BasisSource::residuals);
                                }),
                    "no residual-grown basis is measured");
    }
  } // namespace

  /**
   * `Study = accuracy`: the scene on coarser and finer meshes, with every element, at full order and with reduced bases; errors of
   * every mode against the extrapolated modes of the family that converges best, split by their kinds, beside what each takes.
   */
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
    run.screen << "\n  Pareto front: what nothing beats in both time and largest frequency error\n\n";
    pareto_table(methods).print(run.screen);
    run.screen << '\n';
    run.finish();
  }

  extern const Study accuracy_study = [] {
    Study study{"accuracy", run_accuracy_study, {"Accuracy study/"}};
    study.rules = {{"Output/", [](const Parameters &) { return "the study writes no mode shapes"; }},
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
