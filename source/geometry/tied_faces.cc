// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/geometry/mortar.h>
#include <squeal/geometry/tied_faces.h>

#include <cmath>
#include <map>
#include <set>

namespace Squeal
{
  namespace
  {
    /// Smallest admissible fraction of a tied surface that is opposite the other surface [-].
    constexpr double least_tied = 0.2;

    /// Smaller coefficients of a row are rounding errors [-].
    constexpr double least_coefficient = 1e-13;

    /// A named surface with the mesh numbers of its nodes.
    struct NumberedPatch
    {
      SurfacePatch              patch;
      std::vector<unsigned int> numbers;
    };

    /// Named surface with outward faces and all their nodes; @p outer: all outer faces of the mesh.
    NumberedPatch patch_of(const Mesh &mesh, const std::vector<CellFace> &outer, const std::string &surface)
    {
      std::set<std::array<unsigned int, 4>> named;
      for (const Mesh::Face &face : mesh.faces)
        if (mesh.surface_names[face.surface] == surface)
          named.insert(face_key(face));
      NumberedPatch                        result;
      std::map<unsigned int, unsigned int> places;
      for (const CellFace &face : outer)
        if (named.count(face.key) > 0)
          {
            const Mesh::Cell &cell = mesh.cells[face.cell];
            SurfaceElement    element{shape_of_face(face.n_corners), {}};
            for (const unsigned int i : nodes_of_face(cell.shape, mesh.degree, face.number))
              {
                const auto [place, is_new] = places.emplace(cell.nodes[i], result.numbers.size());
                if (is_new)
                  {
                    result.numbers.push_back(cell.nodes[i]);
                    result.patch.points.push_back(mesh.points[cell.nodes[i]]);
                  }
                element.nodes.push_back(place->second);
              }
            result.patch.elements.push_back(element);
          }
      return result;
    }

    void merge_masters(SlaveRows &rows)
    {
      for (auto &[slave, row] : rows)
        {
          std::map<int, double> sums;
          for (const auto &[master, coefficient] : row)
            sums[master] += coefficient;
          row.clear();
          for (const auto &[master, coefficient] : sums)
            if (std::abs(coefficient) > least_coefficient)
              row.emplace_back(master, coefficient);
        }
    }
  } // namespace

  TiedNodes tied_nodes(const Mesh &mesh)
  {
    TiedNodes                   result;
    const std::vector<CellFace> outer = mesh.tied.empty() ? std::vector<CellFace>() : outer_faces(mesh);
    for (const auto &[first, second] : mesh.tied)
      {
        const std::string where = "parameter Contact/Tied, surfaces " + first + " and " + second;
        const auto        slave = patch_of(mesh, outer, first), master = patch_of(mesh, outer, second);
        const double      gap = largest_gap(slave.patch);
        Mortar            coupling;
        try
          {
            coupling = mortar(slave.patch, master.patch, gap);
          }
        catch (const MeshError &error)
          {
            throw MeshError(error.reason, where, error.change);
          }
        if (coupling.overlap_area < least_tied * coupling.slave_area)
          throw MeshError(text("only ", std::round(100. * coupling.overlap_area / coupling.slave_area),
                               " % of the first surface is opposite the ", "second one"),
                          where, "exchange the surfaces if the first one is larger, or correct their positions");
        for (const MortarRow &row : coupling.rows)
          {
            double self = 0.;
            for (const auto &[node, weight] : row.slave)
              if (node == row.node)
                self = weight;
            const auto [entry, is_new] = result.masters.emplace(slave.numbers[row.node], SlaveRows::mapped_type());
            if (!is_new)
              throw MeshError(text("a node of the first surface is tied twice, at (", slave.patch.points[row.node], ") m"), where,
                              "tie each face to only one other surface, or exchange the two surfaces of one tie");
            for (const auto &[node, weight] : row.master)
              entry->second.emplace_back(master.numbers[node], weight / self);
            for (const auto &[node, weight] : row.slave)
              if (node != row.node)
                entry->second.emplace_back(slave.numbers[node], -weight / self);
          }
        for (const std::string &note : coupling_notes(coupling, gap, first, second))
          result.notes.push_back(first + " / " + second + ", tied: " + note);
      }
    if (!resolve(result.masters))
      throw MeshError("tied faces depend on each other circularly", "parameter Contact/Tied", "exchange the two surfaces of one tie");
    merge_masters(result.masters);
    return result;
  }
} // namespace Squeal
