#pragma once

#include <squeal/geometry/hex_mesh.h>

#include <array>
#include <optional>

namespace Squeal
{
  /// How deep a point is in a hexahedron, below the nearest face; negative outside.
  struct Depth
  {
    double relative; ///< to the extent of the hexahedron across that face [-]
    double length;   ///< [m]
  };

  /// x(ξ) = Σ a_m ξ^m, m ∈ {0, 1}³, from [-1, 1]³ to a hexahedron.
  class TrilinearMap
  {
  public:
    TrilinearMap(const HexMesh &mesh, const HexMesh::Hexahedron &hexahedron);

    /// By Newton's method for ξ; nothing for points that are more than about three quarters of the hexahedron's extent away.
    std::optional<Depth> depth(const HexMesh::Point &point) const;

  private:
    using Vector   = dealii::Tensor<1, 3>;
    using Jacobian = dealii::Tensor<2, 3>;

    Vector   position(const Vector &xi) const;
    Jacobian jacobian(const Vector &xi) const;

    std::array<Vector, 8> a; ///< 1, ξ, η, ζ, ξη, ηζ, ζξ, ξηζ
    Jacobian              central_inverse;
  };
} // namespace Squeal
