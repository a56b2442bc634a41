#pragma once

namespace Squeal
{
  /**
   * From here on this process starts no program, writes, makes, renames and
   * removes no file, and opens no connection; what is open stays usable. Whoever
   * tries ends the process with a MesherReply that says what was tried (libseccomp).
   *
   * A Gmsh script does all of these with statements of its own: SystemCall,
   * NonBlockingSystemCall, OnelabRun, CreateDir, Save, Print, Printf > "file",
   * and some plugins and options.
   *
   * Throws std::runtime_error where the system cannot confine a process.
   */
  void confine();

  /**
   * Ends this process where it takes more than @p seconds of processor time, and lets
   * allocations beyond @p bytes of address space fail. No core is dumped.
   */
  void limit_resources(double bytes, double seconds);
} // namespace Squeal
