// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/choices.h>
#include <squeal/geometry/mesh.h>
#include <squeal/linear_algebra/row_map.h>

#include <boost/serialization/array.hpp>
#include <boost/serialization/vector.hpp>

#include <mpi.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace Squeal
{
  /// Dofs of a node and its weight in a sum.
  struct WeightedDofs
  {
    std::array<int, 3> dofs; ///< free dof numbers; -1: clamped
    double             weight;

    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &dofs &weight;
    }
  };

  /// A finite element node: a support point of the displacement with three dofs.
  struct Node
  {
    std::array<double, 3>     position;  ///< [m]
    std::array<int, 3>        dofs;      ///< free dof numbers; -1: clamped or tied
    unsigned int              component; ///< 0: the disc; k ≥ 1: pin k
    std::int64_t              number;    ///< unique over all processes; ascends in the order of the cells
    bool                      is_own;    ///< true if owned by this process, which then owns the rows of its dofs; every node has one owner
    std::vector<WeightedDofs> masters;   ///< masters of a tied node, u = Σ weight u_master; empty for other nodes

    bool is_clamped() const
    {
      return dofs[0] < 0 && masters.empty();
    }

    /// Calls visit(dof, weight) for each free dof in the weighted sum for the displacement along axis @p direction.
    template <typename Visit>
    void for_each_dof(const unsigned int direction, const Visit &visit) const
    {
      if (dofs[direction] >= 0)
        visit(dofs[direction], 1.);
      for (const WeightedDofs &master : masters)
        if (master.dofs[direction] >= 0)
          visit(master.dofs[direction], master.weight);
    }

    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &position &dofs &component &number &is_own &masters;
    }
  };

  /// A Lagrange element of the model's degree: a cell or a face.
  struct NodalElement
  {
    Shape        shape;
    Mesh::Nodes  nodes;     ///< indices into the nodes of the model
    unsigned int component; ///< see Node::component
    std::int64_t number;    ///< unique over all processes; ascends in the order of the cells
    bool         is_own;    ///< true if owned by this process; every element has one owner
  };

  struct Cell : NodalElement
  {
    unsigned int volume; ///< index into volume_names()
  };

  /// A face of only one cell. Its normal by the right-hand rule points outwards.
  struct Face : NodalElement
  {
    std::vector<unsigned int> surfaces; ///< indices of the named surfaces that contain the face
  };

  /**
   * The discretised bodies: isoparametric cells and outer faces, with nodal displacement dofs. Clamped and tied dofs have no number and no
   * rows in the matrices.
   *
   * The model is distributed: a process has the cells that it owns and all other cells that contribute to its rows, with their faces.
   * Process 0 partitions the mesh.
   */
  class Model
  {
  public:
    /**
     * @param mesh         mesh with named parts; processes other than 0 need only the names
     * @param element      finite element; for degree 2, the mesh is extended by second_order()
     * @param communicator processes that share the work
     */
    Model(const Mesh &mesh, Element element, MPI_Comm communicator);

    Element element() const
    {
      return element_type;
    }

    unsigned int degree() const
    {
      return degree_of(element_type);
    }

    MPI_Comm communicator() const
    {
      return processes;
    }

    /// Names of the bodies, the disc first.
    const std::vector<std::string> &component_names() const
    {
      return components;
    }

    const std::vector<std::string> &volume_names() const
    {
      return volumes;
    }

    std::vector<unsigned int> volumes_of(unsigned int component) const;

    /// Nodes of the cells of this process, in the order of the cells.
    const std::vector<Node> &nodes() const
    {
      return node_table;
    }

    const std::vector<Cell> &cells() const
    {
      return cell_table;
    }

    const std::vector<Face> &faces() const
    {
      return face_table;
    }

    /// Faces of a named surface; throws a MeshError that lists all surfaces if there is no surface of this name.
    std::vector<const Face *> faces_of(const std::string &surface) const;

    /// Nodes of all processes in the order of their numbers, on process 0 only; used for output files of small models.
    std::vector<Node> gathered_nodes() const;

    /// Distribution of the free dofs.
    const RowMap &free_map() const
    {
      return map;
    }

    /// Number of all dofs, including clamped and tied dofs.
    unsigned int n_dofs() const
    {
      return n_all_dofs;
    }

    /// Notes for the user on the coupling of tied faces; on process 0 only.
    const std::vector<std::string> &notes() const
    {
      return tied_notes;
    }

  private:
    std::vector<std::string>  components, volumes, surfaces, tied_notes;
    std::vector<unsigned int> component_of_volume;
    Element                   element_type;
    MPI_Comm                  processes;
    std::vector<Node>         node_table;
    std::vector<Cell>         cell_table;
    std::vector<Face>         face_table;
    unsigned int              n_all_dofs;
    RowMap                    map;
  };
} // namespace Squeal
