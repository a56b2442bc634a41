// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/studies/steps/friction_modes.h>

#include <numeric>

namespace Squeal
{
  namespace
  {
    /// Largest R/ω of a vibration [-]: modes above it grow by a factor of more than e^(2π) per period, which is divergence rather than
    /// audible vibration.
    constexpr double fastest_oscillating_divergence = 1.;

    /// Summary of the unstable modes; names the fastest growing oscillating mode.
    std::string squeal(const FrictionModes &friction)
    {
      const auto &lambda = friction.modes.lambda;
      std::size_t n_weak = 0, n_monotonic = 0, leading = lambda.size();
      double      highest = 0.;
      for (std::size_t j = 0; j < lambda.size(); ++j)
        if (friction.unstable[j])
          {
            const double rate = modal_quantities(lambda[j]).divergence_rate;
            n_weak += rate < weak_divergence;
            n_monotonic += rate > fastest_oscillating_divergence;
            if (rate > highest && rate <= fastest_oscillating_divergence)
              {
                leading = j;
                highest = rate;
              }
          }
      const std::size_t n      = friction.n_unstable();
      std::string       result = text("  squeal: ", counted(n, "unstable mode"), friction.at);
      if (leading < lambda.size())
        result += text(", led by ", to_string(friction.labels[leading]), " at ", decimal_text(modal_quantities(lambda[leading]).frequency),
                       " Hz with a divergence rate of ", decimal_text(100. * highest), " %");
      if (n_weak > 0)
        result += text("; ", n_weak, " below ", 100. * weak_divergence, " %");
      if (n_monotonic > 0)
        result += text("; ", n_monotonic, " above ", 100. * fastest_oscillating_divergence, " %, which diverge rather than oscillate");
      return result;
    }
  } // namespace

  FrictionModes named_modes(const FrictionlessModes &frictionless, JudgedModes modes)
  {
    FrictionModes result{std::move(modes), {}, {}, {}};
    result.labels = frictionless.identify(*result.modes.real_part, result.modes.imaginary_part.get());
    std::vector<double> growth; // growth rates; zero for modes that do not grow
    for (std::size_t j = 0; j < result.unstable.size(); ++j)
      growth.push_back(result.unstable[j] ? result.modes.lambda[j].real() : 0.);
    mark_doublets(result.labels, growth);
    return result;
  }

  FrictionModes friction_modes(const FrictionlessModes &frictionless, const double mu, Run &run)
  {
    const Parameters &parameters = run.parameters;
    run.progress.begin("Complex modes");
    FrictionModes result =
      named_modes(frictionless, modes_with_friction(frictionless.linearisation.coupled, frictionless, mu, parameters.discretization.band(),
                                                    parameters.solvers, run.progress));
    const ComplexModes &found = result.modes;
    if (const std::string &varied = frictionless.linearisation.coupled.varied; !varied.empty())
      result.at = text(" at ", varied, " = ", exact_text(mu));
    result.cost = run.progress.finish(
      text(found.lambda.size(), " found, ", result.n_unstable(), " unstable", result.at,
           found.n_rigid_body > 0 ? text(", rigid-body modes: ", found.n_rigid_body) : "",
           found.real_values.empty() ? "" : text(", ", counted(found.real_values.size(), "real eigenvalue")), "; ", found.summary));
    return result;
  }

  std::vector<std::string> verdict(const FrictionModes &friction, const double maximum_frequency)
  {
    std::vector<std::string> lines;
    if (const std::size_t n = friction.n_growing_real(); n > 0)
      lines.push_back(text("  static divergence: ", counted(n, "real eigenvalue"), " above zero", friction.at, ", largest growth rate ",
                           decimal_text(friction.modes.real_values.back()), " 1/s"));
    if (friction.n_unstable() > 0)
      lines.push_back(squeal(friction));
    if (const std::size_t n = friction.n_of(Verdict::undecided); n > 0)
      lines.push_back(text("  undecided: ", counted(n, "mode grows or decays", "modes grow or decay"), friction.at,
                           " by less than the estimated error of the eigenvalue"));
    if (lines.empty())
      lines.push_back(text("  stable: no unstable mode below ", exact_text(maximum_frequency), " Hz", friction.at));
    return lines;
  }

