// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/conventions.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/linear_algebra/dense.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <algorithm>
#include <cmath>

#include <limits>

namespace Squeal
{
  namespace
  {
    /// Normal displacements of contact nodes below this fraction of the largest displacement are rounding errors [-].
    constexpr double no_normal_motion = 1e-8;

    /// ω_max / s: s is normally so far below the elastic frequencies that each refinement step gains several digits [-].
    constexpr double band_per_shift = 5000.;

    /// Refinement ends if it no longer halves the largest ‖K u − f‖ / ‖f‖, which must then be below this limit [-].
    constexpr double largest_residual = 1e-9;

    /// Ritz vectors, M-orthonormal, and Ritz values of K and M on the columns of X, ascending.
    std::pair<MultiVector, std::vector<double>> rayleigh_ritz(const MultiVector &X, const SecondOrderSystem &system)
    {
      const RealPairs   axes = symmetric_eigenpairs(gram(X, *system.mass * X));
      const MultiVector Y    = X * DenseMatrix(axes.vectors * as_column(axes.values).cwiseSqrt().cwiseInverse().asDiagonal());
      // Use identical values on all processes, so that all drop the same motions
      const RealPairs ritz = agreed(X.communicator(), symmetric_eigenpairs(gram(Y, *system.stiffness * Y)));
      return {Y * ritz.vectors, ritz.values};
    }

    /// Shift s for K + s² M if the lowest frequency ω_1 < s, else 0. Without the shift, K⁻¹ would amplify a motion at ω_1 and its rounding
    /// errors by (ω/ω_1)² relative to a mode at ω.
    double shift_for(const std::vector<double> &eigenvalues, const double largest_circular_frequency)
    {
      const double s = largest_circular_frequency / band_per_stabilizing_shift;
      return eigenvalues.front() < s * s ? s : 0.;
    }
  } // namespace

  MultiVector rigid_motions(const Model &model, const unsigned int component)
  {
    MultiVector motions(model.free_map(), 6);
    for (const Node &node : model.nodes())
      if (node.component == component)
        {
          const auto  &p            = node.position;
          const double values[6][3] = {{1., 0., 0.}, {0., 1., 0.}, {0., 0., 1.}, {0., -p[2], p[1]}, {p[2], 0., -p[0]}, {-p[1], p[0], 0.}};
          for (int j = 0; j < 6; ++j)
            for (int k = 0; k < 3; ++k)
              if (const int i = motions.map().place(node.dofs[k]); i >= 0)
                motions(i, j) = values[j][k];
        }
    return motions;
  }

  MultiVector rigid_disc_motions(const Model &model, const CoupledSystem &system)
  {
    // T_c eliminates dofs of pins only, which are zero here, and selects all other dofs. Its transpose therefore extracts the displacements
    // of the disc
    return transpose_times(*system.kernel, rigid_motions(model, 0));
  }

  ContactMotions contact_motions(const SparseMatrix &normal, const MultiVector &motions)
  {
    const DenseMatrix    D    = replicate(normal * motions);
    const double         size = largest_of_processes(motions.communicator(), max_norm(motions.local())) * std::sqrt(D.rows());
    const SingularValues axes = singular_values(D); // descending
    const auto [values, V]    = agreed(motions.communicator(), {axes.values, axes.right});
    const int k               = motions.n_columns();
    const int rank = std::count_if(values.begin(), values.end(), [size](const double value) { return value / size > no_normal_motion; });

    ContactMotions result;
    if (rank > 0)
      result.pressing.emplace(motions * V.leftCols(rank));
    if (rank < k)
      result.sliding.emplace(motions * V.rightCols(k - rank));
    return result;
  }

  std::optional<MultiVector> free_motions(const Model &model, const SecondOrderSystem &system, const unsigned int component)
  {
    const bool is_clamped = std::any_of(model.nodes().begin(), model.nodes().end(),
                                        [&](const Node &node) { return node.component == component && node.is_clamped(); });
    if (largest_of_processes(model.communicator(), is_clamped) > 0.)
      return {};
    const auto [modes, eigenvalues] = rayleigh_ritz(rigid_motions(model, component), system);
    const double hidden             = unresolved_square(*system.stiffness, *system.mass);
    const int    n_free = std::count_if(eigenvalues.begin(), eigenvalues.end(), [hidden](const double value) { return !(value > hidden); });
    if (n_free == 0)
      return {};
    return view(modes, 0, n_free);
  }

  double stabilizing_shift(const Model &model, const CoupledSystem &system, const double largest_circular_frequency)
  {
    const std::vector<double> eigenvalues =
      rayleigh_ritz(rigid_disc_motions(model, system), {system.mass, nullptr, system.stiffness}).second;
    return shift_for(eigenvalues, largest_circular_frequency);
  }

  double stabilizing_shift(const Model &model, const SecondOrderSystem &system, const double largest_circular_frequency)
  {
    return shift_for(rayleigh_ritz(rigid_motions(model, 0), system).second, largest_circular_frequency);
  }

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
                                "use mounts that either hold a body firmly or leave it free");
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
    return {system.stiffness,           system.mass, free_motions(model, system, 0),
            largest_circular_frequency, library,     "stiffness of disc and pins without contact"};
  }

  MultiVector attachment_modes(const InertiaRelief &response, const SparseMatrix &P)
  {
    return response.solve(transpose_times(P, unit_vectors(P.rows())));
  }
} // namespace Squeal
