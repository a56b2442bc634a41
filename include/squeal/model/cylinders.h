#pragma once

#include <squeal/model/model.h>

namespace Squeal
{
  /**
   * Makes quadratic elements follow their cylinders: where all vertices of a
   * named surface (disc_bore, disc_rim; pin_side, pin by pin) lie on a circular
   * cylinder about an axis parallel to z, its faces and edges get that
   * cylinder as their manifold, and so do the coincident edges of the contact
   * faces on the other side, so that contact nodes pair in degree 2 as well.
   * Surfaces of any other shape keep straight edges.
   */
  void attach_cylinders(const Model &model, dealii::Triangulation<3> &triangulation);
} // namespace Squeal
