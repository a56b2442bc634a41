#pragma once

#include <squeal/studies/run.h>

namespace Squeal
{
  /**
   * `Study = stability`: component modes, real coupled modes and complex modes
   * at one friction coefficient, about equal shares of the load or about steady
   * sliding, with their tables and mode shapes. A dry run makes, checks and
   * counts the mesh, and writes nothing.
   */
  void run_stability_study(Run &run);
} // namespace Squeal
