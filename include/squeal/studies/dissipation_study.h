#pragma once

#include <squeal/studies/run.h>

namespace Squeal
{
  /**
   * `Study = dissipation`: complex modes at one friction coefficient without
   * radial dissipation and with each reading of it, c_b consistent and as
   * published, R_n0 from equal shares of the load and from steady sliding, side
   * by side with the last column of the paper's Table 1.
   */
  void run_dissipation_study(Run &run);
} // namespace Squeal
