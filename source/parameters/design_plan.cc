// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/design_plan.h>
#include <squeal/parameters/number_list.h>

#include <deal.II/base/utilities.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/sobol.hpp>
#include <boost/random/uniform_01.hpp>
#include <boost/random/uniform_int_distribution.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <map>
#include <numeric>
#include <sstream>

namespace Squeal
{
  namespace
  {
    using dealii::Utilities::split_string_list;
    using dealii::Utilities::trim;

    /// Maximum number of designs: a larger number is probably a typo, because full grids grow quickly.
    constexpr std::size_t most_designs = 100000;

    const std::string how_to_write = "write Section/Name = a, b, c or Section/Name = a to b in n";

    /// Value of a range, rounded to six digits, or to more digits if the range is narrow, so that designs differ.
    std::string rounded(const double value, const double first, const double last)
    {
      constexpr int      most_digits = 17;
      const double       size        = std::max(std::abs(first), std::abs(last)) / (last - first);
      std::ostringstream stream;
      stream << std::setprecision(std::min(most_digits, 6 + static_cast<int>(std::max(0., std::floor(std::log10(size)))))) << value;
      return exact_text(std::clamp(std::stod(stream.str()), first, last));
    }

    [[noreturn]] void refuse(const std::string &what, const std::string &change = how_to_write)
    {
      throw ParameterError(what, where_variables, change);
    }

    double number(const std::string &text, const std::string &entry)
    {
      const auto value = parse_number(text);
      if (!value)
        refuse(in_quotes(text) + " in " + in_quotes(entry) + " is not a finite number", how_to_write + decimal_point_hint(entry));
      return *value;
    }

    /// Parses a range, for example "0.03 to 0.05 in 5 by ratio".
    void parse_range(const std::string &text, const std::string &entry, DesignVariable &variable)
    {
      std::string       rest  = single_spaced(text);
      const std::string ratio = " by ratio";
      if (rest.size() > ratio.size() && rest.compare(rest.size() - ratio.size(), ratio.size(), ratio) == 0)
        {
          variable.by_ratio = true;
          rest.resize(rest.size() - ratio.size());
        }
      const auto to = rest.find(" to "), in = rest.find(" in ");
      variable.is_range = true;
      variable.first    = number(rest.substr(0, to), entry);
      variable.last     = number(rest.substr(to + 4, in == std::string::npos ? in : in - to - 4), entry);
      if (!(variable.first < variable.last))
        refuse("the range in " + in_quotes(entry) + " does not ascend", "give a last value above the first");
      if (variable.by_ratio && !(variable.first > 0.))
        refuse("the range in " + in_quotes(entry) + " begins at " + exact_text(variable.first) +
                 ", but `by ratio` requires positive values",
               "begin with a positive number, or remove `by ratio`");
      if (in == std::string::npos)
        return;
      const double n = number(rest.substr(in + 4), entry);
      if (n != std::floor(n) || n < 2. || n > most_designs)
        refuse("the number of levels in " + in_quotes(entry) + " is " + exact_text(n) + ", not an integer from 2 to " +
                 std::to_string(most_designs),
               "give an integer from 2 to " + std::to_string(most_designs));
      for (int i = 0; i < static_cast<int>(n); ++i)
        variable.levels.push_back(i + 1 < n ? variable.at(i / (n - 1.)) : exact_text(variable.last));
    }

    /// Path and index of "Section/Name[3]"; the index is zero if the name has no index.
    std::pair<std::string, unsigned int> split_index(const std::string &name, const std::string &where)
    {
      const auto bracket = name.find('[');
      if (bracket == std::string::npos)
        return {name, 0};
      const auto number = parse_number(name.substr(bracket + 1, name.size() - bracket - 2));
      if (name.back() != ']' || !number || *number != std::floor(*number) || *number < 1. || *number > 1e6)
        throw ParameterError(in_quotes(name) + " has an invalid index", where, "write Section/Name[k] with an integer k from 1 to 1000000");
      return {trim(name.substr(0, bracket)), static_cast<unsigned int>(*number)};
    }

    std::vector<std::string> names_of(const std::vector<DesignVariable> &variables)
    {
      std::vector<std::string> names;
      for (const DesignVariable &variable : variables)
        names.push_back(variable.name);
      return names;
    }

    /// Rejects names that set a number twice: A and A, A and A[1], A + B and B.
    void refuse_repeated(const std::vector<std::string> &names, const std::string &where)
    {
      std::vector<std::pair<std::string, std::pair<std::string, unsigned int>>> known; // written name; path and index that it sets
      for (const std::string &several : names)
        for (const std::string &name : split_string_list(several, '+'))
          {
            const auto [path, k] = split_index(name, where);
            for (const auto &[other, sets] : known)
              if (sets.first == path && (sets.second == k || sets.second == 0 || k == 0))
                throw ParameterError(in_quotes(path) + " varies twice: in " + in_quotes(other) +
                                       (other == several ? "" : " and in " + in_quotes(several)),
                                     where, "vary each number of a parameter only once");
            known.push_back({several, {path, k}});
          }
    }

