// SPDX-License-Identifier: GPL-3.0-or-later

// Runs Gmsh for squeal in a separate, confined process. Started by run_mesher() (geometry/mesher.h); not for direct use.

#include "meshing.h"

#include <squeal/geometry/gmsh_mesh.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <string>

#include <fcntl.h>
#include <sys/prctl.h>
#include <unistd.h>

namespace
{
  using namespace Squeal;

  /// Sends a reply to the original standard output; Gmsh's output is redirected to the log.
  void send(std::FILE *answer, const MesherReply reply, const std::string &content)
  {
    std::fputc(static_cast<char>(reply), answer);
    std::fwrite(content.data(), 1, content.size(), answer);
    std::fflush(answer);
  }
} // namespace

/// Arguments: file (may be empty), memory limit [byte], time limit [s], confined or free, then pairs of names and values for DefineNumber.
int main(int argc, char **argv)
{
  if (argc < 5)
    return 2;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  close_range(STDERR_FILENO + 1, ~0u, 0);
  std::FILE *const answer = fdopen(fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0), "w");
  dup2(STDERR_FILENO, STDOUT_FILENO);
  limit_resources(std::atof(argv[2]), std::atof(argv[3]));
  try
    {
      start_gmsh();
      for (int i = 5; i + 1 < argc; i += 2)
        set_number(argv[i], std::atof(argv[i + 1]));
      std::string why_not_confined;
      if (argv[4] != std::string(mesher_free))
        try
          {
            confine();
          }
        catch (const std::runtime_error &error)
          {
            why_not_confined = error.what();
          }
      GmshMesh mesh         = mesh_geometry("/dev/stdin", argv[1]);
      mesh.why_not_confined = why_not_confined;
      send(answer, MesherReply::mesh, to_bytes(mesh));
    }
  catch (const GmshError &error)
    {
      send(answer, MesherReply::failure, error.what());
    }
  catch (const std::bad_alloc &)
    {
      send(answer, MesherReply::out_of_memory, "");
    }
  _exit(0); // skip Gmsh's cleanup
}
