// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include "scenes.h"

#include <squeal/geometry/mesh.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace Squeal::Testing
{
  /// Cells into which a box is cut.
  enum class Cut
  {
    hexahedra,
    wedges,
    pyramids,
    tetrahedra,
    mixed ///< along x: wedges, hexahedra, pyramids with tetrahedra, then tetrahedra
  };

  inline constexpr Cut all_cuts[] = {Cut::hexahedra, Cut::wedges, Cut::pyramids, Cut::tetrahedra, Cut::mixed};

  struct Box
  {
    Cut                         cut;
    std::array<unsigned int, 3> n; ///< bricks per direction; at least 4 along x for mixed
    Mesh::Point                 lower, upper;
    double                      distortion; ///< largest shift of a corner relative to the brick size; faces of the box stay flat
    unsigned int                seed = 1;
  };

  /// Adds a volume of bricks, all cut in the same way, with the given names for its lower and upper faces in z.
  inline void add_box(Mesh &mesh, const Box &box, const std::string &volume, const std::array<std::string, 2> &surfaces)
  {
    std::mt19937                     random(box.seed);
    std::uniform_real_distribution<> shift(-box.distortion, box.distortion);
    const auto                      &n     = box.n;
    const unsigned int               first = mesh.points.size(), number = mesh.volume_names.size();
    const auto                       add_point = [&](const std::array<double, 3> &index) {
      Mesh::Point point;
      for (unsigned int d = 0; d < 3; ++d)
        {
          const bool is_inside = index[d] > 0. && index[d] < n[d];
          point[d] = box.lower[d] + (box.upper[d] - box.lower[d]) * (index[d] + (is_inside ? shift(random) : 0.)) / n[d];
        }
      mesh.points.push_back(point);
      return static_cast<unsigned int>(mesh.points.size() - 1);
    };
    const auto add_cell = [&](const Shape shape, const Mesh::Nodes &nodes) { mesh.cells.push_back({shape, nodes, number}); };
    for (unsigned int k = 0; k <= n[2]; ++k)
      for (unsigned int j = 0; j <= n[1]; ++j)
        for (unsigned int i = 0; i <= n[0]; ++i)
          add_point({{double(i), double(j), double(k)}});

    const Topology &brick = topology(Shape::hexahedron);
    for (unsigned int k = 0; k < n[2]; ++k)
      for (unsigned int j = 0; j < n[1]; ++j)
        for (unsigned int i = 0; i < n[0]; ++i)
          {
            const unsigned int part = box.cut == Cut::mixed ? std::min(i, 3u) : 4; // along x
            Mesh::Nodes        v;
            for (const Mesh::Point &corner : brick.corners)
              v.push_back(first + i + std::lround(corner[0]) +
                          (n[0] + 1) * (j + std::lround(corner[1]) + (n[1] + 1) * (k + std::lround(corner[2]))));
            if (box.cut == Cut::hexahedra || part == 1)
              add_cell(Shape::hexahedron, v);
            else if (box.cut == Cut::wedges || part == 0)
              {
                add_cell(Shape::wedge, {v[0], v[1], v[2], v[4], v[5], v[6]});
                add_cell(Shape::wedge, {v[0], v[2], v[3], v[4], v[6], v[7]});
              }
            else
              {
                // Divide around a central node into pyramids or, by the diagonal from the lowest node of each face, into tetrahedra. The
                // face towards the hexahedra begins with nodes 0 and 4
                const unsigned int centre = add_point({{i + 0.5, j + 0.5, k + 0.5}});
                for (unsigned int face = 0; face < 6; ++face)
                  {
                    std::array<unsigned int, 4> f;
                    std::transform(brick.faces[face].begin(), brick.faces[face].end(), f.begin(), [&](const unsigned c) { return v[c]; });
                    std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
                    if (box.cut == Cut::pyramids || (part == 2 && brick.faces[face][1] == 4))
                      add_cell(Shape::pyramid, {f[0], f[3], f[2], f[1], centre});
                    else
                      for (const unsigned int c : {1, 2})
                        add_cell(Shape::tetrahedron, {f[0], f[c + 1], f[c], centre});
                  }
              }
          }

    mesh.volume_names.push_back(volume);
    find_bodies(mesh);
    for (const unsigned int side : {0, 1})
      {
        const double z = (side == 0 ? box.lower : box.upper)[2];
        mesh.surface_names.push_back(surfaces[side]);
        for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell)
          if (mesh.cells[cell].volume == number)
            for (const auto &corners : topology(mesh.cells[cell].shape).faces)
              {
                Mesh::Nodes nodes;
                for (const unsigned int corner : corners)
                  nodes.push_back(mesh.cells[cell].nodes[corner]);
                if (std::all_of(nodes.begin(), nodes.end(), [&](const unsigned int node) { return mesh.points[node][2] == z; }))
                  mesh.faces.push_back({shape_of_face(nodes.size()), nodes, unsigned(mesh.surface_names.size() - 1)});
              }
      }
  }

  // A disc block and a pin block on the two sides of an inclined plane

  inline const Eigen::Vector3d block_centre(1.15, 0.1, 0.02);
  inline const Eigen::Matrix3d block_turn =
    (Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(-0.2, Eigen::Vector3d::UnitX())).matrix();

  /// Two blocks of 0.3 m × 0.2 m × 0.2 m; the plane between them is normal to the third column of block_turn and contains block_centre.
  inline Mesh two_blocks(const Cut                                         disc,
                         const Cut                                         pin,
                         const std::array<std::array<unsigned int, 3>, 2> &bricks,
                         const double                                      distortion,
                         const std::string                                &end_of_pin)
  {
    Mesh mesh;
    add_box(mesh, {disc, bricks[0], {-0.15, -0.1, -0.1}, {0.15, 0.1, 0.}, distortion, 1}, "disc", {{"disc_bore", "disc_contact"}});
    add_box(mesh, {pin, bricks[1], {-0.15, -0.1, 0.}, {0.15, 0.1, 0.1}, distortion, 2}, "pin_top_1", {{"pin_contact", end_of_pin}});
    return mapped(mesh, [](const Point3 &p) {
      const Eigen::Vector3d x = block_centre + block_turn * Eigen::Vector3d::Map(p.data());
      return Point3{{x[0], x[1], x[2]}};
    });
  }
} // namespace Squeal::Testing