    /// Normalised value for comparisons: "1, 2" for "1.0,2".
    std::string plain(const std::string &value)
    {
      std::string result;
      for (const std::string &part : split_string_list(value, ','))
        {
          const auto number = parse_number(part);
          result += (result.empty() ? "" : ", ") + (number ? exact_text(*number) : single_spaced(part));
        }
      return result;
    }

    void refuse_equal_levels(const DesignVariable &variable)
    {
      std::map<std::string, std::string> seen;
      for (const std::string &level : variable.levels)
        if (const auto [other, is_new] = seen.emplace(plain(level), level); !is_new)
          refuse(in_quotes(variable.name) + " has equal values, " + in_quotes(other->second) + " and " + in_quotes(level),
                 "give each value once; write decimals with a point, not a comma");
    }

    std::vector<DesignVariable> parse_variables(const std::string &text)
    {
      std::vector<DesignVariable> result;
      for (const std::string &entry : split_string_list(text, ';'))
        {
          if (entry.empty())
            continue;
          const auto equals = entry.find('=');
          if (equals == std::string::npos)
            refuse(in_quotes(entry) + " has no `=`", how_to_write + decimal_point_hint(text));
          DesignVariable    variable{single_spaced(entry.substr(0, equals)), {}};
          const std::string values = trim(entry.substr(equals + 1));
          if (variable.name.empty())
            refuse(in_quotes(entry) + " has no parameter name before `=`");
          if ((' ' + single_spaced(values)).find(" to ") != std::string::npos)
            parse_range(values, entry, variable);
          else
            {
              variable.levels = values.find('|') != std::string::npos ? split_string_list(values, '|') :
                                                                        split_numbers(values, variable.name, where_variables);
              variable.levels.erase(std::remove(variable.levels.begin(), variable.levels.end(), ""), variable.levels.end());
              if (variable.levels.empty())
                refuse(in_quotes(entry) + " has no values after `=`");
            }
          refuse_equal_levels(variable);
          result.push_back(variable);
        }
      if (result.empty())
        refuse("no varied parameter is given");
      refuse_repeated(names_of(result), where_variables);
      return result;
    }

    void check_levels(const std::vector<DesignVariable> &variables)
    {
      for (const DesignVariable &variable : variables)
        if (variable.levels.empty())
          refuse("the range of " + in_quotes(variable.name) + " has no levels",
                 "append `in n`, or set Designs/Plan = Latin hypercube or Sobol sequence to sample the range");
    }

    std::vector<std::vector<std::string>> full_grid(const std::vector<DesignVariable> &variables)
    {
      double n = 1.;
      for (const DesignVariable &variable : variables)
        n *= static_cast<double>(variable.levels.size());
      if (n > most_designs)
        refuse(text("the full grid has ", n, " designs, more than ", most_designs),
               "use fewer levels, or set Designs/Plan = Latin hypercube");
      std::vector<std::vector<std::string>> result = {{}};
      for (const DesignVariable &variable : variables)
        {
          std::vector<std::vector<std::string>> longer;
          for (const auto &values : result)
            for (const std::string &level : variable.levels)
              {
                longer.push_back(values);
                longer.back().push_back(level);
              }
          result = std::move(longer);
        }
      return result;
    }

    std::vector<std::vector<std::string>> one_at_a_time(const std::vector<DesignVariable> &variables)
    {
      const std::vector<std::string>        as_it_is(variables.size());
      std::vector<std::vector<std::string>> result = {as_it_is};
      for (std::size_t v = 0; v < variables.size(); ++v)
        for (const std::string &level : variables[v].levels)
          {
            result.push_back(as_it_is);
            result.back()[v] = level;
          }
      return result;
    }

    /// Samples in the unit cube, one per row. Boost's generators and distributions give the same numbers on every platform.
    std::vector<std::vector<double>> samples(const DesignParameters &designs, const std::size_t dimension)
    {
      const std::size_t                 n = designs.n_samples;
      std::vector<std::vector<double>>  result(n, std::vector<double>(dimension));
      boost::random::mt19937_64         generator(designs.seed);
      boost::random::uniform_01<double> uniform;
      if (designs.choice == DesignChoice::latin_hypercube)
        {
          for (std::size_t v = 0; v < dimension; ++v)
            {
              std::vector<std::size_t> parts(n);
              std::iota(parts.begin(), parts.end(), 0);
              for (std::size_t i = n; i > 1; --i)
                std::swap(parts[i - 1], parts[boost::random::uniform_int_distribution<std::size_t>(0, i - 1)(generator)]);
              for (std::size_t i = 0; i < n; ++i)
                result[i][v] = (static_cast<double>(parts[i]) + uniform(generator)) / static_cast<double>(n);
            }
          return result;
        }
      return sobol_points(n, dimension, designs.seed);
    }

