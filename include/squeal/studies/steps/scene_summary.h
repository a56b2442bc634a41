#pragma once

#include <squeal/geometry/hex_mesh.h>
#include <squeal/studies/steps/run.h>

namespace Squeal
{
  /**
   * Prints, before the work, what the program understood: sizes, masses, and the memory to expect; warns of implausible values; rejects
   * models that exceed the memory, and a disc that is not round about z but about another axis. Throws MeshError.
   */
  void summarise_scene(const HexMesh &mesh, Run &run);
} // namespace Squeal
