#pragma once

#include <squeal/contact/contact_operators.h>
#include <squeal/model/model.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace Squeal
{
  /**
   * Cells of this process, or faces of them, with shared vertices, as a file of fields has them. All nodes are vertices: an element of degree p
   * is p³ hexahedra, a face of it p² quadrilaterals, whose normals point out of the body.
   */
  struct FieldMesh
  {
    unsigned int              corners;    ///< of a cell: 8 for hexahedra, 4 for quadrilaterals
    std::vector<Node>         nodes;      ///< vertices
    std::vector<std::int32_t> cells;      ///< places of their vertices among these, cell by cell in the order of VTK
    std::vector<std::int32_t> components; ///< of each cell, see Node
  };

  /// All bodies, or those of a component.
  FieldMesh body_mesh(const Model &model, const std::optional<Component> &component);

  /// The surface of all bodies.
  FieldMesh surface_mesh(const Model &model);

  /// The pins' contact faces.
  FieldMesh contact_face_mesh(const Model &model);
} // namespace Squeal
