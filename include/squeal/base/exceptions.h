// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <stdexcept>
#include <string>

namespace Squeal
{
  /// What the user reads when a run cannot go on: what is wrong, where, and what to change. Thrown by everything that checks input, meshes
  /// or the outcome of a solver; main() prints it as one message and returns 1.
  struct Error : std::runtime_error
  {
    /**
     * @param what   the quantity or parameter, its value, and why it is refused
     * @param where  file, section, surface, component or step
     * @param change what would make the run succeed
     */
    Error(const std::string &what, const std::string &where, const std::string &change)
      : std::runtime_error(what + "\n  where:  " + where + "\n  change: " + change)
      , reason(what)
      , where(where)
      , change(change)
    {}

    const std::string reason, where, change; ///< the three parts of the message
  };

  /// An Error in the parameter file or on the command line.
  struct ParameterError : Error
  {
    using Error::Error;
  };

  /// An Error in a geometry or mesh.
  struct MeshError : Error
  {
    using Error::Error;
  };

  /// An Error of a solver: not converged, not certified, count not met.
  struct SolverError : Error
  {
    using Error::Error;
  };

  /// An Error while reading or writing files.
  struct FileError : Error
  {
    using Error::Error;
  };
} // namespace Squeal
