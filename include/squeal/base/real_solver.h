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
  inline constexpr EnumName<RealSolver> enum_table<RealSolver>[] = {{RealSolver::anasazi, "Anasazi"}, {RealSolver::arpack, "ARPACK"}};
} // namespace Squeal
