#pragma once

#include <squeal/contact/coupled_system.h>
#include <squeal/model/model.h>

namespace Squeal
{
  /**
   * The six rigid-body motions of the disc with the pins following where the
   * contact makes them, in coupled coordinates, n × 6.
   */
  MultiVector rigid_disc_motions(const Model &model, const CoupledSystem &system);

  /**
   * A shift s ≥ 0 [rad/s] with which K_c + s² M_c is safely positive definite:
   * zero if every rigid-body motion of the disc meets an elastic resistance,
   * else a small part of the band. Decided by the smallest Rayleigh quotient
   * of K_c and M_c on the rigid-body motions.
   */
  double stabilizing_shift(const Model &model, const CoupledSystem &system, double largest_circular_frequency);
} // namespace Squeal