    /// Position and length of the k-th number in a string.
    std::pair<std::size_t, std::size_t> place_of_number(const std::string &text, const unsigned int k, const std::string &where)
    {
      const auto   is_of_name = [](const char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.'; };
      unsigned int n          = 0;
      for (std::size_t i = 0; i < text.size();)
        {
          char             *end    = nullptr;
          const char *const start  = text.c_str() + i;
          const bool        begins = std::isdigit(static_cast<unsigned char>(*start)) || *start == '-' || *start == '+' || *start == '.';
          if (begins && (i == 0 || !is_of_name(text[i - 1])))
            std::strtod(start, &end);
          if (end == nullptr || end == start)
            {
              ++i;
              continue;
            }
          if (++n == k)
            return {i, end - start};
          i += end - start;
        }
      throw ParameterError(Squeal::text("the value ", in_quotes(text), " has ", counted(n, "number"), ", but number ", k, " is varied"),
                           where, "lower the index, or remove it to vary the whole value");
    }
  } // namespace

  std::string number_of(const std::string &text, const unsigned int k, const std::string &where)
  {
    const auto [place, length] = place_of_number(text, k, where);
    return text.substr(place, length);
  }

  std::string with_number(const std::string &text, const unsigned int k, const std::string &value, const std::string &where)
  {
    const auto [place, length] = place_of_number(text, k, where);
    return text.substr(0, place) + value + text.substr(place + length);
  }

  std::string DesignVariable::at(const double t) const
  {
    if (is_range)
      return rounded(by_ratio ? first * std::pow(last / first, t) : first + t * (last - first), first, last);
    return levels[std::min(levels.size() - 1, static_cast<std::size_t>(t * static_cast<double>(levels.size())))];
  }

  std::vector<DesignVariable> design_variables(const DesignParameters &designs)
  {
    return parse_variables(designs.variables);
  }

  std::vector<std::vector<double>> sobol_points(const std::size_t n, const std::size_t dimension, const unsigned int seed)
  {
    boost::random::mt19937_64         generator(seed);
    boost::random::uniform_01<double> uniform;
    std::vector<double>               shift(dimension, 0.);
    if (seed > 0)
      for (double &component : shift)
        component = uniform(generator);
    boost::random::sobol             sequence(dimension);
    std::vector<std::vector<double>> result(n, std::vector<double>(dimension));
    for (std::vector<double> &point : result)
      for (std::size_t v = 0; v < dimension; ++v)
        {
          double whole;
          point[v] = std::modf(uniform(sequence) + shift[v], &whole);
        }
    return result;
  }

  std::string as_csv(const DesignPlan &plan)
  {
    const auto line = [](const std::vector<std::string> &fields) {
      std::string result;
      for (const std::string &field : fields)
        result += (result.empty() ? "\"" : ",\"") + field + "\"";
      return result + "\n";
    };
    std::string result = line(plan.names);
    for (const std::vector<std::string> &values : plan.designs)
      result += line(values);
    return result;
  }

  DesignPlan design_plan(const Parameters &parameters)
  {
    const DesignParameters &designs = parameters.designs;
    if (designs.choice == DesignChoice::file)
      {
        DesignPlan plan = read_design_file(parameters);
        refuse_repeated(plan.names, plan.where_names);
        return plan;
      }
    const std::vector<DesignVariable> variables = parse_variables(designs.variables);
    DesignPlan                        plan;
    plan.names       = names_of(variables);
    plan.where_names = where_variables;
    if (!designs.is_sampled())
      {
        check_levels(variables);
        plan.designs = designs.choice == DesignChoice::full_grid ? full_grid(variables) : one_at_a_time(variables);
        return plan;
      }
    for (const std::vector<double> &sample : samples(designs, variables.size()))
      {
        plan.designs.emplace_back();
        for (std::size_t v = 0; v < variables.size(); ++v)
          plan.designs.back().push_back(variables[v].at(sample[v]));
      }
    return plan;
  }

  Parameters with_design(const Parameters               &parameters,
                         const std::vector<std::string> &names,
                         const std::vector<std::string> &values,
                         const std::string              &where)
  {
    Parameters result = parameters;
    for (std::size_t v = 0; v < names.size(); ++v)
      if (!values[v].empty())
        for (const std::string &name : split_string_list(names[v], '+'))
          {
            const auto [path, k] = split_index(name, where);
            result.set(path, where,
                       [&, k = k](const std::string &current) { return k == 0 ? values[v] : with_number(current, k, values[v], where); });
          }
    if (result.goal != AccuracyGoal::as_given)
      result = with_goal(result);
    return result;
  }

  std::string current_value(const Parameters &parameters, const std::string &name, const std::string &where)
  {
    const auto [path, k] = split_index(split_string_list(name, '+').front(), where);
    Parameters  copy     = parameters;
    std::string result;
    copy.set(path, where, [&result](const std::string &current) { return result = current; });
    return k == 0 ? result : number_of(result, k, where);
  }
} // namespace Squeal
