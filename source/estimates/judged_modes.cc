// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/estimates/judged_modes.h>
#include <squeal/estimates/residual_iteration.h>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    /// Verdicts for given relative errors of λ. Without damping, a mode can grow only if there is a second mode within the errors.
    std::vector<Verdict> verdicts_of(const ComplexModes &modes, const std::vector<double> &errors, const bool has_damping)
    {
      const auto          &lambda = modes.lambda;
      const auto           error  = [&](const std::size_t j) { return errors[j] * std::abs(lambda[j]); };
      std::vector<Verdict> result;
      for (std::size_t i = 0; i < lambda.size(); ++i)
        {
          bool alone = true;
          for (std::size_t j = 0; j < lambda.size(); ++j)
            alone = alone && (j == i || std::abs(lambda[i] - lambda[j]) > error_safety * (error(i) + error(j)));
          result.push_back(verdict_of(lambda[i], error(i), alone && !has_damping));
        }
      return result;
    }
  } // namespace

  bool is_slow(const CoupledSystem &system, const std::complex<double> &lambda)
  {
    return std::norm(lambda) <= slow_square * system.hidden_square;
  }

  double largest_error(const CoupledSystem &system, const ComplexModes &modes, const Conditioning &conditioning)
  {
    double result = 0.;
    for (std::size_t j = 0; j < modes.lambda.size(); ++j)
      if (!is_slow(system, modes.lambda[j]))
        result = std::max(result, conditioning.errors[j]);
    return result;
  }

  std::size_t JudgedModes::n_unstable() const
  {
    return n_of(Verdict::unstable);
  }

  std::size_t JudgedModes::n_of(const Verdict verdict) const
  {
    return std::count(verdicts.begin(), verdicts.end(), verdict);
  }

  std::size_t JudgedModes::n_growing_real() const
  {
    return std::count_if(modes.real_values.begin(), modes.real_values.end(), [](const double lambda) { return lambda > 0.; });
  }

  std::vector<double> uncertainties(const CoupledSystem &system, const ComplexModes &modes, const Conditioning &conditioning)
  {
    const double        largest = largest_error(system, modes, conditioning);
    std::vector<double> result  = conditioning.errors;
    for (std::size_t j = 0; j < result.size(); ++j)
      if (!is_slow(system, modes.lambda[j]))
        result[j] = largest;
    return result;
  }

  JudgedModes judged_by_errors(ComplexModes modes, Conditioning conditioning, const bool has_damping)
  {
    JudgedModes result;
    result.modes        = std::move(modes);
    result.conditioning = std::move(conditioning);
    result.verdicts     = verdicts_of(result.modes, result.conditioning.errors, has_damping);
    for (const Verdict one : result.verdicts)
      result.unstable.push_back(one == Verdict::unstable);
    return result;
  }

  JudgedModes judged_modes(const CoupledSystem &system, const SystemModes &frictionless, ComplexModes modes)
  {
    JudgedModes result;
    result.modes = std::move(modes);
    result.conditioning =
      estimate_conditioning(system, *frictionless.inverse, frictionless.shift, result.modes, modal_products(system, result.modes));
    // Friction and damping do not change rigid-body modes, K φ = 0: the other pairs of λ that count as zero are slow modes
    result.n_slow             = std::max(0, result.modes.n_rigid_body - frictionless.real.n_rigid_body);
    result.modes.n_rigid_body = frictionless.real.n_rigid_body;
    result.verdicts           = verdicts_of(result.modes, uncertainties(system, result.modes, result.conditioning), system.has_damping());
    for (const Verdict one : result.verdicts)
      result.unstable.push_back(one == Verdict::unstable);
    return result;
  }

  JudgedModes modes_with_friction(const CoupledSystem    &system,
                                  const SystemModes      &frictionless,
                                  const double            mu,
                                  const Band             &band,
                                  const SolverParameters &solvers,
                                  Progress               &progress)
  {
    const SymmetricModes &real = frictionless.real;
    ComplexModes          modes;
    if (solvers.complex_solver == ComplexSolver::krylov)
      modes = krylov_modes(system, *frictionless.inverse, frictionless.shift, mu, band, real.eigenvalues.size(), solvers, progress,
                           real.vectors.get());
    else
      {
        ResidualIterationOptions iteration;
        iteration.band          = band;
        iteration.tolerance     = solvers.iteration_tolerance;
        iteration.maximum_basis = solvers.maximum_basis;
        modes                   = residual_iteration(system, *frictionless.inverse, *real.vectors, mu, iteration, progress);
      }
    if (modes.lambda.empty())
      throw SolverError("no oscillating mode lies in the band", "complex modes", "raise Band/Maximum frequency");
    return judged_modes(system, frictionless, std::move(modes));
  }
} // namespace Squeal
