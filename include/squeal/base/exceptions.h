// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <stdexcept>
#include <string>

namespace Squeal
{
  /// An error message for the user: what is wrong, where, and what to change. Thrown by checks of input, meshes and solver results; main()
  /// prints the message and returns 1.
  struct Error : std::runtime_error
  {
    /**
     * @param what   the quantity or parameter, its value, and why it is rejected
     * @param where  file, section, surface, component or step
     * @param change remedy: how to make the run succeed
     */
    Error(const std::string &what, const std::string &where, const std::string &change)
      : std::runtime_error(what + "\n  where:  " + where + "\n  change: " + change)
      , reason(what)
      , where(where)
      , change(change)
    {}

    const std::string reason, where, change;
  };

  /// An error in the parameter file, in a file that it names, or on the command line.
  struct ParameterError : Error
  {
    using Error::Error;
  };

  struct MeshError : Error
  {
    using Error::Error;
  };

  /// A computation failed or gave an unusable result, for example fewer modes than counted.
  struct SolverError : Error
  {
    using Error::Error;
  };

  struct FileError : Error
  {
    using Error::Error;
  };
} // namespace Squeal
