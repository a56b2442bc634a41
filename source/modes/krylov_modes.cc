// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/eigen/quadratic_modes.h>
#include <squeal/modes/system_modes.h>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    /// Sum of all terms with one power of λ; terms are applied individually, because a matrix of the sum would need as much memory as K.
    struct SumOfTerms : LinearOperator
    {
      SumOfTerms(const CoupledSystem &system, const ParameterValues &values, const int power)
        : system(system)
        , values(values)
        , power(power)
      {}

      void apply(const MultiVector &X, MultiVector &Y) const override
      {
        Y = times(system.terms, values, power, X);
      }

      const RowMap &map() const override
      {
        return system.map();
      }

      const CoupledSystem   &system;
      const ParameterValues &values;
      const int              power;
    };

    /// True if UpdatedInverse, whose factor is for the values of the system, also gives Q(s)⁻¹ at these values.
    bool is_in_factor(const CoupledSystem &system, const ParameterValues &values, const double shift)
    {
      return std::all_of(system.terms.begin(), system.terms.end(), [&](const Term &term) {
        return !term.matrix || (term.power > 0 && shift == 0.) ||
               (term.is_frictionless() ? term.coefficient.at(values) == term.coefficient.at(system.values) : term.vanishes(values));
      });
    }

    /// Modes at the friction coefficient @p mu, with Q(s)⁻¹ from @p inverse if it includes all terms, else from LU factors.
    ComplexModes attempt(const CoupledSystem         &system,
                         const std::vector<Term>     &sparse,
                         const ParameterValues       &values,
                         const QuadraticPencil       &pencil,
                         const QuadraticModesOptions &options,
                         const double                 mu,
                         const SolverParameters      &parameters,
                         UpdatedInverse              &inverse)
    {
      std::unique_ptr<const LinearOperator> lu;
      if (parameters.shift_inverse == ShiftInverse::updated_cholesky && is_in_factor(system, values, options.shift))
        inverse.set_friction_coefficient(mu);
      else
        lu = factorize_general(*pencil_at(sparse_matrices(sparse, values), options.shift), "stiffness of the coupled system with friction");
      const QuadraticModes found = quadratic_modes(pencil, lu ? *lu : inverse, options);
      ComplexModes         modes;
      modes.lambda         = found.values;
      modes.real_part      = found.real_part;
      modes.imaginary_part = found.imaginary_part;
      modes.real_values    = found.real_values;
      modes.n_rigid_body   = found.n_zero_values / 2;
      modes.summary        = text(counted(found.n_solves, "solve"), ", ", counted(found.n_restarts, "restart"));
      return modes;
    }
  } // namespace

  ComplexModes krylov_modes(const CoupledSystem    &system,
                            UpdatedInverse         &inverse,
                            const double            shift,
                            const double            mu,
                            const Band             &band,
                            const int               n_expected,
                            const SolverParameters &parameters,
                            Progress               &progress,
                            const MultiVector      *real_modes)
  {
    const ParameterValues values = system.at(mu);
    std::vector<Term>     sparse, others;
    for (const Term &term : system.terms)
      (term.is_sparse() ? sparse : others).push_back(term);
    const bool has_full_terms = !terms_of(others, values, 1).empty();
    // Reject modal damping with a shift, because the shifted factor cannot include modal damping
    if (shift != 0. && has_full_terms)
      throw SolverError("the Krylov solver cannot combine modal damping with a body that is free or softly mounted", "complex modes",
                        "choose Complex modes/Solver = residual iteration, stiffen Mounts/Elastic mounts, or leave "
                        "Damping/Modal damping ratio empty");

    const SumOfTerms      mass(system, values, 2), damping(system, values, 1), stiffness(system, values, 0);
    const QuadraticPencil pencil{&mass, terms_of(system.terms, values, 1).empty() ? nullptr : &damping, &stiffness};

    QuadraticModesOptions options;
    options.shift                      = shift;
    options.largest_circular_frequency = band.end;
    options.largest_damping            = band.largest_damping;
    options.largest_decay              = band.largest_decay;
    options.zero_modulus               = std::sqrt(system.hidden_square);
    options.expected                   = n_expected;
    options.close_vectors              = real_modes;
    options.tolerance                  = parameters.complex_tolerance;
    // Use a wider block without damping, because modes of equal frequency on all pins form a cluster that a narrower block might miss in
    // part
    options.block_size     = pencil.damping ? 8 : 12;
    options.stiffness_norm = norm_bound(sparse, values, 0);
    options.damping_norm   = norm_bound(sparse, values, 1);
    options.report         = [&](const std::string &state) { progress.update(state); };

    ComplexModes modes;
    try
      {
        modes = attempt(system, sparse, values, pencil, options, mu, parameters, inverse);
      }
    catch (const SolverError &)
      {
        // Retry with a shift, because K̃ is almost singular close to a static instability; other failures usually recur
        if (shift != 0. || has_full_terms)
          throw;
        options.shift = band.end / band_per_stabilizing_shift;
        UpdatedInverse shifted(system, options.shift, parameters.library);
        modes = attempt(system, sparse, values, pencil, options, mu, parameters, shifted);
        modes.summary += ", shifted";
      }
    finish_modes(system, values, inverse, modes);
    return modes;
  }
} // namespace Squeal