  std::string note_on_count(const FrictionModes &friction, const std::size_t n_real_modes, const double maximum_rate)
  {
    const ComplexModes &modes     = friction.modes;
    const std::size_t   n_complex = modes.lambda.size() + modes.n_rigid_body, n_values = modes.real_values.size();
    if (n_complex == n_real_modes)
      return "";
    const std::string counts =
      text("  note: ", counted(n_real_modes, "real mode"), ", but ", counted(n_complex, "complex mode"), " in the band: ");
    std::string rest;
    if (n_values > 0)
      rest = counted(n_values, "real eigenvalue replaces", "real eigenvalues replace") + " modes that no longer oscillate";
    if (friction.n_slow > 0)
      rest +=
        text(rest.empty() ? "" : ", and ", "eigenvalues with |lambda| below ", zero_frequency, " of the end of the band are not listed");
    if (2 * n_complex + n_values == 2 * n_real_modes)
      return counts + rest;
    if (maximum_rate > 0.)
      rest += text(rest.empty() ? "" : ", and ", "modes may have crossed the end of the band or decay faster than ",
                   exact_text(maximum_rate), " 1/s");
    else if (friction.n_slow == 0)
      rest += text(rest.empty() ? "" : ", and ", "modes have crossed the end of the band");
    return counts + rest;
  }

  std::string note_on_weak_damping(const CoupledSystem &system, const FrictionModes &friction)
  {
    const std::size_t n = system.has_damping() ? friction.n_of(Verdict::neutral) : 0;
    if (n == 0)
      return "";
    return text("  note: the growth rates of ", n, " of ", friction.verdicts.size(), " modes are below ", 100. * negligible_divergence,
                " % of omega, within rounding errors; these modes count as stable");
  }

  void record_conditioning(const CoupledSystem &system,
                           const ComplexModes  &modes,
                           const Conditioning  &conditioning,
                           const double         tolerance,
                           Run                 &run)
  {
    const double kappa = std::accumulate(conditioning.modes.begin(), conditioning.modes.end(), 1.,
                                         [](const double a, const double b) { return std::max(a, b); });
    run.measure("condition number of the stiffness [-]", conditioning.stiffness);
    run.measure("condition number of the mass [-]", conditioning.mass);
    run.measure("condition number of the span of the modes [-]", conditioning.span);
    run.measure("largest condition number of an eigenvalue [-]", kappa);
    run.measure("largest cancellation in the stiffness [-]", conditioning.largest_cancellation);
    run.measure("largest root of eps_res [-]", conditioning.largest_residual);
    run.measure("digits of the eigenvalues [-]", conditioning.digits());
    const auto slowest =
      std::count_if(modes.lambda.begin(), modes.lambda.end(), [&](const auto &lambda) { return is_slow(system, lambda); });
    if (conditioning.largest_error() > tolerance)
      run.warn(
        text("the eigenvalues are accurate to about ", std::floor(conditioning.digits()), " of 16 digits: growth rates below ",
             100. * largest_error(system, modes, conditioning), " % of omega cannot be distinguished from zero",
             slowest > 0 ?
               text("; for ", counted(slowest, "mode"), " below ", decimal_text(hertz(std::sqrt(slow_square * system.hidden_square))),
                    " Hz, the limit is ", 100. * conditioning.largest_error(), " %") :
               "",
             " (condition numbers: stiffness ", conditioning.stiffness, ", eigenvalues up to ", kappa, "; cancellation in the stiffness ",
             conditioning.largest_cancellation, "; energy of the residuals up to ", conditioning.largest_residual, ")"));
  }

  std::vector<std::optional<WaveShares>> waves_with_rotation(const FrictionlessModes &frictionless,
                                                             const FrictionModes     &friction,
                                                             const SlidingVelocity   &velocity)
  {
    const Scene        &scene  = *frictionless.linearisation.scene;
    const SparseMatrix &T_c    = *frictionless.linearisation.coupled.kernel;
    auto                result = wave_shares(*scene.model, nodal_masses(*scene.model, *scene.system.mass), friction.labels,
                                             T_c * *friction.modes.real_part, T_c * *friction.modes.imaginary_part);
    for (auto &shares : result)
      if (!velocity.turns_about_z())
        shares.reset();
      else if (shares && (*velocity.rigid_motion())[5] < 0.)
        std::swap(shares->positive, shares->negative);
    return result;
  }

  ModeField mode_field(const Linearisation        &linearisation,
                       const std::string          &name,
                       const std::complex<double> &lambda,
                       const MultiVector          &real_part,
                       const MultiVector          &imaginary_part)
  {
    const CoupledSystem             &system    = linearisation.coupled;
    const std::vector<unsigned int> &closed    = linearisation.closed;
    const auto                       reactions = normal_reactions(system, {lambda}, real_part, imaginary_part);
    const MultiVector                re = *system.kernel * real_part, im = *system.kernel * imaginary_part;

    ModeField field{name, lambda, {}, std::vector<std::complex<double>>(linearisation.scene->interface.size())};
    for (int i = 0; i < re.n_local_rows(); ++i)
      field.displacement.emplace_back(re(i, 0), im(i, 0));
    for (std::size_t c = 0; c < closed.size(); ++c)
      field.reactions[closed[c]] = reactions(c, 0);
    return field;
  }
} // namespace Squeal
