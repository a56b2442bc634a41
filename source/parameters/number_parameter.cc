#include <squeal/parameters/number_parameter.h>

#include <deal.II/base/utilities.h>

namespace Squeal
{
  void add_number_parameter(dealii::ParameterHandler            &prm,
                            const std::string                   &name,
                            double                              &value,
                            const std::string                   &documentation,
                            const dealii::Patterns::PatternBase &pattern)
  {
    prm.declare_entry(name, exact_text(value), pattern, documentation);
    // The pattern has refused what is not a number
    prm.add_action(name, [&value](const std::string &text) { value = parse_number(text).value(); });
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
      values.clear();
      for (const std::string &part : dealii::Utilities::split_string_list(text, ','))
        values.push_back(parse_number(part).value());
    });
  }
} // namespace Squeal
