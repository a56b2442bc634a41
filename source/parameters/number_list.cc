// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/number_list.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <functional>
#include <regex>

namespace Squeal
{
  using dealii::Utilities::split_string_list;

  namespace
  {
    /// Two groups of digits joined by a single comma: "0,4", also in "pin: 0,4; ...", but not "1,2,3".
    struct JoinedDigits
    {
      std::string before, after;

      bool is_fraction() const
      {
        return after.size() > 1 && after.front() == '0' && (before.size() == 1 || before.front() != '0');
      }
      bool begins_with_zero() const
      {
        return before.find_first_not_of("+-0") == std::string::npos;
      }
    };

    std::vector<JoinedDigits> joined_digits(const std::string &text)
    {
      static const std::regex   joined(R"((^|[\s:;|=])([+-]?[0-9]{1,20}),([0-9]{1,20})(?=$|,?\s|[;|]|[eE][+-]?[0-9]))");
      std::vector<JoinedDigits> result;
      for (std::sregex_iterator match(text.begin(), text.end(), joined); match != std::sregex_iterator(); ++match)
        result.push_back({(*match)[2], (*match)[3]});
      return result;
    }

    std::ptrdiff_t n_spaced_commas(const std::string &text)
    {
      static const std::regex spaced(R"(\s,|,\s)");
      return std::distance(std::sregex_iterator(text.begin(), text.end(), spaced), std::sregex_iterator());
    }

    /// True if commas look like decimal commas. This applies if digits after a comma begin with zero, if semicolons separate the numbers,
    /// or if commas with and without blanks are mixed and commas without blanks occur more than once or after a zero.
    bool has_decimal_commas(const std::string &list, const std::vector<JoinedDigits> &joined)
    {
      if (joined.empty())
        return false;
      if (list.find(';') != std::string::npos || std::any_of(joined.begin(), joined.end(), std::mem_fn(&JoinedDigits::is_fraction)))
        return true;
      const auto n_commas = std::count(list.begin(), list.end(), ','), n_joined = static_cast<std::ptrdiff_t>(joined.size());
      return n_joined < n_commas && n_joined + n_spaced_commas(list) == n_commas &&
             (n_joined > 1 || std::any_of(joined.begin(), joined.end(), std::mem_fn(&JoinedDigits::begins_with_zero)));
    }
  } // namespace

  std::vector<std::string> split_numbers(const std::string &list, const std::string &what, const std::string &where)
  {
    if (const auto joined = joined_digits(list); has_decimal_commas(list, joined))
      throw ParameterError(what + " has commas that look like decimal commas: " + in_quotes(list), where,
                           "write decimal points, for example " + joined.front().before + "." + joined.front().after +
                             "; in a list of integers, put a blank after every comma");
    return split_string_list(list, ',');
  }

  std::string decimal_point_hint(const std::string &text)
  {
    const auto joined = joined_digits(text);
    return joined.empty() ? "" : "; write a decimal point: " + joined.front().before + "." + joined.front().after;
  }

  void check_distinct(const std::vector<double> &numbers, const char *parameter)
  {
    for (auto number = numbers.begin(); number != numbers.end(); ++number)
      if (std::find(numbers.begin(), number, *number) != number)
        throw ParameterError(exact_text(*number) + " is given twice in " + in_quotes(exact_text(numbers)),
                             std::string("parameter ") + parameter, "give each value once; write decimals with a point, not a comma");
  }

  void ListFormat::refuse(const std::string &what, const std::string &list) const
  {
    throw ParameterError(what, std::string("parameter ") + parameter, std::string("write ") + text + decimal_point_hint(list));
  }

  std::vector<ListEntry> parse_list(const std::string &text, const ListFormat &format)
  {
    const bool             has_key = *format.key != '\0';
    const std::string      where   = std::string("parameter ") + format.parameter;
    std::set<std::string>  seen;
    std::vector<ListEntry> entries;
    for (const std::string &part : split_string_list(text, format.separator))
      {
        if (part.empty())
          continue;
        const auto halves = has_key ? split_string_list(part, ':') : std::vector<std::string>{"", part};
        const auto values = halves.size() != 2            ? std::vector<std::string>() :
                            format.between_numbers == ',' ? split_numbers(halves[1], format.parameter, where) :
                                                            split_string_list(halves[1], format.between_numbers);
        if (format.n_numbers.count(values.size()) == 0)
          format.refuse(in_quotes(part) + " is " + format.refusal, text);
        ListEntry entry{part, halves[0], {}};
        if (has_key && entry.key.empty())
          format.refuse(in_quotes(part) + " is " + format.refusal + ": it lacks the name of a " + format.key);
        if (has_key && !seen.insert(entry.key).second)
          throw ParameterError(format.key + (" " + in_quotes(entry.key)) + " is given twice", where,
                               std::string("give each ") + format.key + " once");
        for (const std::string &value : values)
          if (const auto number = parse_number(value))
            entry.numbers.push_back(*number);
          else
            throw ParameterError(in_quotes(value) + " is not a finite number",
                                 where + (has_key ? std::string(", ") + format.key + " " + legible(entry.key) : ""),
                                 std::string("write ") + format.text + decimal_point_hint(text));
        entries.push_back(entry);
      }
    return entries;
  }
} // namespace Squeal
