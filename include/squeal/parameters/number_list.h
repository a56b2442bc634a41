// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/text.h>
#include <squeal/parameters/declarations.h>

#include <boost/algorithm/string/join.hpp>

#include <functional>
#include <set>
#include <string>
#include <vector>

namespace Squeal
{
  /**
   * Splits a list into strings at commas. Throws ParameterError if some commas look like decimal commas, as in "0,3, 0,4", "0,4, 1" and
   * "0,05"; uniform lists such as "0,30" and "1,2,3" are accepted.
   *
   * @param what  name of the list, for messages: "Sweep/Count modes at"
   * @param where parameter or line
   */
  std::vector<std::string> split_numbers(const std::string &list, const std::string &what, const std::string &where);

  /// Hint for an error message: "; write a decimal point: 0.4" if a number seems to have a decimal comma; empty otherwise.
  std::string decimal_point_hint(const std::string &text);

  /// Throws a ParameterError that names @p parameter ("Section/Name") if a number occurs twice.
  void check_distinct(const std::vector<double> &numbers, const char *parameter);

  /// Format of a list of entries such as "disc_bore: 0, 7.8e10, 1.88e10; disc_rim: ...".
  struct ListFormat
  {
    const char           *parameter; ///< "Section/Name"
    const char           *refusal;   ///< description of an invalid entry: "not an elastic mount"
    const char           *text;      ///< "surface: radial, tangential, axial; surface: ... [N/m^3]"
    const char           *key;       ///< meaning of the name before the colon: "surface"; empty if there is none
    std::set<std::size_t> n_numbers; ///< permitted numbers of values in an entry
    char                  separator = ';', between_numbers = ',';

    /// Throws a ParameterError that quotes this format; a decimal comma in @p list adds a hint.
    [[noreturn]] void refuse(const std::string &what, const std::string &list = "") const;
  };

  struct ListEntry
  {
    std::string         text;
    std::string         key;
    std::vector<double> numbers;
  };

  /// Nonempty entries of a list. Throws ParameterError for invalid entries and for duplicate names.
  std::vector<ListEntry> parse_list(const std::string &text, const ListFormat &format);

  /// Declares a list of values; an entry has a @p key and @p numbers (members, or functions that return them). Omitted numbers are zero.
  template <typename Value>
  void declare_list(Declarations                                        &declarations,
                    const std::string                                   &name,
                    std::vector<Value>                                  &values,
                    const std::string                                   &documentation,
                    const ListFormat                                    &format,
                    const std::vector<std::function<double &(Value &)>> &numbers,
                    std::string Value::*key = nullptr)
  {
    declarations.add_text(
      name, documentation,
      [=, &values] {
        std::vector<std::string> entries;
        for (Value &value : values)
          {
            std::vector<std::string> texts;
            for (const auto &number : numbers)
              texts.push_back(exact_text(number(value)));
            entries.push_back((key ? value.*key + ": " : "") + boost::algorithm::join(texts, format.between_numbers + std::string(" ")));
          }
        return boost::algorithm::join(entries, format.separator + std::string(" "));
      },
      [=, &values](const std::string &text) {
        values.clear();
        for (const ListEntry &entry : parse_list(text, format))
          {
            values.emplace_back();
            if (key)
              values.back().*key = entry.key;
            for (std::size_t i = 0; i < entry.numbers.size(); ++i)
              numbers[i](values.back()) = entry.numbers[i];
          }
      });
  }
} // namespace Squeal
