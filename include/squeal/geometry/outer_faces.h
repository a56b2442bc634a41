#pragma once

#include <squeal/geometry/hex_mesh.h>

#include <array>
#include <vector>

namespace Squeal
{
  /// A face that belongs to one hexahedron only.
  struct OuterFace
  {
    std::array<unsigned int, 4> nodes;  ///< around the face, outwards by the right-hand rule
    unsigned int                volume; ///< of its hexahedron
  };

  /// All of them, in no order that means anything.
  std::vector<OuterFace> outer_faces(const HexMesh &mesh);

  /// Centre of a face [m] and its normal times its area [m²].
  struct FaceGeometry
  {
    HexMesh::Point centre, area_normal;
  };

  FaceGeometry face_geometry(const HexMesh &mesh, const std::array<unsigned int, 4> &nodes);
} // namespace Squeal
