// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/model/model.h>
#include <squeal/modes/complex_modes.h>
#include <squeal/parameters/materials.h>

#include <complex>
#include <memory>
#include <string>
#include <vector>

namespace Squeal
{
  /// Points in the bodies at which displacements of different meshes and elements are compared: x_q with masses m_q [kg], so that Σ_q m_q
  /// |u(x_q)|² approximates the integral of ρ |u|² over all bodies.
  struct CommonPoints
  {
    struct Body
    {
      std::string                   name;
      std::vector<dealii::Point<3>> points; ///< [m]
      std::vector<double>           masses; ///< [kg]

      template <class Archive>
      void serialize(Archive &archive, const unsigned int /*version*/)
      {
        archive &name &points &masses;
      }
    };
    std::vector<Body> bodies;

    int n() const;

    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &bodies;
    }
  };

  /// Components of displacements.
  enum class Directions
  {
    cartesian,  ///< x, y, z
    cylindrical ///< radial, circumferential and axial about the disc's axis: the components do not change if a pin moves to another angle
  };

  /// Points of quadrature() in all cells of a mesh, m_q = ρ |J| w_q, identical on every process. The points of the coarsest mesh are also
  /// used for all finer meshes.
  CommonPoints common_points(const Model &model, const MaterialParameters &materials, unsigned int degree = 1);

  /**
   * E, 3 n_q × n, maps the free dofs of a mesh to displacements at common points times √m_q, so that (E u)ᵀ E v approximates the mass
   * product of u and v. Rows are distributed evenly over the processes, in the same way for all meshes. Incompatible modes of
   * elements, which vanish with the square of the element size, are neglected.
   *
   * Throws MeshError if the mesh lacks a body. Collective; each process searches for all points in its cells.
   */
  std::unique_ptr<const SparseMatrix> displacements_at(const CommonPoints &points,
                                                       const Model        &model,
                                                       Directions          directions = Directions::cartesian);

  /// Displacements of modes at common points, each component times √m_q: 3 n_q × k.
  struct ModesAtPoints
  {
    std::vector<std::complex<double>> lambda; ///< λ of each mode [rad/s]
    MultiVector                       real_part, imaginary_part;
  };

  /**
   * Evaluates complex modes at common points.
   *
   * @param displacements E of the mesh of the modes
   * @param kernel        T_c: maps coupled coordinates to displacements of the bodies
   */
  ModesAtPoints at_points(const SparseMatrix &displacements, const SparseMatrix &kernel, const ComplexModes &modes);
} // namespace Squeal
