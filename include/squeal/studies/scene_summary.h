#pragma once

#include <squeal/geometry/hex_mesh.h>
#include <squeal/studies/run.h>

namespace Squeal
{
  /**
   * Says, before the work, what the program understood: sizes, masses, about how many modes
   * to expect and how much memory they take; warns of what is implausible, and refuses what memory
   * cannot hold and a disc that is not round about z but about another axis. Throws MeshError. Returns the number of modes that it
   * expects in the band.
   */
  double summarise_scene(const HexMesh &mesh, Run &run);
} // namespace Squeal
