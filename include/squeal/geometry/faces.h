#pragma once

#include <squeal/geometry/hex_mesh.h>

#include <array>
#include <vector>

namespace Squeal
{
  /// A face of a hexahedron.
  struct HexFace
  {
    std::array<unsigned int, 4> nodes;  ///< around the face, outwards by the right-hand rule
    unsigned int                volume; ///< of its hexahedron
    std::array<unsigned int, 4> key;    ///< the nodes in ascending order
  };

  /// Those of all hexahedra, ascending by key: the two of a face between hexahedra follow each other.
  std::vector<HexFace> all_faces(const HexMesh &mesh);

  /// Those that belong to one hexahedron only.
  std::vector<HexFace> outer_faces(const HexMesh &mesh);

  /// Centre of a face [m] and its normal times its area [m²].
  struct FaceGeometry
  {
    HexMesh::Point       centre;
    dealii::Tensor<1, 3> area_normal;
  };

  FaceGeometry face_geometry(const HexMesh &mesh, const std::array<unsigned int, 4> &nodes);
} // namespace Squeal
