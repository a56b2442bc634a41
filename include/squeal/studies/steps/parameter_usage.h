// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/parameters/parameters.h>

namespace Squeal
{
  /// A parameter that has no effect on a run, and the reason.
  struct UnusedParameter
  {
    std::string path; ///< "Section/Name"
    std::string why;
  };

  /// Non-default parameters that have no effect on the results of the run, in the order of declaration. Throws MeshError if the geometry
  /// does not exist.
  std::vector<UnusedParameter> unused_parameters(const Parameters &parameters);

  /// The parameters among @p paths that have no effect on the results of the run. Throws MeshError as unused_parameters() does.
  std::vector<UnusedParameter> unused_among(const std::vector<std::string> &paths, const Parameters &parameters);

  /// unused_parameters(), and parameters set by Accuracy, in one line: "  note: unused parameters: Operation/Load per side (no contact
  /// damping), ..."; empty if there are none.
  std::string unused_parameters_note(const Parameters &parameters);

  /// Reason why the rotation speed does not affect modes; null if it does.
  Reason no_sliding_speed(const Parameters &parameters);

  /// Paths of the parameters with non-default values.
  std::vector<std::string> changed_parameters(Parameters parameters);
} // namespace Squeal
