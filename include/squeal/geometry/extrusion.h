#pragma once

#include <squeal/geometry/hex_mesh.h>
#include <squeal/geometry/plan.h>
#include <squeal/parameters/geometry.h>

namespace Squeal
{
  /**
   * Disc and pins over their plan: the disc from z = -thickness/2 to
   * +thickness/2, each pin outwards from the face of its side. Pins have nodes
   * of their own, at exactly the places of the disc's.
   *
   * Volumes: disc, then the pins in the order of the plan. Surfaces:
   * disc_contact, pin_contact, pin_clamp, pin_side, then one for each curve of
   * the plan.
   */
  HexMesh extrude(const Plan &plan, const GeometryParameters &parameters);
} // namespace Squeal
