#pragma once

#include <squeal/parameters/geometry.h>

#include <optional>
#include <string>

namespace Squeal
{
  /**
   * What a geometry makes of the parameters in section `Geometry`: a script of Gmsh names those that it uses, and a
   * plan is extruded by those of thickness, height and layers; a mesh of solids is as it is.
   */
  class GeometryUsage
  {
  public:
    /// Reads the file, without running it. Throws MeshError if there is none.
    explicit GeometryUsage(const GeometryParameters &parameters);

    /// Whether a length, layout or number of elements called @p name in section `Geometry` matters, such as "Pin height".
    bool uses(const std::string &name) const;

  private:
    std::optional<GeometryScript> script; ///< nothing: a mesh
    bool                          is_plan;
  };
} // namespace Squeal
