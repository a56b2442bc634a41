// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// What the user typed behind the name of the program.
  struct CommandLine
  {
    std::string                parameter_file; ///< empty: none
    std::vector<std::string>   overrides;      ///< of the form Section/Name=value, in their order
    std::optional<std::string> output;         ///< result folder
    std::string                designs;        ///< numbers of designs, such as "3, 7-9"; empty: all
    bool                       dry_run = false, print_parameters = false, version = false, help = false;
  };

  /**
   * Takes options (`--name value` or `--name=value`) and the parameter file in any order; what follows `--` is no option.
   *
   * Throws ParameterError that quotes the word which is not understood.
   */
  CommandLine parse_command_line(const std::vector<std::string> &words);
} // namespace Squeal
