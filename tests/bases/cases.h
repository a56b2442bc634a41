#pragma once

#include "scenes.h"

namespace Squeal::Testing
{
  /// Contact faces, element, mounts.
  struct Case
  {
    const char        *name;
    double             slope; ///< of the contact faces
    Element            element;
    std::vector<Mount> mounts;
    int                n_free    = 0;    ///< rigid-body motions that the mounts leave to the disc
    double             tolerance = 1e-9; ///< of residuals of static responses

    /// Gives the faces their slope.
    HexMesh sloped(const HexMesh &mesh) const
    {
      return mapped(mesh, [this](const Point3 &p) {
        return Point3{{p[0], p[1], p[2] + slope * (std::hypot(p[0], p[1]) - 0.2) + 0.3 * slope * p[1]}};
      });
    }
  };

  inline void PrintTo(const Case &c, std::ostream *stream)
  {
    *stream << c.name;
  }

  inline const std::vector<Mount> held = {{"disc_bore", 1e9, 7.80e10, 1.88e10}};
} // namespace Squeal::Testing
