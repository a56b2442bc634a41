// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/gmsh_mesh.h>

#include <stdexcept>
#include <string>

namespace Squeal
{
  /// Gmsh failed or reported an error: at what. Its log, which it prints, says more.
  class GmshError : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };

  /// Starts Gmsh without the user's configuration files, on one thread and with fixed seeds, so that the same input gives the same mesh.
  /// Once in a process.
  void start_gmsh();

  /// Gives a parameter a value that DefineNumber[..., Name "..."] takes over. Throws GmshError.
  void set_number(const std::string &name, double value);

  /// Opens a script that sets variables, then a geometry or mesh if there is one, and meshes what is not meshed yet: a solid as the file
  /// itself prescribes, a plan with quadrilaterals only, every element halved. Groups with the same name become one. Throws GmshError, and
  /// std::bad_alloc where memory ends.
  GmshMesh mesh_geometry(const std::string &script, const std::string &file);

  /**
   * From here on this process starts no program, writes, makes, renames and
   * removes no file, and opens no connection; what is open stays usable. Whoever
   * tries ends the process by SIGSYS (libseccomp).
   *
   * A Gmsh script does all of these with statements of its own: SystemCall,
   * NonBlockingSystemCall, OnelabRun, CreateDir, Save, Print, Printf > "file",
   * and some plugins and options.
   *
   * Throws std::runtime_error where the system cannot confine a process.
   */
  void confine();

  /// Ends this process by SIGALRM after @p seconds, and lets allocations beyond @p bytes of address space fail. No core is dumped.
  void limit_resources(double bytes, double seconds);
} // namespace Squeal
