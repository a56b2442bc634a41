#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/number_list.h>

#include <deal.II/base/utilities.h>

namespace Squeal
{
  using dealii::Utilities::split_string_list;

  void ListFormat::refuse(const std::string &what) const
  {
    throw ParameterError(what, std::string("parameter ") + parameter, std::string("write ") + text);
  }

  std::vector<ListEntry> parse_list(const std::string &text, const ListFormat &format)
  {
    const bool             has_key = *format.key != '\0';
    std::set<std::string>  seen;
    std::vector<ListEntry> entries;
    for (const std::string &part : split_string_list(text, format.separator))
      {
        if (part.empty())
          continue;
        const auto halves = has_key ? split_string_list(part, ':') : std::vector<std::string>{"", part};
        const auto values = halves.size() == 2 ? split_string_list(halves[1], format.between_numbers) : std::vector<std::string>();
        if (format.n_numbers.count(values.size()) == 0)
          format.refuse(in_quotes(part) + " is " + format.refusal);
        ListEntry entry{part, halves[0], {}};
        if (has_key && entry.key.empty())
          format.refuse(in_quotes(part) + " is " + format.refusal + ": it names no " + format.key);
        if (has_key && !seen.insert(entry.key).second)
          throw ParameterError(format.key + (" " + in_quotes(entry.key)) + " is given twice", std::string("parameter ") + format.parameter,
                               std::string("give each ") + format.key + " once");
        for (const std::string &value : values)
          if (const auto number = parse_number(value))
            entry.numbers.push_back(*number);
          else
            throw ParameterError(in_quotes(value) + " is not a finite number",
                                 std::string("parameter ") + format.parameter +
                                   (has_key ? std::string(", ") + format.key + " " + legible(entry.key) : ""),
                                 std::string("write ") + format.text);
        entries.push_back(entry);
      }
    return entries;
  }
} // namespace Squeal
