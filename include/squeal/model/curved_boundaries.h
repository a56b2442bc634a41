#pragma once

#include <squeal/model/model.h>

#include <deal.II/grid/tria.h>

namespace Squeal
{
  /// A circular cylinder about an axis parallel to z.
  struct Cylinder
  {
    dealii::types::manifold_id id;   ///< of the faces and edges on it
    std::array<double, 2>      axis; ///< x and y [m]

    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &id &axis;
    }
  };

  /**
   * Makes quadratic elements follow their cylinders: where all vertices of a named surface (disc_bore, disc_rim; pin_side, pin by
   * pin) lie on a circular cylinder about an axis parallel to z, its faces and edges get that cylinder as their manifold. So do
   *
   * - faces of pins behind them that lie on a cylinder about the same axis, ring by ring: a ring that is thinner than the arc is high would
   *   otherwise be squeezed between a curved and a straight face. A cell with two such faces side by side, whose edges would meet at
   *   180 degrees, keeps them straight;
   * - coincident edges of the contact faces on the other side, so that contact nodes pair in degree 2 as well.
   *
   * Surfaces of any other shape keep straight edges. Returns the cylinders, whose manifolds are still to be set.
   *
   * @param triangulation all cells of the mesh
   */
  std::vector<Cylinder> follow_cylinders(const Model &model, dealii::Triangulation<3> &triangulation);
} // namespace Squeal
