#pragma once

#include <stdexcept>
#include <string>

namespace Squeal
{
  /**
   * What the user reads when a run cannot go on: what is wrong, where, and
   * what to change. Thrown by everything that checks input, meshes or the
   * outcome of a solver; main() prints it as one message and returns 1.
   */
  class Error : public std::runtime_error
  {
  public:
    /**
     * @param what   the quantity or parameter, its value, and why it is refused
     * @param where  file, section, surface, component or step
     * @param change what would make the run succeed
     */
    Error(const std::string &what, const std::string &where, const std::string &change);

    const std::string reason, where, change; ///< the three parts of the message
  };

  /// An Error in the parameter file or on the command line.
  class ParameterError : public Error
  {
  public:
    using Error::Error;
  };

  /// An Error in a geometry or mesh.
  class MeshError : public Error
  {
  public:
    using Error::Error;
  };

  /// An Error of a solver: not converged, not certified, count not met.
  class SolverError : public Error
  {
  public:
    using Error::Error;
  };

  /// An Error while reading or writing files.
  class FileError : public Error
  {
  public:
    using Error::Error;
  };
} // namespace Squeal
