// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/robustness.h>

#include <boost/algorithm/string.hpp>

#include <regex>

namespace Squeal
{
  namespace
  {
    constexpr const char *where_distributions = "parameter Robustness/Distributions",
                         *where_correlations  = "parameter Robustness/Correlations";

    const std::string how_to_distribute = "write Section/Name = DISTRIBUTION with `uniform A to B`, `normal MEAN, DEVIATION`, `normal "
                                          "MEAN, DEVIATION in A to B`, `lognormal MEAN, DEVIATION` or `table A, B, C`; append % to all "
                                          "numbers for percent of the nominal value, and `for each pin` for independent values";

    [[noreturn]] void refuse_distribution(const std::string &what, const std::string &change = how_to_distribute)
    {
      throw ParameterError(what, where_distributions, change);
    }

    /// Entries separated by semicolons, each divided at its `=`.
    std::vector<std::pair<std::string, std::string>> entries_of(const std::string &given, const char *where, const std::string &change)
    {
      std::vector<std::pair<std::string, std::string>> result;
      std::vector<std::string>                         entries;
      boost::split(entries, given, boost::is_any_of(";"));
      for (const std::string &entry : entries)
        {
          const std::string line = single_spaced(entry);
          if (line.empty())
            continue;
          const auto        equals = line.find('=');
          const std::string name   = boost::trim_copy(line.substr(0, equals));
          if (equals == std::string::npos || name.empty())
            throw ParameterError(in_quotes(line) + " is not of the form `name = ...`", where, change);
          result.emplace_back(name, boost::trim_copy(line.substr(equals + 1)));
        }
      return result;
    }

    /// Numbers separated by commas and ` to `, all or none with a percent sign.
    std::vector<double> numbers_of(std::string list, const std::string &entry, bool &is_relative)
    {
      boost::replace_all(list, " to ", ",");
      std::vector<std::string> parts;
      boost::split(parts, list, boost::is_any_of(","));
      std::vector<double> result;
      std::size_t         n_percent = 0;
      for (std::string &part : parts)
        {
          boost::trim(part);
          if (boost::ends_with(part, "%"))
            {
              ++n_percent;
              part.pop_back();
              boost::trim(part);
            }
          const auto number = parse_number(part);
          if (!number)
            refuse_distribution(in_quotes(part) + " in " + in_quotes(entry) + " is not a finite number");
          result.push_back(*number);
        }
      if (n_percent != 0 && n_percent != result.size())
        refuse_distribution("some numbers in " + in_quotes(entry) + " have a percent sign and others do not",
                            "write % after all numbers or after none");
      is_relative = n_percent > 0;
      return result;
    }

    void check_numbers(const Distribution &distribution, const std::string &entry)
    {
      const std::vector<double> &x         = distribution.numbers;
      const auto                 n_numbers = x.size();
      switch (distribution.kind)
        {
          case DistributionKind::uniform:
            if (n_numbers != 2 || !(x[0] < x[1]))
              refuse_distribution(in_quotes(entry) + " does not give a lower limit and a higher upper limit");
            return;
          case DistributionKind::normal:
            if (n_numbers == 4 && !(x[2] < x[3]))
              refuse_distribution("the lower limit in " + in_quotes(entry) + " is not below the upper limit");
            if ((n_numbers != 2 && n_numbers != 4) || !(x[1] > 0.))
              refuse_distribution(in_quotes(entry) + " does not give a mean and a positive standard deviation");
            if (n_numbers == 4 && (x[2] > x[0] + 8. * x[1] || x[3] < x[0] - 8. * x[1]))
              refuse_distribution("the interval in " + in_quotes(entry) + " is more than 8 standard deviations from the mean",
                                  "give limits that enclose the mean");
            return;
          case DistributionKind::lognormal:
            if (n_numbers != 2 || !(x[0] > 0.) || !(x[1] > 0.))
              refuse_distribution(in_quotes(entry) + " does not give a positive mean and a positive standard deviation");
            return;
          case DistributionKind::table:
            if (n_numbers < 2)
              refuse_distribution(in_quotes(entry) + " is a table of only one value", "give two or more values");
        }
    }
  } // namespace

