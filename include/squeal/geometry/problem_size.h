#pragma once

#include <squeal/geometry/hex_mesh.h>
#include <squeal/geometry/plan.h>
#include <squeal/parameters/geometry.h>

#include <mpi.h>

#include <string>

namespace Squeal
{
  /// About how large a scene is; real numbers, because what is asked for may exceed every integer.
  struct ProblemSize
  {
    double hexahedra, dofs, contact_nodes;

    /**
     * Memory that the scene takes until its modes are computed [byte]: the program itself, matrices and
     * factors per dof, columns of K_c^-1 A per contact node where they are kept, and modes. Fitted to runs of
     * 32 000 to 139 000 dofs, for which it is within a twentieth (scripts/measure_scaling.py).
     */
    double memory(unsigned int degree, double n_modes) const;
  };

  /// Of the supplied plan, from the parameters alone.
  ProblemSize expected_size(const GeometryParameters &parameters);

  /// Of a plan once it is extruded.
  ProblemSize expected_size(const Plan &plan, const GeometryParameters &parameters);

  /// Of a mesh, with elements of the given degree.
  ProblemSize expected_size(const HexMesh &mesh, unsigned int degree);

  /**
   * Throws MeshError with these numbers if the memory, and what a study takes further [byte], exceeds what is available on the machines of
   * the processes.
   */
  void check_memory(const ProblemSize &size,
                    unsigned int       degree,
                    double             n_modes,
                    const std::string &where,
                    double             further      = 0.,
                    MPI_Comm           communicator = MPI_COMM_SELF);
} // namespace Squeal
