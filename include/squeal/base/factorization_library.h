#pragma once

#include <squeal/base/enum_table.h>

namespace Squeal
{
  /// Libraries that factorise sparse matrices, and what replaces them.
  enum class FactorizationLibrary
  {
    automatic, ///< CHOLMOD or UMFPACK on one process, MUMPS on several
    cholmod,   ///< symmetric positive definite, one process
    umfpack,   ///< general, one process
    mumps,     ///< any matrix, any number of processes
    multigrid  ///< none: symmetric positive definite systems by conjugate gradients with multigrid
  };

  template <>
  inline constexpr EnumName<FactorizationLibrary> enum_table<FactorizationLibrary>[] = {{FactorizationLibrary::automatic, "automatic"},
                                                                                        {FactorizationLibrary::cholmod, "CHOLMOD"},
                                                                                        {FactorizationLibrary::umfpack, "UMFPACK"},
                                                                                        {FactorizationLibrary::mumps, "MUMPS"},
                                                                                        {FactorizationLibrary::multigrid, "multigrid"}};
} // namespace Squeal
