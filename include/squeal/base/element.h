#pragma once

#include <squeal/base/enum_table.h>

namespace Squeal
{
  /// Hexahedra.
  enum class Element
  {
    trilinear,          ///< 8 nodes, straight edges
    incompatible_modes, ///< the same, with quadratic displacements inside each element (model/cell_stiffness.h)
    quadratic           ///< 27 nodes, edges that follow named cylinders
  };

  template <>
  inline constexpr EnumName<Element> enum_table<Element>[] = {{Element::trilinear, "trilinear"},
                                                              {Element::incompatible_modes, "incompatible modes"},
                                                              {Element::quadratic, "quadratic"}};

  /// Polynomial degree of the nodal displacements.
  constexpr unsigned int degree_of(const Element element)
  {
    return element == Element::quadratic ? 2 : 1;
  }
} // namespace Squeal
