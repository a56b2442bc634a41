// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/geometry/mortar.h>

#include <Eigen/Core>

namespace Squeal
{
  /// Largest number of nodes of a face.
  inline constexpr int most_face_nodes = 9;

  using FaceVector = Eigen::Matrix<double, most_face_nodes, 1>;
  using FaceMatrix = Eigen::Matrix<double, most_face_nodes, most_face_nodes>;

  /// Integrals over the part of a slave element that is opposite the master; unused entries are zero.
  struct ElementOverlap
  {
    FaceMatrix                                       mass = FaceMatrix::Zero(); ///< ∫ N_i N_j [m²]
    std::vector<std::pair<unsigned int, FaceMatrix>> coupling;                  ///< master elements with ∫ N_i N_l [m²]

    double area() const
    {
      return mass.sum();
    }
  };

  struct SurfaceOverlap
  {
    std::vector<ElementOverlap> elements;    ///< integrals of each slave element
    double                      mean_cosine; ///< area-weighted mean cosine between the normals of both surfaces; −1 without overlap
    double                      coarseness;  ///< see Mortar
    double                      largest_gap; ///< see Mortar
  };

  /// Computes the integrals as sums over segments: intersections of slave and master elements, projected onto the plane of the slave
  /// element. Elements of degree 2 are first divided into four by their nodes. Quadrature points are mapped to both elements along the
  /// normal of this plane. Throws MeshError if the reference coordinates of a point cannot be found.
  SurfaceOverlap overlap(const SurfacePatch &slave, const SurfacePatch &master, double search_distance);

  struct WholeElement
  {
    FaceVector      functions   = FaceVector::Zero();      ///< ∫ N_i [m²]
    Eigen::Vector3d area_normal = Eigen::Vector3d::Zero(); ///< ∫ n [m²]
  };

  WholeElement whole_element(const SurfacePatch &patch, const SurfaceElement &element);
} // namespace Squeal
