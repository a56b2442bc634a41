#include <squeal/base/conventions.h>
#include <squeal/base/text.h>
#include <squeal/studies/steps/mesh_estimate.h>

#include <algorithm>

namespace Squeal
{
  namespace
  {
    /// Modes that a warning names.
    constexpr std::size_t n_named = 5;

    /// "A0-4 at 2315 Hz (0.3 %, 0.05 points)".
    std::string described(const ModeLabel &label, const std::complex<double> &lambda, const DiscretisationError &error)
    {
      return text(to_string(label), " at ", decimal_text(modal_quantities(lambda).frequency), " Hz (",
                  error.has_counterpart ?
                    text(decimal_text(100. * error.frequency), " %, ", decimal_text(100. * error.divergence), " points") :
                    "no counterpart",
                  ")");
    }

    void warn_of_unconverged(const std::vector<DiscretisationError> &errors,
                             const FrictionModes                    &friction,
                             const AccuracyLimits                   &limits,
                             Run                                    &run)
    {
      std::string names;
      std::size_t n = 0;
      for (std::size_t j = 0; j < errors.size(); ++j)
        if (friction.unstable[j] && !errors[j].is_within(limits.frequency, limits.divergence) && ++n <= n_named)
          names += (names.empty() ? "" : ", ") + described(friction.labels[j], friction.modes.lambda[j], errors[j]);
      if (n > 0)
        run.warn(text(n, n == 1 ? " unstable mode is" : " unstable modes are", " not converged on this mesh to ", 100. * limits.frequency,
                      " % of the frequency and ", 100. * limits.divergence, " percentage points of the divergence rate: ", names,
                      n > n_named ? ", ..." : "", "; finer meshes tell whether they grow"));
    }
  } // namespace

  ModesAtPoints modes_at(const CommonPoints &points, const FrictionlessModes &frictionless, const FrictionModes &friction)
  {
    const Linearisation &linearisation = frictionless.linearisation;
    return at_points(*displacements_at(points, *linearisation.scene->model), *linearisation.coupled.kernel, friction.modes);
  }

  std::optional<CoarserSolution> solve_on_coarser_mesh(Run &run)
  {
    if (run.parameters.goal == AccuracyGoal::as_given)
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
    run.progress.finish(text(scene.model->free_map().n(), " dofs, ", friction.modes.lambda.size(), " complex modes, ",
                             friction.n_unstable(), " unstable, to estimate the error of the mesh"));
    return result;
  }

  std::vector<DiscretisationError> mesh_errors(const CoarserSolution   &coarser,
                                               const FrictionlessModes &frictionless,
                                               const FrictionModes     &friction,
                                               const AccuracyGoal       goal)
  {
    auto result = discretisation_errors(coarser.modes, modes_at(coarser.points, frictionless, friction), error_by_difference(goal),
                                        friction.modes.estimated_errors);
    // What the arithmetic leaves open no mesh decides
    for (std::size_t j = 0; j < result.size(); ++j)
      if (friction.verdicts[j] == Verdict::undecided)
        result[j].verdict = Verdict::undecided;
    return result;
  }

  void report_mesh_errors(const std::vector<DiscretisationError> &errors, const FrictionModes &friction, Run &run)
  {
    const AccuracyLimits limits    = limits_of(run.parameters.goal);
    double               frequency = 0., divergence = 0.;
    long                 n_converged = 0, n_lost = 0, n_in_cluster = 0;
    const auto           count = [&](const Verdict verdict) {
      return std::count_if(errors.begin(), errors.end(), [verdict](const DiscretisationError &error) { return error.verdict == verdict; });
    };
    for (const DiscretisationError &error : errors)
      {
        frequency  = std::max(frequency, error.frequency);
        divergence = std::max(divergence, error.divergence);
        n_converged += error.is_within(limits.frequency, limits.divergence);
        n_lost += !error.has_counterpart;
        n_in_cluster += error.in_cluster;
      }
    run.measure("largest estimated error of a frequency by the mesh [-]", frequency);
    run.measure("largest estimated error of a divergence rate by the mesh [-]", divergence);
    run.count("modes converged on the mesh", n_converged);
    run.count("modes without counterpart on the coarser mesh", n_lost);
    run.count("modes in clusters whose members the mesh decides", n_in_cluster);
    for (const Verdict verdict : {Verdict::unstable, Verdict::stable, Verdict::undecided})
      run.count("modes " + to_string(verdict) + " with the error of the mesh", count(verdict));
    run.progress.note(text("  accuracy: ", to_string(run.parameters.goal),
                           " asked for; estimated by a coarser mesh, frequencies are within ", decimal_text(100. * frequency),
                           " % and divergence rates within ", decimal_text(100. * divergence), " percentage points",
                           n_lost > 0 ? text(", ", n_lost, n_lost == 1 ? " mode" : " modes", " without counterpart left out") : ""));
    run.progress.note(text("  with the error of the mesh: ", count(Verdict::unstable), " modes unstable, ", count(Verdict::stable),
                           " stable, ", count(Verdict::undecided), " undecided; ", n_converged, " of ", errors.size(), " converged"));
    warn_of_unconverged(errors, friction, limits, run);
  }
} // namespace Squeal
