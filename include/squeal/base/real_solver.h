#pragma once

#include <squeal/base/enum_table.h>

namespace Squeal
{
  /// Solvers of symmetric modes.
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
} // namespace Squeal
