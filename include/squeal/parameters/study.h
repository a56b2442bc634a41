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

  /// Why a run does not use something, for a message; null if it does.
  using Reason = const char *;

  /// Of a study that leaves it to the general rules whether it uses something.
  inline constexpr Reason as_in_general = "";

  inline Reason unless(const bool is_used, const Reason reason)
  {
    return is_used ? nullptr : reason;
  }

  /// Whether @p path, "Section/Name" or "Section/", is that of a parameter or of its section.
  inline bool concerns(const std::string &path, const std::string &parameter)
  {
    return path.back() == '/' ? parameter.rfind(path, 0) == 0 : parameter == path;
  }

  /// When a parameter, or all of a section, is of no use.
  struct UsageRule
  {
    const char *path; ///< "Section/Name", or "Section/" for all of it
    Reason (*why_unused)(const Parameters &);
  };

  /// A question that a run may answer: its name, the parameters that it uses, what they must fulfil, and what answers it. Each stands in
  /// the file that answers it.
  struct Study
  {
    const char *name;            ///< in `set Study = ...`
    void (*run)(Scene &, Run &); ///< the scene is meshed

    /// Paths of parameters and sections that only this study uses, and others that list them, too.
    std::vector<const char *> own_parameters = {};

    /// When it leaves parameters unused, its own or others'. For those that it names the general rules do not hold.
    std::vector<UsageRule> rules = {};

    /// Throws ParameterError where parameters do not fit the study; null: nothing to check.
    void (*check)(const Parameters &) = nullptr;

    /// What answers it for a system file in the place of a mesh; null: nothing.
    void (*run_of_system)(Run &) = nullptr;

    bool has(const std::string &parameter) const
    {
      return std::any_of(own_parameters.begin(), own_parameters.end(), [&](const char *own) { return concerns(own, parameter); });
    }
  };

  /// All studies, the default first. Parameter files name them; they are listed where they are made, in studies/.
  const std::vector<const Study *> &studies();
} // namespace Squeal
