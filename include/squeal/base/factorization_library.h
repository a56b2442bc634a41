#pragma once

#include <squeal/base/enum_table.h>

namespace Squeal
{
  /// Libraries that factorise sparse matrices.
  enum class FactorizationLibrary
  {
    automatic, ///< CHOLMOD or UMFPACK on one process, MUMPS on several
    cholmod,   ///< symmetric positive definite, one process
    umfpack,   ///< general, one process
    mumps      ///< any matrix, any number of processes
  };

  template <>
  inline constexpr EnumName<FactorizationLibrary> enum_table<FactorizationLibrary>[] = {{FactorizationLibrary::automatic, "automatic"},
                                                                                        {FactorizationLibrary::cholmod, "CHOLMOD"},
                                                                                        {FactorizationLibrary::umfpack, "UMFPACK"},
                                                                                        {FactorizationLibrary::mumps, "MUMPS"}};
} // namespace Squeal
