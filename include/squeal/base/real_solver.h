#pragma once

#include <squeal/base/enum_table.h>

namespace Squeal
{
  /// Solvers of symmetric modes.
  enum class RealSolver
  {
    lanczos, ///< block Lanczos
    anasazi, ///< block Krylov-Schur
    arpack,  ///< implicitly restarted Lanczos, the paper's method
    lobpcg   ///< preconditioned by multigrid: without any factor
  };

  template <>
  inline constexpr EnumName<RealSolver> enum_table<RealSolver>[] = {{RealSolver::lanczos, "block Lanczos"},
                                                                    {RealSolver::anasazi, "Anasazi"},
                                                                    {RealSolver::arpack, "ARPACK"},
                                                                    {RealSolver::lobpcg, "LOBPCG"}};

  /// How it is known that no mode is missing.
  enum class ModeCounting
  {
    inertia, ///< by the pivots of an LDLᵀ factor
    none     ///< not at all
  };

  template <>
  inline constexpr EnumName<ModeCounting> enum_table<ModeCounting>[] = {{ModeCounting::inertia, "inertia"}, {ModeCounting::none, "none"}};
} // namespace Squeal
