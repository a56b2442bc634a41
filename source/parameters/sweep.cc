// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/given_system.h>
#include <squeal/parameters/number_list.h>
#include <squeal/parameters/sweep.h>

#include <cmath>
#include <string>

namespace Squeal
{
  namespace
  {
    template <typename Function>
    std::vector<double> spaced(const ValueRange &range, const Function &between)
    {
      std::vector<double> values;
      for (unsigned int i = 0; i < range.number; ++i)
        values.push_back(i == 0 ? range.first : i + 1 == range.number ? range.last : between(double(i) / (range.number - 1)));
      return values;
    }

    void check_range(const ValueRange &range, const std::string &what, const std::string &parameters)
    {
      if (range.number == 0)
        throw ParameterError("the number of " + what + " is zero", "parameters " + parameters, "give a number of at least 1");
      if (range.number > 1 && !(range.first < range.last))
        throw ParameterError("the range of the " + what + " from " + exact_text(range.first) + " to " + exact_text(range.last) +
                               " does not ascend",
                             "parameters " + parameters, "give a last value above the first, or a single value");
    }

    void check_inside(const std::vector<double> &values, const ValueRange &range, const char *name)
    {
      for (const double value : values)
        if (value < range.first || value > (range.number > 1 ? range.last : range.first))
          throw ParameterError("the value " + exact_text(value) + " is outside the sweep", std::string("parameter Sweep/") + name,
                               "give values from " + exact_text(range.first) + " to " +
                                 exact_text(range.number > 1 ? range.last : range.first) + "; commas separate values");
    }
  } // namespace

  std::vector<double> ValueRange::linear() const
  {
    return spaced(*this, [this](const double s) { return first + s * (last - first); });
  }

  std::vector<double> ValueRange::geometric() const
  {
    return spaced(*this, [this](const double s) { return first * std::pow(last / first, s); });
  }

  std::vector<double> SweepParameters::map_grid() const
  {
    return ValueRange{friction_coefficients.first, friction_coefficients.last, map_friction_coefficients}.linear();
  }

  void SweepParameters::declare(Declarations &declarations)
  {
    constexpr Range       coefficients      = {0., 10.};
    constexpr std::size_t most_coefficients = 1000;
    declarations.enter("Sweep");
    declarations.add("First friction coefficient", friction_coefficients.first, "none", "Start of the sweep.", coefficients);
    declarations.add("Last friction coefficient", friction_coefficients.last, "none", "End of the sweep.", coefficients);
    declarations.add("Number of friction coefficients", friction_coefficients.number, "none",
                     "Number of equally spaced values in the sweep; the steps are refined where modes coalesce.", {1, 100000});
    declarations.add("Tolerance", tolerance, "none",
                     "Maximum estimated relative error of lambda, for every mode at every value of the sweep.", {1e-10, 1e-2});
    declarations.add(
      "Maximum basis", maximum_basis, "vectors",
      "Size beyond which the reduced basis is not enriched; it contains all real modes even if there are more. If a sweep requires a "
      "larger basis, only the values that meet the tolerance are written, and a design fails. The limit is 900 for a common basis of "
      "several designs, and 1500 for samples of uncertain parameters.",
      {1});
    declarations.add("Threshold tolerance", threshold_tolerance, "none",
                     "Maximum width of the interval of the varied parameter that encloses a threshold.", {1e-13, 1e-2});
    declarations.add("Compare dissipation", compare_dissipation,
                     "If Operation/Radial dissipation is not none, repeats the sweep without it and shows both results.");
    declarations.add(
      "Mode shapes at", mode_shapes, "none",
      "Friction coefficients, separated by commas, at which the mode with the largest divergence rate is written as a field if it grows.",
      coefficients, most_coefficients);
    declarations.add(
      "Complex plane at", planes, "none",
      "Values within the sweep, separated by commas, at which all modes of the band are written to a table and drawn in the complex plane; "
      "empty: the values of Mode shapes at.",
      {}, most_coefficients);
    declarations.add(
      "Count modes at", counts, "none",
      "Values within the sweep, separated by commas, at which the modes of the band are counted by the argument principle, independently "
      "of the solver for complex modes.",
      {}, most_coefficients);
    declarations.add(
      "Map parameter", map_parameter,
      "Second parameter of a stability map, in addition to the friction coefficient: the load per side or the rotation speed.");
    declarations.add("First map value", map_values.first, "N or rad/s", "Smallest load or speed of the map.", {0.});
    declarations.add("Last map value", map_values.last, "N or rad/s", "Largest load or speed of the map.", {0.});
    declarations.add("Number of map values", map_values.number, "none",
                     "Number of loads or speeds in the map; the ratio of successive values is constant.", {1, 10000});
    declarations.add("Map friction coefficients", map_friction_coefficients, "none",
                     "Number of friction coefficients in the map, equally spaced from the first to the last value of the sweep.",
                     {1, 10000});
    declarations.add("Parameter", parameter,
                     "With System: name, first value, last value and number of values of the varied parameter, for example omega, 6.28, "
                     "25.1, 31. Empty: the parameter mu, from First to Last friction coefficient.");
    declarations.add("Second parameter", second_parameter,
                     "With System: the second parameter of a stability map, in the same format as Parameter. Empty: no map.");
  }

  NamedRange SweepParameters::varied_parameter() const
  {
    return parameter.empty() ? NamedRange{"mu", friction_coefficients} : parsed_range(parameter, "parameter Sweep/Parameter");
  }

  std::optional<NamedRange> SweepParameters::second_varied_parameter() const
  {
    return second_parameter.empty() ? std::nullopt : std::optional(parsed_range(second_parameter, "parameter Sweep/Second parameter"));
  }

  void SweepParameters::check_of_system() const
  {
    const NamedRange varied = varied_parameter();
    check_range(varied.values, "values of " + varied.name,
                parameter.empty() ? "Sweep/First friction coefficient, Last friction coefficient and Number of friction coefficients" :
                                    "Sweep/Parameter");
    if (const auto second = second_varied_parameter(); second && second->name == varied.name)
      throw ParameterError(in_quotes(second->name) + " is both the first and the second parameter of the map",
                           "parameter Sweep/Second parameter", "name a different parameter");
    check_distinct(planes, "Sweep/Complex plane at");
    check_distinct(counts, "Sweep/Count modes at");
    check_inside(planes, varied.values, "Complex plane at");
    check_inside(counts, varied.values, "Count modes at");
  }

  void SweepParameters::check() const
  {
    check_range(friction_coefficients, "friction coefficients",
                "Sweep/First friction coefficient, Last friction coefficient and Number of friction coefficients");
    check_distinct(mode_shapes, "Sweep/Mode shapes at");
    check_distinct(planes, "Sweep/Complex plane at");
    check_distinct(counts, "Sweep/Count modes at");
    check_inside(mode_shapes, friction_coefficients, "Mode shapes at");
    check_inside(planes, friction_coefficients, "Complex plane at");
    check_inside(counts, friction_coefficients, "Count modes at");
    if (map_parameter == MapParameter::none)
      return;
    check_range(map_values, "map values", "Sweep/First map value, Last map value and Number of map values");
    if (!(map_values.first > 0.))
      throw ParameterError("the map begins at zero, but its values have a constant ratio", "parameter Sweep/First map value",
                           "give a positive load or speed");
    // Check the range again, because a sweep with a single value need not ascend
    check_range({friction_coefficients.first, friction_coefficients.last, map_friction_coefficients}, "friction coefficients of the map",
                "Sweep/First friction coefficient, Last friction coefficient and Map friction coefficients");
  }
} // namespace Squeal
