// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/declarations.h>
#include <squeal/parameters/number_list.h>

#include <boost/algorithm/string/join.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace Squeal
{
  namespace
  {
    std::string with_unit(const std::string &documentation, const std::string &unit)
    {
      return documentation + " Units: " + unit + ".";
    }

    [[noreturn]] void refuse(const std::string &path, const std::string &demand, const std::string &value, const std::string &accepted)
    {
      const std::string given = value.empty() ? "but is empty" : "not " + (parse_number(value) ? legible(value) : in_quotes(value));
      throw ParameterError(path + " must " + demand + ", " + given, "",
                           "give " + accepted + decimal_point_hint(value) + "; squeal --print-parameters describes the parameter");
    }

    /// A type of number, and its description in messages.
    struct NumberKind
    {
      NumberKind(const Range &range, const bool is_integer, const std::string &unit)
        : range(range)
        , is_integer(is_integer)
        , unit(unit == "none" || unit.find_first_of(", ") != std::string::npos ? "" : " " + unit)
      {}

      Range       range;
      bool        is_integer;
      std::string unit; ///< unit after a blank; empty without a unit or with several units

      /// Bounds as text: "0 ... 10", ">= 0" or "<= 10"; empty if there are none.
      std::string bounds() const
      {
        if (std::isfinite(range.least) && std::isfinite(range.greatest))
          return exact_text(range.least) + " ... " + exact_text(range.greatest);
        return std::isfinite(range.least)    ? ">= " + exact_text(range.least) :
               std::isfinite(range.greatest) ? "<= " + exact_text(range.greatest) :
                                               "";
      }

      bool has_both_bounds() const
      {
        return bounds().find("...") != std::string::npos;
      }

      /// "a number in 0 ... 10 m" for the noun "a number".
      std::string accepted(const std::string &noun) const
      {
        const bool in = bounds().empty() ? !unit.empty() : has_both_bounds();
        return noun + (in ? " in" : "") + (bounds().empty() ? "" : " ") + bounds() + unit;
      }

      /// Parses a number. Throws a ParameterError that names @p path if the string or the value is invalid.
      double parse(const std::string &path, const std::string &text) const
      {
        constexpr int     largest_integer = std::numeric_limits<int>::max();
        const std::string wanted          = accepted(is_integer ? "an integer" : "a number");
        const auto        number          = parse_number(text);
        if (number && is_integer && *number > largest_integer)
          refuse(path, "be at most " + std::to_string(largest_integer) + unit, text, wanted);
        if (number && !range.contains(*number))
          refuse(path, (has_both_bounds() ? "lie in " : "be ") + bounds() + unit, text, wanted);
        if (!number || (is_integer && text.find_first_not_of("+-0123456789") != std::string::npos))
          refuse(path, "be " + wanted, text, wanted);
        return *number;
      }
    };
  } // namespace

  bool Range::contains(const double value) const
  {
    return value >= least && value <= greatest;
  }

  void Declarations::enter(const std::string &name)
  {
    section = name + "/";
  }

  void Declarations::add(const std::string &name,
                         double            &value,
                         const std::string &unit,
                         const std::string &documentation,
                         const Range       &range)
  {
    const NumberKind  kind(range, false, unit);
    const std::string path = section + name;
    declared.push_back({path, with_unit(documentation, unit), kind.accepted("a number"), [&value] { return exact_text(value); },
                        [&value, kind, path](const std::string &text) { value = kind.parse(path, text); }});
  }

  void Declarations::add(const std::string &name,
                         unsigned int      &value,
                         const std::string &unit,
                         const std::string &documentation,
                         const Range       &range)
  {
    const NumberKind  kind(range, true, unit);
    const std::string path = section + name;
    declared.push_back({path, with_unit(documentation, unit), kind.accepted("an integer"), [&value] { return std::to_string(value); },
                        [&value, kind, path](const std::string &text) { value = static_cast<unsigned int>(kind.parse(path, text)); }});
  }

  void Declarations::add(const std::string   &name,
                         std::vector<double> &values,
                         const std::string   &unit,
                         const std::string   &documentation,
                         const Range         &range,
                         const std::size_t    most_numbers)
  {
    const NumberKind  kind(range, false, unit);
    const std::string path = section + name, accepted = kind.accepted("numbers") + ", separated by commas";
    declared.push_back({path, with_unit(documentation, unit), accepted, [&values] { return exact_text(values); },
                        [&values, kind, path, accepted, most_numbers](const std::string &text) {
                          const auto parts = split_numbers(text, path, "");
                          if (parts.size() > most_numbers)
                            throw ParameterError(path + " has " + std::to_string(parts.size()) + " values, but accepts at most " +
                                                   std::to_string(most_numbers),
                                                 "", "give at most " + std::to_string(most_numbers) + " " + accepted);
                          values.clear();
                          for (const std::string &part : parts)
                            values.push_back(kind.parse(path + ", value " + std::to_string(values.size() + 1) + ",", part));
                        }});
  }

  void Declarations::add(const std::string &name, bool &value, const std::string &documentation)
  {
    const std::string path = section + name, accepted = "true or false";
    declared.push_back({path, documentation, accepted, [&value] { return value ? "true" : "false"; },
                        [&value, path, accepted](const std::string &text) {
                          if (text != "true" && text != "false")
                            refuse(path, "be " + accepted, text, accepted);
                          value = text == "true";
                        }});
  }

  void Declarations::add(const std::string &name, std::string &value, const std::string &documentation)
  {
    add_text(
      name, documentation, [&value] { return value; }, [&value](const std::string &text) { value = text; });
  }

  void Declarations::add_choice(const std::string                              &name,
                                const std::vector<std::string>                 &names,
                                const std::string                              &documentation,
                                const std::function<std::string()>             &print,
                                const std::function<void(const std::string &)> &parse)
  {
    const std::string path = section + name, accepted = "one of " + boost::algorithm::join(names, ", ");
    declared.push_back({path, documentation, accepted, print, [=](const std::string &text) {
                          if (std::find(names.begin(), names.end(), text) == names.end())
                            refuse(path, "be " + accepted, text, accepted);
                          parse(text);
                        }});
  }

  void Declarations::add_text(const std::string                              &name,
                              const std::string                              &documentation,
                              const std::function<std::string()>             &print,
                              const std::function<void(const std::string &)> &parse)
  {
    declared.push_back({section + name, documentation, "", print, parse});
  }

  const std::vector<DeclaredParameter> &Declarations::parameters() const
  {
    return declared;
  }

  const DeclaredParameter *Declarations::find(const std::string &path) const
  {
    const auto found = std::find_if(declared.begin(), declared.end(), [&](const DeclaredParameter &other) { return other.path == path; });
    return found == declared.end() ? nullptr : &*found;
  }
} // namespace Squeal
