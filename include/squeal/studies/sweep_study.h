#pragma once

#include <squeal/studies/run.h>

namespace Squeal
{
  void run_sweep_study(Run &run);
} // namespace Squeal
