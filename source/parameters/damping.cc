#include <squeal/base/exceptions.h>
#include <squeal/parameters/damping.h>
#include <squeal/parameters/number_parameter.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

namespace Squeal
{
  namespace
  {
    constexpr const char *where  = "parameter Damping/Modal damping ratio";
    constexpr const char *format = "write frequency: ratio, frequency: ratio, ... [Hz, -]";

    std::string print_ratios(const std::vector<ModalDampingRatio> &ratios)
    {
      std::ostringstream text;
      for (const ModalDampingRatio &entry : ratios)
        text << (&entry == &ratios.front() ? "" : ", ") << exact_text(entry.frequency) << ": " << exact_text(entry.ratio);
      return text.str();
    }

    double number(const std::string &text)
    {
      const auto value = parse_number(text);
      if (!value)
        throw ParameterError(in_quotes(text) + " is not a number", where, format);
      return *value;
    }

    std::vector<ModalDampingRatio> parse_ratios(const std::string &text)
    {
      std::vector<ModalDampingRatio> ratios;
      for (const std::string &entry : dealii::Utilities::split_string_list(text, ','))
        {
          if (entry.empty())
            continue;
          const auto parts = dealii::Utilities::split_string_list(entry, ':');
          if (parts.size() != 2)
            throw ParameterError(in_quotes(entry) + " is not a frequency with its damping ratio", where, format);
          ratios.push_back({number(parts[0]), number(parts[1])});
        }
      return ratios;
    }
  } // namespace

  double DampingParameters::modal_ratio(const double frequency) const
  {
    if (modal_ratios.empty())
      return 0.;
    const auto above = std::upper_bound(modal_ratios.begin(), modal_ratios.end(), frequency,
                                        [](const double f, const ModalDampingRatio &entry) { return f < entry.frequency; });
    if (above == modal_ratios.begin())
      return above->ratio;
    const ModalDampingRatio &below = *(above - 1);
    if (above == modal_ratios.end())
      return below.ratio;
    return below.ratio + (above->ratio - below.ratio) * (frequency - below.frequency) / (above->frequency - below.frequency);
  }

  void DampingParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection("Damping");
    prm.declare_entry("Modal damping ratio", print_ratios(modal_ratios), dealii::Patterns::Anything(),
                      "Damping ratios of the real coupled modes as a list `frequency: ratio, ...` over ascending frequencies, linear in "
                      "between and constant beyond the ends. Empty: none. Units: Hz and none.");
    prm.add_action("Modal damping ratio", [this](const std::string &text) { modal_ratios = parse_ratios(text); });
    prm.leave_subsection();
  }

  void DampingParameters::check() const
  {
    for (const ModalDampingRatio &entry : modal_ratios)
      {
        if (!(entry.frequency >= 0.) || !std::isfinite(entry.frequency))
          throw ParameterError("the frequency " + exact_text(entry.frequency) + " Hz is not a finite value >= 0", where,
                               "give frequencies that are not negative");
        if (!(entry.ratio >= 0. && entry.ratio < 1.))
          throw ParameterError("the damping ratio " + exact_text(entry.ratio) + " at " + exact_text(entry.frequency) +
                                 " Hz is not in [0, 1)",
                               where, "give a ratio of the critical damping, 0.01 for one per cent");
        if (&entry != &modal_ratios.front() && !(entry.frequency > (&entry - 1)->frequency))
          throw ParameterError("the frequency " + exact_text(entry.frequency) + " Hz does not exceed the one before it, " +
                                 exact_text((&entry - 1)->frequency) + " Hz",
                               where, "give each frequency once, in ascending order");
      }
  }
} // namespace Squeal
