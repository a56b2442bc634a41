// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/parameters/parameters.h>

namespace Squeal
{
  /// A parameter that a run does not use, and why.
  struct UnusedParameter
  {
    std::string path; ///< "Section/Name"
    std::string why;
  };

  /// Parameters that differ from their defaults and yet change nothing in the results of the run, in the order of their declaration. Throws
  /// MeshError if there is no geometry of the name that the parameters give.
  std::vector<UnusedParameter> unused_parameters(const Parameters &parameters);

  /// Those of some parameters that change nothing in the results of the run. Throws MeshError as unused_parameters() does.
  std::vector<UnusedParameter> unused_among(const std::vector<std::string> &paths, const Parameters &parameters);

  /// What unused_parameters() finds in one line: "  note: not used here: Operation/Load per side (no contact damping), ..."; empty if there are none.
  std::string unused_parameters_note(const Parameters &parameters);

  /// Why the sliding speed damps nothing; null if it does. For studies that do not show it either.
  Reason no_sliding_speed(const Parameters &parameters);

  /// Paths of the parameters that differ from their defaults.
  std::vector<std::string> changed_parameters(Parameters parameters);
} // namespace Squeal
