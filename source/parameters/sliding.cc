#include <squeal/base/exceptions.h>
#include <squeal/parameters/enum_parameter.h>
#include <squeal/parameters/number_parameter.h>
#include <squeal/parameters/sliding.h>

#include <deal.II/base/utilities.h>

#include <cmath>
#include <set>
#include <sstream>

namespace Squeal
{
  namespace
  {
    constexpr const char *gap_format  = "pin: gap; pin: gap, sliding taper, radial taper; ... [m, -, -]";
    constexpr const char *load_format = "pin: load; pin: load; ... [N]";

    /// One entry `pin: number, number, ...` of a list.
    struct PinNumbers
    {
      std::string         pin;
      std::vector<double> numbers;
    };

    std::vector<PinNumbers> parse(const std::string           &text,
                                  const char                  *parameter,
                                  const std::set<std::size_t> &n_numbers,
                                  const char                  *format)
    {
      std::vector<PinNumbers> entries;
      std::set<std::string>   seen;
      for (const std::string &part : dealii::Utilities::split_string_list(text, ';'))
        {
          if (part.empty())
            continue;
          const auto halves = dealii::Utilities::split_string_list(part, ':');
          const auto values = halves.size() == 2 ? dealii::Utilities::split_string_list(halves[1], ',') : std::vector<std::string>();
          if (halves.empty() || halves[0].empty() || n_numbers.count(values.size()) == 0)
            throw ParameterError(in_quotes(part) + " is not an entry of the list", std::string("parameter ") + parameter,
                                 std::string("write ") + format);
          PinNumbers entry{halves[0], {}};
          for (const std::string &value : values)
            {
              const auto number = parse_number(value);
              if (!number)
                throw ParameterError(in_quotes(value) + " is not a finite number",
                                     std::string("parameter ") + parameter + ", pin " + legible(entry.pin), std::string("write ") + format);
              entry.numbers.push_back(*number);
            }
          if (!seen.insert(entry.pin).second)
            throw ParameterError("pin " + in_quotes(entry.pin) + " is given twice", std::string("parameter ") + parameter,
                                 "give each pin once");
          entries.push_back(entry);
        }
      return entries;
    }

    std::string print(const std::vector<PinNumbers> &entries)
    {
      std::ostringstream text;
      for (const PinNumbers &entry : entries)
        {
          text << (&entry == &entries.front() ? "" : "; ") << entry.pin << ": ";
          for (std::size_t i = 0; i < entry.numbers.size(); ++i)
            text << (i == 0 ? "" : ", ") << exact_text(entry.numbers[i]);
        }
      return text.str();
    }

    std::string print(const std::vector<PinGap> &gaps)
    {
      std::vector<PinNumbers> entries;
      for (const PinGap &gap : gaps)
        entries.push_back({gap.pin, {gap.gap, gap.sliding_taper, gap.radial_taper}});
      return print(entries);
    }

    std::string print(const std::vector<PinLoad> &loads)
    {
      std::vector<PinNumbers> entries;
      for (const PinLoad &load : loads)
        entries.push_back({load.pin, {load.load}});
      return print(entries);
    }
  } // namespace

  void SlidingParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection("Steady sliding");
    add_enum_parameter(prm, "Contact state", state,
                       "State about which the system is linearised: equal load, every contact node is closed and carries the same share "
                       "of the load of its side; steady sliding, the quasi-static solution with unilateral contact and friction, in "
                       "which nodes may lift off. All other parameters of this section belong to steady sliding.");
    add_enum_parameter(prm, "Control", control,
                       "What is given: load per side, the force Operation/Load per side on the rigid backplate of each side; "
                       "displacement, the way of both backplates; load per pin, a force on each pin.");
    add_number_parameter(prm, "Displacement", displacement,
                         "Way of each backplate along the disc's axis towards the disc, from where a pin without gap touches it, for "
                         "Control = displacement. Units: m.",
                         dealii::Patterns::Double(0.));
    prm.declare_entry("Loads", print(pin_loads), dealii::Patterns::Anything(),
                      "Forces on the pins for Control = load per pin, as a list `pin: load; ...`; a pin that is not listed gets an equal "
                      "share of Operation/Load per side. Units: N.");
    prm.add_action("Loads", [this](const std::string &text) {
      pin_loads.clear();
      for (const PinNumbers &entry : parse(text, "Steady sliding/Loads", {1}, load_format))
        pin_loads.push_back({entry.pin, entry.numbers[0]});
    });
    prm.declare_entry("Gaps", print(gaps), dealii::Patterns::Anything(),
                      "Initial gaps of pins (height tolerance, wear), as a list `pin: gap; pin: gap, sliding taper, radial taper; ...`, "
                      "along the disc's axis, positive where the pin does not touch. The gap grows by the tapers per distance from the "
                      "centre of the face along the sliding direction and outwards. Units: m, none, none.");
    prm.add_action("Gaps", [this](const std::string &text) {
      gaps.clear();
      for (const PinNumbers &entry : parse(text, "Steady sliding/Gaps", {1, 3}, gap_format))
        gaps.push_back({entry.pin, entry.numbers[0], entry.numbers.size() > 1 ? entry.numbers[1] : 0.,
                        entry.numbers.size() > 2 ? entry.numbers[2] : 0.});
    });
    prm.leave_subsection();
  }

  void SlidingParameters::check_steady() const
  {
    for (const PinLoad &entry : pin_loads)
      if (!(entry.load > 0.))
        throw ParameterError("the load is " + exact_text(entry.load) + " N", "parameter Steady sliding/Loads, pin " + entry.pin,
                             "give a positive force; a pin that shall not touch gets a gap and no actuator of its own");
    if (control == BackplateControl::displacement && !(displacement > 0.) && gaps.empty())
      throw ParameterError("the backplates do not move", "parameter Steady sliding/Displacement",
                           "give a positive way, or set Steady sliding/Control = load per side");
    if (control != BackplateControl::load_per_pin && !pin_loads.empty())
      throw ParameterError("loads of single pins are given, but `" + to_string(control) + "` is prescribed",
                           "parameter Steady sliding/Loads", "set Steady sliding/Control = load per pin, or remove the loads");
    if (control != BackplateControl::displacement && displacement != 0.)
      throw ParameterError("a displacement is given, but `" + to_string(control) + "` is prescribed",
                           "parameter Steady sliding/Displacement", "set Steady sliding/Control = displacement, or remove it");
  }
} // namespace Squeal
