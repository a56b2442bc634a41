#include <squeal/geometry/faces.h>

#include <algorithm>

namespace Squeal
{
  std::vector<HexFace> all_faces(const HexMesh &mesh)
  {
    // Outwards by the right-hand rule
    constexpr unsigned int corners[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

    std::vector<HexFace> faces;
    faces.reserve(6 * mesh.hexahedra.size());
    for (const auto &[nodes, volume] : mesh.hexahedra)
      for (const auto &[a, b, c, d] : corners)
        {
          HexFace face{{{nodes[a], nodes[b], nodes[c], nodes[d]}}, volume, {}};
          face.key = face.nodes;
          std::sort(face.key.begin(), face.key.end());
          faces.push_back(face);
        }
    std::sort(faces.begin(), faces.end(), [](const HexFace &a, const HexFace &b) { return a.key < b.key; });
    return faces;
  }

  std::vector<HexFace> outer_faces(const HexMesh &mesh)
  {
    const std::vector<HexFace> all = all_faces(mesh);
    std::vector<HexFace>       outer;
    for (std::size_t i = 0; i < all.size(); ++i)
      if ((i == 0 || all[i - 1].key != all[i].key) && (i + 1 == all.size() || all[i + 1].key != all[i].key))
        outer.push_back(all[i]);
    return outer;
  }

  FaceGeometry face_geometry(const HexMesh &mesh, const std::array<unsigned int, 4> &nodes)
  {
    const HexMesh::Point &a = mesh.points[nodes[0]], &b = mesh.points[nodes[1]], &c = mesh.points[nodes[2]], &d = mesh.points[nodes[3]];
    return {(a + b + c + d) / 4., cross_product_3d(c - a, d - b) / 2.};
  }
} // namespace Squeal
