#pragma once

#include <squeal/parameters/declarations.h>

#include <set>
#include <string>
#include <vector>

namespace Squeal
{
  /// How a list of entries such as "disc_bore: 0, 7.8e10, 1.88e10; disc_rim: ..." is written.
  struct ListFormat
  {
    const char           *parameter; ///< "Section/Name"
    const char           *refusal;   ///< what a wrong entry is: "not an elastic mount"
    const char           *text;      ///< "surface: radial, tangential, axial; surface: ... [N/m^3]"
    const char           *key;       ///< what the name before the colon is: "surface"; empty where there is none
    std::set<std::size_t> n_numbers; ///< how many an entry may have
    char                  separator = ';', between_numbers = ',';

    /// Throws ParameterError with this format as the remedy.
    [[noreturn]] void refuse(const std::string &what) const;
  };

  struct ListEntry
  {
    std::string         text; ///< as written
    std::string         key;
    std::vector<double> numbers;
  };

  /// The entries of a list, empty ones left out. Throws ParameterError, also where a name is given twice.
  std::vector<ListEntry> parse_list(const std::string &text, const ListFormat &format);

  /// Declares a list of values, each of which @p print and @p read bring to an entry and back.
  template <typename Value, typename Print, typename Read>
  void declare_list(Declarations       &declarations,
                    const std::string  &name,
                    std::vector<Value> &values,
                    const std::string  &documentation,
                    const ListFormat   &format,
                    const Print        &print,
                    const Read         &read)
  {
    declarations.add_text(
      name, documentation,
      [=, &values] {
        std::string text;
        for (const Value &value : values)
          text += (text.empty() ? "" : format.separator + std::string(" ")) + print(value);
        return text;
      },
      [=, &values](const std::string &text) {
        values.clear();
        for (const ListEntry &entry : parse_list(text, format))
          values.push_back(read(entry));
      });
  }
} // namespace Squeal
