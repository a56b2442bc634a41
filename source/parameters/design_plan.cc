#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/design_plan.h>

#include <deal.II/base/utilities.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/sobol.hpp>
#include <boost/random/uniform_01.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <boost/tokenizer.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <numeric>
#include <sstream>

namespace Squeal
{
  namespace
  {
    using dealii::Utilities::split_string_list;
    using dealii::Utilities::trim;

    /// A full grid has so many designs soon; more are a slip of the pen.
    constexpr std::size_t most_designs = 100000;

    constexpr const char *where_variables = "parameter Designs/Variables";
    constexpr const char *how_to_write    = "write Section/Name = a, b, c; or Section/Name = a to b in n";

    /// A value that people can read: six digits tell designs apart.
    std::string rounded(const double value)
    {
      std::ostringstream stream;
      stream << std::setprecision(6) << value;
      return exact_text(std::stod(stream.str()));
    }

    [[noreturn]] void refuse(const std::string &what, const std::string &change = how_to_write)
    {
      throw ParameterError(what, where_variables, change);
    }

    double number(const std::string &text, const std::string &entry)
    {
      const auto value = parse_number(text);
      if (!value)
        refuse(in_quotes(text) + " in " + in_quotes(entry) + " is not a finite number");
      return *value;
    }

    /// "0.03 to 0.05 in 5 by ratio"
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
        refuse("the range in " + in_quotes(entry) + " does not ascend");
      if (variable.by_ratio && !(variable.first > 0.))
        refuse("the range in " + in_quotes(entry) + " begins at " + exact_text(variable.first) + ", of which there are no ratios",
               "begin with a positive number, or leave out `by ratio`");
      if (in == std::string::npos)
        return;
      const double n = number(rest.substr(in + 4), entry);
      if (n != std::floor(n) || n < 2. || n > most_designs)
        refuse("the number of levels in " + in_quotes(entry) + " is " + exact_text(n), "give two or more");
      for (int i = 0; i < static_cast<int>(n); ++i)
        variable.levels.push_back(i + 1 < n ? variable.at(i / (n - 1.)) : exact_text(variable.last));
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
            refuse(in_quotes(entry) + " has no `=`");
          DesignVariable    variable{single_spaced(entry.substr(0, equals)), {}};
          const std::string values = trim(entry.substr(equals + 1));
          if (variable.name.empty())
            refuse(in_quotes(entry) + " names no parameter");
          if (std::any_of(result.begin(), result.end(), [&](const DesignVariable &other) { return other.name == variable.name; }))
            refuse(in_quotes(variable.name) + " varies twice", "give each parameter once");
          if ((' ' + single_spaced(values)).find(" to ") != std::string::npos)
            parse_range(values, entry, variable);
          else
            {
              variable.levels = split_string_list(values, values.find('|') != std::string::npos ? '|' : ',');
              variable.levels.erase(std::remove(variable.levels.begin(), variable.levels.end(), ""), variable.levels.end());
              if (variable.levels.empty())
                refuse(in_quotes(entry) + " has no values");
            }
          result.push_back(variable);
        }
      if (result.empty())
        refuse("no parameter varies");
      return result;
    }

    void check_levels(const std::vector<DesignVariable> &variables)
    {
      for (const DesignVariable &variable : variables)
        if (variable.levels.empty())
          refuse("the range of " + in_quotes(variable.name) + " has no levels",
                 "write `in n` behind it; or set Designs/Plan = Latin hypercube or Sobol sequence, which sample ranges");
    }

    std::vector<std::vector<std::string>> full_grid(const std::vector<DesignVariable> &variables)
    {
      double n = 1.;
      for (const DesignVariable &variable : variables)
        n *= static_cast<double>(variable.levels.size());
      if (n > most_designs)
        refuse(text("the full grid has ", n, " designs"), "take fewer levels, or a Latin hypercube");
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

    /// Samples in the unit cube, a row each. The generators and distributions of Boost give the same numbers everywhere.
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

    std::vector<std::string> fields_of(const std::string &line, const std::string &where)
    {
      using Separator = boost::escaped_list_separator<char>;
      std::vector<std::string> result;
      try
        {
          for (const std::string &field : boost::tokenizer<Separator>(line, Separator('\0', ',', '"')))
            result.push_back(trim(field));
        }
      catch (const std::exception &error)
        {
          throw ParameterError("the line is not comma-separated: " + std::string(error.what()), where, "quote values that contain commas");
        }
      return result;
    }

    /// A file with the names of the variables in its first line and a design in each of the others.
    DesignPlan from_file(const Parameters &parameters)
    {
      namespace fs            = std::filesystem;
      const std::string &name = parameters.designs.file;
      if (name.empty())
        throw ParameterError("no file of designs is named", "parameter Designs/File", "name a CSV file, or choose another Designs/Plan");
      const fs::path beside = fs::path(parameters.geometry.directory) / name, file = fs::exists(beside) ? beside : fs::path(name);
      std::ifstream  stream(file);
      if (!stream)
        throw FileError("the file of designs cannot be read", "file " + beside.string() + ", parameter Designs/File",
                        "check its name and permissions");
      DesignPlan  plan;
      std::string line;
      for (int number = 1; std::getline(stream, line); ++number)
        {
          if (number == 1 && line.rfind("\xEF\xBB\xBF", 0) == 0)
            line = line.substr(3);
          if (trim(line).empty())
            continue;
          const std::string where  = text("file ", file.string(), ", line ", number);
          const auto        fields = fields_of(trim(line), where);
          if (plan.names.empty())
            {
              plan.names = fields;
              if (std::find(fields.begin(), fields.end(), "") != fields.end())
                throw ParameterError("a column has no name", where, "name the parameter of each column");
            }
          else if (fields.size() != plan.names.size())
            throw ParameterError(text(fields.size(), " values stand below ", plan.names.size(), " names"), where,
                                 "give one value for each name; quote values that contain commas");
          else
            plan.designs.push_back(fields);
        }
      if (plan.designs.empty())
        throw ParameterError("the file holds no design", "file " + file.string(),
                             "write names in the first line, a design in each other one");
      return plan;
    }

    /// "Section/Name[3]" divided into path and number; zero: none.
    std::pair<std::string, unsigned int> split_index(const std::string &name)
    {
      const auto bracket = name.find('[');
      if (bracket == std::string::npos)
        return {name, 0};
      const auto number = parse_number(name.substr(bracket + 1, name.size() - bracket - 2));
      if (name.back() != ']' || !number || *number != std::floor(*number) || *number < 1. || *number > 1e6)
        refuse(in_quotes(name) + " does not say which number varies", "write Section/Name[k] with k from one on");
      return {trim(name.substr(0, bracket)), static_cast<unsigned int>(*number)};
    }
  } // namespace

  namespace
  {
    /// Place and length of the k-th number of a text.
    std::pair<std::size_t, std::size_t> place_of_number(const std::string &text, const unsigned int k)
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
      throw ParameterError(Squeal::text("the value ", in_quotes(text), " has ", n, n == 1 ? " number" : " numbers", ", not ", k),
                           where_variables, "count the numbers from one on");
    }
  } // namespace

  std::string number_of(const std::string &text, const unsigned int k)
  {
    const auto [place, length] = place_of_number(text, k);
    return text.substr(place, length);
  }

  std::string with_number(const std::string &text, const unsigned int k, const std::string &value)
  {
    const auto [place, length] = place_of_number(text, k);
    return text.substr(0, place) + value + text.substr(place + length);
  }

  std::string DesignVariable::at(const double t) const
  {
    if (is_range)
      return rounded(by_ratio ? first * std::pow(last / first, t) : first + t * (last - first));
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
      return from_file(parameters);
    const std::vector<DesignVariable> variables = parse_variables(designs.variables);
    DesignPlan                        plan;
    for (const DesignVariable &variable : variables)
      plan.names.push_back(variable.name);
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

  Parameters with_design(const Parameters &parameters, const std::vector<std::string> &names, const std::vector<std::string> &values)
  {
    Parameters result = parameters;
    for (std::size_t v = 0; v < names.size(); ++v)
      if (!values[v].empty())
        for (const std::string &name : split_string_list(names[v], '+'))
          {
            const auto [path, k] = split_index(name);
            result.set(path, where_variables,
                       [&, k = k](const std::string &current) { return k == 0 ? values[v] : with_number(current, k, values[v]); });
          }
    if (result.goal != AccuracyGoal::as_given)
      result = with_goal(result);
    return result;
  }

  std::string current_value(const Parameters &parameters, const std::string &name)
  {
    const auto [path, k] = split_index(split_string_list(name, '+').front());
    Parameters  copy     = parameters;
    std::string result;
    copy.set(path, where_variables, [&result](const std::string &current) { return result = current; });
    return k == 0 ? result : number_of(result, k);
  }
} // namespace Squeal
