#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/stability/krylov_modes.h>
#include <squeal/stability/residual_iteration.h>
#include <squeal/studies/friction_modes.h>

#include <algorithm>

namespace Squeal
{
  namespace
  {
    /// Divergence rates below this are rounding errors of a neutral mode of the Krylov solver [-].
    constexpr double negligible_divergence = 1e-8;

    /// Divergence rates that the least structural damping outweighs [-].
    constexpr double weak_divergence = 1e-4;

    /// The largest of the estimated errors of λ may be that much too small.
    constexpr double estimate_safety = 3.;

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
  } // namespace

  std::size_t FrictionModes::n_unstable() const
  {
    return std::count(unstable.begin(), unstable.end(), true);
  }

  FrictionModes friction_modes(const Scene             &scene,
                               const Linearisation     &linearisation,
                               const FrictionlessModes &frictionless,
                               const double             mu,
                               Run                     &run,
                               const std::string       &step)
  {
    const Parameters     &parameters = run.parameters;
    const CoupledSystem  &coupled    = linearisation.coupled;
    const SymmetricModes &real       = frictionless.real;
    const double          omega_max  = circular_frequency(parameters.discretization.maximum_frequency);

    run.progress.begin(step);
    FrictionModes result;
    ComplexModes &modes = result.modes;
    if (parameters.solvers.complex_solver == ComplexSolver::krylov)
      modes = krylov_modes(coupled, *frictionless.inverse, frictionless.shift, mu, omega_max, real.eigenvalues.size(), parameters.solvers,
                           run.progress);
    else
      {
        ResidualIterationOptions iteration;
        iteration.largest_frequency = omega_max;
        iteration.tolerance         = parameters.solvers.iteration_tolerance;
        iteration.maximum_basis     = parameters.solvers.maximum_basis;
        modes                       = residual_iteration(coupled, *frictionless.inverse, *real.vectors, mu, iteration, run.progress);
      }
    if (modes.lambda.empty())
      throw SolverError("no oscillating mode lies in the band", "complex modes", "raise Band/Maximum frequency");
    // Neither friction nor damping moves K φ = 0; with damping, λ = 0 need not be a double eigenvalue.
    modes.n_rigid_body = real.n_rigid_body;

    result.unstable   = unstable_modes(modes);
    result.identities = identify_coupled(scene, linearisation, frictionless, *modes.real_part, modes.imaginary_part.get());
    result.labels     = labels_of(result.identities);
    run.progress.finish(text(modes.lambda.size(), " found, ", result.n_unstable(), " unstable at mu = ", mu,
                             modes.n_rigid_body > 0 ? text(", ", modes.n_rigid_body, " of a rigid body") : "", "; ", modes.summary));
    return result;
  }

  std::string verdict(const FrictionModes &friction, const double mu, const double maximum_frequency)
  {
    const auto &lambda = friction.modes.lambda;
    std::size_t n_weak = 0, leading = 0;
    bool        found = false;
    for (std::size_t j = 0; j < lambda.size(); ++j)
      if (friction.unstable[j])
        {
          const double rate = modal_quantities(lambda[j]).divergence_rate;
          if (!found || rate > modal_quantities(lambda[leading]).divergence_rate)
            leading = j;
          found = true;
          n_weak += rate < weak_divergence;
        }
    if (!found)
      return text("  stable: no unstable mode below ", maximum_frequency, " Hz at mu = ", mu);
    const ModalQuantities mode = modal_quantities(lambda[leading]);
    return text("  squeal: ", friction.n_unstable(), friction.n_unstable() == 1 ? " unstable mode" : " unstable modes", " at mu = ", mu,
                ", led by ", friction.labels[leading], " at ", mode.frequency, " Hz with a divergence rate of ", 100. * mode.divergence_rate,
                " %", n_weak > 0 ? text("; ", n_weak, " below ", 100. * weak_divergence, " %") : "");
  }
} // namespace Squeal
