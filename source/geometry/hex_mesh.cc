#include <squeal/base/exceptions.h>
#include <squeal/geometry/hex_mesh.h>

#include <deal.II/base/geometry_info.h>

#include <boost/algorithm/string/join.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

namespace Squeal
{
  namespace
  {
    /// FNV-1a with 64 bits.
    std::uint64_t hash(const std::string_view bytes)
    {
      std::uint64_t result = 0xcbf29ce484222325ull;
      for (const char byte : bytes)
        result = (result ^ static_cast<unsigned char>(byte)) * 0x100000001b3ull;
      return result;
    }
  } // namespace

  std::uint64_t checksum(const HexMesh &mesh)
  {
    double size = 0.;
    for (const HexMesh::Point &point : mesh.points)
      size = std::max(size, point.norm());
    // A power of ten, which rounding of the size does not change
    const double unit = 1e-8 * std::pow(10., std::floor(std::log10(size)));
    std::string  places;
    for (const HexMesh::Point &point : mesh.points)
      for (unsigned int d = 0; d < 3; ++d)
        places += std::to_string(std::llround(point[d] / unit)) + ' ';
    return hash(places);
  }

  std::vector<unsigned int> volume_of_nodes(const HexMesh &mesh)
  {
    std::vector<unsigned int> volumes(mesh.points.size(), 0);
    for (const HexMesh::Hexahedron &hexahedron : mesh.hexahedra)
      for (const unsigned int node : hexahedron.nodes)
        volumes[node] = hexahedron.volume;
    return volumes;
  }

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

  std::optional<Depth> depth_in_cell(const HexMesh &mesh, const HexMesh::Hexahedron &cell, const HexMesh::Point &point)
  {
    using Unit                          = dealii::GeometryInfo<3>;
    constexpr unsigned int deal_node[8] = {0, 1, 3, 2, 4, 5, 7, 6};
    constexpr int          max_steps    = 20;
    constexpr double       negligible = 5e-9, far = 1.25; // of coordinates from 0 to 1; the next node of a regular grid is at 1.5
    const auto             largest = [](const auto &v) { return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])}); };
    const HexMesh::Point   centre(0.5, 0.5, 0.5);
    const auto             offset = [&](const HexMesh::Point &xi) {
      dealii::Tensor<1, 3> x = point;
      for (unsigned int v = 0; v < 8; ++v)
        x -= Unit::d_linear_shape_function(xi, v) * mesh.points[cell.nodes[deal_node[v]]];
      return x;
    };

    HexMesh::Point xi = centre;
    for (int step = 0; step <= max_steps && largest(xi - centre) < far; ++step)
      {
        dealii::Tensor<2, 3> jacobian;
        for (unsigned int v = 0; v < 8; ++v)
          jacobian += outer_product(mesh.points[cell.nodes[deal_node[v]]], Unit::d_linear_shape_function_gradient(xi, v));
        const dealii::Tensor<2, 3> inverse = invert(jacobian);
        const dealii::Tensor<1, 3> change  = inverse * offset(xi);
        xi += change;
        if (largest(change) >= negligible)
          continue;
        // Row d of the inverse is the gradient of coordinate d; outside, where it may be singular, the nearest point counts
        Depth          depth{1., std::numeric_limits<double>::infinity()};
        HexMesh::Point nearest;
        for (unsigned int d = 0; d < 3; ++d)
          {
            const double inside = 0.5 - std::abs(xi[d] - 0.5);
            nearest[d]          = std::clamp(xi[d], 0., 1.);
            depth.relative      = std::min(depth.relative, inside);
            depth.length        = std::min(depth.length, inside / inverse[d].norm());
          }
        if (depth.relative < 0.)
          depth.length = -offset(nearest).norm();
        return depth;
      }
    return {};
  }

  unsigned int pin_number(const std::vector<std::string> &volume_names, const std::string &pin, const char *parameter)
  {
    const std::vector<std::string> pins(volume_names.begin() + 1, volume_names.end());
    const auto                     found = std::find(pins.begin(), pins.end(), pin);
    if (found == pins.end())
      throw ParameterError("there is no pin `" + pin + "`", std::string("parameter ") + parameter,
                           "name one of " + boost::algorithm::join(pins, ", "));
    return found - pins.begin() + 1;
  }
} // namespace Squeal
