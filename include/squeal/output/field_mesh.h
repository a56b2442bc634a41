#pragma once

#include <squeal/contact/contact_operators.h>
#include <squeal/linear_algebra/row_delivery.h>
#include <squeal/model/model.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace Squeal
{
  /**
   * Cells with shared vertices, as a file of fields has them, a part of them on each process. All nodes are vertices: elements of degree p
   * are p³ hexahedra. Vertices and cells are in the order of the mesh, however that is distributed: the same file on any number of processes.
   */
  struct FieldMesh
  {
    std::vector<Node>                  nodes;      ///< vertices that this process writes; those of processes before come first in the file
    std::vector<Node>                  own;        ///< vertices whose displacements it has
    std::shared_ptr<const RowDelivery> delivery;   ///< from these to those
    unsigned int                       corners;    ///< of a cell: 8 for hexahedra, 4 for quadrilaterals
    std::vector<std::int32_t>          cells;      ///< places of vertices in the file, cell by cell in the order of VTK
    std::vector<std::int32_t>          components; ///< of each cell, see Node
    std::size_t                        n_all_nodes, n_all_cells; ///< of all processes

    /// Values of the vertices that this process writes, row by row, from those of its own ones, n_own × k. All processes must call.
    std::vector<float> delivered(const DenseMatrix &values) const;

    unsigned int n_cells() const
    {
      return components.size();
    }
  };

  /// All bodies, or those of a component. All processes must call.
  FieldMesh body_mesh(const Model &model, const std::optional<Component> &component);

  /// The pins' contact faces, all on process 0; vertices are the pins' nodes of the contact pairs, in their order.
  FieldMesh contact_face_mesh(const Model &model, const ContactInterface &interface);
} // namespace Squeal
