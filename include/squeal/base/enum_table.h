// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace Squeal
{
  /// One value of an enumeration with the name that parameter files use.
  template <typename Enum>
  struct EnumName
  {
    Enum             value;
    std::string_view name;
  };

  /// Names of an enumeration, stated once: specialised beside each enum as an array of EnumName; parser, printing and documentation all read it.
  template <typename Enum>
  inline constexpr std::nullptr_t enum_table = nullptr;

  /// The name of @p value.
  template <typename Enum>
  std::string to_string(const Enum value)
  {
    for (const EnumName<Enum> &entry : enum_table<Enum>)
      if (entry.value == value)
        return std::string(entry.name);
    return "?";
  }

  /// All names in their order.
  template <typename Enum>
  std::vector<std::string> enum_names()
  {
    std::vector<std::string> names;
    for (const EnumName<Enum> &entry : enum_table<Enum>)
      names.emplace_back(entry.name);
    return names;
  }

  /// The value called @p name, which must be one of enum_names().
  template <typename Enum>
  Enum enum_value(const std::string &name)
  {
    for (const EnumName<Enum> &entry : enum_table<Enum>)
      if (entry.name == name)
        return entry.value;
    return enum_table<Enum>[0].value;
  }
} // namespace Squeal
