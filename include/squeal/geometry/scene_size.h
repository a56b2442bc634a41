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
  /// Approximate size of a model. Numbers are real because requested sizes may exceed the largest integer.
  struct ProblemSize
  {
    double cells, dofs, contact_nodes;
    double row_length = 65.; ///< entries of K per dof

    /// Memory of the program and the model up to the computation of modes [byte]: matrices, factors, modes, and columns of K_c^-1 A (one
    /// per contact node) if they are kept.
    double memory(double n_modes) const;
  };

  /// Size of the extruded supplied plan, from the parameters alone.
  ProblemSize expected_size(const GeometryParameters &parameters);

  /// Size of an extruded plan.
  ProblemSize expected_size(const Plan &plan, const GeometryParameters &parameters);

  /// Size of a model with this mesh and elements of this @p degree.
  ProblemSize expected_size(const Mesh &mesh, unsigned int degree);

  /// Throws a MeshError with size and memory if the model needs more than the available memory of the machines that run the processes.
  void check_memory(const ProblemSize &size, double n_modes, const std::string &where, MPI_Comm communicator = MPI_COMM_SELF);

  /// True if at least half of the disc's lateral faces and half of its other faces are surfaces of revolution about z, n·(e_z × x) ≈ 0.
  /// Throws a MeshError that names @p where if this fraction is clearly larger for another axis, which is found from the second moments of
  /// the surface.
  bool is_round_about_z(const Mesh &mesh, const std::string &where);

  /// Throws ParameterError if the nodal spacing of an element of this @p degree exceeds the wavelength of the slowest wave at @p
  /// largest_circular_frequency [rad/s]: modes at the end of the band would be artefacts of the mesh.
  void check_wave_resolution(const Mesh &mesh, const MaterialParameters &materials, unsigned int degree, double largest_circular_frequency);
} // namespace Squeal
