#pragma once

#include <squeal/base/enum_table.h>

namespace Squeal
{
  /// Libraries for symmetric modes.
  enum class RealSolver
  {
    anasazi, ///< block Krylov-Schur
    arpack   ///< implicitly restarted Lanczos, the paper's method
  };

  template <>
  struct EnumTable<RealSolver>
  {
    static constexpr std::array<EnumName<RealSolver>, 2> names = {{{RealSolver::anasazi, "Anasazi"}, {RealSolver::arpack, "ARPACK"}}};
  };
} // namespace Squeal
