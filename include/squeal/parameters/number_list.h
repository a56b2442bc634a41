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
   * Numbers of a list that are separated by commas, as texts. Throws ParameterError where some commas look like decimal ones, as in
   * "0,3, 0,4", "0,4, 1" and "0,05"; uniform lists such as "0,30" and "1,2,3" are what they are.
   *
   * @param what  the list, for a message: "Sweep/Count modes at"
   * @param where parameter or line
   */
  std::vector<std::string> split_numbers(const std::string &list, const std::string &what, const std::string &where);

  /// For the remedy of a refused text: "; write a decimal point: 0.4" where a number in it seems to have a decimal comma, else nothing.
  std::string decimal_point_hint(const std::string &text);

  /// Throws ParameterError where a number is given twice to a @p parameter, "Section/Name", that needs each once.
  void check_distinct(const std::vector<double> &numbers, const char *parameter);

  /// How a list of entries such as "disc_bore: 0, 7.8e10, 1.88e10; disc_rim: ..." is written.
  struct ListFormat
  {
    const char           *parameter; ///< "Section/Name"
    const char           *refusal;   ///< what a wrong entry is: "not an elastic mount"
    const char           *text;      ///< "surface: radial, tangential, axial; surface: ... [N/m^3]"
    const char           *key;       ///< what the name before the colon is: "surface"; empty where there is none
    std::set<std::size_t> n_numbers; ///< how many an entry may have
    char                  separator = ';', between_numbers = ',';

    /// Throws ParameterError with this format as the remedy; @p list: as written, where a decimal comma may be the reason.
    [[noreturn]] void refuse(const std::string &what, const std::string &list = "") const;
  };

  struct ListEntry
  {
    std::string         text; ///< as written
    std::string         key;
    std::vector<double> numbers;
  };

  /// The entries of a list, empty ones left out. Throws ParameterError, also where a name is given twice.
  std::vector<ListEntry> parse_list(const std::string &text, const ListFormat &format);

  /// Declares a list of values, whose @p numbers (members, or functions that return them) and @p key stand in an entry; numbers left out
  /// are zero.
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
