// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/mpi_environment.h>

#include <mpi.h>
#include <unistd.h>

#include <cstdlib>

/// Replaces MPI_Init() of the library, because Ipopt, which OpenTURNS may load, would otherwise start MPI before main(). MPI is started by
/// deal.II, which calls MPI_Init_thread().
extern "C" int MPI_Init(int * /*argc*/, char *** /*argv*/)
{
  return MPI_SUCCESS;
}

namespace Squeal
{
  void prepare_mpi_environment()
  {
    // This variable is set by mpirun in the processes that it starts
    const char *n_processes = std::getenv("OMPI_COMM_WORLD_LOCAL_SIZE");
    if (n_processes == nullptr)
      {
        setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
        // Processes without a daemon would all create the same folder and remove it when they end
        setenv("OMPI_MCA_orte_create_session_dirs", "0", 0);
        // Avoids a shared-memory file, which Open MPI 5 creates but does not use
        setenv("OMPI_MCA_btl", "self", 0);
        // Avoids the search for network interfaces, which takes 0.2 s
        setenv("OMPI_MCA_pml", "ob1", 0);
      }
    // Compare with all cores of the machine, not only with the cores to which this process is bound
    else if (std::atoi(n_processes) > ::sysconf(_SC_NPROCESSORS_ONLN))
      setenv("OMPI_MCA_mpi_yield_when_idle", "1", 0);
  }
} // namespace Squeal
