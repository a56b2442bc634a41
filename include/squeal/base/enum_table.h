#pragma once

#include <array>
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

  /**
   * Names of an enumeration, stated once: specialised beside each enum as
   * `static constexpr std::array names`; parser, printing and documentation
   * all read it.
   */
  template <typename Enum>
  struct EnumTable;

  /// The name of @p value.
  template <typename Enum>
  std::string to_string(const Enum value)
  {
    for (const auto &entry : EnumTable<Enum>::names)
      if (entry.value == value)
        return std::string(entry.name);
    return "?";
  }

  /// All names in their order.
  template <typename Enum>
  std::vector<std::string> enum_names()
  {
    std::vector<std::string> names;
    for (const auto &entry : EnumTable<Enum>::names)
      names.emplace_back(entry.name);
    return names;
  }

  /// The value called @p name, which must be one of enum_names().
  template <typename Enum>
  Enum enum_value(const std::string &name)
  {
    for (const auto &entry : EnumTable<Enum>::names)
      if (entry.name == name)
        return entry.value;
    return EnumTable<Enum>::names.front().value;
  }
} // namespace Squeal
