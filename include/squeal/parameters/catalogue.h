#pragma once

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// A declared parameter, read back from the handler that it was declared to.
  struct CataloguedParameter
  {
    std::string path; ///< "Section/Name"
    std::string value;
    std::string documentation;
    std::string pattern; ///< deal.II's description of what it accepts, such as "[Double 0...10 (inclusive)]"

    /// "Section", "Subsection", ... and last the name.
    std::vector<std::string> path_parts() const;

    /// The unit that ends the documentation, "Units: m."; empty where it is none, or where a list has several.
    std::string unit() const;
  };

  /// All parameters in the order in which they were declared.
  std::vector<CataloguedParameter> catalogue(const dealii::ParameterHandler &prm);

  /**
   * What a parameter accepts, in words, from its deal.II pattern: "a number in 0 ... 10", "an integer >= 1", "one of
   * positive, negative", "numbers >= 0 m, separated by commas"; empty where the pattern accepts anything.
   */
  std::string accepted_values(const CataloguedParameter &parameter);

  /// Why @p value is refused: "Operation/Friction coefficient must lie in 0 ... 10, not -0.1". The pattern must not match it.
  std::string refusal(const CataloguedParameter &parameter, const std::string &value);
} // namespace Squeal
