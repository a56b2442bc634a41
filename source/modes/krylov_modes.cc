#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/eigen/quadratic_modes.h>
#include <squeal/linear_algebra/matrix_operator.h>
#include <squeal/modes/krylov_modes.h>

#include <algorithm>

namespace Squeal
{
  namespace
  {
    /// A sparse matrix, which may be null, and terms in λ without sparse form.
    class DampingOperator : public LinearOperator
    {
    public:
      DampingOperator(const Epetra_Map                   &rows,
                      std::shared_ptr<const SparseMatrix> matrix,
                      std::vector<Term>                   others,
                      const ParameterValues              &values)
        : rows(rows)
        , matrix(std::move(matrix))
        , others(std::move(others))
        , values(values)
      {}

      void apply(const MultiVector &X, MultiVector &Y) const override
      {
        if (matrix)
          matrix->Multiply(false, X, Y);
        if (!others.empty())
          Y.Update(1., times(others, values, 1, X), matrix ? 1. : 0.);
      }

      const Epetra_Map &map() const override
      {
        return rows;
      }

    private:
      const Epetra_Map                   &rows;
      std::shared_ptr<const SparseMatrix> matrix;
      std::vector<Term>                   others;
      ParameterValues                     values;
    };

    /// Whether UpdatedInverse, whose factor is that of a symmetric matrix, holds all terms.
    bool is_symmetric(const std::vector<Term> &terms, const ParameterValues &values)
    {
      return std::none_of(terms.begin(), terms.end(),
                          [&values](const Term &term) { return term.symmetry == Symmetry::skew && !term.vanishes(values); });
    }

    /// Q(s)⁻¹ at friction coefficient @p mu, by @p inverse where it @p fits, or by factors kept in @p lu.
    const LinearOperator &inverse_with_friction(const SecondOrderSystem        &matrices,
                                                const double                    shift,
                                                const double                    mu,
                                                const SolverParameters         &parameters,
                                                const bool                      fits,
                                                UpdatedInverse                 &inverse,
                                                std::unique_ptr<Factorization> &lu)
    {
      if (parameters.shift_inverse == ShiftInverse::updated_cholesky && (fits || shift == 0.))
        {
          inverse.set_friction_coefficient(mu);
          return inverse;
        }
      const auto library = parameters.library == FactorizationLibrary::cholmod ? FactorizationLibrary::automatic : parameters.library;
      lu                 = factorize_general(*pencil_at(matrices, shift), library, "stiffness of the coupled system with friction");
      return *lu;
    }

    ComplexModes complex_modes(const QuadraticModes &found)
    {
      ComplexModes modes;
      modes.lambda         = found.values;
      modes.real_part      = found.real_part;
      modes.imaginary_part = found.imaginary_part;
      modes.real_values    = found.real_values;
      modes.n_rigid_body   = found.n_zero_values / 2;
      modes.summary        = std::to_string(found.n_solves) + " solves, " + std::to_string(found.n_restarts) + " restarts";
      return modes;
    }
  } // namespace

  ComplexModes krylov_modes(const CoupledSystem    &system,
                            UpdatedInverse         &inverse,
                            const double            shift,
                            const double            mu,
                            const double            largest_circular_frequency,
                            const int               n_expected,
                            const SolverParameters &parameters,
                            Progress               &progress)
  {
    const ParameterValues values = system.at(mu);
    std::vector<Term>     sparse, others;
    for (const Term &term : system.terms)
      (term.is_sparse() ? sparse : others).push_back(term);
    const bool has_full_terms = !terms_of(others, values, 1).empty(), symmetric = is_symmetric(sparse, values);
    // The inverse would hold them
    if (shift != 0. && has_full_terms)
      throw SolverError("modal damping and a disc that is free or held softly do not go together with the Krylov solver", "complex modes",
                        "choose Complex modes/Solver = residual iteration, hold the disc by stiffer Mounts/Elastic mounts, or leave "
                        "Damping/Modal damping ratio empty");

    // The pencil: sparse matrices, but for modal damping
    const SecondOrderSystem matrices = sparse_matrices(sparse, values);
    const MatrixOperator    mass(matrices.mass), stiffness(matrices.stiffness);
    const DampingOperator   damping(system.map(), matrices.damping, has_full_terms ? others : std::vector<Term>(), values);
    const QuadraticPencil   pencil{&mass, matrices.damping || has_full_terms ? &damping : nullptr, &stiffness};

    QuadraticModesOptions options;
    options.shift                      = shift;
    options.largest_circular_frequency = largest_circular_frequency;
    options.largest_damping            = largest_rate_of_band;
    options.expected                   = n_expected;
    options.tolerance                  = parameters.complex_tolerance;
    options.stiffness_norm             = matrices.stiffness->NormInf();
    options.report                     = [&](const std::string &state) { progress.update(state); };

    ComplexModes                   modes;
    std::unique_ptr<Factorization> lu;
    try
      {
        modes =
          complex_modes(quadratic_modes(pencil, inverse_with_friction(matrices, shift, mu, parameters, symmetric, inverse, lu), options));
      }
    catch (const SolverError &)
      {
        // Near the friction coefficient where a mode begins to diverge K̃ is almost singular, and its inverse magnifies rounding
        // errors: a shift helps. If the reason was another one, the next attempt says so.
        if (shift != 0. || has_full_terms)
          throw;
        options.shift = largest_circular_frequency / band_per_stabilizing_shift;
        UpdatedInverse shifted(system, options.shift, parameters.library);
        modes = complex_modes(
          quadratic_modes(pencil, inverse_with_friction(matrices, options.shift, mu, parameters, symmetric, shifted, lu), options));
        modes.summary += ", shifted";
      }
    finish_modes(system, values, inverse, modes);
    return modes;
  }
} // namespace Squeal
