// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/contact.h>
#include <squeal/parameters/number_list.h>

#include <deal.II/base/utilities.h>

#include <boost/algorithm/string/join.hpp>

#include <cmath>

namespace Squeal
{
  namespace
  {
    constexpr const char *where = "parameter Contact/Pairs", *where_tied = "parameter Contact/Tied";

    std::string print(const std::vector<ContactPair> &pairs)
    {
      std::vector<std::string> texts;
      for (const ContactPair &pair : pairs)
        {
          const bool is_rigid = pair.normal_stiffness == 0.;
          texts.push_back(pair.disc + " / " + pair.pin +
                          (is_rigid && pair.friction_factor == 1. ? "" : ": " + exact_text(pair.friction_factor)) +
                          (is_rigid ? "" : ", " + exact_text(pair.normal_stiffness)));
        }
      return boost::algorithm::join(texts, "; ");
    }

    std::vector<ContactPair> parse(const std::string &text)
    {
      using dealii::Utilities::split_string_list;
      std::vector<ContactPair> pairs;
      const auto               refuse = [](const std::string &what) {
        throw ParameterError(
                        what, where,
                        "write surface of the disc / surface of another body: friction factor, normal stiffness; ...; the numbers may be "
                                      "omitted, for example disc_top / pad_outer; disc_bottom / pad_inner: 0.9");
      };
      for (const std::string &entry : split_string_list(text, ';'))
        {
          if (entry.empty())
            continue;
          const auto halves = split_string_list(entry, ':'), names = split_string_list(halves[0], '/');
          if (halves.size() > 2 || names.size() != 2 || names[0].empty() || names[1].empty())
            refuse(in_quotes(entry) + " is not a pair of surfaces");
          ContactPair pair{names[0], names[1]};
          const auto  numbers = halves.size() == 2 ? split_numbers(halves[1], "Contact/Pairs", where) : std::vector<std::string>{"1"};
          const auto  factor = parse_number(numbers[0]), stiffness = numbers.size() > 1 ? parse_number(numbers[1]) : std::optional(0.);
          if (numbers.size() > 2 || !factor || !(*factor > 0.))
            refuse(in_quotes(entry) + " does not give a positive friction factor, optionally followed by one normal stiffness");
          if (!stiffness || !(*stiffness >= 0.))
            refuse("the normal stiffness in " + in_quotes(entry) + " is not a number >= 0");
          pair.friction_factor  = *factor;
          pair.normal_stiffness = *stiffness;
          if (names[0] == names[1])
            throw ParameterError(in_quotes(names[0]) + " is paired with itself", where, "pair two different surfaces");
          for (const ContactPair &other : pairs)
            if (other.disc == names[0] && other.pin == names[1])
              throw ParameterError("the pair " + in_quotes(names[0] + " / " + names[1]) + " is given twice", where, "give each pair once");
          pairs.push_back(pair);
        }
      if (pairs.empty())
        refuse("the list of contact pairs is empty");
      return pairs;
    }

    std::vector<TiedPair> parse_tied(const std::string &text)
    {
      using dealii::Utilities::split_string_list;
      std::vector<TiedPair> result;
      for (const std::string &entry : split_string_list(text, ';'))
        {
          if (entry.empty())
            continue;
          const auto names = split_string_list(entry, '/');
          if (names.size() != 2 || names[0].empty() || names[1].empty() || names[0] == names[1])
            throw ParameterError(in_quotes(entry) + " is not a pair of different surfaces", where_tied,
                                 "write surface / other surface; ..., for example lining_back / backplate_front");
          result.push_back({names[0], names[1]});
        }
      return result;
    }

    std::string print_tied(const std::vector<TiedPair> &pairs)
    {
      std::vector<std::string> texts;
      for (const TiedPair &pair : pairs)
        texts.push_back(pair.slave + " / " + pair.master);
      return boost::algorithm::join(texts, "; ");
    }
  } // namespace

  void ContactParameters::declare(Declarations &declarations)
  {
    declarations.enter("Contact");
    declarations.add_text(
      "Pairs",
      "Pairs of sliding surfaces, as a list `surface of the disc / surface of another body: friction factor, normal stiffness; ...`. The "
      "factor (default: 1) multiplies Operation/Friction coefficient. The second number is the stiffness per area of springs normal to the "
      "faces; without this number, the contact is rigid. The meshes need not match: faces with different nodes are coupled by mortar "
      "elements. Units: none, N/m^3.",
      [this] { return print(pairs); }, [this](const std::string &text) { pairs = parse(text); });
    declarations.add_text(
      "Tied",
      "Bonded surfaces, as a list `surface / other surface; ...`: the nodes of the first surface follow the second surface, and the "
      "volumes become one body. The meshes need not match; the first surface should be the smaller, finer or softer of the two. Units: "
      "none.",
      [this] { return print_tied(tied); }, [this](const std::string &text) { tied = parse_tied(text); });
  }

  void ContactParameters::check() const
  {
    for (const TiedPair &one : tied)
      {
        for (const ContactPair &pair : pairs)
          for (const std::string &surface : {one.slave, one.master})
            if (surface == pair.disc || surface == pair.pin)
              throw ParameterError("surface " + in_quotes(surface) + " is in both Contact/Tied and Contact/Pairs", where_tied,
                                   "remove it from one of the two lists");
        for (const TiedPair &other : tied)
          if (&one != &other && one.slave == other.slave)
            throw ParameterError("surface " + in_quotes(one.slave) + " is the first surface of two ties", where_tied,
                                 "use each surface as the first surface of only one tie");
      }
  }
} // namespace Squeal
