#pragma once

#include <squeal/studies/run.h>

namespace Squeal
{
  /**
   * `Study = reduction`: reduced bases measured against full-order modes, those
   * of Tables 2, 4 and 5 of the paper and better ones: sizes, rank decisions,
   * errors by groups of modes, error estimates with their verdicts, and what
   * building and solving cost.
   */
  void run_reduction_study(Run &run);
} // namespace Squeal
