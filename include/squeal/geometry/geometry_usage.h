#pragma once

#include <squeal/parameters/geometry.h>

#include <set>
#include <string>

namespace Squeal
{
  /**
   * Which of GeometryParameters::script_variables() matter to the geometry: a script of Gmsh names those that it uses, a
   * plan is extruded by those of thickness, height and layers, and contact nodes are paired in every mesh. Reads the file,
   * without running it. Throws MeshError if there is none.
   */
  std::set<std::string> used_variables(const GeometryParameters &parameters);
} // namespace Squeal
