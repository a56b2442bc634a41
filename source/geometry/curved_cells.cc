// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/geometry/cell_volume.h>
#include <squeal/geometry/curved_cells.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

namespace Squeal
{
  namespace
  {
    /// Rejects mid-edge nodes so far from the middle of their edge that the edge folds back or bulges beyond a half circle.
    void check_middles(const Mesh &mesh)
    {
      constexpr double                                    farthest = 0.5; // relative to the length of the edge
      std::set<unsigned int>                              off;
      std::optional<std::pair<std::size_t, unsigned int>> first; // element and node
      for (std::size_t element = 0; element < mesh.cells.size(); ++element)
        {
          const Mesh::Cell &cell    = mesh.cells[element];
          std::size_t       on_edge = topology(cell.shape).corners.size();
          for (const auto &[a, b] : topology(cell.shape).edges)
            {
              const unsigned int node = cell.nodes[on_edge++];
              const Mesh::Point &p = mesh.corner(cell, a), &q = mesh.corner(cell, b);
              if (mesh.points[node].distance(p + (q - p) / 2.) <= farthest * p.distance(q))
                continue;
              off.insert(node);
              first = first.value_or(std::pair(element, node));
            }
        }
      if (first)
        throw MeshError(text(counted(off.size(), "second-order node is", "second-order nodes are"),
                             " farther from the middle of the edge than half its length; one such node is at (", mesh.points[first->second],
                             ") m"),
                        describe_cell(mesh, first->first),
                        "move second-order nodes to the middle of their edges, or use smaller elements on curved surfaces");
    }

    /// Rejects edges and quadrilaterals whose middle nodes differ between neighbouring cells or are corners of other cells: the cells would
    /// separate.
    void check_shared_middles(const Mesh &mesh)
    {
      std::map<std::array<unsigned int, 4>, unsigned int> middles; // middle nodes by ascending corners; edges repeat each corner
      std::vector<bool>                                   is_corner(mesh.points.size(), false);
      std::set<std::size_t>                               unmatched; // indices of elements
      for (const Mesh::Cell &cell : mesh.cells)
        for (unsigned int v = 0; v < topology(cell.shape).corners.size(); ++v)
          is_corner[cell.nodes[v]] = true;
      for (std::size_t element = 0; element < mesh.cells.size(); ++element)
        {
          const Mesh::Cell &cell  = mesh.cells[element];
          const auto        check = [&](std::array<unsigned int, 4> corners, const unsigned int middle) {
            std::sort(corners.begin(), corners.end());
            if (is_corner[middle] || middles.emplace(corners, middle).first->second != middle)
              unmatched.insert(element);
          };
          std::size_t on_edge = topology(cell.shape).corners.size();
          for (const auto &[a, b] : topology(cell.shape).edges)
            check({{cell.nodes[a], cell.nodes[a], cell.nodes[b], cell.nodes[b]}}, cell.nodes[on_edge++]);
          for (unsigned int f = 0; f < topology(cell.shape).faces.size(); ++f)
            if (const auto &numbers = nodes_of_face(cell.shape, 2, f); numbers.size() == 9)
              check({{cell.nodes[numbers[0]], cell.nodes[numbers[1]], cell.nodes[numbers[2]], cell.nodes[numbers[3]]}},
                    cell.nodes[numbers[8]]);
        }
      if (!unmatched.empty())
        throw MeshError(text("Second-order nodes of ", unmatched.size(), " of ", mesh.cells.size(),
                             " elements differ from those of a neighbour on the same edge or face, or are corners of another element"),
                        describe_cell(mesh, *unmatched.begin()),
                        "merge second-order nodes as well as corners, and mesh neighbours with matching elements");
    }
  } // namespace

  void check_curved(const Mesh &mesh)
  {
    check_shared_middles(mesh);
    check_middles(mesh);
    std::vector<std::size_t> inverted;
    for (std::size_t element = 0; element < mesh.cells.size(); ++element)
      if (!(worst_determinant(mesh, mesh.cells[element]) > 0.))
        inverted.push_back(element);
    if (!inverted.empty())
      throw MeshError(text(inverted.size(), " of ", mesh.cells.size(), inverted.size() == 1 ? " elements is" : " elements are",
                           " folded by second-order nodes: the Jacobian determinant is negative or zero"),
                      describe_cell(mesh, inverted[0]),
                      "use smaller elements on curved surfaces, or optimise the elements in Gmsh (Mesh.HighOrderOptimize = 1)");
  }
} // namespace Squeal
