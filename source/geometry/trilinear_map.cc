#include <squeal/geometry/trilinear_map.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Squeal
{
  namespace
  {
    /// Of the nodes, in Gmsh's order.
    constexpr int signs[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};

    constexpr int    max_steps         = 20;
    constexpr double negligible_change = 1e-8;
    constexpr double far               = 2.5; // the next node of a regular grid is at 3

    double largest(const dealii::Tensor<1, 3> &xi)
    {
      return std::max({std::abs(xi[0]), std::abs(xi[1]), std::abs(xi[2])});
    }
  } // namespace

  TrilinearMap::TrilinearMap(const HexMesh &mesh, const HexMesh::Hexahedron &hexahedron)
  {
    for (unsigned int v = 0; v < 8; ++v)
      {
        const Vector x              = mesh.points[hexahedron.nodes[v]] / 8.;
        const auto &[xi, eta, zeta] = signs[v];
        const int monomials[8]      = {1, xi, eta, zeta, xi * eta, eta * zeta, zeta * xi, xi * eta * zeta};
        for (unsigned int m = 0; m < 8; ++m)
          a[m] += double(monomials[m]) * x;
      }
    central_inverse = invert(jacobian({}));
  }

  TrilinearMap::Vector TrilinearMap::position(const Vector &xi) const
  {
    return a[0] + xi[0] * (a[1] + xi[1] * a[4]) + xi[1] * (a[2] + xi[2] * a[5]) + xi[2] * (a[3] + xi[0] * a[6]) +
           xi[0] * xi[1] * xi[2] * a[7];
  }

  TrilinearMap::Jacobian TrilinearMap::jacobian(const Vector &xi) const
  {
    const Vector columns[3] = {a[1] + xi[1] * a[4] + xi[2] * a[6] + xi[1] * xi[2] * a[7],
                               a[2] + xi[0] * a[4] + xi[2] * a[5] + xi[0] * xi[2] * a[7],
                               a[3] + xi[1] * a[5] + xi[0] * a[6] + xi[0] * xi[1] * a[7]};
    Jacobian     result;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        result[i][j] = columns[j][i];
    return result;
  }

  std::optional<Depth> TrilinearMap::depth(const HexMesh::Point &point) const
  {
    const Vector x(point);
    Vector       xi = central_inverse * (x - a[0]);
    for (int step = 0; step < max_steps; ++step)
      {
        if (!(largest(xi) < far))
          return {};
        const Jacobian inverse = invert(jacobian(xi));
        const Vector   change  = inverse * (x - position(xi));
        xi += change;
        if (largest(change) < negligible_change)
          {
            // Row i of the inverse is the gradient of coordinate i; outside, where it may be singular, the nearest point counts
            Depth  depth{1., std::numeric_limits<double>::infinity()};
            Vector nearest;
            for (unsigned int i = 0; i < 3; ++i)
              {
                const double inside = 1. - std::abs(xi[i]);
                nearest[i]          = std::max(-1., std::min(1., xi[i]));
                depth.relative      = std::min(depth.relative, inside / 2.);
                depth.length        = std::min(depth.length, inside / inverse[i].norm());
              }
            if (depth.relative < 0.)
              depth.length = -(x - position(nearest)).norm();
            return depth;
          }
      }
    return {};
  }
} // namespace Squeal
