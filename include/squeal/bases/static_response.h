#pragma once

#include <squeal/bases/inertia_relief.h>
#include <squeal/model/model.h>
#include <squeal/system/second_order_system.h>

namespace Squeal
{
  /**
   * Static responses of the uncoupled bodies, K u = f, for blocks of forces:
   * with f = P_nᵀ or P_tᵀ the normal and tangential attachment modes of disc and
   * pins together (section 5.1 of the paper). K consists of one block for each
   * component, so that one factorisation is that of every component.
   *
   * Where the mount leaves the disc some rigid-body motions, the forces are
   * relieved by inertia (InertiaRelief).
   */
  class StaticResponse : public InertiaRelief
  {
  public:
    /**
     * @param largest_circular_frequency end of the band [rad/s]: a rigid-body
     *        motion whose frequency is below 10⁻⁴ of it counts as free
     *
     * Throws SolverError if K (or K + s² M) is not positive definite.
     */
    StaticResponse(const Model &model, const SecondOrderSystem &system, double largest_circular_frequency, FactorizationLibrary library);
  };
} // namespace Squeal
