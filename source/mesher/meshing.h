// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/gmsh_mesh.h>

#include <stdexcept>
#include <string>

namespace Squeal
{
  /// Error of Gmsh; the message names the step, and details are in Gmsh's log.
  class GmshError : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };

  /// Starts Gmsh without the user's configuration files, on one thread and with fixed seeds, so that meshes are reproducible.
  /// Call once per process.
  void start_gmsh();

  /// Sets the value for DefineNumber[..., Name "..."]. Throws GmshError.
  void set_number(const std::string &name, double value);

  /// Opens a script that sets variables, then a geometry or mesh file (may be empty), and generates the mesh unless the file contains it. A
  /// solid is meshed as prescribed in the file, a plan with quadrilaterals only, by subdivision of its elements. Groups with the same name
  /// are merged. Throws GmshError, and std::bad_alloc if memory is exhausted.
  GmshMesh mesh_geometry(const std::string &script, const std::string &file);

  /**
   * Confines this process, which can then no longer start programs, write, create, rename or remove files, or open connections. Files that
   * are already open remain usable. Attempts to remove files fail; most other forbidden calls end the process by SIGSYS (libseccomp).
   *
   * Gmsh scripts could perform these actions by SystemCall, NonBlockingSystemCall, OnelabRun, CreateDir, Save, Print, Printf > "file", and
   * some plugins and options.
   *
   * Throws std::runtime_error if the system cannot confine a process.
   */
  void confine();

  /// Ends this process by SIGALRM after @p seconds, and limits its address space to @p bytes. No core dump is written.
  void limit_resources(double bytes, double seconds);
} // namespace Squeal
