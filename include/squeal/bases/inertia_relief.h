#pragma once

#include <squeal/linear_algebra/factorization.h>
#include <squeal/model/model.h>
#include <squeal/system/terms.h>

#include <memory>
#include <optional>
#include <string>

namespace Squeal
{
  /**
   * Solves K u = f for blocks of forces, K symmetric positive semidefinite with
   * a known kernel N of rigid-body motions. Where there is one the forces are
   * relieved by inertia,
   *
   *   K u = f − M N Nᵀf,   NᵀM u = 0,   NᵀM N = 1,
   *
   * solved with the factor of K + s² M and iterative refinement.
   */
  class InertiaRelief
  {
  public:
    /**
     * @param rigid_body N, n × k, M-orthonormal; nothing if K is positive definite
     * @param largest_circular_frequency end of the band [rad/s]: s is a small part of it
     * @param what       whose stiffness K is, for messages
     *
     * Throws SolverError if K (or K + s² M) is not positive definite.
     */
    InertiaRelief(std::shared_ptr<const SparseMatrix> stiffness,
                  std::shared_ptr<const SparseMatrix> mass,
                  const std::optional<MultiVector>   &rigid_body,
                  double                              largest_circular_frequency,
                  FactorizationLibrary                library,
                  std::string                         what);

    /// u for every column of @p forces. Throws SolverError if the refinement fails.
    MultiVector solve(const MultiVector &forces) const;

    /// N; null if K is positive definite.
    const MultiVector *rigid_body_modes() const
    {
      return N.get();
    }

  private:
    std::shared_ptr<const SparseMatrix> K;
    std::unique_ptr<MultiVector>        N, MN;
    std::unique_ptr<Factorization>      factor;
    std::string                         what;
  };

  /**
   * Static responses of the uncoupled bodies, K u = f: with f = P_nᵀ or P_tᵀ the normal and tangential attachment modes of
   * disc and pins together (section 5.1 of the paper). K consists of one block for each component, so that one factorisation
   * is that of every component.
   *
   * @param largest_circular_frequency end of the band [rad/s], for the shift of a disc that can move freely
   *
   * Throws SolverError if K (or K + s² M) is not positive definite.
   */
  InertiaRelief static_response(const Model             &model,
                                const SecondOrderSystem &system,
                                double                   largest_circular_frequency,
                                FactorizationLibrary     library);

  /// K⁻¹ Pᵀ, n × n_c: responses to unit forces between the contact nodes, along the direction of P [m/N].
  MultiVector attachment_modes(const InertiaRelief &response, const SparseMatrix &P);
} // namespace Squeal
