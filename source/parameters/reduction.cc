#include <squeal/base/exceptions.h>
#include <squeal/parameters/enum_parameter.h>
#include <squeal/parameters/number_parameter.h>
#include <squeal/parameters/reduction.h>

#include <deal.II/base/utilities.h>

#include <cmath>
#include <sstream>

namespace Squeal
{
  namespace
  {
    constexpr const char *truncation_format = "frequency; ... [Hz], or disc, pins free, pins sliding; ... [modes]";

    /// The numbers of a list; throws ParameterError naming the parameter.
    std::vector<double> parse_numbers(const std::string &text, const std::string &parameter, const std::string &format)
    {
      std::vector<double> numbers;
      for (const std::string &part : dealii::Utilities::split_string_list(text, ','))
        {
          if (part.empty())
            continue;
          const auto number = parse_number(part);
          if (!number)
            throw ParameterError(in_quotes(part) + " is not a finite number", "parameter " + parameter, "write " + format);
          numbers.push_back(*number);
        }
      return numbers;
    }

    std::string print_numbers(const std::vector<double> &numbers)
    {
      std::string text;
      for (const double number : numbers)
        text += (text.empty() ? "" : ", ") + exact_text(number);
      return text;
    }

    std::vector<ModeTruncation> parse_truncations(const std::string &text)
    {
      std::vector<ModeTruncation> result;
      for (const std::string &part : dealii::Utilities::split_string_list(text, ';'))
        {
          if (part.empty())
            continue;
          const auto numbers = parse_numbers(part, "Reduction/Component modes", truncation_format);
          if (numbers.size() == 1)
            result.push_back({numbers[0], 0, 0, 0});
          else if (numbers.size() == 3)
            {
              for (const double number : numbers)
                if (number != std::floor(number) || number < 0. || number > 1e6)
                  throw ParameterError(in_quotes(part) + " has a number of modes that is not a count",
                                       "parameter Reduction/Component modes", std::string("write ") + truncation_format);
              result.push_back({0., static_cast<int>(numbers[0]), static_cast<int>(numbers[1]), static_cast<int>(numbers[2])});
            }
          else
            throw ParameterError(in_quotes(part) + " is neither a frequency nor three numbers of modes",
                                 "parameter Reduction/Component modes", std::string("write ") + truncation_format);
        }
      return result;
    }

    std::string print_truncations(const std::vector<ModeTruncation> &truncations)
    {
      std::string text;
      for (const ModeTruncation &truncation : truncations)
        text += (text.empty() ? "" : "; ") + (truncation.frequency > 0. ?
                                                exact_text(truncation.frequency) :
                                                std::to_string(truncation.disc) + ", " + std::to_string(truncation.pins_free) + ", " +
                                                  std::to_string(truncation.pins_sliding));
      return text;
    }

    /// Binds a list of numbers.
    void add_list(dealii::ParameterHandler &prm, const std::string &name, std::vector<double> &numbers, const std::string &documentation)
    {
      prm.declare_entry(name, print_numbers(numbers), dealii::Patterns::Anything(), documentation);
      prm.add_action(
        name, [&numbers, name](const std::string &text) { numbers = parse_numbers(text, "Reduction/" + name, "a list of numbers"); });
    }
  } // namespace

  std::string ModeTruncation::text() const
  {
    if (frequency > 0.)
      return exact_text(frequency) + " Hz";
    return std::to_string(disc) + "/" + std::to_string(pins_free) + "/" + std::to_string(pins_sliding);
  }

  void ReductionParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Double;
    prm.enter_subsection("Reduction");
    add_enum_parameter(
      prm, "Problem", problem,
      "What the bases are measured on: frictionless, real coupled modes (section 5 of the paper); friction, complex modes at "
      "Operation/Friction coefficient (section 6).");
    std::string names;
    for (const std::string &name : bases)
      names += (names.empty() ? "" : ", ") + name;
    prm.declare_entry("Bases", names, dealii::Patterns::Anything(),
                      "Names of reduced bases, separated by commas; empty: all that fit the problem.");
    prm.add_action("Bases", [this](const std::string &text) {
      bases.clear();
      for (const std::string &name : dealii::Utilities::split_string_list(text, ','))
        if (!name.empty())
          bases.push_back(name);
    });
    prm.declare_entry("Component modes", print_truncations(truncations), dealii::Patterns::Anything(),
                      "Truncations of the component modes, separated by semicolons: a frequency (all modes below it) or three numbers of "
                      "modes `disc, pins free, pins sliding`, those of all pins together. Units: Hz.");
    prm.add_action("Component modes", [this](const std::string &text) { truncations = parse_truncations(text); });
    add_number_parameter(prm, "Coupled frequency", coupled_frequency,
                         "Real coupled modes below this frequency go into the bases `real ...`; 0: those of the band. Units: Hz.",
                         Double(0.));
    add_number_parameter(prm, "Rank tolerance", rank_tolerance,
                         "Directions of a basis whose M-norm is below this part of the largest are dropped. Units: none.",
                         Double(1e-14, 1e-2));
    add_list(prm, "Grown tolerances", grown_tolerances,
             "Bases `residual-grown`: grown until the estimated relative error of every lambda is below each of these. Units: none.");
    add_list(prm, "Snapshots", snapshots, "Friction coefficients whose complex modes make the basis `POD`. Units: none.");
    add_number_parameter(prm, "POD tolerance", pod_tolerance,
                         "Principal axes of the snapshots below this part of the largest are left out. Units: none.", Double(1e-13, 1.));
    prm.leave_subsection();
  }

  void ReductionParameters::check() const
  {
    if (truncations.empty())
      throw ParameterError("no truncation of the component modes is given", "parameter Reduction/Component modes",
                           std::string("write ") + truncation_format);
    for (const ModeTruncation &truncation : truncations)
      if (!(truncation.frequency > 0.) && (truncation.disc < 1 || (truncation.pins_free < 1 && truncation.pins_sliding < 1)))
        throw ParameterError("the truncation `" + truncation.text() + "` leaves no modes", "parameter Reduction/Component modes",
                             "give a positive frequency, or at least one mode of the disc and one of the pins");
    for (const double tolerance : grown_tolerances)
      if (!(tolerance >= 1e-11 && tolerance <= 1e-1))
        throw ParameterError("the tolerance " + exact_text(tolerance) + " is out of reach or no accuracy at all",
                             "parameter Reduction/Grown tolerances", "give values between 1e-11 and 0.1");
    for (const double mu : snapshots)
      if (!(mu >= 0. && mu <= 10.))
        throw ParameterError("the friction coefficient " + exact_text(mu) + " is not between 0 and 10", "parameter Reduction/Snapshots",
                             "give friction coefficients near that of the operation");
  }
} // namespace Squeal
