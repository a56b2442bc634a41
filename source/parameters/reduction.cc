// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/number_list.h>
#include <squeal/parameters/reduction.h>

#include <deal.II/base/utilities.h>

#include <boost/algorithm/string/join.hpp>

#include <cmath>

namespace Squeal
{
  namespace
  {
    const ListFormat truncation_list = {"Reduction/Component modes",
                                        "neither a frequency nor three numbers of modes",
                                        "frequency; ... [Hz], or disc, pins free, pins sliding; ... [modes]",
                                        "",
                                        {1, 3}};

    ModeTruncation parse_truncation(const ListEntry &entry)
    {
      if (entry.numbers.size() == 1)
        return {entry.numbers[0], 0, 0, 0};
      for (const double number : entry.numbers)
        if (number != std::floor(number) || number < 0. || number > 1e6)
          truncation_list.refuse(in_quotes(entry.text) + " contains a number of modes that is not an integer from 0 to 1000000");
      return {0., static_cast<int>(entry.numbers[0]), static_cast<int>(entry.numbers[1]), static_cast<int>(entry.numbers[2])};
    }
  } // namespace

  std::string ModeTruncation::text() const
  {
    if (frequency > 0.)
      return exact_text(frequency) + " Hz";
    return std::to_string(disc) + "/" + std::to_string(pins_free) + "/" + std::to_string(pins_sliding);
  }

  void ReductionParameters::declare(Declarations &declarations)
  {
    declarations.enter("Reduction");
    declarations.add(
      "Problem", problem,
      "Eigenproblem of the comparison. `frictionless`: real coupled modes (section 5 of the paper). `friction`: complex modes at "
      "Operation/Friction coefficient (section 6).");
    declarations.add_text(
      "Bases", "Names of reduced bases, separated by commas; empty: all bases that apply to the problem.",
      [this] { return boost::algorithm::join(bases, ", "); },
      [this](const std::string &text) {
        bases.clear();
        for (const std::string &name : dealii::Utilities::split_string_list(text, ','))
          if (!name.empty())
            bases.push_back(name);
      });
    declarations.add_text(
      "Component modes",
      "Truncations of the component modes, separated by semicolons. Each truncation is a frequency (all modes below it) or three numbers "
      "of modes `disc, pins free, pins sliding`, where the numbers for the pins count all pins together. Units: Hz.",
      [this] {
        std::vector<std::string> texts;
        for (const ModeTruncation &t : truncations)
          texts.push_back(t.frequency > 0. ? exact_text(t.frequency) :
                                             exact_text({double(t.disc), double(t.pins_free), double(t.pins_sliding)}));
        return boost::algorithm::join(texts, "; ");
      },
      [this](const std::string &text) {
        truncations.clear();
        for (const ListEntry &entry : parse_list(text, truncation_list))
          truncations.push_back(parse_truncation(entry));
      });
    declarations.add("Coupled frequency", coupled_frequencies, "Hz",
                     "Upper frequencies of the real coupled modes in the bases `real ...`, with one basis for each frequency; 0: end of "
                     "the band.",
                     {0.});
    declarations.add("Rank tolerance", rank_tolerance, "none",
                     "Directions of a basis with an M-norm below this fraction of the largest M-norm are dropped.", {1e-14, 1e-2});
    declarations.add("Grown tolerances", grown_tolerances, "none",
                     "Tolerances of the `residual-grown` bases, one basis for each tolerance: a basis is complete when the estimated "
                     "relative error of every lambda is below the tolerance.");
    declarations.add(
      "Snapshots", snapshots, "none",
      "Friction coefficients at which the complex modes of the basis `POD` are computed; for a system file, values of the parameter mu or, "
      "if there is no mu, of the first parameter.");
    declarations.add("POD tolerance", pod_tolerance, "none",
                     "Principal axes of the snapshots with an M-norm below this fraction of the largest M-norm are dropped.", {1e-13, 1.});
  }

  void ReductionParameters::check() const
  {
    if (truncations.empty())
      truncation_list.refuse("no truncation of the component modes is given");
    for (const ModeTruncation &truncation : truncations)
      if (!(truncation.frequency > 0.) && (truncation.disc < 1 || (truncation.pins_free < 1 && truncation.pins_sliding < 1)))
        throw ParameterError("the truncation `" + truncation.text() + "` has no modes of the disc, or no modes of the pins",
                             "parameter Reduction/Component modes",
                             "give a positive frequency, or at least one mode of the disc and one mode of the pins");
    for (const double mu : snapshots)
      if (!(mu >= 0. && mu <= 10.))
        throw ParameterError("the friction coefficient " + exact_text(mu) + " is not between 0 and 10", "parameter Reduction/Snapshots",
                             "give values from 0 to 10 near Operation/Friction coefficient");
    check_of_system();
  }

  void ReductionParameters::check_of_system() const
  {
    if (coupled_frequencies.empty())
      throw ParameterError("the list of upper frequencies of real coupled modes is empty", "parameter Reduction/Coupled frequency",
                           "give at least one frequency; 0 means the end of the band");
    check_distinct(coupled_frequencies, "Reduction/Coupled frequency");
    check_distinct(grown_tolerances, "Reduction/Grown tolerances");
    check_distinct(snapshots, "Reduction/Snapshots");
    for (const double tolerance : grown_tolerances)
      if (!(tolerance >= 1e-11 && tolerance <= 1e-1))
        throw ParameterError("the tolerance " + exact_text(tolerance) + " is not between 1e-11 and 0.1",
                             "parameter Reduction/Grown tolerances", "give values between 1e-11 and 0.1");
  }
} // namespace Squeal
