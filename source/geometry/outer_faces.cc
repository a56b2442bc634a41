#include <squeal/geometry/outer_faces.h>

#include <algorithm>

namespace Squeal
{
  namespace
  {
    /// Corners of the six faces, outwards by the right-hand rule.
    constexpr unsigned int face_corners[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  } // namespace

  std::vector<OuterFace> outer_faces(const HexMesh &mesh)
  {
    struct Face
    {
      std::array<unsigned int, 4> key;
      OuterFace                   face;
    };
    std::vector<Face> faces;
    faces.reserve(6 * mesh.hexahedra.size());
    for (const HexMesh::Hexahedron &hexahedron : mesh.hexahedra)
      for (const auto &corners : face_corners)
        {
          Face face;
          for (unsigned int v = 0; v < 4; ++v)
            face.face.nodes[v] = hexahedron.nodes[corners[v]];
          face.face.volume = hexahedron.volume;
          face.key         = face.face.nodes;
          std::sort(face.key.begin(), face.key.end());
          faces.push_back(face);
        }
    std::sort(faces.begin(), faces.end(), [](const Face &a, const Face &b) { return a.key < b.key; });

    std::vector<OuterFace> result;
    for (std::size_t i = 0; i < faces.size();)
      {
        std::size_t end = i + 1;
        while (end < faces.size() && faces[end].key == faces[i].key)
          ++end;
        if (end == i + 1)
          result.push_back(faces[i].face);
        i = end;
      }
    return result;
  }

  FaceGeometry face_geometry(const HexMesh &mesh, const std::array<unsigned int, 4> &nodes)
  {
    const auto    &p = mesh.points;
    FaceGeometry   result{{{0., 0., 0.}}, {{0., 0., 0.}}};
    HexMesh::Point first, second; // diagonals
    for (unsigned int d = 0; d < 3; ++d)
      {
        for (const unsigned int node : nodes)
          result.centre[d] += p[node][d] / 4.;
        first[d]  = p[nodes[2]][d] - p[nodes[0]][d];
        second[d] = p[nodes[3]][d] - p[nodes[1]][d];
      }
    for (unsigned int d = 0; d < 3; ++d)
      result.area_normal[d] = (first[(d + 1) % 3] * second[(d + 2) % 3] - first[(d + 2) % 3] * second[(d + 1) % 3]) / 2.;
    return result;
  }
} // namespace Squeal
