#pragma once

namespace Squeal
{
  /**
   * What the mesher, a process of its own, says to the program: one letter on
   * the file descriptor below, then the text or bytes that belong to it.
   */
  enum class MesherReply : char
  {
    mesh           = 'm', ///< to_bytes() of a GmshMesh
    failure        = 'f', ///< what Gmsh reports
    out_of_memory  = 'o', ///< nothing follows
    starts_program = 'p', ///< nothing follows
    writes_file    = 'w', ///< name of the file, empty where it is not known
    uses_network   = 'n'  ///< nothing follows
  };

  inline constexpr int mesher_reply_descriptor = 3;

  /// Where the mesher finds a script, and the name by which Gmsh opens it.
  inline constexpr int         mesher_script_descriptor = 4;
  inline constexpr const char *mesher_script_name       = "/proc/self/fd/4";

  /// Arguments of the mesher that say whether the geometry may do what confine() forbids.
  inline constexpr const char *mesher_confined = "confined", *mesher_free = "free";
} // namespace Squeal
