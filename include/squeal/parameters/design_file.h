#pragma once

#include <squeal/parameters/design_plan.h>

namespace Squeal
{
  /// Where the file of designs is: beside the parameter file, or in the current directory; empty where the designs come from none.
  std::string designs_file(const Parameters &parameters);

  /**
   * The designs of the CSV file that Designs/File names: names of the variables in its first line, a design in each of the others. Throws
   * FileError if it cannot be read, ParameterError with the line if it is no comma-separated text in UTF-8.
   */
  DesignPlan read_design_file(const Parameters &parameters);
} // namespace Squeal
