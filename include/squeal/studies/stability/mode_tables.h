// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/studies/steps/mode_results.h>

namespace Squeal
{
  /// Records numbers of modes and their accuracy in the run record.
  void record_modes(const FrictionlessModes &frictionless, const FrictionModes &friction, Run &run);

  /// Prints the verdict and the unstable modes.
  void report_modes(const FrictionlessModes                &frictionless,
                    const FrictionModes                    &friction,
                    const std::vector<DiscretisationError> &mesh_errors,
                    Run                                    &run);

  /**
   * Stores the tables of modes with friction, of modes without friction, and of real eigenvalues if there are any.
   *
   * @param energies columns by mode index, for example shares of energy and travelling waves
   * @param more     additional columns, including a verdict; empty: the table contains the verdict of the solver
   */
  void store_mode_tables(const FrictionlessModes &frictionless,
                         const FrictionModes     &friction,
                         const Columns<int>      &energies,
                         const Columns<int>      &more,
                         Run                     &run);
} // namespace Squeal
