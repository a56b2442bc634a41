#include <squeal/base/exceptions.h>
#include <squeal/bases/inertia_relief.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <algorithm>
#include <limits>

namespace Squeal
{
  namespace
  {
    /// ω_max / s: the shift lies far below the elastic modes, so that each refinement gains several digits.
    constexpr double band_per_shift = 5000.;

    /// Refinement ends when it no longer halves the largest ‖K u − f‖ / ‖f‖, which must then be below this.
    constexpr double largest_residual = 1e-9;
  } // namespace

  InertiaRelief::InertiaRelief(std::shared_ptr<const SparseMatrix> stiffness,
                               std::shared_ptr<const SparseMatrix> mass,
                               const std::optional<MultiVector>   &rigid_body,
                               const double                        largest_circular_frequency,
                               const FactorizationLibrary          library,
                               std::string                         what)
    : K(std::move(stiffness))
    , what(std::move(what))
  {
    if (!rigid_body)
      {
        factor = factorize_positive_definite(*K, library, this->what);
        return;
      }
    N              = std::make_unique<MultiVector>(*rigid_body);
    MN             = std::make_unique<MultiVector>(*mass * *N);
    const double s = largest_circular_frequency / band_per_shift;
    factor         = factorize_positive_definite(*add(1., *K, s * s, *mass), library, this->what);
  }

  MultiVector InertiaRelief::solve(const MultiVector &forces) const
  {
    MultiVector u(forces.map(), forces.n_columns());
    if (!N)
      {
        factor->apply(forces, u);
        return u;
      }

    MultiVector relieved = forces;
    multiply_add(-1., *MN, gram(*N, forces), 1., relieved);
    const std::vector<double> norms    = column_norms(relieved);
    MultiVector               residual = relieved, correction(u);
    double                    smallest = std::numeric_limits<double>::max();
    while (true)
      {
        factor->apply(residual, correction);
        u += correction;
        multiply_add(-1., *N, gram(*MN, u), 1., u);
        residual                          = relieved - *K * u;
        const std::vector<double> rest    = column_norms(residual);
        double                    largest = 0.;
        for (std::size_t j = 0; j < rest.size(); ++j)
          if (norms[j] > 0.)
            largest = std::max(largest, rest[j] / norms[j]);
        if (!(largest < 0.5 * smallest))
          {
            if (!(std::min(largest, smallest) < largest_residual))
              throw SolverError("static responses with inertia relief do not converge", what,
                                "use a mount that either holds the disc or leaves it free, nothing in between");
            return u;
          }
        smallest = largest;
      }
  }

  InertiaRelief static_response(const Model               &model,
                                const SecondOrderSystem   &system,
                                const double               largest_circular_frequency,
                                const FactorizationLibrary library)
  {
    return {system.stiffness,           system.mass, free_disc_motions(model, system),
            largest_circular_frequency, library,     "stiffness of disc and pins without contact"};
  }

  MultiVector attachment_modes(const InertiaRelief &response, const SparseMatrix &P)
  {
    return response.solve(transpose_times(P, unit_vectors(P.rows())));
  }
} // namespace Squeal
