// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/mpi_environment.h>

#include <unistd.h>

#include <cstdlib>

namespace Squeal
{
  void prepare_mpi_environment()
  {
    // What mpirun tells the processes that it starts
    const char *n_processes = std::getenv("OMPI_COMM_WORLD_LOCAL_SIZE");
    if (n_processes == nullptr)
      {
        setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
        // Isolated processes would all make, and remove at their end, one and the same folder
        setenv("OMPI_MCA_orte_create_session_dirs", "0", 0);
        // Open MPI 5 makes a file for shared memory, which nobody else would read
        setenv("OMPI_MCA_btl", "self", 0);
        // To look for networks takes a fifth of a second
        setenv("OMPI_MCA_pml", "ob1", 0);
      }
    // Not the cores to which this process is bound, but all that there are
    else if (std::atoi(n_processes) > ::sysconf(_SC_NPROCESSORS_ONLN))
      setenv("OMPI_MCA_mpi_yield_when_idle", "1", 0);
  }
} // namespace Squeal
