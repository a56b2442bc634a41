// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/output/table.h>
#include <squeal/studies/steps/friction_modes.h>

namespace Squeal
{
  /// Columns of a table of complex modes, by mode index: shares φᴴ K_p φ / Σ_p φᴴ K_p φ of the elastic energy [%] in the disc, the pins,
  /// each other volume, the mounts, and contact springs if there are any. Volumes of the disc with their own material count as other
  /// volumes.
  Columns<int> strain_energy_columns(const Linearisation &linearisation, const ComplexModes &modes, const MaterialParameters &materials);
} // namespace Squeal
