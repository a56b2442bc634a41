// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/contact/contact_interface.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/parameters/sliding.h>

namespace Squeal
{
  /**
   * Nodal forces of a uniform pressure on each pressed face, n × 1 [N]:
   *
   *   f_i = −p ∫ n N_i dA,   p = load / |∫ n dA|
   *
   * with the outward normal n. The resultant on each face is the load; on a flat face, p = load / area.
   *
   * Throws MeshError if a face does not exist; ParameterError if a face belongs to the disc, is in contact or clamped, or has no resultant,
   * or if the pressure pushes its body away from the disc.
   */
  MultiVector pressing_forces(const Model             &model,
                              const ContactInterface  &interface,
                              const SlidingParameters &parameters,
                              double                   load_per_side);
} // namespace Squeal
