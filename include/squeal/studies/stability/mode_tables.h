// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/studies/steps/mode_results.h>

namespace Squeal
{
  /// Numbers of modes and what their accuracy rests on, for the run record.
  void record_modes(const FrictionlessModes &frictionless, const FrictionModes &friction, Run &run);

  /// Verdict and unstable modes, which is what most users want to know.
  void report_modes(const FrictionlessModes                &frictionless,
                    const FrictionModes                    &friction,
                    const std::vector<DiscretisationError> &mesh_errors,
                    Run                                    &run);

  /**
   * Tables of the modes with friction, of those without, and of real eigenvalues where there are any.
   *
   * @param energies columns of the numbers of the modes with friction: where they are and how they travel
   * @param more     others, with the verdict; empty: the verdict is that of the arithmetic
   */
  void store_mode_tables(const FrictionlessModes &frictionless,
                         const FrictionModes     &friction,
                         const Columns<int>      &energies,
                         const Columns<int>      &more,
                         Run                     &run);
} // namespace Squeal
