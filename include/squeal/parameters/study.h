// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace Squeal
{
  struct Parameters;
  class Run;
  struct Scene;

  /// Reason why a run does not use a parameter, for messages; null if the run uses it.
  using Reason = const char *;

  /// Marker for parameters whose use depends on the general rules for all studies.
  inline constexpr Reason as_in_general = "";

  inline Reason unless(const bool is_used, const Reason reason)
  {
    return is_used ? nullptr : reason;
  }

  /// Rule for a parameter that is used although its section is unused.
  inline Reason is_used(const Parameters & /*parameters*/)
  {
    return nullptr;
  }

  /// True if @p path, "Section/Name" or "Section/", names the parameter or its section.
  inline bool concerns(const std::string &path, const std::string &parameter)
  {
    return path.back() == '/' ? parameter.rfind(path, 0) == 0 : parameter == path;
  }

  /// Condition under which a parameter, or a whole section, has no effect.
  struct UsageRule
  {
    const char *path; ///< "Section/Name", or "Section/" for the whole section
    Reason (*why_unused)(const Parameters &);
  };

  /// A study: its name, the parameters that it uses, their requirements, and the function that runs it. Defined in the source file of the
  /// study.
  struct Study
  {
    const char *name;            ///< name in `set Study = ...`
    void (*run)(Scene &, Run &); ///< called with a meshed model

    /// Paths of the parameters and sections that are used only by the studies that list them.
    std::vector<const char *> own_parameters = {};

    /// Conditions under which parameters are unused in this study; they replace the general rules for these parameters.
    std::vector<UsageRule> rules = {};

    /// Throws ParameterError if parameters do not fit the study; null: no requirements.
    void (*check)(const Parameters &) = nullptr;

    /// Runs the study for a system file instead of a mesh; null: not available.
    void (*run_of_system)(Run &) = nullptr;

    bool has_reduced_model = false; ///< for `Output/Write system = reduced`

    bool has(const std::string &parameter) const
    {
      return std::any_of(own_parameters.begin(), own_parameters.end(), [&](const char *own) { return concerns(own, parameter); });
    }
  };

  /// All studies, the default first, defined in studies/. Parameter files refer to them by name.
  const std::vector<const Study *> &studies();
} // namespace Squeal
