#pragma once

#include <squeal/base/enum_table.h>

#include <deal.II/base/parameter_handler.h>

namespace Squeal
{
  /// Declares an entry whose values are the names of an enumeration and binds it to @p value.
  template <typename Enum>
  void add_enum_parameter(dealii::ParameterHandler &prm, const std::string &name, Enum &value, const std::string &documentation)
  {
    prm.declare_entry(name, to_string(value), dealii::Patterns::Selection(enum_selection<Enum>()), documentation);
    prm.add_action(name, [&value](const std::string &text) { value = enum_value<Enum>(text); });
  }
} // namespace Squeal
