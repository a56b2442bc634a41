#pragma once

#include <squeal/base/enum_table.h>

namespace Squeal
{
  /// Files in which shapes of modes are written.
  enum class FieldFormat
  {
    xdmf, ///< XDMF with HDF5: the mesh once, single precision, compressed
    vtu   ///< a file of VTK for each mode, with the mesh
  };

  template <>
  inline constexpr EnumName<FieldFormat> enum_table<FieldFormat>[] = {{FieldFormat::xdmf, "XDMF"}, {FieldFormat::vtu, "VTU"}};
} // namespace Squeal
