// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/mesh.h>
#include <squeal/geometry/plan.h>
#include <squeal/parameters/geometry.h>
#include <squeal/parameters/materials.h>

#include <mpi.h>

#include <string>

namespace Squeal
{
  /// About how large a scene is; real numbers, because what is asked for may exceed every integer.
  struct ProblemSize
  {
    double cells, dofs, contact_nodes;
    double row_length = 65.; ///< entries of K per dof

    /// Memory that the scene takes until its modes are computed [byte]: the program itself, matrices per entry, factors per dof, columns of
    /// K_c^-1 A per contact node where they are kept, and modes.
    double memory(double n_modes) const;
  };

  /// Of the supplied plan, from the parameters alone.
  ProblemSize expected_size(const GeometryParameters &parameters);

  /// Of a plan once it is extruded.
  ProblemSize expected_size(const Plan &plan, const GeometryParameters &parameters);

  /// Of a mesh, with elements of the given degree.
  ProblemSize expected_size(const Mesh &mesh, unsigned int degree);

  /// Throws MeshError with these numbers if the memory exceeds what is available on the machines of the processes.
  void check_memory(const ProblemSize &size, double n_modes, const std::string &where, MPI_Comm communicator = MPI_COMM_SELF);

  /// Whether at least half of the disc's lateral surface is round about z, n·(e_z × x) ≈ 0. Throws MeshError, naming @p where, where
  /// clearly more of it is round about another axis, which the second moments of the surface give.
  bool is_round_about_z(const Mesh &mesh, const std::string &where);

  /// Throws ParameterError where an element, of given @p degree, is so long that less than one distance of nodes fits into a shear wave of
  /// @p largest_circular_frequency [rad/s]: the modes at the end of the band are those of the mesh.
  void check_wave_resolution(const Mesh &mesh, const MaterialParameters &materials, unsigned int degree, double largest_circular_frequency);
} // namespace Squeal
