// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>

namespace Squeal
{
  /// Eigensolvers for symmetric matrices.
  enum class RealSolver
  {
    lanczos, ///< block Lanczos
    anasazi, ///< block Krylov-Schur
    arpack   ///< implicitly restarted Lanczos, the paper's method
  };

  template <>
  inline constexpr EnumName<RealSolver> enum_table<RealSolver>[] = {{RealSolver::lanczos, "block Lanczos"},
                                                                    {RealSolver::anasazi, "Anasazi"},
                                                                    {RealSolver::arpack, "ARPACK"}};

  /// Libraries that factorise positive definite matrices.
  enum class FactorizationLibrary
  {
    automatic, ///< CHOLMOD on one process, MUMPS on several
    cholmod,   ///< for one process
    mumps      ///< for any number of processes
  };

  template <>
  inline constexpr EnumName<FactorizationLibrary> enum_table<FactorizationLibrary>[] = {{FactorizationLibrary::automatic, "automatic"},
                                                                                        {FactorizationLibrary::cholmod, "CHOLMOD"},
                                                                                        {FactorizationLibrary::mumps, "MUMPS"}};

  /// Hexahedral finite elements.
  enum class Element
  {
    trilinear,          ///< 8 nodes, straight edges
    incompatible_modes, ///< trilinear with additional quadratic displacements inside each element (model/cell_stiffness.h)
    quadratic           ///< 27 nodes, curved edges on the cylinders disc_bore, disc_rim and pin_side
  };

  template <>
  inline constexpr EnumName<Element> enum_table<Element>[] = {{Element::trilinear, "trilinear"},
                                                              {Element::incompatible_modes, "incompatible modes"},
                                                              {Element::quadratic, "quadratic"}};

  constexpr unsigned int degree_of(const Element element)
  {
    return element == Element::quadratic ? 2 : 1;
  }
} // namespace Squeal
