#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/damping.h>
#include <squeal/parameters/number_list.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace Squeal
{
  namespace
  {
    const ListFormat ratio_list = {"Damping/Modal damping ratio",
                                   "not a frequency with its damping ratio",
                                   "frequency: ratio, frequency: ratio, ... [Hz, -]",
                                   "",
                                   {2},
                                   ',',
                                   ':'};
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

  void DampingParameters::declare(Declarations &declarations)
  {
    declarations.enter("Damping");
    declare_list(declarations, "Modal damping ratio", modal_ratios,
                 "Damping ratios of the real coupled modes as a list `frequency: ratio, ...` over ascending frequencies, linear in "
                 "between and constant beyond the ends. Empty: none. Units: Hz and none.",
                 ratio_list, {&ModalDampingRatio::frequency, &ModalDampingRatio::ratio});
  }

  void DampingParameters::check() const
  {
    const std::string where = std::string("parameter ") + ratio_list.parameter;
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
