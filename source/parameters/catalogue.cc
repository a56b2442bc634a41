#include <squeal/base/text.h>
#include <squeal/parameters/catalogue.h>

#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

namespace Squeal
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    void collect(const Json &node, const std::string &path, std::vector<CataloguedParameter> &parameters)
    {
      for (const auto &[name, child] : node.items())
        if (const auto pattern = child.find("pattern_description"); pattern != child.end() && pattern->is_string())
          parameters.push_back({path + name, child.at("value"), child.at("documentation"), *pattern});
        else
          collect(child, path + name + "/", parameters);
    }

    /// What stands between two marks; nothing if either is missing.
    std::optional<std::string> between(const std::string &text, const std::string &before, const std::string &after)
    {
      const auto begin = text.find(before);
      if (begin == std::string::npos)
        return {};
      const auto end = text.rfind(after);
      if (end == std::string::npos || end < begin + before.size())
        return {};
      return text.substr(begin + before.size(), end - begin - before.size());
    }

    // ------------------------------------------------------------------ numbers

    /// A number or an integer with its bounds.
    struct NumberKind
    {
      bool                  is_integer;
      std::optional<double> lower, upper; ///< nothing: unbounded

      /// "a number in 0 ... 10 m", or in the plural "numbers in 0 ... 10 m".
      std::string text(const std::string &unit, const bool plural = false) const
      {
        const std::string noun  = plural ? (is_integer ? "integers" : "numbers") : is_integer ? "an integer" : "a number";
        const std::string range = range_text();
        const std::string in    = range.empty() ? (unit.empty() ? "" : " in") : lower && upper ? " in " + range : " " + range;
        return noun + in + (unit.empty() ? "" : " " + unit);
      }

      /// "lie in 0 ... 10 m" or "be >= 0 m" for a number that does not; "be a number ..." for anything else.
      std::string demand(const std::string &value, const std::string &unit) const
      {
        const std::string suffix = unit.empty() ? "" : " " + unit;
        const auto        number = parse_number(value);
        // What an integer can hold ends somewhere, too
        if (number && is_integer && *number > std::numeric_limits<int>::max())
          return "be at most " + std::to_string(std::numeric_limits<int>::max()) + suffix;
        const bool is_outside = number && ((lower && *number < *lower) || (upper && *number > *upper));
        if (!is_outside)
          return "be " + text(unit);
        return (lower && upper ? "lie in " : "be ") + range_text() + suffix;
      }

    private:
      /// "0 ... 10", ">= 0", "<= 10", or nothing.
      std::string range_text() const
      {
        if (lower && upper)
          return exact_text(*lower) + " ... " + exact_text(*upper);
        return lower ? ">= " + exact_text(*lower) : upper ? "<= " + exact_text(*upper) : "";
      }
    };

    std::optional<double> bound(const std::string &text)
    {
      // deal.II prints "MAX_DOUBLE" for what is unbounded
      const auto number = parse_number(text);
      return number && std::abs(*number) < std::numeric_limits<int>::max() ? number : std::nullopt;
    }

    std::optional<NumberKind> number_kind(const std::string &pattern)
    {
      const bool is_integer = pattern.rfind("[Integer", 0) == 0;
      if (!is_integer && pattern.rfind("[Double", 0) != 0)
        return {};
      NumberKind kind{is_integer, {}, {}};
      if (const auto range = between(pattern, is_integer ? "range " : "[Double ", " (inclusive)"))
        {
          kind.lower = bound(range->substr(0, range->find("...")));
          kind.upper = bound(range->substr(range->find("...") + 3));
        }
      return kind;
    }

    // -------------------------------------------------------------------- lists

    /// Several values with a separator; their pattern and largest number.
    struct ListKind
    {
      std::string element;
      std::size_t largest_number;
    };

    /// Lists of the program are separated by commas.
    std::optional<ListKind> list_kind(const std::string &pattern)
    {
      const auto element = between(pattern, "[List of <", "> of length ");
      const auto length  = between(pattern, "> of length ", " (inclusive)");
      if (!element || !length)
        return {};
      return ListKind{*element, std::stoul(length->substr(length->find("...") + 3))};
    }

    std::optional<std::string> choices(const std::string &pattern)
    {
      const auto names = between(pattern, "[Selection ", " ]");
      if (!names)
        return {};
      std::string text;
      for (const std::string &name : dealii::Utilities::split_string_list(*names, '|'))
        text += (text.empty() ? "" : ", ") + name;
      return text;
    }
    /// How a refused value ends a sentence.
    std::string but_is(const std::string &value)
    {
      if (value.empty())
        return ", but is empty";
      return ", not " + (parse_number(value) ? legible(value) : in_quotes(value));
    }
  } // namespace

  std::vector<std::string> CataloguedParameter::path_parts() const
  {
    return dealii::Utilities::split_string_list(path, '/');
  }

  std::string CataloguedParameter::unit() const
  {
    const std::string unit = between(documentation, "Units: ", ".").value_or("none");
    return unit == "none" || unit.find_first_of(", ") != std::string::npos ? "" : unit;
  }

  std::vector<CataloguedParameter> catalogue(const dealii::ParameterHandler &prm)
  {
    std::stringstream text;
    prm.print_parameters(text, static_cast<dealii::ParameterHandler::OutputStyle>(dealii::ParameterHandler::JSON |
                                                                                  dealii::ParameterHandler::KeepDeclarationOrder));
    std::vector<CataloguedParameter> parameters;
    collect(Json::parse(text), "", parameters);
    return parameters;
  }

  std::string accepted_values(const CataloguedParameter &parameter)
  {
    const std::string &pattern = parameter.pattern;
    if (const auto names = choices(pattern))
      return "one of " + *names;
    if (pattern == "[Bool]")
      return "true or false";
    if (const auto list = list_kind(pattern))
      if (const auto number = number_kind(list->element))
        return number->text(parameter.unit(), true) + ", separated by commas";
    if (const auto number = number_kind(pattern))
      return number->text(parameter.unit());
    return "";
  }

  std::string refusal(const CataloguedParameter &parameter, const std::string &value)
  {
    if (const auto number = number_kind(parameter.pattern))
      return parameter.path + " must " + number->demand(value, parameter.unit()) + but_is(value);
    if (const auto list = list_kind(parameter.pattern))
      {
        const auto parts = dealii::Utilities::split_string_list(value, ',');
        if (parts.size() > list->largest_number)
          return parameter.path + " has " + std::to_string(parts.size()) + " values, but takes at most " +
                 std::to_string(list->largest_number);
        for (std::size_t i = 0; i < parts.size(); ++i)
          if (!dealii::Patterns::pattern_factory(list->element)->match(parts[i]))
            return refusal({parameter.path + ", value " + std::to_string(i + 1) + ",", "", parameter.documentation, list->element},
                           parts[i]);
      }
    return parameter.path + " must be " + accepted_values(parameter) + but_is(value);
  }
} // namespace Squeal
