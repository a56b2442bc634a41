// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace Squeal
{
  /// A value of an enumeration and its name in parameter files.
  template <typename Enum>
  struct EnumName
  {
    Enum             value;
    std::string_view name;
  };

  /// Names of an enumeration for parsing, printing and documentation; specialised next to each enum as an array of EnumName.
  template <typename Enum>
  inline constexpr std::nullptr_t enum_table = nullptr;

  template <typename Enum>
  std::string to_string(const Enum value)
  {
    for (const EnumName<Enum> &entry : enum_table<Enum>)
      if (entry.value == value)
        return std::string(entry.name);
    return "?";
  }

  template <typename Enum>
  std::vector<std::string> enum_names()
  {
    std::vector<std::string> names;
    for (const EnumName<Enum> &entry : enum_table<Enum>)
      names.emplace_back(entry.name);
    return names;
  }

  /// Value with this @p name, which must be one of enum_names().
  template <typename Enum>
  Enum enum_value(const std::string &name)
  {
    for (const EnumName<Enum> &entry : enum_table<Enum>)
      if (entry.name == name)
        return entry.value;
    return enum_table<Enum>[0].value;
  }
} // namespace Squeal