  void RobustnessParameters::declare(Declarations &declarations)
  {
    declarations.enter("Robustness");
    declarations.add(
      "Distributions", distributions,
      "Uncertain parameters, as `Section/Name = distribution; ...`: uniform A to B; normal MEAN, DEVIATION, truncated at three standard "
      "deviations from the mean or, with `in A to B`, at A and B (mean and deviation before truncation); lognormal MEAN, "
      "DEVIATION (of the parameter, not of its logarithm); table A, B, C with equally probable values. If all numbers of an entry end with "
      "%, they are percentages of the nominal value, which must be positive. If an entry ends with `for each pin`, each volume of a pin "
      "with the constants of Pin material has an independent value; this is available for Young modulus, Density, Rayleigh alpha and "
      "Rayleigh beta of Pin material. Names are written as in Designs/Variables; with a system file, they are names of its parameters.");
    declarations.add("Correlations", correlations,
                     "Correlation coefficients of the normal scores of two parameters (normal copula), as `name, name = value; ...`.");
    declarations.add(
      "Number of samples", n_samples, "none",
      "Number of independent samples from which the probabilities are computed; rounded up to an even number for Sobol indices.",
      {10., 1e6});
    declarations.add("Seed", seed, "none", "Seed of the random number generator; the same seed generates the same samples.",
                     {0., 2147483647.});
    declarations.add("Tolerance", tolerance, "none", "Maximum estimated relative error of lambda at every sample.", {1e-12, 0.1});
    declarations.add("Sobol indices", has_indices,
                     "Computes first-order and total Sobol' indices. Each uncertain number requires Number of samples / 2 additional "
                     "samples. Indices are not computed if parameters are correlated.");
    declarations.add("Frequency bands", frequency_bands, "Hz",
                     "Band limits in ascending order: the probability of squeal is also reported for each band between two successive "
                     "limits.",
                     {0.});
    declarations.add("Samples with onsets", n_onsets, "none",
                     "Number of samples, starting with the first, whose modes are tracked over the values of the section Sweep to find "
                     "their onsets of growth. The tolerance is Sweep/Tolerance.",
                     {0., 1e5});
    declarations.add("Worst samples", n_worst, "none",
                     "Number of samples with the largest divergence rates that are written as parameter files of full-order runs.",
                     {0., 1000.});
  }

  std::vector<UncertainParameter> RobustnessParameters::uncertain_parameters() const
  {
    std::vector<UncertainParameter> result;
    for (const auto &[name, given] : entries_of(distributions, where_distributions, how_to_distribute))
      {
        static const std::regex pattern(R"((uniform|normal|lognormal|table) (.*?)(?: in (.* to .*?))?( for each pin)?)");
        std::smatch             parts;
        if (!std::regex_match(given, parts, pattern))
          refuse_distribution(in_quotes(given) + " is not a valid distribution for " + in_quotes(name));
        UncertainParameter parameter{name, {enum_value<DistributionKind>(parts[1]), {}}};
        parameter.for_each_pin = parts[4].matched;
        if (parts[3].matched && parameter.distribution.kind != DistributionKind::normal)
          refuse_distribution("`in A to B` truncates normal distributions only, not " + in_quotes(given));
        parameter.distribution.numbers =
          numbers_of(parts[2].str() + (parts[3].matched ? "," + parts[3].str() : ""), given, parameter.is_relative);
        check_numbers(parameter.distribution, given);
        for (const UncertainParameter &other : result)
          if (other.name == name)
            refuse_distribution(in_quotes(name) + " has two distributions", "give each parameter once");
        result.push_back(std::move(parameter));
      }
    if (result.empty())
      refuse_distribution("no uncertain parameter is given");
    return result;
  }

  std::vector<Correlation> RobustnessParameters::parsed_correlations() const
  {
    const std::string        how    = "write name, name = value with a value between -1 and 1";
    const auto               refuse = [&](const std::string &what) { throw ParameterError(what, where_correlations, how); };
    const auto               known  = uncertain_parameters();
    std::vector<Correlation> result;
    for (const auto &[pair, given] : entries_of(correlations, where_correlations, how))
      {
        std::vector<std::string> names;
        boost::split(names, pair, boost::is_any_of(","));
        for (std::string &name : names)
          boost::trim(name);
        const auto value = parse_number(given);
        if (names.size() != 2 || names.front() == names.back() || !value || !(std::abs(*value) < 1.))
          refuse(in_quotes(pair + " = " + given) + " is not a correlation between -1 and 1 of two different parameters");
        for (const std::string &name : names)
          {
            const auto found = std::find_if(known.begin(), known.end(), [&](const UncertainParameter &p) { return p.name == name; });
            if (found == known.end())
              throw ParameterError(in_quotes(name) + " has no distribution", where_correlations,
                                   "give its distribution in Robustness/Distributions, or remove the correlation");
            if (found->for_each_pin)
              throw ParameterError(in_quotes(name) + " is independent for each pin", where_correlations,
                                   "remove the correlation, or `for each pin` in Robustness/Distributions");
          }
        for (const Correlation &other : result)
          if ((other.first == names.front() && other.second == names.back()) ||
              (other.first == names.back() && other.second == names.front()))
            throw ParameterError("the pair " + in_quotes(names.front() + ", " + names.back()) + " has two correlations", where_correlations,
                                 "give each pair once");
        result.push_back({names.front(), names.back(), *value});
      }
    return result;
  }
} // namespace Squeal
