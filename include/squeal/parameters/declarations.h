// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace Squeal
{
  /// Inclusive bounds of a number.
  struct Range
  {
    double least    = -std::numeric_limits<double>::infinity();
    double greatest = std::numeric_limits<double>::infinity();

    bool contains(double value) const;
  };

  /// A parameter, bound to the member that holds its value.
  struct DeclaredParameter
  {
    std::string path;          ///< "Section/Name"
    std::string documentation; ///< ends with "Units: m." for numbers
    std::string accepted;      ///< "a number in 0 ... 10", "one of positive, negative", ...; empty: see the documentation

    std::function<std::string()> print; ///< value as a string that parse() reads back unchanged

    /// Sets the value. Throws ParameterError, for example "Operation/Friction coefficient must lie in 0 ... 10, not -0.1".
    std::function<void(const std::string &)> parse;
  };

  /// Parameters in the order of declaration. The bound members must outlive this object.
  class Declarations
  {
  public:
    /// Begins a section for the following declarations.
    void enter(const std::string &section);

    /// A number; @p unit is "none" for a number without a unit.
    void add(const std::string &name, double &value, const std::string &unit, const std::string &documentation, const Range &range = {});
    void add(const std::string &name,
             unsigned int      &value,
             const std::string &unit,
             const std::string &documentation,
             const Range       &range = {0.});
    void add(const std::string &name, bool &value, const std::string &documentation);
    void add(const std::string &name, std::string &value, const std::string &documentation);

    /// Numbers separated by commas.
    void add(const std::string   &name,
             std::vector<double> &values,
             const std::string   &unit,
             const std::string   &documentation,
             const Range         &range        = {},
             std::size_t          most_numbers = std::numeric_limits<std::size_t>::max());

    template <typename Enum>
    void add(const std::string &name, Enum &value, const std::string &documentation)
    {
      add_choice(
        name, enum_names<Enum>(), documentation, [&value] { return to_string(value); },
        [&value](const std::string &text) { value = enum_value<Enum>(text); });
    }

    /// One of several names; @p parse receives only these names.
    void add_choice(const std::string                              &name,
                    const std::vector<std::string>                 &names,
                    const std::string                              &documentation,
                    const std::function<std::string()>             &print,
                    const std::function<void(const std::string &)> &parse);

    /// A string in a format that @p print and @p parse define.
    void add_text(const std::string                              &name,
                  const std::string                              &documentation,
                  const std::function<std::string()>             &print,
                  const std::function<void(const std::string &)> &parse);

    const std::vector<DeclaredParameter> &parameters() const;

    /// Parameter with this path; null if there is none.
    const DeclaredParameter *find(const std::string &path) const;

  private:
    std::string                    section; ///< "Section/"
    std::vector<DeclaredParameter> declared;
  };
} // namespace Squeal
