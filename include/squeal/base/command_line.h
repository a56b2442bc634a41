// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  struct CommandLine
  {
    std::string                parameter_file; ///< empty: none
    std::vector<std::string>   overrides;      ///< Section/Name=value, in the order of the command line
    std::optional<std::string> output;         ///< result folder
    std::string                designs;        ///< numbers of designs: "3, 7-9"; empty: all
    bool                       dry_run = false, print_parameters = false, version = false, help = false;
  };

  /**
   * Parses options (`--name value` or `--name=value`) and the parameter file in any order; words after `--` are not options.
   *
   * Throws a ParameterError that quotes the first invalid word.
   */
  CommandLine parse_command_line(const std::vector<std::string> &words);
} // namespace Squeal
