// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/modes/system_modes.h>

#include <algorithm>

namespace Squeal
{
  std::size_t n_in_band(const std::vector<double> &eigenvalues, const double largest_eigenvalue)
  {
    return std::upper_bound(eigenvalues.begin(), eigenvalues.end(), largest_eigenvalue) - eigenvalues.begin();
  }

  SymmetricModesOptions real_modes_options(const SolverParameters &solvers, const std::string &what, const double shift)
  {
    SymmetricModesOptions options;
    options.solver    = solvers.real_solver;
    options.tolerance = solvers.real_tolerance;
    options.library   = solvers.library;
    options.what      = what;
    options.shift     = shift * shift;
    return options;
  }

  ModeCount number_of_modes(const CoupledSystem    &system,
                            const double            largest_circular_frequency,
                            const SolverParameters &solvers,
                            Progress               &progress)
  {
    progress.begin("Mode count");
    const ModeCount    count     = count_below(*system.stiffness, *system.mass, largest_circular_frequency * largest_circular_frequency,
                                               "real modes of the coupled system");
    const unsigned int allowed   = solvers.maximum_modes;
    const double       frequency = hertz(largest_circular_frequency);
    if (count.n_modes > static_cast<int>(allowed))
      throw ParameterError(
        text(counted(count.n_modes, "mode lies", "modes lie"), " below ", frequency, " Hz, more than the maximum of ", allowed),
        "parameter Real modes/Maximum number of modes",
        "lower Band/Maximum frequency, or raise Real modes/Maximum number of modes; the computing time increases with "
        "up to the cube of the number of modes");
    progress.finish(text(count.n_modes, " below ", frequency, " Hz by inertia"));
    return count;
  }

  SystemModes system_modes(const CoupledSystem    &system,
                           const double            shift,
                           const double            largest_circular_frequency,
                           const ModeCount        &count,
                           const int               block_size,
                           const SolverParameters &solvers,
                           Progress               &progress)
  {
    SystemModes result;
    result.shift = shift;
    progress.begin("Factorisation");
    const AttachmentModes attachment = !may_keep_attachment_modes(system)                          ? AttachmentModes::not_kept :
                                       solvers.complex_solver == ComplexSolver::residual_iteration ? AttachmentModes::when_needed :
                                                                                                     AttachmentModes::at_once;
    result.inverse                   = std::make_shared<UpdatedInverse>(system, shift, solvers.library, attachment);
    const double n_entries           = result.inverse->frictionless().n_factor_entries();
    result.factorisation =
      progress.finish(text(n_entries / 1e6, " million entries", shift > 0. ? ", shifted because a body is free or softly mounted" : ""));

    progress.begin("Real modes");
    SymmetricModesOptions options = real_modes_options(solvers, "real modes of the coupled system", shift);
    options.count                 = count;
    options.block_size            = block_size;
    // Use the same factor, unless it includes damping because of the shift
    if (shift == 0. || !system.has_damping())
      options.inverse = result.inverse.get();
    result.real              = symmetric_modes(*system.stiffness, *system.mass, count.limit, options);
    const std::size_t n_real = n_in_band(result.real.eigenvalues, largest_circular_frequency * largest_circular_frequency);
    if (n_real == 0)
      throw SolverError("no mode of the coupled system lies in the band", "real modes", "raise Band/Maximum frequency");
    result.solution = progress.finish(text(result.real.eigenvalues.size(), " found, ", result.real.n_counted, " counted by inertia",
                                           n_real < result.real.eigenvalues.size() ? text(", ", n_real, " in the band") : "",
                                           result.real.n_rigid_body > 0 ? text(", ", result.real.n_rigid_body, " of a rigid body") : ""));
    return result;
  }

  ContourOptions contour_of_band(const CoupledSystem    &system,
                                 const SystemModes      &frictionless,
                                 const Band             &band,
                                 const SolverParameters &solvers)
  {
    ContourOptions options     = contour_of_band(band);
    options.method             = contour_method(system);
    options.real_modes         = real_modes_options(solvers, "real modes beyond the band", frictionless.shift);
    options.real_modes.inverse = &frictionless.inverse->frictionless(); // inverse of the undamped system
    return options;
  }
} // namespace Squeal
