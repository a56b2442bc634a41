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
  /// Dofs of a node with its factor in a sum.
  struct WeightedDofs
  {
    std::array<int, 3> dofs; ///< numbers among the free dofs; -1 where clamped
    double             weight;

    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &dofs &weight;
    }
  };

  /// One finite element node: a support point of the displacement, with its three dofs.
  struct Node
  {
    std::array<double, 3>     position;  ///< [m]
    std::array<int, 3>        dofs;      ///< numbers among the free dofs; -1 where clamped or tied
    unsigned int              component; ///< 0: the disc; k ≥ 1: pin k
    std::int64_t              number;    ///< tells the nodes of all processes apart; ascends in the order of the cells
    bool                      is_own;    ///< every node is that of one process, which has the rows of its dofs
    std::vector<WeightedDofs> masters;   ///< of a tied node: u = Σ weight u of these; empty for others

    bool is_clamped() const
    {
      return dofs[0] < 0 && masters.empty();
    }

    /// Calls visit(dof, weight) for each free dof of which the displacement along axis @p direction is the weighted sum.
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

  /// A Lagrange element of the model's degree: a cell, or a face of one.
  struct NodalElement
  {
    Shape        shape;
    Mesh::Nodes  nodes;     ///< places among the nodes of the model
    unsigned int component; ///< as that of a node
    std::int64_t number;    ///< tells those of all processes apart, ascends in the order of the cells
    bool         is_own;    ///< every one is that of one process
  };

  struct Cell : NodalElement
  {
    unsigned int volume; ///< index into volume_names()
  };

  /// A face that belongs to one cell only, outwards by the right-hand rule.
  struct Face : NodalElement
  {
    std::vector<unsigned int> surfaces; ///< that it is on: indices into the names of surfaces
  };

  /**
   * The discretised bodies: cells and outer faces on nodes with displacement dofs, numbered without the clamped and the tied ones, which
   * never reach a matrix. Cells are isoparametric.
   *
   * All is distributed: a process has its cells and those that meet at a node of its own, with their faces. Process 0 makes the parts.
   */
  class Model
  {
  public:
    /**
     * @param mesh         with named parts; other processes than 0 need the names only
     * @param element      of degree 2: see second_order()
     * @param communicator processes that share the work
     */
    Model(const Mesh &mesh, Element element, MPI_Comm communicator);

    Element element() const
    {
      return element_type;
    }

    /// Polynomial degree of the nodal displacements.
    unsigned int degree() const
    {
      return degree_of(element_type);
    }

    MPI_Comm communicator() const
    {
      return processes;
    }

    /// Names of the bodies, the disc's first.
    const std::vector<std::string> &component_names() const
    {
      return components;
    }

    /// Names of the volumes of which the bodies are made.
    const std::vector<std::string> &volume_names() const
    {
      return volumes;
    }

    /// Those of a body.
    std::vector<unsigned int> volumes_of(unsigned int component) const;

    /// Nodes of the cells that this process has, in the order of these.
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

    /// Those of a named surface; throws MeshError naming the known surfaces if there is none of this name.
    std::vector<const Face *> faces_of(const std::string &surface) const;

    /// Nodes of all processes in the order of their numbers, on process 0: for files of small models.
    std::vector<Node> gathered_nodes() const;

    /// Distribution of the free dofs.
    const RowMap &free_map() const
    {
      return map;
    }

    /// Number of all dofs, clamped and tied ones included.
    unsigned int n_dofs() const
    {
      return n_all_dofs;
    }

    /// How tied faces were coupled, for the user; on process 0.
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
