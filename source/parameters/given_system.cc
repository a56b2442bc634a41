// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/given_system.h>

#include <boost/algorithm/string.hpp>

#include <filesystem>

namespace Squeal
{
  namespace
  {
    std::vector<std::string> trimmed_parts(const std::string &text, const char *separator)
    {
      std::vector<std::string> parts;
      boost::split(parts, text, boost::is_any_of(separator));
      for (std::string &part : parts)
        boost::trim(part);
      return parts;
    }
  } // namespace

  std::string GivenSystemParameters::path() const
  {
    const std::filesystem::path beside = std::filesystem::path(directory) / file;
    return (std::filesystem::exists(beside) ? beside : std::filesystem::path(file)).lexically_normal().string();
  }

  void GivenSystemParameters::declare(Declarations &declarations)
  {
    declarations.add(
      "System", file,
      "Folder that contains system.json and its matrices, or path of system.json. The run uses this system instead of a mesh. Available "
      "for Study = stability, reduction, sweep, sensitivity, geometry (designs), search (Goal = probability or quantile), robustness and "
      "updating. Empty: the system is computed from the geometry.");
    declarations.add_text(
      "System values", "Parameter values that replace the values in the system file, for example mu = 0.3, omega = 12.6.",
      [this] {
        std::string result;
        for (const auto &[name, value] : values)
          result += (result.empty() ? "" : ", ") + name + " = " + exact_text(value);
        return result;
      },
      [this](const std::string &given) {
        values.clear();
        if (given.empty())
          return;
        for (const std::string &part : trimmed_parts(given, ","))
          {
            const auto sides = trimmed_parts(part, "=");
            const auto value = sides.size() == 2 ? parse_number(sides[1]) : std::nullopt;
            if (!value || sides[0].empty() || !values.emplace(sides[0], *value).second)
              throw ParameterError(in_quotes(part) + " is not of the form name = number, or sets a parameter for the second time",
                                   "parameter System values", "write name = number, separated by commas, and give each name once");
          }
      });
  }

  NamedRange parsed_range(const std::string &given, const std::string &where)
  {
    const auto parts  = trimmed_parts(given, ",");
    const auto refuse = [&](const std::string &what) {
      throw ParameterError(what, where, "write name, first value, last value and number of values, for example omega, 6.28, 25.1, 31");
    };
    if (parts.size() != 4 || parts[0].empty())
      refuse(in_quotes(given) + " is not a range of a parameter");
    const auto first = parse_number(parts[1]), last = parse_number(parts[2]), number = parse_number(parts[3]);
    if (!first || !last || !(*first < *last))
      refuse(text(in_quotes(parts[1]), " and ", in_quotes(parts[2]), " are not two ascending numbers"));
    if (!number || *number != static_cast<unsigned int>(*number) || *number < 2 || *number > 100000)
      refuse("the number of values, " + in_quotes(parts[3]) + ", is not an integer from 2 to 100000");
    return {parts[0], {*first, *last, static_cast<unsigned int>(*number)}};
  }
} // namespace Squeal
