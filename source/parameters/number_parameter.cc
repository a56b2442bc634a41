#include <squeal/parameters/number_parameter.h>

#include <deal.II/base/utilities.h>

#include <array>
#include <charconv>

namespace Squeal
{
  std::string exact_text(const double value)
  {
    std::array<char, 32> text;
    const auto           end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    return {text.data(), end};
  }

  void add_number_parameter(dealii::ParameterHandler            &prm,
                            const std::string                   &name,
                            double                              &value,
                            const std::string                   &documentation,
                            const dealii::Patterns::PatternBase &pattern)
  {
    prm.declare_entry(name, exact_text(value), pattern, documentation);
    prm.add_action(name, [&value](const std::string &text) { value = dealii::Utilities::string_to_double(text); });
  }

  void add_number_parameter(dealii::ParameterHandler            &prm,
                            const std::string                   &name,
                            std::vector<double>                 &values,
                            const std::string                   &documentation,
                            const dealii::Patterns::PatternBase &pattern)
  {
    std::string list;
    for (std::size_t i = 0; i < values.size(); ++i)
      list += (i > 0 ? ", " : "") + exact_text(values[i]);
    prm.declare_entry(name, list, pattern, documentation);
    prm.add_action(name, [&values](const std::string &text) {
      values = dealii::Utilities::string_to_double(dealii::Utilities::split_string_list(text, ','));
    });
  }
} // namespace Squeal
