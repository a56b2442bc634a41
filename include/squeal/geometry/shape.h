// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <deal.II/base/point.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace Squeal
{
  /// Shapes of cells and of their faces.
  enum class Shape : std::uint8_t
  {
    triangle,
    quadrilateral,
    tetrahedron,
    pyramid,
    wedge,
    hexahedron
  };

  /// Corners, edges and faces of a shape, numbered as in Gmsh. Reference coordinates are the same as in deal.II: unit triangle and
  /// tetrahedron, unit square and cube, wedge = triangle × [0, 1], pyramid on [−1, 1]² with its apex at (0, 0, 1).
  struct Topology
  {
    const char                          *name; ///< name of the shape, plural
    unsigned int                         dimension;
    std::vector<dealii::Point<3>>        corners;
    std::vector<std::array<unsigned, 2>> edges;

    /// Corners of each face, outwards by the right-hand rule; a triangle or quadrilateral is its own face.
    std::vector<std::vector<unsigned int>> faces;
  };

  const Topology &topology(Shape shape);

  constexpr Shape shape_of_face(const std::size_t n_corners)
  {
    return n_corners == 3 ? Shape::triangle : Shape::quadrilateral;
  }

  /// Nodes of a Lagrange element of degree 1 or 2: corners; in degree 2 also the middles of edges, then the centres of quadrilateral faces
  /// and of a hexahedron.
  std::vector<dealii::Point<3>> reference_nodes(Shape shape, unsigned int degree);

  inline constexpr unsigned int most_nodes = 27;

  /// Indices of the nodes of a face in the node list of its cell, in the order of reference_nodes() of the face.
  const std::vector<unsigned int> &nodes_of_face(Shape cell, unsigned int degree, unsigned int face);

  /**
   * Shape functions N_i of a Lagrange element, in the order of reference_nodes(): FE_Q, FE_SimplexP, FE_WedgeP and FE_PyramidP of deal.II.
   * Pyramids of degree 2, which deal.II lacks, use the nodal basis of P_2 + span{w x, w y, w, w²}, w = x y / (1 − z) (M. Bergot, G. Cohen,
   * M. Duruflé 2010).
   */
  class ShapeFunctions
  {
  public:
    static const ShapeFunctions &of(Shape shape, unsigned int degree);

    virtual ~ShapeFunctions() = default;

    virtual unsigned int n() const = 0;

    virtual double value(unsigned int i, const dealii::Point<3> &x) const = 0;

    /// Gradient with respect to reference coordinates; the third component is zero for faces.
    virtual dealii::Tensor<1, 3> gradient(unsigned int i, const dealii::Point<3> &x) const = 0;
  };

  /// A point of a quadrature rule.
  struct QuadraturePoint
  {
    dealii::Point<3> x; ///< reference coordinates
    double           weight;
  };

  /// Quadrature rule with positive weights, exact for the mass of an undistorted element of this degree: Gauss with degree + 1 points per
  /// direction (pyramids: degree + 2); Witherden and Vincent (2015) on triangles and tetrahedra.
  std::vector<QuadraturePoint> quadrature(Shape shape, unsigned int degree);
} // namespace Squeal
