#pragma once

#include <squeal/contact/coupled_system.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/model/model.h>

#include <optional>

namespace Squeal
{
  /// ω_max / s for a shift s that keeps the inverse of K + s² M from magnifying slow motions [-].
  inline constexpr double band_per_stabilizing_shift = 50.;

  /// Displacements along and rotations about x, y, z of one component, the others at rest: n × 6 on the uncoupled dofs.
  MultiVector rigid_motions(const Model &model, unsigned int component);

  /**
   * The six rigid-body motions of the disc with the pins following where the
   * contact makes them, in coupled coordinates, n × 6.
   */
  MultiVector rigid_disc_motions(const Model &model, const CoupledSystem &system);

  /**
   * Rigid-body motions of the uncoupled disc that its mounts leave free
   * (up to rounding errors of K), M-orthonormal; nothing if they hold it.
   */
  std::optional<MultiVector> free_disc_motions(const Model &model, const SecondOrderSystem &system);

  /// Combinations of rigid-body motions, M-orthonormal as these are, by what they do to the contact nodes.
  struct ContactMotions
  {
    std::optional<MultiVector> pressing; ///< those that move contact nodes along the normals
    std::optional<MultiVector> sliding;  ///< those that leave the gaps as they are
  };

  /**
   * Splits the M-orthonormal rigid-body @p motions, n × k, by the singular values of
   * @p normal times them; root mean squares over the contact nodes below 10⁻⁸ of the
   * largest displacement are rounding errors. The same on every process.
   */
  ContactMotions contact_motions(const SparseMatrix &normal, const MultiVector &motions);

  /**
   * A shift s ≥ 0 [rad/s] with which K_c + s² M_c is well-conditioned positive
   * definite: zero if every rigid-body motion of the disc is faster than the
   * fiftieth part of the band's end, else that part. Decided by the smallest
   * Rayleigh quotient of K_c and M_c on the rigid-body motions.
   */
  double stabilizing_shift(const Model &model, const CoupledSystem &system, double largest_circular_frequency);

  /// The same for the disc alone, of which @p system has M and K on the uncoupled dofs.
  double stabilizing_shift(const Model &model, const SecondOrderSystem &system, double largest_circular_frequency);
} // namespace Squeal
