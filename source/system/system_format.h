// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/system/terms.h>

namespace Squeal
{
  /// The entries `format` and `version` of system.json.
  inline constexpr const char *system_format         = "squeal system";
  inline constexpr int         system_format_version = 1;

  template <>
  inline constexpr EnumName<TermKind> enum_table<TermKind>[] = {{TermKind::body, "body"},
                                                                {TermKind::mount, "mount"},
                                                                {TermKind::rotation, "rotation"},
                                                                {TermKind::friction, "friction"},
                                                                {TermKind::circulatory, "circulatory"},
                                                                {TermKind::contact_damping, "contact damping"},
                                                                {TermKind::modal_damping, "modal damping"}};

  template <>
  inline constexpr EnumName<Symmetry> enum_table<Symmetry>[] = {{Symmetry::symmetric, "symmetric"}, {Symmetry::skew, "skew"}};

} // namespace Squeal
