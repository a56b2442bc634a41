#pragma once

#include <squeal/contact/contact_operators.h>
#include <squeal/model/model.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace Squeal
{
  /// Cells with shared vertices, as a file of fields has them. All nodes are vertices: elements of degree p are p³ hexahedra.
  struct FieldMesh
  {
    std::vector<unsigned int> nodes;      ///< vertices: numbers in Model::nodes()
    unsigned int              corners;    ///< of a cell: 8 for hexahedra, 4 for quadrilaterals
    std::vector<std::int32_t> cells;      ///< places in @p nodes, cell by cell in the order of VTK
    std::vector<std::int32_t> components; ///< of each cell, see Node

    unsigned int n_cells() const
    {
      return components.size();
    }
  };

  /// All bodies, or those of a component.
  FieldMesh body_mesh(const Model &model, const std::optional<Component> &component);

  /// The pins' contact faces; vertices are the pins' nodes of the contact pairs, in their order.
  FieldMesh contact_face_mesh(const Model &model, const ContactInterface &interface);
} // namespace Squeal
